//! The elements that are solved together.

/// The elements that are solved together, and room for it.
#[derive(Default)]
pub(super) struct Together {
    /// Places among all elements.
    pub(super) members: Vec<usize>,
    /// S of each at the ends of the four steps before the last.
    pub(super) before: Vec<[f64; 4]>,
    pub(super) without: Vec<[f64; 2]>,
    pub(super) old: Vec<f64>,
    pub(super) matrix: Vec<f64>,
    pub(super) residual: Vec<f64>,
}

impl Together {
    pub(super) fn new(members: Vec<usize>) -> Together {
        let g = members.len();
        Together {
            members,
            before: vec![[0.0; 4]; g],
            without: vec![[0.0; 2]; g],
            old: vec![0.0; g],
            matrix: vec![0.0; g * g],
            residual: vec![0.0; g],
        }
    }

    /// At the first sample.
    pub(super) fn begin(&mut self, smooth: &[f64]) {
        for (&i, before) in self.members.iter().zip(&mut self.before) {
            *before = [smooth[i]; 4];
        }
    }
}
