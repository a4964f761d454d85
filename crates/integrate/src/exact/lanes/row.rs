//! Packs of one number for each degree of freedom.

use super::Pack;

/// Packs of one number for each degree of freedom: an array where the compiler knows how many, so
/// that they stay in registers from step to step.
pub(super) trait Row: Clone {
    fn packs(&self) -> &[Pack];

    fn packs_mut(&mut self) -> &mut [Pack];

    /// Takes the place of `other`, which is room afterwards.
    fn take_over(&mut self, other: &mut Self);

    /// The row itself, for a while: what is left in its place is not looked at.
    fn lend(&mut self) -> Self;
}

impl<const N: usize> Row for [Pack; N] {
    #[inline(always)]
    fn packs(&self) -> &[Pack] {
        self
    }

    #[inline(always)]
    fn packs_mut(&mut self) -> &mut [Pack] {
        self
    }

    #[inline(always)]
    fn take_over(&mut self, other: &mut Self) {
        *self = *other;
    }

    #[inline(always)]
    fn lend(&mut self) -> Self {
        *self
    }
}

impl Row for Vec<Pack> {
    #[inline(always)]
    fn packs(&self) -> &[Pack] {
        self
    }

    #[inline(always)]
    fn packs_mut(&mut self) -> &mut [Pack] {
        self
    }

    #[inline(always)]
    fn take_over(&mut self, other: &mut Self) {
        std::mem::swap(self, other);
    }

    #[inline(always)]
    fn lend(&mut self) -> Self {
        std::mem::take(self)
    }
}

/// Where eight plants are: x and ẋ.
#[derive(Clone)]
pub(super) struct State<R> {
    pub(super) displacement: R,
    pub(super) velocity: R,
}

impl<R: Row> State<R> {
    #[inline(always)]
    pub(super) fn packs(&self) -> [&[Pack]; 2] {
        [self.displacement.packs(), self.velocity.packs()]
    }

    /// As [`Row::lend`].
    #[inline(always)]
    pub(super) fn lend(&mut self) -> State<R> {
        State {
            displacement: self.displacement.lend(),
            velocity: self.velocity.lend(),
        }
    }

    /// Takes the place of `other`, which is room afterwards.
    #[inline(always)]
    pub(super) fn take_over(&mut self, other: &mut State<R>) {
        self.displacement.take_over(&mut other.displacement);
        self.velocity.take_over(&mut other.velocity);
    }
}

/// Longest row whose entries are found by comparing: the longest array that a batch is marched in.
pub(super) const COMPARED: usize = 4;

/// An entry found by comparing: an index that only the run knows would keep a short row in memory.
#[inline(always)]
pub(super) fn entry(row: &[Pack], wanted: usize) -> Pack {
    debug_assert!(wanted < row.len());
    if row.len() > COMPARED {
        return row[wanted];
    }
    let mut found = Pack::ZERO;
    for (i, pack) in row.iter().enumerate() {
        if i == wanted {
            found = *pack;
        }
    }
    found
}

/// Changes an entry, found likewise.
#[inline(always)]
pub(super) fn change(row: &mut [Pack], wanted: usize, change: impl Fn(&Pack) -> Pack) {
    debug_assert!(wanted < row.len());
    if row.len() > COMPARED {
        row[wanted] = change(&row[wanted]);
        return;
    }
    for (i, pack) in row.iter_mut().enumerate() {
        if i == wanted {
            *pack = change(pack);
        }
    }
}
