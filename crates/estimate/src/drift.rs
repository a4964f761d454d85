//! Waves along a travel of which nothing but they themselves shows where it begins.
//!
//! Of a slide whose speed alone is measured, no linear model cares where it is. A force that repeats along its travel does:
//!
//! ```text
//! F = a sin(2π (x₀ᵣ + d) / p) + b cos(2π (x₀ᵣ + d) / p)                    (1)
//! ```
//!
//! Every record r begins at a place x₀ᵣ of its own, each as good as the next for the search, and the objective has a
//! valley for every period. A shift of all of them turns a and b into each other, so b stays as it is.

use std::f64::consts::TAU;

use simgap_effects::{Effect, Placed, Wave};
use simgap_model::Location;

use crate::Problem;

/// Places within a period that an initial state is sought from.
const PLACES: usize = 8;

/// A wave along a travel that is not known.
pub(crate) struct Drift {
    pub(crate) wave: Wave,
    /// Displacement of each mass by which the place stretches by one metre.
    travel: Vec<f64>,
}

impl Problem {
    /// Whether an effect alone shows where the records begin along its travel.
    #[must_use]
    pub fn shows_travel(&self, placed: &Placed) -> bool {
        self.drift(placed.effect, &placed.at).is_some()
    }

    /// What an effect is a wave along, where nothing else tells where that begins.
    pub(crate) fn drift(&self, effect: &dyn Effect, at: &Location) -> Option<Drift> {
        let wave = effect.wave()?;
        let travel = self.model.unseen_travel(at)?;
        Some(Drift { wave, travel })
    }
}

impl Drift {
    /// A state at which the wave is ahead by so many radians.
    pub(crate) fn ahead(&self, state: &[f64], values: &[f64], phase_rad: f64) -> Vec<f64> {
        let by_m = phase_rad / TAU * values[self.wave.period];
        let mut moved = state.to_vec();
        for (displacement, part) in moved.iter_mut().zip(&self.travel) {
            *displacement += by_m * part;
        }
        moved
    }

    /// States from which one is near to where a record begins.
    pub(crate) fn places(&self, state: &[f64], values: &[f64]) -> Vec<Vec<f64>> {
        let phase = |place: usize| TAU * place as f64 / PLACES as f64;
        let places = (0..PLACES).map(|place| self.ahead(state, values, phase(place)));
        places.collect()
    }
}

/// Every state of a record that one is sought from, by all waves whose travel is not known.
pub(crate) fn places<'a>(
    problem: &Problem,
    effects: impl Iterator<Item = &'a Placed>,
    state: Vec<f64>,
) -> Vec<Vec<f64>> {
    let mut states = vec![state];
    for placed in effects {
        if let Some(drift) = problem.drift(placed.effect, &placed.at) {
            let moved = states.iter();
            states = moved
                .flat_map(|state| drift.places(state, &placed.values))
                .collect();
        }
    }
    states
}
