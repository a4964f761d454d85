//! A model with its effects driven by a record: predicted outputs.
