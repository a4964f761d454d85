//! The stages of a diagnosis, as they are told while it runs.

/// What is being done. In the order in which a diagnosis goes through them, but for single effects from many values, which may come after those beside
/// parameters; it leaves out those of the search that it need not go through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// The model as given, and the noise of its records.
    NominalModel,
    /// Wrong nominal parameters.
    NominalParameters,
    /// Single effects, by score.
    Singles,
    /// Single effects, from many values.
    SinglesFromManyValues,
    /// Effects beside nominal parameters that are re-estimated.
    BesideParameters,
    /// Sets of two.
    Pairs,
    /// Sets of two, from many values.
    PairsFromManyValues,
    /// Sets of three.
    Threes,
    /// Stretches of the records, each with a start of its own.
    Stretches,
    /// What was found in a part of the samples, fitted to all of them.
    AllSamples,
    /// Sets fitted again, with samples that count by the colour of what is left.
    Colour,
    /// Changes to the best set, in several rounds.
    Changes,
    /// The posterior of all sets that were fitted.
    Posterior,
    /// The answer fitted to all records.
    FinalFit,
    /// Predictions of the check records.
    CheckRecords,
}

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Stage; 15] = [
        Stage::NominalModel,
        Stage::NominalParameters,
        Stage::Singles,
        Stage::SinglesFromManyValues,
        Stage::BesideParameters,
        Stage::Pairs,
        Stage::PairsFromManyValues,
        Stage::Threes,
        Stage::Stretches,
        Stage::AllSamples,
        Stage::Colour,
        Stage::Changes,
        Stage::Posterior,
        Stage::FinalFit,
        Stage::CheckRecords,
    ];

    /// As it is told.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Stage::NominalModel => "nominal model",
            Stage::NominalParameters => "nominal parameters",
            Stage::Singles => "single effects",
            Stage::SinglesFromManyValues => "single effects from many values",
            Stage::BesideParameters => "effects beside re-estimated parameters",
            Stage::Pairs => "pairs of effects",
            Stage::PairsFromManyValues => "pairs from many values",
            Stage::Threes => "sets of three",
            Stage::Stretches => "single effects in stretches",
            Stage::AllSamples => "fits to all samples",
            Stage::Colour => "fits under the colour of what is left",
            Stage::Changes => "changes to the best set",
            Stage::Posterior => "posterior",
            Stage::FinalFit => "final fit",
            Stage::CheckRecords => "check records",
        }
    }
}
