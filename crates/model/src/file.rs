//! The model file (TOML, schema `simgap-model/1`): text to [`Model`] and back.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::element::Table;
use crate::elements::for_elements;
use crate::law::file::LawFile;
use crate::{
    Damper, EffectEntry, Input, Load, Location, Mass, Model, ModelError, Output, Pendulum,
    PlantParameter, PlantPort, Spring,
};

/// The schema this version reads and writes.
pub const SCHEMA: &str = "simgap-model/1";

macro_rules! model_file {
    ($($(#[$doc:meta])* $list:ident: $Kind:ident { $($table:ident: $File:ty),* })*) => {
        #[derive(Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        struct ModelFile {
            schema: String,
            name: String,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            mass: Vec<Mass>,
            $($(
                #[serde(default, skip_serializing_if = "Vec::is_empty")]
                $table: Vec<$File>,
            )*)*
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            spring: Vec<Spring>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            damper: Vec<Damper>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            input: Vec<Input>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            output: Vec<Output>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            load: Vec<Load>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            pendulum: Vec<Pendulum>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            parameter: Vec<PlantParameter>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            port: Vec<PlantPort>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            law: Vec<LawFile>,
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            effect: Vec<EffectFile>,
        }

        impl ModelFile {
            /// The model and its elements, without anything else.
            fn of_elements(model: &Model) -> ModelFile {
                ModelFile {
                    schema: SCHEMA.into(),
                    name: model.name.clone(),
                    mass: vec![],
                    $($($table: Table::all_of(model),)*)*
                    spring: vec![],
                    damper: vec![],
                    input: vec![],
                    output: vec![],
                    load: vec![],
                    pendulum: vec![],
                    parameter: vec![],
                    port: vec![],
                    law: vec![],
                    effect: vec![],
                }
            }

            /// Adds the elements to a model that has its masses.
            fn add_elements(&mut self, model: &mut Model) -> Result<(), ModelError> {
                $($(
                    let tables = std::mem::take(&mut self.$table).into_iter();
                    for table in tables {
                        table.add_to(model)?;
                    }
                )*)*
                Ok(())
            }
        }
    };
}

for_elements!(model_file);

#[derive(Serialize, Deserialize)]
struct EffectFile {
    kind: String,
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "crate::two::two_or_none"
    )]
    between: Option<[String; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mass: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    input: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    channel: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    parameter: Option<String>,
    #[serde(flatten)]
    parameters: BTreeMap<String, f64>,
}

impl EffectFile {
    fn into_entry(self, index: usize) -> Result<EffectEntry, ModelError> {
        let places = [
            self.between.map(Location::Between),
            self.mass.map(Location::Mass),
            self.input.map(Location::Input),
            self.channel.map(Location::Channel),
            self.parameter.map(Location::Parameter),
        ];
        let mut found: Vec<Location> = places.into_iter().flatten().collect();
        match (found.pop(), found.is_empty()) {
            (Some(at), true) => Ok(EffectEntry {
                kind: self.kind,
                at,
                parameters: self.parameters,
            }),
            (one, _) => Err(ModelError::Shape {
                place: format!("[[effect]] {} \"{}\"", index + 1, self.kind),
                found: if one.is_none() {
                    "no place is given".into()
                } else {
                    "several places are given".into()
                },
                needed: "exactly one of between, mass, input, channel, parameter".into(),
            }),
        }
    }

    fn from_entry(entry: &EffectEntry) -> EffectFile {
        let mut file = EffectFile {
            kind: entry.kind.clone(),
            between: None,
            mass: None,
            input: None,
            channel: None,
            parameter: None,
            parameters: entry.parameters.clone(),
        };
        match entry.at.clone() {
            Location::Between(pair) => file.between = Some(pair),
            Location::Mass(mass) => file.mass = Some(mass),
            Location::Input(channel) => file.input = Some(channel),
            Location::Channel(channel) => file.channel = Some(channel),
            Location::Parameter(name) => file.parameter = Some(name),
        }
        file
    }
}

/// Line and character of a byte of the text, both from 1.
fn place_of(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    let line = 1 + before.matches('\n').count();
    (line, 1 + before[start..].chars().count())
}

impl Model {
    /// Reads a model from the text of a model file and checks it.
    ///
    /// # Errors
    /// [`ModelError`] with the line (syntax) or the table and item (meaning).
    ///
    /// ```
    /// use simgap_model::Model;
    /// let text = r#"
    /// schema = "simgap-model/1"
    /// name = "axis"
    /// [[mass]]
    /// name = "carriage"
    /// value = 95.0
    /// [[output]]
    /// channel = "q"
    /// kind = "displacement"
    /// at = "carriage"
    /// "#;
    /// let model = Model::from_toml(text)?;
    /// assert_eq!(model.masses[0].value, 95.0);
    /// # Ok::<(), simgap_model::ModelError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Model, ModelError> {
        let mut file: ModelFile = toml::from_str(text).map_err(|error| {
            let (line, column) = error
                .span()
                .map_or((1, 1), |span| place_of(text, span.start));
            let words: Vec<&str> = error.message().split_whitespace().collect();
            ModelError::Syntax {
                line,
                column,
                found: words.join(" "),
            }
        })?;
        if file.schema != SCHEMA {
            return Err(ModelError::Schema {
                found: file.schema,
                needed: SCHEMA,
            });
        }
        let effects = std::mem::take(&mut file.effect)
            .into_iter()
            .enumerate()
            .map(|(i, effect)| effect.into_entry(i))
            .collect::<Result<Vec<_>, _>>()?;
        let laws = std::mem::take(&mut file.law).into_iter();
        let laws = laws.map(|law| law.into_law(text, &|offset| place_of(text, offset)));
        let laws = laws.collect::<Result<Vec<_>, _>>()?;
        let mut model = Model {
            name: std::mem::take(&mut file.name),
            masses: std::mem::take(&mut file.mass),
            ..Model::default()
        };
        file.add_elements(&mut model)?;
        // A beam has pushed its spring: those of the file come first.
        file.spring.append(&mut model.springs);
        let model = Model {
            springs: file.spring,
            dampers: file.damper,
            inputs: file.input,
            outputs: file.output,
            loads: file.load,
            pendulums: file.pendulum,
            plant_parameters: file.parameter,
            ports: file.port,
            laws,
            effects,
            ..model
        };
        model.check()?;
        Ok(model)
    }

    /// Writes the model as the text of a model file; [`Model::from_toml`] reads it back unchanged.
    ///
    /// # Errors
    /// [`ModelError::Syntax`] when the model cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, ModelError> {
        let masses = self.masses.iter();
        let masses = masses.filter(|mass| self.coordinate_kind(&mass.name).is_none());
        let springs = self.springs.iter();
        let springs = springs.filter(|spring| !self.is_of_element(spring));
        let file = ModelFile {
            mass: masses.cloned().collect(),
            spring: springs.cloned().collect(),
            damper: self.dampers.clone(),
            input: self.inputs.clone(),
            output: self.outputs.clone(),
            load: self.loads.clone(),
            pendulum: self.pendulums.clone(),
            parameter: self.plant_parameters.clone(),
            port: self.ports.clone(),
            law: self.laws.iter().map(LawFile::from_law).collect(),
            effect: self.effects.iter().map(EffectFile::from_entry).collect(),
            ..ModelFile::of_elements(self)
        };
        toml::to_string(&file).map_err(|error| ModelError::Syntax {
            line: 0,
            column: 0,
            found: error.to_string(),
        })
    }
}
