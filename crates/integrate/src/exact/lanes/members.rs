//! The joints of eight sets that are solved together.

use super::Pack;

/// The joints that are solved together, and room for it.
pub(super) struct Together {
    /// Places among all joints.
    pub(super) members: Vec<usize>,
    pub(super) without: Vec<[Pack; 2]>,
    pub(super) old: Vec<Pack>,
    pub(super) matrix: Vec<Pack>,
    pub(super) residual: Vec<Pack>,
}

impl Together {
    pub(super) fn new(members: &[usize]) -> Together {
        let g = members.len();
        Together {
            members: members.to_vec(),
            without: vec![[Pack::ZERO; 2]; g],
            old: vec![Pack::ZERO; g],
            matrix: vec![Pack::ZERO; g * g],
            residual: vec![Pack::ZERO; g],
        }
    }
}
