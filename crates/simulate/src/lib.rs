//! A model with its effects driven by a record: predicted outputs.
//!
//! [`Run`] brings a record into the units of a model; [`Simulator`] holds the model with its
//! effects, ready to be marched through runs from any initial state; [`predict_all`] does many at once. The plant may be a
//! simulator of the user's ([`Plant`]).
//!
//! ```
//! use simgap_effects::{Placed, find};
//! use simgap_model::{Location, Model};
//! use simgap_record::parse_csv;
//! use simgap_simulate::{Run, Simulator, substeps_for};
//!
//! let text = r#"
//! schema = "simgap-model/1"
//! name = "axis"
//! [[mass]]
//! name = "table"
//! value = 2.0
//! [[spring]]
//! name = "leaf"
//! between = ["table", "ground"]
//! stiffness = 800.0
//! [[damper]]
//! name = "guide"
//! between = ["table", "ground"]
//! damping = 4.0
//! [[input]]
//! channel = "u"
//! kind = "force"
//! at = "table"
//! [[output]]
//! channel = "y"
//! kind = "displacement"
//! at = "table"
//! "#;
//! let model = Model::from_toml(text)?;
//! // 8 N for 20 s: a spring of 800 N/m gives way by 10 mm.
//! let mut record = String::from("t [s],u [N]\n");
//! for k in 0..2000 {
//!     record += &format!("{},8\n", 0.01 * f64::from(k));
//! }
//! let run = Run::new(&model, &parse_csv("step.csv", record.as_bytes())?)?;
//! let steps = substeps_for(&model, std::slice::from_ref(&run))?;
//! let plain = Simulator::new(&model, &[], steps)?.predict(&run, &[])?;
//! assert!((plain[0][1999] - 0.01).abs() < 1e-6);
//!
//! // With 2 N of dry friction it comes to rest somewhere within 2.5 mm of that.
//! let friction = find("coulomb_friction").ok_or("not in the catalogue")?;
//! let at = Location::Between(["table".into(), "ground".into()]);
//! let effects = [Placed::new(friction, at, vec![2.0])];
//! let rubbing = Simulator::new(&model, &effects, steps)?.predict(&run, &[])?;
//! assert!((rubbing[0][1999] - 0.01).abs() < 0.0025);
//! assert!((rubbing[0][1999] - rubbing[0][1900]).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod batch;
mod drive;
mod driven;
mod error;
mod external;
mod outputs;
mod outside;
mod plant;
mod port_law;
mod ports;
mod predict;
mod prepare;
mod prepared;
mod response;
mod run;
mod simulator;
mod step;
mod waveform;

pub use batch::{Job, Prediction, predict_all};
pub use drive::lone_changes;
pub use error::SimulateError;
pub use external::ExternalPlant;
pub use plant::{Plant, PlantError, PlantRun};
pub use run::{Mended, Run, input_quantity, input_unit, output_quantity, output_unit};
pub use simgap_integrate::exact::lanes::LANES;
pub use simulator::{MemberPath, Simulator};
pub use step::substeps_for;
