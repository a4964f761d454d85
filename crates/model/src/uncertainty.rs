//! How well the nominal values are known.

use crate::parts::{DEFAULT_UNCERTAINTY, LARGEST_UNCERTAINTY};
use crate::{Location, Model, same_pair};

/// A kind of nominal value, by the place where parts of that kind add up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum NominalQuantity {
    /// Mass or inertia, at [`Location::Mass`].
    Mass,
    /// Stiffness of the springs, at [`Location::Between`].
    Stiffness,
    /// Damping of the dampers, at [`Location::Between`].
    Damping,
    /// Torque of the pendulums, at [`Location::Mass`].
    Pendulum,
    /// Known constant forces, at [`Location::Mass`].
    Load,
    /// Gain of an input, at [`Location::Input`].
    InputGain,
    /// Gain of an output, at [`Location::Channel`].
    OutputGain,
    /// A parameter of a simulator, at [`Location::Parameter`].
    PlantParameter,
}

/// Value and stated uncertainty of each part of a kind at a place; with `iter_mut` and `&mut` the latter to be changed.
macro_rules! nominal_parts {
    ($model:expr, $quantity:expr, $at:expr, $iter:ident, $($reference:tt)*) => {{
        use NominalQuantity as Q;
        let parts: Vec<(f64, _)> = match ($quantity, $at) {
            (Q::Mass, Location::Mass(name)) => {
                let here = $model.masses.$iter().filter(|mass| &mass.name == name);
                here.map(|mass| (mass.value, $($reference)* mass.uncertainty)).collect()
            }
            (Q::Stiffness, Location::Between(pair)) => {
                let here = $model.springs.$iter().filter(|one| same_pair(&one.between, pair));
                here.map(|one| (one.stiffness, $($reference)* one.uncertainty)).collect()
            }
            (Q::Damping, Location::Between(pair)) => {
                let here = $model.dampers.$iter().filter(|one| same_pair(&one.between, pair));
                here.map(|one| (one.damping, $($reference)* one.uncertainty)).collect()
            }
            (Q::Pendulum, Location::Mass(name)) => {
                let here = $model.pendulums.$iter().filter(|arm| &arm.at == name);
                here.map(|arm| (arm.value, $($reference)* arm.uncertainty)).collect()
            }
            (Q::Load, Location::Mass(name)) => {
                let here = $model.loads.$iter().filter(|load| &load.at == name);
                here.map(|load| (load.value, $($reference)* load.uncertainty)).collect()
            }
            (Q::InputGain, Location::Input(channel)) => {
                let here = $model.inputs.$iter().filter(|one| &one.channel == channel);
                here.map(|one| (1.0, $($reference)* one.uncertainty)).collect()
            }
            (Q::OutputGain, Location::Channel(channel)) => {
                let here = $model.outputs.$iter().filter(|one| &one.channel == channel);
                here.map(|one| (1.0, $($reference)* one.uncertainty)).collect()
            }
            (Q::PlantParameter, Location::Parameter(name)) => {
                let here = $model.plant_parameters.$iter().filter(|one| &one.name == name);
                here.map(|one| (one.value, $($reference)* one.uncertainty)).collect()
            }
            _ => vec![],
        };
        parts
    }};
}

impl Model {
    /// Relative standard deviation of a nominal value: of the sum of its parts, whose errors are
    /// independent of each other.
    ///
    /// ```text
    /// s = sqrt(Σ (kᵢ uᵢ)²) / |Σ kᵢ|
    /// ```
    ///
    /// | Symbol | Meaning | Unit |
    /// |---|---|---|
    /// | kᵢ | value of the i-th part of this kind at the place; 1 for a gain, which has one part | of the part |
    /// | uᵢ | its `uncertainty`, [`DEFAULT_UNCERTAINTY`] where none is stated | 1 |
    ///
    /// At most 10, the largest that can be stated, where parts of opposite sign cancel; the default
    /// where the model has no such part or all of them are zero.
    ///
    /// ```
    /// use simgap_model::{Location, Model, NominalQuantity};
    /// let model = Model::from_toml(r#"
    /// schema = "simgap-model/1"
    /// name = "axis"
    /// [[mass]]
    /// name = "carriage"
    /// value = 95.0
    /// uncertainty = 0.1
    /// [[output]]
    /// channel = "q"
    /// kind = "displacement"
    /// at = "carriage"
    /// "#)?;
    /// let carriage = Location::Mass("carriage".into());
    /// assert!((model.stated_uncertainty(NominalQuantity::Mass, &carriage) - 0.1).abs() < 1e-15);
    /// # Ok::<(), simgap_model::ModelError>(())
    /// ```
    #[must_use]
    pub fn stated_uncertainty(&self, quantity: NominalQuantity, at: &Location) -> f64 {
        let (mut sum, mut variance) = (0.0, 0.0_f64);
        for (value, uncertainty) in nominal_parts!(self, quantity, at, iter,) {
            let deviation = value * uncertainty.unwrap_or(DEFAULT_UNCERTAINTY);
            sum += value;
            variance += deviation * deviation;
        }
        if variance == 0.0 {
            return DEFAULT_UNCERTAINTY;
        }
        (variance.sqrt() / f64::abs(sum)).min(LARGEST_UNCERTAINTY)
    }

