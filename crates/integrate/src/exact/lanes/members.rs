//! The elements of eight sets that are solved together.

use super::Pack;

/// The elements that are solved together, and room for it.
pub(super) struct Together {
    /// Places among all elements.
    pub(super) members: Vec<usize>,
    /// S of each at the ends of the four steps before the last.
    pub(super) before: Vec<[Pack; 4]>,
    pub(super) without: Vec<[Pack; 2]>,
    pub(super) old: Vec<Pack>,
    pub(super) matrix: Vec<Pack>,
    pub(super) residual: Vec<Pack>,
}

impl Together {
    pub(super) fn new(members: &[usize], before: Vec<[Pack; 4]>) -> Together {
        let g = members.len();
        Together {
            members: members.to_vec(),
            before,
            without: vec![[Pack::ZERO; 2]; g],
            old: vec![Pack::ZERO; g],
            matrix: vec![Pack::ZERO; g * g],
            residual: vec![Pack::ZERO; g],
        }
    }
}
