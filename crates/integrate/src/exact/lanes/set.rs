//! One parameter set of a batch.

use crate::exact::law::Element;
use crate::exact::march::Excitation;
use crate::exact::plant::Plant;
use crate::exact::propagator::ExactPropagator;

/// One parameter set: what [`ExactPropagator::march`] takes.
#[derive(Clone, Copy)]
pub struct LaneSet<'a> {
    /// The linear part.
    pub propagator: &'a ExactPropagator,
    /// The nonlinear forces.
    pub elements: &'a [Element],
    /// The excitation; sets of one batch may have different ones, of different lengths.
    pub excitation: Excitation<'a>,
    /// x at the first sample, m; length n.
    pub displacement: &'a [f64],
    /// ẋ at the first sample, m/s; length n.
    pub velocity: &'a [f64],
}

impl<'a> LaneSet<'a> {
    /// Whether two sets can be marched in one batch: as many degrees of freedom, elements at the same places
    /// that rub and remember alike, the same bases and substeps.
    #[must_use]
    pub fn is_alike(&self, other: &LaneSet<'_>) -> bool {
        let alike = |a: &Element, b: &Element| {
            a.port == b.port
                && a.law.dry_level(0.0).is_some() == b.law.dry_level(0.0).is_some()
                && a.law.remembers() == b.law.remembers()
                && a.law.has_tangent() == b.law.has_tangent()
        };
        self.propagator.dof_count == other.propagator.dof_count
            && self.elements.len() == other.elements.len()
            && self
                .elements
                .iter()
                .zip(other.elements)
                .all(|(a, b)| alike(a, b))
            && self.excitation.base_count == other.excitation.base_count
            && self.excitation.substeps == other.excitation.substeps
    }

    /// Samples that the excitation holds in full.
    pub(super) fn sample_count(&self) -> usize {
        let whole = |values: &[f64], width: usize| match width {
            0 => usize::MAX,
            width => values.len() / width,
        };
        let e = &self.excitation;
        e.sample_count
            .min(whole(e.dof_force, self.propagator.dof_count))
            .min(whole(e.base_displacement, e.base_count))
            .min(whole(e.base_velocity, e.base_count))
    }

    /// The elements at the first sample.
    pub(super) fn begin(&self) -> Plant<'a> {
        let n = self.propagator.dof_count;
        let e = &self.excitation;
        let mut plant = Plant::new(self.propagator, self.elements);
        if self.sample_count() > 0 && !self.elements.is_empty() {
            let mut state: Vec<f64> = self
                .displacement
                .iter()
                .chain(self.velocity)
                .copied()
                .collect();
            state.resize(2 * n, 0.0);
            let bases = e.base_displacement.iter().take(e.base_count);
            let base: Vec<f64> = bases
                .chain(e.base_velocity.iter().take(e.base_count))
                .copied()
                .collect();
            plant.begin(&state, &e.dof_force[..n], &base, e.start_s);
        }
        plant
    }
}
