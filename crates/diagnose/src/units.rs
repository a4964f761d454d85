//! Units of what an answer tells: of the machine as it moves, along lines or in angles, and of its channels.

use std::collections::BTreeSet;

use simgap_effects::{Effect, Parameter, unit_of_rotation};
use simgap_model::{GROUND, Location, Model, OutputKind};
use simgap_record::{Record, Unit};
use simgap_simulate::{input_unit, output_unit};

use crate::DiagnoseError;

/// Refuses records that hold a channel of the model in different units: numbers that a gain takes as they are, or another quantity.
///
/// # Errors
/// [`DiagnoseError::OtherUnit`].
pub(crate) fn refuse_other_units(model: &Model, records: &[&Record]) -> Result<(), DiagnoseError> {
    let inputs = model
        .inputs
        .iter()
        .map(|input| (&input.channel, input.gain));
    let outputs = model
        .outputs
        .iter()
        .map(|output| (&output.channel, output.gain));
    for (channel, gain) in inputs.chain(outputs) {
        let columns = records.iter().filter_map(|record| {
            let unit = &record.channel(channel)?.unit;
            let is_stated = !["", "-", "1"].contains(&unit.symbol());
            is_stated.then_some((record.name(), unit))
        });
        let columns: Vec<(&str, &Unit)> = columns.collect();
        let Some(((known_in, known), others)) = columns.split_first() else {
            continue;
        };
        let is_known = |unit: &Unit| {
            let has_factor = gain.is_none() || unit.si_factor() == known.si_factor();
            known.measures_as(unit) && has_factor
        };
        if let Some((record, found)) = others.iter().find(|(_, unit)| !is_known(unit)) {
            return Err(DiagnoseError::OtherUnit {
                record: (*record).to_string(),
                channel: channel.clone(),
                found: found.symbol().to_string(),
                known: format!("{} in {known_in}", known.symbol()),
            });
        }
    }
    Ok(())
}

