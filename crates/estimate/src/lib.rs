//! Output-error estimation: sensitivities, priors, uncertainty.
