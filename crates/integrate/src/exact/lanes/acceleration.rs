//! Accelerations of the coordinates that an observer looks at.

use pulp::Simd;

use super::set::LaneSet;
use super::wide::Wide;
use super::{LANES, Pack};
use crate::exact::propagator::ExactPropagator;

/// `ẍ = M⁻¹ (f − C ẋ − K x)` without what is zero in all sets: most masses are joined to few others, and an accelerometer
/// sees one of them.
pub(super) struct Acceleration {
    /// Coordinates of a sample; none where nobody looks at any.
    pub(super) width: usize,
    nets: Vec<Net>,
    rows: Vec<Read>,
    /// Room for the net forces.
    net: Vec<Pack>,
}

/// The net force on a coordinate: what stiffness and damping make of the others.
struct Net {
    coordinate: usize,
    terms: Vec<(usize, [Pack; 2])>,
}

/// A coordinate that is looked at: what the net forces, by their place in the list, do to it.
struct Read {
    coordinate: usize,
    terms: Vec<(usize, Pack)>,
}

impl Acceleration {
    pub(super) fn new(
        sets: &[LaneSet<'_>; LANES],
        n: usize,
        is_read: &dyn Fn(usize) -> bool,
    ) -> Acceleration {
        let entry = |matrix: fn(&ExactPropagator) -> &[f64], i: usize, j: usize| {
            let pack = Pack::of(|l| matrix(sets[l].propagator)[i * n + j]);
            (pack != Pack::ZERO).then_some(pack)
        };
        let mobility = |i: usize, j: usize| entry(|p| &p.inverse_mass, i, j);
        let is_read: Vec<usize> = (0..n).filter(|i| is_read(*i)).collect();
        let pushes = |j: &usize| is_read.iter().any(|i| mobility(*i, *j).is_some());
        let pushing: Vec<usize> = (0..n).filter(pushes).collect();
        let net = |&j: &usize| {
            let term = |k: usize| {
                let (spring, damper) = (entry(|p| &p.stiffness, j, k), entry(|p| &p.damping, j, k));
                let is_joined = spring.is_some() || damper.is_some();
                is_joined.then(|| (k, [spring, damper].map(|pack| pack.unwrap_or(Pack::ZERO))))
            };
            Net {
                coordinate: j,
                terms: (0..n).filter_map(term).collect(),
            }
        };
        let read = |&i: &usize| {
            let places = pushing.iter().enumerate();
            let terms = places.filter_map(|(place, j)| Some((place, mobility(i, *j)?)));
            Read {
                coordinate: i,
                terms: terms.collect(),
            }
        };
        Acceleration {
            width: if is_read.is_empty() { 0 } else { n },
            nets: pushing.iter().map(net).collect(),
            rows: is_read.iter().map(read).collect(),
            net: vec![Pack::ZERO; pushing.len()],
        }
    }

    /// Writes down those at a state under forces, m/s².
    #[inline(always)]
    pub(super) fn write<S: Simd>(
        &mut self,
        simd: S,
        [x, v]: [&[Pack]; 2],
        force: &[Pack],
        out: &mut [Pack],
    ) {
        for (net, out) in self.nets.iter().zip(&mut self.net) {
            let mut sum = Wide::of(simd, &force[net.coordinate]);
            for (k, [stiffness, damping]) in &net.terms {
                let spring = Wide::of(simd, stiffness) * Wide::of(simd, &x[*k]);
                let damper = Wide::of(simd, damping) * Wide::of(simd, &v[*k]);
                sum -= spring + damper;
            }
            *out = sum.pack();
        }
        for row in &self.rows {
            let mut sum = Wide::zero(simd);
            for (place, mobility) in &row.terms {
                sum += Wide::of(simd, mobility) * Wide::of(simd, &self.net[*place]);
            }
            out[row.coordinate] = sum.pack();
        }
    }
}
