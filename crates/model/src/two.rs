//! Lists of exactly two. A list that serde reads into an array ends with the length of the array, whatever follows.

use serde::de::Error;
use serde::{Deserialize, Deserializer};

/// Two values.
pub(crate) fn two<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<[T; 2], D::Error> {
    let all = Vec::deserialize(deserializer)?;
    let two = all.try_into();
    two.map_err(|all: Vec<T>| D::Error::invalid_length(all.len(), &"an array of length 2"))
}

/// [`two`], where they may be left out.
pub(crate) fn two_or_none<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<[T; 2]>, D::Error> {
    two(deserializer).map(Some)
}
