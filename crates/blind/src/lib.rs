//! Cases whose effect is withheld from the diagnosis, and their score.
//!
//! [`schedule`] lists what a campaign holds, [`generate`] makes one case of it: a plant, its
//! nominal model, two records to learn from and one to judge by, and the withheld [`Truth`].
//! [`score()`] holds an [`Answer`] against it; [`Totals`] sums up a campaign.
//!
//! This crate knows nothing of the diagnosis, and the diagnosis nothing of it: whoever runs both
//! hands over the model and the records and nothing else.
//!
//! ```text
//! seed, recipe -> plant, excitations -> effect at a legal place, sized by its gap
//!                                              |
//!            fine simulation -> sampling -> noise -> records          truth
//!                                                       |               |
//!                                                  (diagnosis) ----> score
//! ```

mod bench;
mod case;
mod draft;
mod equivalent;
mod error;
mod excitation;
mod foreign;
mod gap;
mod generate;
mod plant;
mod random;
mod recipe;
mod score;
mod size;
mod table;
mod totals;

pub use bench::OVERSAMPLING;
pub use case::{Case, Status, Truth};
pub use draft::{GAP_OVER_NOISE, LARGEST_GAP, SMALLEST_GAP};
pub use equivalent::{Equivalent, equivalents};
pub use error::BlindError;
pub use foreign::foreign_effects;
pub use generate::generate;
pub use recipe::{Recipe, schedule};
pub use score::{Answer, Named, Outcome, Score, Verdict, score};
pub use table::{Style, render};
pub use totals::{Bin, KindRow, Totals};

/// Seeds for setting thresholds of the diagnosis. Never used to report.
pub const TUNE_SEEDS: std::ops::Range<u64> = 1..1000;
/// Seeds for reported figures. Never used to set a threshold.
pub const REPORT_SEEDS: std::ops::Range<u64> = 1000..2000;
