//! Complex numbers and matrices as they are serialised: `{"re": .., "im": ..}`, and rows.
//!
//! For `#[serde(with = "simgap_model::serial::rows")]` and its neighbours. JSON has no number that is not finite: it holds
//! null there, which is not read back.
//!
//! ```
//! use faer::{Mat, mat};
//!
//! #[derive(serde::Serialize, serde::Deserialize)]
//! struct Flexibility {
//!     #[serde(with = "simgap_model::serial::rows")]
//!     m_per_n: Mat<f64>,
//! }
//! let written = toml::to_string(&Flexibility { m_per_n: mat![[0.5, 0.1], [0.1, 0.25]] })?;
//! let read: Flexibility = toml::from_str(&written)?;
//! assert_eq!(read.m_per_n[(0, 1)], 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use faer::c64;
use serde::{Deserialize, Serialize};

/// A complex number as `{"re": .., "im": ..}`.
#[derive(Serialize, Deserialize)]
struct Complex {
    re: f64,
    im: f64,
}

impl From<c64> for Complex {
    fn from(value: c64) -> Self {
        Complex {
            re: value.re,
            im: value.im,
        }
    }
}

impl From<Complex> for c64 {
    fn from(value: Complex) -> Self {
        c64::new(value.re, value.im)
    }
}

/// One complex number.
pub mod complex {
    use super::{Complex, Deserialize, Serialize, c64};
    use serde::{Deserializer, Serializer};

    /// Writes `{"re": .., "im": ..}`.
    ///
    /// # Errors
    /// Those of the serialiser.
    pub fn serialize<S: Serializer>(value: &c64, serializer: S) -> Result<S::Ok, S::Error> {
        Complex::from(*value).serialize(serializer)
    }

    /// Reads `{"re": .., "im": ..}`.
    ///
    /// # Errors
    /// Those of the deserialiser.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<c64, D::Error> {
        Complex::deserialize(deserializer).map(c64::from)
    }
}

/// A list of complex numbers.
pub mod complex_list {
    use super::{Complex, Deserialize, c64};
    use serde::{Deserializer, Serializer};

    /// Writes a list of `{"re": .., "im": ..}`.
    ///
    /// # Errors
    /// Those of the serialiser.
    pub fn serialize<S: Serializer>(values: &[c64], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(values.iter().copied().map(Complex::from))
    }

    /// Reads a list of `{"re": .., "im": ..}`.
    ///
    /// # Errors
    /// Those of the deserialiser.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<c64>, D::Error> {
        let values = Vec::<Complex>::deserialize(deserializer)?;
        Ok(values.into_iter().map(c64::from).collect())
    }
}

/// A list of complex numbers, or none.
pub mod complex_list_or_none {
    use super::{Complex, Deserialize, c64};
    use serde::{Deserializer, Serializer};

    /// Writes a list of `{"re": .., "im": ..}` or null.
    ///
    /// # Errors
    /// Those of the serialiser.
    pub fn serialize<S: Serializer>(
        values: &Option<Vec<c64>>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        match values {
            Some(values) => super::complex_list::serialize(values, serializer),
            None => serializer.serialize_none(),
        }
    }

    /// Reads a list of `{"re": .., "im": ..}` or null.
    ///
    /// # Errors
    /// Those of the deserialiser.
    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<Vec<c64>>, D::Error> {
        let values = Option::<Vec<Complex>>::deserialize(deserializer)?;
        Ok(values.map(|values| values.into_iter().map(c64::from).collect()))
    }
}

/// A matrix as a list of its rows.
pub mod rows {
    use super::Deserialize;
    use faer::Mat;
    use serde::de::Error;
    use serde::ser::SerializeSeq;
    use serde::{Deserializer, Serializer};

    /// Writes one list for each row.
    ///
    /// # Errors
    /// Those of the serialiser.
    pub fn serialize<S: Serializer>(matrix: &Mat<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        let mut sequence = serializer.serialize_seq(Some(matrix.nrows()))?;
        for i in 0..matrix.nrows() {
            let row: Vec<f64> = (0..matrix.ncols()).map(|j| matrix[(i, j)]).collect();
            sequence.serialize_element(&row)?;
        }
        sequence.end()
    }

    /// Reads one list for each row.
    ///
    /// # Errors
    /// Those of the deserialiser, and rows that are not of one length.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Mat<f64>, D::Error> {
        let rows = Vec::<Vec<f64>>::deserialize(deserializer)?;
        let columns = rows.first().map_or(0, Vec::len);
        for (i, row) in rows.iter().enumerate() {
            if row.len() != columns {
                let (found, row) = (row.len(), i + 1);
                return Err(D::Error::custom(format!(
                    "row {row} of a matrix has {found} entries, the first {columns}"
                )));
            }
        }
        Ok(Mat::from_fn(rows.len(), columns, |i, j| rows[i][j]))
    }
}
