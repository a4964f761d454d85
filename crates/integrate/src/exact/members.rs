//! The joints that are solved together.

/// The joints that are solved together, and room for it.
#[derive(Default)]
pub(super) struct Together {
    /// Places among all joints.
    pub(super) members: Vec<usize>,
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
            without: vec![[0.0; 2]; g],
            old: vec![0.0; g],
            matrix: vec![0.0; g * g],
            residual: vec![0.0; g],
        }
    }
}
