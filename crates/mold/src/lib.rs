//! The mold oscillator of the paper: one and two degrees of freedom, and its records rebuilt from the tables.
//!
//! - [`OneDof`]: Eq. (1)-(3) with Table 1.
//! - [`TwoDof`]: Eq. (4) with Table 5 as printed, and [`TwoDof::restored`], the same masses and k₁
//!   with k_leaf and k₂ solved so that the modes lie where the paper wants them.
//! - [`HeaveRoll`]: heave and roll on a left and a right cylinder; [`LockedCylinder`]: shut oil as a spring.
//! - [`ServoMold`]: the same with each cylinder under servo control, in closed form and as a model file.
//! - [`LeafSpring`], [`MoldOnLeaves`]: leaf springs as beams, in closed form and as condensed finite elements.
//! - [`RebuiltRecord`]: the measured data is lost; these records follow the printed numbers and say
//!   so ([`SweepRecord`] for a sweep). Each of the two readings of the 50 − f lines ([`Reading`]) can be built at any sample rate.
//!
//! Source of every published number: `park-mold`, through [`simgap_tables`].
//!
//! ```
//! use simgap_mold::{OneDof, TwoDof};
//!
//! let matrices = TwoDof::published(1.0)?.model()?.matrices()?;
//! assert_eq!(matrices.mass_matrix[(1, 1)], 7000.0);
//! assert!((OneDof::published()?.natural_freq_hz() - 2.522).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod beam;
mod channel;
mod error;
mod heave_roll;
mod leaves;
mod noise;
mod oil;
mod one_dof;
mod plan;
mod rebuild;
mod restored;
mod servo;
mod servo_drive;
mod sweep;
mod two_dof;

pub use beam::{BeamEnds, LeafSpring};
pub use channel::{DISPLACEMENT_CHANNEL, FORCE_CHANNEL};
pub use error::MoldError;
pub use heave_roll::{Cylinder, HeaveRoll};
pub use leaves::{CondensedLeaf, MoldOnLeaves};
pub use oil::LockedCylinder;
pub use one_dof::{LEAF_CHANNEL, LeafEnd, OneDof, STANDARD_GRAVITY};
pub use plan::{
    Derivative, HARMONIC_SHARE, Reading, RebuildPlan, published_line_amplitude, published_plan,
};
pub use rebuild::{RebuiltRecord, rebuild};
pub use servo::{SET_POINT_CHANNEL, ServoMold};
pub use servo_drive::{Controller, ServoDrive};
pub use sweep::{SweepPlan, SweepRecord, published_sweep, rebuild_sweep};
pub use two_dof::TwoDof;
