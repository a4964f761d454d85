//! A sensor that is not connected: what stands in its channel is noise of the amplifier.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::common::{Noise, plant, record};
use simgap_diagnose::{Request, Status, diagnose};
use simgap_record::{Channel, Record};

/// A record of the plant in which noise with a correlation of neighbours stands for the acceleration.
fn unconnected(number: u64, colour: f64) -> Record {
    let whole = record(&plant(), &[], number, 2500, 4e-3, 0.0);
    let mut noise = Noise(77 + number);
    let mut level = 0.0;
    let fresh = (1.0 - colour * colour).sqrt();
    let read = (0..whole.len()).map(|_| {
        level = colour * level + fresh * noise.next();
        2e-3 * level
    });
    let read: Vec<f64> = read.collect();
    let channels = whole
        .channels()
        .iter()
        .map(|channel| match channel.name.as_str() {
            "a" => Channel::new("a", "m/s^2", read.clone()),
            _ => channel.clone(),
        });
    Record::from_uniform(format!("{number}.csv"), 0.0, 4e-3, channels.collect()).unwrap()
}

/// White and coloured: nothing of the catalogue is blamed, and the channel is named in the first sentence.
#[test]
fn verify_a_channel_of_noise_is_told_as_not_connected() {
    for colour in [0.0, 0.8] {
        let records: Vec<Record> = (1..4).map(|k| unconnected(k, colour)).collect();
        let model = plant();
        let request = Request::new(&model, &records[..2], &records[2..]);
        let diagnosis = diagnose(&request, &|_| {}).unwrap().diagnosis;
        let verdict = &diagnosis.verdict;
        assert_eq!(verdict.status, Status::Unknown, "{colour}: {verdict:?}");
        assert!(verdict.effects.is_empty() && !verdict.complete);
        let first = &verdict.description[0];
        assert!(
            first.contains("channel a has nothing to do with the inputs"),
            "{first}"
        );
        let next = diagnosis.next_experiment.unwrap();
        assert!(
            next.contains("whether the sensor of a is connected"),
            "{next}"
        );
    }
}
