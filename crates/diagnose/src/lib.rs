//! Where the gap lies, which effect causes it, how far it shrinks.
