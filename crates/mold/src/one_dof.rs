//! The mold on one spring and one damper, Eq. (1) to (3).

use std::f64::consts::TAU;

use simgap_model::{
    Damper, GROUND, Input, InputKind, Load, Mass, Model, Output, OutputKind, Spring,
};

use crate::MoldError;
use crate::channel::{DISPLACEMENT_CHANNEL, FORCE_CHANNEL};
use crate::error::{not_negative, positive};

/// Standard gravity, m/s² (exact by definition; `bipm-si`). The paper does not print its g.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Node of the far end of the leaf spring.
const LEAF_END: &str = "leaf_end";

/// The mold with one degree of freedom,
///
/// ```text
/// m ÿ + c ẏ + (k_leaf + k_add) y − k_leaf y_leaf = F − m g,     c = 2 ζ √(k m)      (1)
/// ```
///
/// | symbol | meaning | unit | published (Table 1) |
/// |---|---|---|---|
/// | m | mass | kg | 33 000 |
/// | ζ | damping ratio | 1 | 0.3 |
/// | k | k_leaf + k_add, total stiffness | N/m | 8 287 639 |
/// | k_leaf | part of k that the leaf spring brings ([`with_leaf`](Self::with_leaf)) | N/m | not printed |
/// | y_leaf | motion of the far end of the leaf spring | m | not printed |
/// | F | pressure force | N | |
///
/// Neither the split of k nor y_leaf is printed, so [`published`](Self::published) has one spring to ground and
/// y_leaf = 0. Valid for m, k > 0 and ζ ≥ 0.
///
/// Reference: `park-mold`, Eq. (1) and Table 1.
///
/// ```
/// let mold = simgap_mold::OneDof::published()?;
/// assert!((mold.natural_freq_hz() - 2.522).abs() < 1e-3);
/// assert!((mold.damping() - 313_779.0).abs() < 1.0);
/// # Ok::<(), simgap_mold::MoldError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct OneDof {
    mass_kg: f64,
    damping_ratio: f64,
    stiffness: f64,
    damping: f64,
    leaf: Option<Leaf>,
}

/// The leaf spring of Eq. (1).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
struct Leaf {
    stiffness: f64,
    moves: bool,
}

/// What the far end of the leaf spring does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum LeafEnd {
    /// y_leaf = 0.
    Fixed,
    /// y_leaf is an input, channel [`LEAF_CHANNEL`].
    Moving,
}

/// Channel of the motion of the far end of the leaf spring, m.
pub const LEAF_CHANNEL: &str = "y_leaf";

impl OneDof {
    /// A mold of mass (kg), damping ratio (1) and stiffness (N/m).
    ///
    /// # Errors
    /// [`MoldError::Parameter`] outside m, k > 0 and ζ ≥ 0.
    pub fn new(mass_kg: f64, damping_ratio: f64, stiffness: f64) -> Result<Self, MoldError> {
        positive("mass", mass_kg)?;
        not_negative("damping ratio", damping_ratio)?;
        positive("stiffness", stiffness)?;
        Ok(Self {
            mass_kg,
            damping_ratio,
            stiffness,
            damping: 2.0 * damping_ratio * (stiffness * mass_kg).sqrt(),
            leaf: None,
        })
    }

    /// The same with another damping c, N s/m.
    ///
    /// ```
    /// let mold = simgap_mold::OneDof::published()?.with_damping(147_000.0)?;
    /// assert!((mold.damping_ratio() - 0.1405).abs() < 1e-4);
    /// # Ok::<(), simgap_mold::MoldError>(())
    /// ```
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a negative damping.
    pub fn with_damping(mut self, damping: f64) -> Result<Self, MoldError> {
        self.damping = not_negative("damping", damping)?;
        self.damping_ratio = 0.5 * damping / (self.stiffness * self.mass_kg).sqrt();
        Ok(self)
    }

    /// The same with `leaf_stiffness` of the total stiffness in the leaf spring (k_leaf, N/m), and the rest in the
    /// cylinder (k_add).
    ///
    /// ```
    /// use simgap_mold::{LeafEnd, OneDof};
    /// let mold = OneDof::published()?.with_leaf(1.2e5, LeafEnd::Moving)?;
    /// assert_eq!(mold.leaf_stiffness() + mold.additional_stiffness(), mold.stiffness());
    /// assert_eq!(mold.model()?.inputs[1].channel, "y_leaf");
    /// # Ok::<(), simgap_mold::MoldError>(())
    /// ```
    ///
    /// # Errors
    /// [`MoldError::Parameter`] for a stiffness that is negative or above the total.
    pub fn with_leaf(mut self, leaf_stiffness: f64, end: LeafEnd) -> Result<Self, MoldError> {
        not_negative("k_leaf", leaf_stiffness)?;
        not_negative(
            "k_add, the total stiffness less k_leaf",
            self.stiffness - leaf_stiffness,
        )?;
        self.leaf = Some(Leaf {
            stiffness: leaf_stiffness,
            moves: end == LeafEnd::Moving,
        });
        Ok(self)
    }

