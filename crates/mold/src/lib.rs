//! The mold oscillator of the paper: one and two degrees of freedom, and its records rebuilt from the tables.
