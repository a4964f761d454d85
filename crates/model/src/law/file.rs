//! `[[law]]` as the model file writes it.

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::{Law, LawParameter};
use crate::ModelError;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LawFile {
    name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    summary: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    between: Option<Places>,
    force: Spanned<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    parameter: Vec<LawParameter>,
}

#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected two names of nodes, or a list of such pairs"
)]
enum Places {
    One([String; 2]),
    Several(Vec<[String; 2]>),
}

/// Line and character of a byte of a text.
pub(crate) type PlaceOf<'a> = &'a dyn Fn(usize) -> (usize, usize);

impl LawFile {
    /// The law, its force told with its place in the file where it cannot be read.
    pub(crate) fn into_law(self, text: &str, place_of: PlaceOf<'_>) -> Result<Law, ModelError> {
        let span = self.force.span();
        let law = Law {
            name: self.name,
            summary: self.summary,
            between: match self.between {
                None => vec![],
                Some(Places::One(pair)) => vec![pair],
                Some(Places::Several(pairs)) => pairs,
            },
            force: self.force.into_inner(),
            parameters: self.parameter,
        };
        law.check_names()?;
        let Err(bad) = law.parsed() else {
            return Ok(law);
        };
        // Beyond the quotes; where characters are escaped, the place is that of the string.
        let quoted = text.get(span.clone()).unwrap_or_default();
        let begin = quoted.find(&law.force).unwrap_or(0);
        let mut characters = law.force.char_indices().skip(bad.character - 1);
        let within = characters.next().map_or(law.force.len(), |(byte, _)| byte);
        let is_plain = !law.force.is_empty() && quoted.contains(&law.force);
        let at = span.start + if is_plain { begin + within } else { 0 };
        let (line, column) = place_of(at);
        Err(ModelError::Syntax {
            line,
            column,
            found: format!(
                "{}: force has {}, needed is {}",
                law.place(),
                bad.found,
                bad.needed
            ),
        })
    }

    pub(crate) fn from_law(law: &Law) -> LawFile {
        let mut pairs = law.between.clone();
        let first = match pairs.len() {
            1 => pairs.pop(),
            _ => None,
        };
        LawFile {
            name: law.name.clone(),
            summary: law.summary.clone(),
            between: match first {
                Some(pair) => Some(Places::One(pair)),
                None if pairs.is_empty() => None,
                None => Some(Places::Several(pairs)),
            },
            force: Spanned::new(0..0, law.force.clone()),
            parameter: law.parameters.clone(),
        }
    }
}