    /// k_leaf, N/m; zero unless the stiffness was split.
    #[must_use]
    pub fn leaf_stiffness(&self) -> f64 {
        self.leaf.map_or(0.0, |leaf| leaf.stiffness)
    }

    /// k_add = k − k_leaf, N/m.
    #[must_use]
    pub fn additional_stiffness(&self) -> f64 {
        self.stiffness - self.leaf_stiffness()
    }

    /// The values of Table 1.
    ///
    /// # Errors
    /// [`MoldError::Table`] if the fixture was damaged.
    pub fn published() -> Result<Self, MoldError> {
        let table = simgap_tables::table1()?;
        Self::new(
            table.mass.si(),
            table.damping_ratio.si(),
            table.stiffness.si(),
        )
    }

    /// m, kg.
    #[must_use]
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// ζ.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    /// k, N/m.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// c = 2 ζ √(k m), N s/m.
    #[must_use]
    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// √(k/m) / 2π, Hz.
    #[must_use]
    pub fn natural_freq_hz(&self) -> f64 {
        (self.stiffness / self.mass_kg).sqrt() / TAU
    }

    /// f_n √(1 − ζ²), Hz; `None` for ζ ≥ 1, where the free motion does not swing.
    #[must_use]
    pub fn damped_freq_hz(&self) -> Option<f64> {
        let rest = 1.0 - self.damping_ratio * self.damping_ratio;
        (rest > 0.0).then(|| self.natural_freq_hz() * rest.sqrt())
    }

    /// f_n √(1 − 2ζ²), Hz, where the receptance is largest; `None` for ζ ≥ 1/√2, where it is
    /// largest at rest.
    #[must_use]
    pub fn resonance_freq_hz(&self) -> Option<f64> {
        let rest = 1.0 - 2.0 * self.damping_ratio * self.damping_ratio;
        (rest > 0.0).then(|| self.natural_freq_hz() * rest.sqrt())
    }

    /// k y, N: the force that holds the mold at a displacement (m).
    #[must_use]
    pub fn static_force(&self, displacement: f64) -> f64 {
        self.stiffness * displacement
    }

    /// The model file of Eq. (1): input `F_pressure` and weight on the mold, output `y`; and the input `y_leaf` if
    /// the far end of the leaf spring moves.
    ///
    /// # Errors
    /// [`MoldError::Model`] if the lumped model refuses a part.
    pub fn model(&self) -> Result<Model, MoldError> {
        let mold = || "mold".to_owned();
        let to_ground = || [mold(), GROUND.to_owned()];
        let mut springs = vec![Spring {
            name: "cylinder".to_owned(),
            between: to_ground(),
            stiffness: self.additional_stiffness(),
            uncertainty: None,
        }];
        let mut inputs = vec![pressure_input()];
        if let Some(leaf) = self.leaf {
            let far = if leaf.moves { LEAF_END } else { GROUND };
            springs.push(Spring {
                name: "leaf".to_owned(),
                between: [mold(), far.to_owned()],
                stiffness: leaf.stiffness,
                uncertainty: None,
            });
            inputs.extend(leaf.moves.then(|| Input {
                channel: LEAF_CHANNEL.to_owned(),
                kind: InputKind::Displacement,
                at: LEAF_END.to_owned(),
                gain: None,
                uncertainty: None,
                between_samples: None,
            }));
        }
        let model = Model {
            name: "mold-1dof".to_owned(),
            masses: vec![Mass {
                name: mold(),
                value: self.mass_kg,
                uncertainty: None,
            }],
            springs,
            dampers: vec![Damper {
                name: "cylinder".to_owned(),
                between: to_ground(),
                damping: self.damping(),
                uncertainty: None,
            }],
            inputs,
            outputs: vec![displacement_output()],
            loads: vec![Load {
                at: mold(),
                value: -self.mass_kg * STANDARD_GRAVITY,
                uncertainty: None,
            }],
            ..Model::default()
        };
        model.check()?;
        Ok(model)
    }
}

/// The pressure force on the mold.
pub(crate) fn pressure_input() -> Input {
    Input {
        channel: FORCE_CHANNEL.to_owned(),
        kind: InputKind::Force,
        at: "mold".to_owned(),
        gain: None,
        uncertainty: None,
        between_samples: None,
    }
}

/// The measured displacement of the mold.
pub(crate) fn displacement_output() -> Output {
    Output {
        channel: DISPLACEMENT_CHANNEL.to_owned(),
        kind: OutputKind::Displacement,
        at: Some("mold".to_owned()),
        between: None,
        gain: None,
        uncertainty: None,
    }
}
