//! The catalogue of unmodelled effects: one file per effect, physical and measurement.
