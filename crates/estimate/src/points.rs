//! Packed vectors as simulations.

use std::collections::HashMap;
use std::sync::Arc;

use simgap_simulate::Simulator;

use crate::layout::Layout;
use crate::{EstimateError, Problem};

/// A run to be simulated.
pub(crate) struct Point {
    pub(crate) simulator: Arc<Simulator>,
    pub(crate) run: usize,
    pub(crate) initial: Vec<f64>,
    /// Without what moves in steps.
    pub(crate) smooth: bool,
}

/// The simulators of packed vectors: one for all that differ in initial states alone.
pub(crate) struct Simulators<'a> {
    problem: &'a Problem,
    layout: &'a Layout,
    known: HashMap<(Option<usize>, Vec<u64>), Arc<Simulator>>,
}

impl<'a> Simulators<'a> {
    pub(crate) fn new(problem: &'a Problem, layout: &'a Layout) -> Simulators<'a> {
        Simulators {
            problem,
            layout,
            known: HashMap::new(),
        }
    }

    /// A run at a packed vector, which is near that of another simulator if there is one.
    pub(crate) fn point(
        &mut self,
        theta: &[f64],
        run: usize,
        smooth: bool,
        beside: Option<&Arc<Simulator>>,
    ) -> Result<Point, EstimateError> {
        Ok(Point {
            simulator: self.of(theta, run, beside)?,
            run,
            initial: self.layout.state(theta, run).to_vec(),
            smooth,
        })
    }

    /// The simulator of a packed vector in a run, beside another if there is one.
    pub(crate) fn of(
        &mut self,
        theta: &[f64],
        run: usize,
        beside: Option<&Arc<Simulator>>,
    ) -> Result<Arc<Simulator>, EstimateError> {
        let values = self.layout.values_in(theta, run).map(f64::to_bits);
        // What a run has of its own depends on when it was taken.
        let differ = self.layout.own_len() > 0 || self.problem.differs_by_run(&[]);
        let own = differ.then_some(run);
        let key = (own, values.collect());
        if let Some(known) = self.known.get(&key) {
            return Ok(Arc::clone(known));
        }
        let placed = self.layout.placed_in(theta, run);
        let simulator = self.problem.simulator(&placed, run)?;
        let simulator = Arc::new(simulator.beside(beside));
        self.known.insert(key, Arc::clone(&simulator));
        Ok(simulator)
    }
}
