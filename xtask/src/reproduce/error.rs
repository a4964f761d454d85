//! What can go wrong while the paper is reproduced.

use thiserror::Error;

use crate::generated::FileError;

/// Why the reproduction failed.
#[derive(Debug, Error)]
pub enum ReproduceError {
    /// The published numbers.
    #[error(transparent)]
    Table(#[from] simgap_tables::TableError),
    /// The mold oscillator.
    #[error(transparent)]
    Mold(#[from] simgap_mold::MoldError),
    /// The unknown force.
    #[error(transparent)]
    Alpha(#[from] simgap_alpha::AlphaError),
    /// The lumped model.
    #[error(transparent)]
    Model(#[from] simgap_model::ModelError),
    /// A record.
    #[error(transparent)]
    Record(#[from] simgap_record::RecordError),
    /// A simulation.
    #[error(transparent)]
    Integrate(#[from] simgap_integrate::IntegrateError),
    /// A spectrum.
    #[error(transparent)]
    Signal(#[from] simgap_signal::SignalError),
    /// A picture.
    #[error(transparent)]
    Chart(#[from] simgap_report::chart::ChartError),
    /// The diagnosis.
    #[error(transparent)]
    Diagnose(#[from] simgap_diagnose::DiagnoseError),
    /// What a page tells is no longer what is computed.
    #[error("the page on the diagnosed gap tells that {0}, which does not hold any more")]
    Story(&'static str),
    /// The JSON writer.
    #[error("cannot write {page} as JSON: {source}")]
    Json {
        /// Which page.
        page: String,
        /// What the writer says.
        source: serde_json::Error,
    },
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
}
