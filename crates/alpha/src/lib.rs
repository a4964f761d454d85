//! The paper's unknown force: inverse dynamics, Fourier part and beat part.
