//! Output-error estimation: which parameter values make the simulation follow the records best,
//! how sure that is, and what a further effect would bring.
//!
//! A [`Problem`] is a nominal model with its runs; a [`Fit`] is what the data say about one set of
//! effects, with the nominal parameters held near their values and the initial states free.
//!
//! ```
//! use simgap_effects::{Placed, find};
//! use simgap_estimate::{Problem, Start, FitOptions, fit};
//! use simgap_model::{Location, Model};
//! use simgap_simulate::{Run, Simulator};
//!
//! let text = r#"
//! schema = "simgap-model/1"
//! name = "axis"
//! [[mass]]
//! name = "table"
//! value = 2.0
//! [[spring]]
//! name = "leaf"
//! between = ["table", "ground"]
//! stiffness = 800.0
//! [[damper]]
//! name = "guide"
//! between = ["table", "ground"]
//! damping = 4.0
//! [[input]]
//! channel = "u"
//! kind = "force"
//! at = "table"
//! [[output]]
//! channel = "y"
//! kind = "displacement"
//! at = "table"
//! "#;
//! let model = Model::from_toml(text)?;
//! let at = Location::Between(["table".into(), "ground".into()]);
//! let spring = |factor: f64| -> Result<Placed, &str> {
//!     let kind = find("stiffness_error").ok_or("not in the catalogue")?;
//!     Ok(Placed::new(kind, at.clone(), vec![factor]))
//! };
//! // The machine's spring is 10 % stiffer than the model's.
//! let mut run = Run {
//!     name: "sweep".into(),
//!     start_s: 0.0,
//!     time_step_s: 0.01,
//!     len: 400,
//!     first_index: 0,
//!     inputs: vec![(0..400).map(|n| (0.002 * f64::from(n * n)).sin()).collect()],
//!     measured: vec![None],
//!     mended: simgap_simulate::Mended::default(),
//! };
//! let truth = Simulator::new(&model, &[spring(1.1)?], 1)?.predict(&run, &[0.001, 0.0])?;
//! run.measured = truth.into_iter().map(Some).collect();
//!
//! let problem = Problem::new(&model, vec![run])?;
//! let start = Start {
//!     effects: vec![spring(1.01)?],
//!     nominal: vec![],
//!     initial: problem.initial_guess(),
//! };
//! let found = fit(&problem, &start, &FitOptions::white(1))?;
//! assert!((found.estimate.effects[0].values[0] - 1.1).abs() < 1e-3);
//! assert!((found.estimate.initial[0][0] - 0.001).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod base;
mod cancel;
mod candidate;
mod curvature;
mod drift;
mod effort;
mod fit;
mod gram;
mod initial;
mod joint;
mod late;
mod layout;
mod linearise;
mod merit;
mod normal;
mod outright;
mod points;
mod problem;
mod products;
mod reach;
mod scattered;
mod score;
mod signals;
mod site;
mod spread;
mod states;
mod step;
mod summary;
mod whitening;

pub use base::{Base, linearise_at};
pub use cancel::Cancel;
pub use candidate::Candidate;
pub use curvature::{Coordinate, Curvature};
pub use effort::Effort;
pub use fit::{Fit, Interval, NORMAL_95, fit};
pub use initial::{
    fit_initial_states, fit_initial_states_from, may_part, simulator_at, take_own_values,
};
pub use joint::{JointScore, joint_scores};
pub use layout::{Owner, Start};
pub use merit::misfit;
pub use outright::score_outright;
pub use problem::{Discrepancy, FitOptions, Problem};
pub use scattered::{ASTRAY, halton};
pub use score::{Score, score, score_in_place_of, score_shapes};
pub use spread::spread;
pub use summary::{EstimatedEffect, EstimatedParameter, FitSummary};
pub use whitening::Whitening;

pub use simgap_simulate::SimulateError as EstimateError;
