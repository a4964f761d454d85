//! Cases whose effect is withheld from the diagnosis, and their score.
//!
//! [`schedule`] lists what a campaign holds, [`generate`] makes one case of it: a plant, its
//! nominal model, two records to learn from and one to judge by, and the withheld [`Truth`]; [`redraw`] makes it with other noise.
//! [`seal()`] lays the truths down before anything is diagnosed, [`open`] takes them up again.
//! [`score()`] holds an [`Answer`] against a truth; [`Totals`] sums up a campaign.
//!
//! This crate knows nothing of the diagnosis, and the diagnosis nothing of it: whoever runs both
//! hands over the model and the records and nothing else.
//!
//! ```text
//! seed, recipe -> plant, excitations -> effect at a legal place, sized by its gap
//!                                              |
//!            fine simulation -> sampling -> noise -> records      truth -> seal
//!                                                       |                   |
//!                                                  (diagnosis) -> score <- open
//! ```
//!
//! ```
//! use simgap_blind::{Level, Recipe, generate};
//!
//! let case = generate(1, 3, &Recipe::Kind("coulomb_friction".into()), Level::Standard)?;
//! // What a diagnosis is given, and what it is not.
//! assert!(case.model.effects.is_empty() && case.train.len() == 2);
//! assert_eq!(case.truth.effects[0].kind, "coulomb_friction");
//! # Ok::<(), simgap_blind::BlindError>(())
//! ```

mod accept;
mod answer;
mod bench;
mod case;
mod closing;
mod draft;
mod error;
mod excitation;
mod explained;
mod foreign;
mod gap;
mod generate;
mod judge;
mod level;
mod outcome;
mod plant;
mod random;
mod recipe;
mod score;
mod seal;
mod size;
mod table;
mod totals;

pub use answer::{Answer, Named};
pub use bench::OVERSAMPLING;
pub use case::{Case, Equivalent, Hidden, Status, Truth};
pub use closing::{Closing, Signals, gap_to};
pub use error::BlindError;
pub use foreign::foreign_effects;
pub use generate::{generate, redraw};
pub use level::Level;
pub use outcome::{Outcome, Verdict};
pub use recipe::{Recipe, drawn_kinds, schedule};
pub use score::{First, LARGEST_SET, Role, Score, score};
pub use seal::{SealedCase, open, seal, sha256};
pub use table::{
    Requirement, render_calibration, render_confusion, render_figures, render_requirements,
    requirements,
};
pub use totals::{Bin, CLOSE, Share, Spread, Totals};

/// Seeds for setting thresholds of the diagnosis. Never used to report.
pub const TUNE_SEEDS: std::ops::Range<u64> = 1..1000;
/// Seeds for reported figures. Never used to set a threshold.
pub const REPORT_SEEDS: std::ops::Range<u64> = 1000..2000;
