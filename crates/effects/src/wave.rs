//! Forces that go up and down along the travel.

/// The places, among its parameters, of what makes an effect a force along the travel d,
/// `sine · sin(2π d / period) + cosine · cos(2π d / period)`: another point to count the travel from turns it into itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wave {
    /// Place of the factor of the sine, N.
    pub sine: usize,
    /// Place of the factor of the cosine, N; after that of the sine.
    pub cosine: usize,
    /// Place of the period, m.
    pub period: usize,
}
