//! A damper the model lacks altogether.

use simgap_model::{Damper, Location};

use crate::effect::{Action, Effect, Family, Parameter, SiteKind, SiteScale};

/// A damper the model lacks altogether.
///
/// ```text
/// F = c v
/// ```
pub(crate) struct ViscousDamping;

impl Effect for ViscousDamping {
    fn kind(&self) -> &'static str {
        "viscous_damping"
    }

    fn family(&self) -> Family {
        Family::Force
    }

    fn site(&self) -> SiteKind {
        SiteKind::NoDamper
    }

    fn summary(&self) -> &'static str {
        "a damper acts where the model has none"
    }

    fn equation(&self) -> &'static str {
        "F = c v"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &[Parameter {
            name: "damping_n_s_per_m",
            unit: "N s/m",
            lower: 0.0,
            upper: f64::INFINITY,
            neutral: Some(0.0),
            per_record: false,
        }]
    }

    fn is_loss_term(&self) -> bool {
        true
    }

    fn starts(&self, scale: &SiteScale) -> Vec<Vec<f64>> {
        vec![vec![0.05 * scale.force_n / scale.velocity_m_per_s]]
    }

    fn action(&self, values: &[f64]) -> Action {
        let damping = values[0];
        Action::Model(Box::new(move |model, at| {
            if let Location::Between(between) = at {
                model.dampers.push(Damper {
                    name: format!("viscous_damping {}", model.dampers.len() + 1),
                    between: between.clone(),
                    damping,
                    uncertainty: None,
                });
            }
        }))
    }

    fn experiment(&self) -> &'static str {
        "free decay at several amplitudes: the decay rate does not depend on the amplitude"
    }
}
