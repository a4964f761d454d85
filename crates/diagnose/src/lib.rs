//! Where the gap lies, which effect causes it, how far it shrinks.
//!
//! [`diagnose`] takes a nominal model and records, and returns the answer ([`Diagnosis`]), the
//! corrected model and the predictions. It never sees what the cause is: records and model only.
//!
//! ```text
//! training records -> nominal prediction -> noise model -> search over small sets of effects
//!                                                              |  fit, log marginal likelihood
//!                             status <- another cause? <- posterior over the sets
//!                                |
//! check records -> gap, where it lies, whether the answer is complete or refuted
//! ```
//!
//! ```
//! use simgap_diagnose::{Request, Status, diagnose};
//! use simgap_model::Model;
//! use simgap_record::parse_csv;
//!
//! let text = r#"
//! schema = "simgap-model/1"
//! name = "axis"
//! [[mass]]
//! name = "table"
//! value = 0.2
//! [[spring]]
//! name = "leaf"
//! between = ["table", "ground"]
//! stiffness = 800.0
//! [[damper]]
//! name = "guide"
//! between = ["table", "ground"]
//! damping = 0.4
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
//! // A record in which the table follows the force without delay, on a spring of 1000 N/m, with
//! // the rounding of the third digit as noise.
//! let mut csv = String::from("t [s],u [N],y [mm]\n");
//! for k in 0..300 {
//!     let t = 0.01 * f64::from(k);
//!     let force = 5.0 * (1.7 * t).sin() + 3.0 * (0.9 * t).cos();
//!     csv += &format!("{t:.2},{force:.4},{:.3}\n", force);
//! }
//! let records = [parse_csv("slow.csv", csv.as_bytes())?];
//! let request = Request::new(&model, &records, &[]);
//! let outcome = diagnose(&request, &|_| {})?;
//! let gap = &outcome.diagnosis.gap;
//! assert!(gap.corrected < 0.1 * gap.nominal);
//! assert_eq!(outcome.diagnosis.verdict.status, Status::Parameters);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod audit;
mod check;
pub mod compare;
mod data;
mod decide;
mod describe;
mod diagnosis;
mod error;
mod excerpt;
mod final_fit;
mod gap;
mod limit;
mod locate;
mod multi_step;
mod outcome;
mod parity;
mod pipeline;
mod place;
mod prepared;
mod sets;
mod spread;
mod structure;
mod units;

pub use diagnosis::*;
pub use error::DiagnoseError;
pub use limit::Limit;
pub use outcome::NominalEstimate;
pub use pipeline::{Outcome, Progress, Request, diagnose};
pub use sets::{FittedEffect, FittedSet};
pub use simgap_estimate::Cancel;
pub use simgap_inference::Stage;
pub use simgap_inference::{LIKELIER_THAN_NOT, RELEVANT_SHARE};
