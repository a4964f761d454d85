//! Complex numbers and matrices as they are serialised: `{"re", "im"}`, and rows.

use faer::{Mat, c64};
use serde::Serialize;
use serde::ser::{SerializeSeq, SerializeStruct, Serializer};

/// A complex number as `{"re": .., "im": ..}`.
struct Complex<'a>(&'a c64);

impl Serialize for Complex<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        complex(self.0, serializer)
    }
}

pub(crate) fn complex<S: Serializer>(value: &c64, serializer: S) -> Result<S::Ok, S::Error> {
    let mut fields = serializer.serialize_struct("Complex", 2)?;
    fields.serialize_field("re", &value.re)?;
    fields.serialize_field("im", &value.im)?;
    fields.end()
}

pub(crate) fn complex_list<S: Serializer>(
    values: &[c64],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(values.iter().map(Complex))
}

pub(crate) fn complex_list_or_none<S: Serializer>(
    values: &Option<Vec<c64>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match values {
        Some(values) => complex_list(values, serializer),
        None => serializer.serialize_none(),
    }
}

pub(crate) fn rows<S: Serializer>(matrix: &Mat<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    let mut sequence = serializer.serialize_seq(Some(matrix.nrows()))?;
    for i in 0..matrix.nrows() {
        let row: Vec<f64> = (0..matrix.ncols()).map(|j| matrix[(i, j)]).collect();
        sequence.serialize_element(&row)?;
    }
    sequence.end()
}
