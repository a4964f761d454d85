//! Pages and pictures of a diagnosis.
