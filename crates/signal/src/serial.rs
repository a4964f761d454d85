//! Complex numbers as they are serialised: a list of `{"re": .., "im": ..}`, as the other crates write them.

use rustfft::num_complex::Complex64;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Serialize, Deserialize)]
struct Complex {
    re: f64,
    im: f64,
}

pub(crate) fn serialize<S: Serializer>(
    values: &[Complex64],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let parts = values.iter().map(|value| Complex {
        re: value.re,
        im: value.im,
    });
    serializer.collect_seq(parts)
}

pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<Complex64>, D::Error> {
    let values = Vec::<Complex>::deserialize(deserializer)?;
    let values = values
        .into_iter()
        .map(|value| Complex64::new(value.re, value.im));
    Ok(values.collect())
}