    /// States the uncertainty of a nominal value in the parts that make it up: each of n equal ones may be off by √n times
    /// as much as their sum, for their errors are independent.
    ///
    /// ```text
    /// uᵢ = s |Σ kᵢ| / sqrt(Σ kᵢ²)
    /// ```
    ///
    /// with s the relative standard deviation of the sum, [`Model::stated_uncertainty`] afterwards, up to 10. `false`, and
    /// nothing stated, where the model has no such part, or parts that cancel.
    pub fn state_uncertainty(
        &mut self,
        quantity: NominalQuantity,
        at: &Location,
        uncertainty: f64,
    ) -> bool {
        let parts = nominal_parts!(self, quantity, at, iter_mut, &mut);
        let sum: f64 = parts.iter().map(|(value, _)| value).sum();
        let squares: f64 = parts.iter().map(|(value, _)| value * value).sum();
        if sum == 0.0 || squares <= 0.0 {
            return false;
        }
        let each = uncertainty * sum.abs() / squares.sqrt();
        for (_, stated) in parts {
            *stated = Some(each.min(LARGEST_UNCERTAINTY));
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARTS: &str = "schema = \"simgap-model/1\"\nname = \"m\"\n\
        [[mass]]\nname = \"a\"\nvalue = 2.0\nuncertainty = 0.5\n\
        [[spring]]\nname = \"s\"\nbetween = [\"a\", \"ground\"]\nstiffness = 300.0\nuncertainty = 0.1\n\
        [[spring]]\nname = \"t\"\nbetween = [\"ground\", \"a\"]\nstiffness = 100.0\nuncertainty = 0.4\n\
        [[damper]]\nname = \"d\"\nbetween = [\"a\", \"ground\"]\ndamping = 5.0\n\
        [[damper]]\nname = \"e\"\nbetween = [\"a\", \"ground\"]\ndamping = 5.0\n\
        [[load]]\nat = \"a\"\nvalue = 3.0\n\
        [[load]]\nat = \"a\"\nvalue = -3.0\n\
        [[pendulum]]\nat = \"a\"\nvalue = 0.0\nuncertainty = 0.3\n\
        [[input]]\nchannel = \"u\"\nkind = \"force\"\nat = \"a\"\nuncertainty = 0.07\n\
        [[output]]\nchannel = \"y\"\nkind = \"displacement\"\nat = \"a\"\n";

    fn stated(quantity: NominalQuantity, at: Location) -> f64 {
        Model::from_toml(PARTS)
            .unwrap()
            .stated_uncertainty(quantity, &at)
    }

    #[test]
    fn verify_independent_parts_add_their_variances() {
        const ROUNDING: f64 = 1e-15;
        let pair = || Location::Between(["a", "ground"].map(String::from));
        let mass = || Location::Mass("a".into());
        let cases = [
            (NominalQuantity::Mass, mass(), 0.5),
            // 30 and 40 N/m of 400.
            (NominalQuantity::Stiffness, pair(), 50.0 / 400.0),
            // Two equal dampers, known by the default.
            (
                NominalQuantity::Damping,
                pair(),
                DEFAULT_UNCERTAINTY / 2.0_f64.sqrt(),
            ),
            // Parts that cancel, and a part of zero.
            (NominalQuantity::Load, mass(), LARGEST_UNCERTAINTY),
            (NominalQuantity::Pendulum, mass(), DEFAULT_UNCERTAINTY),
            (
                NominalQuantity::InputGain,
                Location::Input("u".into()),
                0.07,
            ),
            (
                NominalQuantity::OutputGain,
                Location::Channel("y".into()),
                DEFAULT_UNCERTAINTY,
            ),
            // No such part at the place.
            (
                NominalQuantity::Mass,
                Location::Input("u".into()),
                DEFAULT_UNCERTAINTY,
            ),
        ];
        for (quantity, at, expected) in cases {
            let found = stated(quantity, at);
            assert!((found - expected).abs() < ROUNDING, "{quantity:?}: {found}");
        }
    }

    #[test]
    fn verify_what_is_stated_is_read_back() {
        let pair = Location::Between(["ground", "a"].map(String::from));
        let mut model = Model::from_toml(PARTS).unwrap();
        for (quantity, at) in [
            (NominalQuantity::Stiffness, pair.clone()),
            (NominalQuantity::Damping, pair.clone()),
            (NominalQuantity::Mass, Location::Mass("a".into())),
            (NominalQuantity::InputGain, Location::Input("u".into())),
        ] {
            assert!(model.state_uncertainty(quantity, &at, 0.13));
            let read = model.stated_uncertainty(quantity, &at);
            assert!((read - 0.13).abs() < 1e-15, "{quantity:?}: {read}");
        }
        // Parts that cancel, and none.
        let before = model.clone();
        let mass = Location::Mass("a".into());
        assert!(!model.state_uncertainty(NominalQuantity::Load, &mass, 0.13));
        assert!(!model.state_uncertainty(NominalQuantity::Mass, &pair, 0.13));
        assert_eq!(model, before);
    }
}