/// Units of the places of a model and of the channels of a record, SI.
pub(crate) struct Units {
    /// Nodes that turn.
    pub(crate) turning: Vec<String>,
    inputs: Vec<(String, &'static str)>,
    outputs: Vec<(String, &'static str)>,
}

impl Units {
    /// For a model and the columns of a record.
    pub(crate) fn new(model: &Model, record: &Record) -> Units {
        let inputs = model.inputs.iter();
        let inputs = inputs.map(|input| (input.channel.clone(), input_unit(input, record)));
        let outputs = model.outputs.iter();
        let outputs = outputs.map(|output| (output.channel.clone(), output_unit(output, record)));
        let mut units = Units {
            turning: vec![],
            inputs: inputs.collect(),
            outputs: outputs.collect(),
        };
        units.turning = units.turning_nodes(model).into_iter().collect();
        units
    }

    /// What turns by the unit of a channel, by an arm or the roll of a body, or by a member that joins it to what turns.
    fn turning_nodes(&self, model: &Model) -> BTreeSet<String> {
        let is_angle = |unit: &str| unit.starts_with("rad") || unit == "N m";
        let mut turning: BTreeSet<String> = BTreeSet::new();
        for (input, (_, unit)) in model.inputs.iter().zip(&self.inputs) {
            turning.extend(is_angle(unit).then(|| input.at.clone()));
        }
        let outputs = model.outputs.iter().zip(&self.outputs);
        let outputs = outputs.filter(|(output, (_, unit))| {
            // The roll of a body is measured at the body.
            is_angle(unit) && output.kind != OutputKind::Roll
        });
        for (output, _) in outputs {
            turning.extend(
                output
                    .at
                    .iter()
                    .chain(output.between.iter().flatten())
                    .cloned(),
            );
            // A simulator tells the motion of a port among its outputs.
            let of_simulator = output.at.as_ref().unwrap_or(&output.channel);
            let ports = model
                .ports
                .iter()
                .filter(|port| [&port.displacement, &port.velocity].contains(&of_simulator));
            turning.extend(ports.map(|port| port.name.clone()));
        }
        turning.extend(model.pendulums.iter().map(|arm| arm.at.clone()));
        let names = model.masses.iter().map(|mass| &mass.name);
        turning.extend(names.filter(|name| model.is_roll(name)).cloned());
        turning.remove(GROUND);
        let springs = model.springs.iter().map(|spring| &spring.between);
        let members: Vec<_> = springs
            .chain(model.dampers.iter().map(|damper| &damper.between))
            .filter(|pair| pair.iter().all(|node| node != GROUND))
            .collect();
        loop {
            let reached = members
                .iter()
                .filter(|pair| pair.iter().any(|n| turning.contains(n)));
            let reached: BTreeSet<String> = reached.copied().flatten().cloned().collect();
            if reached.is_subset(&turning) {
                return turning;
            }
            turning.extend(reached);
        }
    }

    /// The unit of an output.
    pub(crate) fn of_output(&self, index: usize) -> &'static str {
        self.outputs.get(index).map_or("", |(_, unit)| *unit)
    }

    /// The unit of a parameter of an effect at a place; empty for a pure number.
    pub(crate) fn of(&self, effect: &dyn Effect, parameter: &Parameter, at: &Location) -> String {
        if !effect.names_hold_units() {
            // A law of the user's, for this very place.
            return plain(parameter.unit);
        }
        let channel_unit = |channels: &[(String, &'static str)], name: &String| {
            let found = channels.iter().find(|(channel, _)| channel == name);
            found.map_or("", |(_, unit)| *unit)
        };
        let of_channel = match at {
            Location::Channel(name) => channel_unit(&self.outputs, name),
            Location::Input(name) => channel_unit(&self.inputs, name),
            Location::Between(_) | Location::Mass(_) | Location::Parameter(_) => "",
        };
        let of_signal = ["unit of the output", "unit of the input"];
        let per = of_signal
            .iter()
            .find_map(|unit| parameter.unit.strip_prefix(unit));
        match (per, of_channel) {
            (Some(per), "" | "1") if !per.is_empty() => format!("1{per}"),
            (Some(per), unit) => match unit.strip_suffix(per).filter(|_| per == "/s") {
                Some(unit) => format!("{unit}/s^2"),
                None => plain(&format!("{unit}{per}")),
            },
            (None, _) if turns(&self.turning, at) => plain(&unit_of_rotation(parameter.unit)),
            (None, _) => plain(parameter.unit),
        }
    }
}

/// Whether a place is one of those that turn.
pub(crate) fn turns(turning: &[String], at: &Location) -> bool {
    match at {
        Location::Between(pair) => pair.iter().any(|node| turning.contains(node)),
        Location::Mass(mass) => turning.contains(mass),
        Location::Input(_) | Location::Channel(_) | Location::Parameter(_) => false,
    }
}

/// A unit as it is told: nothing for a pure number.
fn plain(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        unit => unit.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use simgap_effects::find;

    use super::*;

    const MODEL: &str = "schema = \"simgap-model/1\"\nname = \"arm\"\n\
        [[mass]]\nname = \"motor\"\nvalue = 2.0\n[[mass]]\nname = \"arm\"\nvalue = 3.0\n\
        [[mass]]\nname = \"slide\"\nvalue = 3.0\n\
        [[spring]]\nname = \"shaft\"\nbetween = [\"motor\", \"arm\"]\nstiffness = 100.0\n\
        [[damper]]\nname = \"bearing\"\nbetween = [\"motor\", \"ground\"]\ndamping = 1.0\n\
        [[damper]]\nname = \"guide\"\nbetween = [\"slide\", \"ground\"]\ndamping = 1.0\n\
        [[input]]\nchannel = \"F\"\nkind = \"force\"\nat = \"slide\"\n\
        [[output]]\nchannel = \"q\"\nkind = \"displacement\"\nat = \"arm\"\n\
        [[output]]\nchannel = \"x\"\nkind = \"velocity\"\nat = \"slide\"\n";

    fn unit(kind: &str, at: &Location) -> String {
        let model = Model::from_toml(MODEL).unwrap();
        let rows: String = (0..9).map(|k| format!("0.{k},{k},1,{k}\n")).collect();
        let text = format!("t [s],F [kN],q [deg],x [mm/s]\n{rows}");
        let record = simgap_record::parse_csv("run.csv", text.as_bytes()).unwrap();
        let effect = find(kind).unwrap();
        Units::new(&model, &record).of(effect, &effect.parameters()[0], at)
    }

    /// The shaft carries the angle of the arm to the motor; the ground does not carry it to the slide.
    #[test]
    fn verify_units_follow_angles_along_members() {
        let pair = |a: &str| Location::Between([a.into(), "ground".into()]);
        let [motor, slide] = [pair("motor"), pair("slide")];
        assert_eq!(unit("coulomb_friction", &motor), "N m");
        assert_eq!(unit("coulomb_friction", &slide), "N");
        assert_eq!(unit("viscous_damping", &motor), "N m s/rad");
        assert_eq!(unit("end_stop", &motor), "rad");
        assert_eq!(
            unit("attached_mode", &Location::Mass("arm".into())),
            "kg m^2"
        );
        assert_eq!(unit("mass_error", &Location::Mass("arm".into())), "");
    }

    #[test]
    fn verify_units_of_channels() {
        let [q, x] = ["q", "x"].map(|name| Location::Channel(name.into()));
        assert_eq!(unit("sensor_bias", &q), "rad");
        assert_eq!(unit("sensor_drift", &x), "m/s^2");
        assert_eq!(unit("sensor_gain", &x), "");
        assert_eq!(unit("input_dead_zone", &Location::Input("F".into())), "N");
    }
}
