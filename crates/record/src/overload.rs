//! Numbers that instruments write where they have none.
//!
//! The standard of their commands (SCPI-99, volume 1, section 7.2.1.4) gives 9.9e37 for infinity,
//! of either sign, and 9.91e37 for no number at all; oscilloscopes and meters write them for an
//! overload. Programs write the largest number of single or double precision, which no sensor measures.

use crate::Channel;

/// Magnitudes of the marks.
const MARKS: [f64; 4] = [9.9e37, 9.91e37, f32::MAX as f64, f64::MAX];
/// Single precision keeps them to this share.
const ROUNDED: f64 = 1e-6;

pub(crate) fn is_mark(value: f64) -> bool {
    MARKS
        .iter()
        .any(|mark| (value.abs() - mark).abs() <= ROUNDED * mark)
}

/// Takes the marks of a channel as missing; how many there were.
pub(crate) fn taken_as_missing(channel: &mut Channel) -> usize {
    let mut marks = 0;
    for value in channel.values.iter_mut().filter(|value| is_mark(**value)) {
        *value = f64::NAN;
        marks += 1;
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_marks_are_known_in_either_precision() {
        let largest = [f64::from(f32::MAX), -3.402823e38, f64::MIN, f64::MAX];
        let standard = [9.9e37, -9.9e37, 9.91e37, f64::from(9.91e37_f32)];
        for mark in standard.into_iter().chain(largest) {
            assert!(is_mark(mark), "{mark}");
        }
        for value in [0.0, 9.8e37, 9.9e36, 1e38, f64::INFINITY, f64::NAN] {
            assert!(!is_mark(value), "{value}");
        }
    }
}
