//! Packs of one number for each degree of freedom.

use super::Pack;

/// Packs of one number for each degree of freedom: an array where the compiler knows how many, so
/// that they stay in registers from step to step.
pub(super) trait Row: Clone {
    fn packs(&self) -> &[Pack];

    fn packs_mut(&mut self) -> &mut [Pack];

    /// Takes the place of `other`, which is room afterwards.
    fn take_over(&mut self, other: &mut Self);

    /// The row for an observer, who indexes it as he likes: in memory, for which there is room.
    fn shown<'a>(&'a self, room: &'a mut Self) -> &'a [Pack];
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
    fn shown<'a>(&'a self, room: &'a mut Self) -> &'a [Pack] {
        *room = *self;
        room
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
    fn shown<'a>(&'a self, _: &'a mut Self) -> &'a [Pack] {
        self
    }
}

/// Where eight plants are: x and ẋ.
#[derive(Clone)]
pub(super) struct State<R> {
    pub(super) displacement: R,
    pub(super) velocity: R,
}

impl<R: Row> State<R> {
    /// Takes the place of `other`, which is room afterwards.
    #[inline(always)]
    pub(super) fn take_over(&mut self, other: &mut State<R>) {
        self.displacement.take_over(&mut other.displacement);
        self.velocity.take_over(&mut other.velocity);
    }
}

/// Takes over a row without new room.
#[inline(always)]
pub(super) fn copy<R: Row>(to: &mut R, from: &R) {
    to.packs_mut().copy_from_slice(from.packs());
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
