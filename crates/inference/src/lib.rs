//! Which sets of effects explain records: proposals, one log marginal likelihood, one posterior.
//!
//! ```text
//! inputs, records         -> what inputs do between samples             between_samples
//! nominal model, records -> noise model (once)                         noise_model
//! catalogue x places     -> sets and their prior                       model_space
//! proposals of sets      -> fits; a search with budgets                proposals, search, stretches, ending
//! ln Z + ln p of each    -> computed once, never changed               marginal_likelihood
//! posterior over sets    -> effects, classes, relevance                model_posterior, relevance
//! a law of any shape, values that agree -> the probability of another cause     other, coincidence
//! ```
//!
//! No stage calls an earlier one. The search may miss a set; it does not judge one. Nothing here knows an effect by name
//! or what is reported of it.

mod asked;
mod between_samples;
mod candidate_model;
mod coincidence;
mod ending;
mod extended;
mod gap;
mod marginal_likelihood;
mod model_posterior;
mod model_space;
mod motion;
pub mod noise_model;
mod other;
mod part;
mod proposals;
mod recolour;
mod relevance;
mod search;
mod shapley;
mod stage;
mod stretches;

pub use between_samples::read_inputs;
pub use candidate_model::{CandidateModel, add, is_nominal, name, rank};
pub use coincidence::Coincidence;
pub use gap::{Gap, RELEVANT_SHARE};
pub use model_posterior::{EffectPosterior, ModelPosterior, Rival, model_posterior};
pub use model_space::ModelSpace;
pub use motion::is_a_cause;
pub use noise_model::NoiseModel;
pub use other::{FreeLaw, LIKELIER_THAN_NOT, Other, other, other_by};
pub use proposals::RECALIBRATION_STD;
pub use search::{Budget, Search};
pub use stage::Stage;
pub use stretches::{bounds, recalibrate};
