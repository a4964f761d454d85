//! The paper's Tables 1-5 as typed data with provenance; nothing computed.
