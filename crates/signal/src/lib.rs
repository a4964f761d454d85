//! Spectra, peaks, windows, order tracking, FRF estimators and agreement metrics.
