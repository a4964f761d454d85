//! Measured records: channels, units, time base, file formats, quality checks.
