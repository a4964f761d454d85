//! Time integration, forward and inverse: Park, Newmark, generalized-alpha, Runge-Kutta, exact propagation.
