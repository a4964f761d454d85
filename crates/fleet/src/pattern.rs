//! Where records lie: paths with named fields.
//!
//! ```text
//! records/machine={machine}/{date}/{record}.csv
//! ```
//!
//! A part between two slashes holds literal text, `{field}` (one character or more) and `*` (any number of characters);
//! a part `**` stands for any number of folders. A field that stands twice has the same value in both places.

use std::collections::BTreeMap;

/// Values of the fields of a path.
pub type Fields = BTreeMap<String, String>;

/// One piece of a part.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Literal(String),
    Field(String),
    Any,
}

/// One part between slashes.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Folders,
    Name(Vec<Piece>),
}

/// A pattern of paths.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    /// As the plan writes it.
    pub text: String,
    /// The folder before the first part that is not literal, with slashes; empty for the folder of the plan.
    pub root: String,
    parts: Vec<Part>,
}

impl Pattern {
    /// A pattern from its text.
    ///
    /// # Errors
    /// What was found and what is needed, where braces do not pair, a field has no name, or `**` is not a part of its own.
    pub fn parse(text: &str) -> Result<Pattern, (String, &'static str)> {
        // A scheme (`s3://`) and the root of a path belong to the folder.
        let (scheme, path) = match text.split_once("://") {
            Some((scheme, path)) => (format!("{scheme}://"), path),
            None if text.starts_with('/') => ("/".to_owned(), &text[1..]),
            None => (String::new(), text),
        };
        let parts: Vec<&str> = path.split('/').filter(|p| !p.is_empty()).collect();
        let is_open = |part: &&&str| part.contains(['{', '}', '*']);
        let literal = parts.iter().take_while(|part| !is_open(part)).count();
        // The last part is a name of files, literal or not.
        let literal = literal.min(parts.len().saturating_sub(1));
        let open = parts[literal..].iter().map(|part| part_of(part));
        Ok(Pattern {
            text: text.to_owned(),
            root: format!("{scheme}{}", parts[..literal].join("/")),
            parts: open.collect::<Result<_, _>>()?,
        })
    }

    /// Names of the fields.
    pub fn fields(&self) -> impl Iterator<Item = &str> {
        let pieces = self.parts.iter().flat_map(|part| match part {
            Part::Folders => &[][..],
            Part::Name(pieces) => &pieces[..],
        });
        pieces.filter_map(|piece| match piece {
            Piece::Field(name) => Some(name.as_str()),
            _ => None,
        })
    }

    /// The values of the fields of a path that the pattern describes. Where there are several ways to read it, earlier
    /// fields are as short as can be.
    ///
    /// ```
    /// use simgap_fleet::pattern::Pattern;
    /// let pattern = Pattern::parse("data/{machine}/{date}_{record}.csv").map_err(|(found, _)| found)?;
    /// let fields = pattern.fields_of("data/m07/2026-03-01_run1.csv").unwrap_or_default();
    /// assert_eq!((&*fields["machine"], &*fields["record"]), ("m07", "run1"));
    /// assert_eq!(pattern.fields_of("data/m07/notes.txt"), None);
    /// # Ok::<(), String>(())
    /// ```
    #[must_use]
    pub fn fields_of(&self, path: &str) -> Option<Fields> {
        let rest = path.strip_prefix(&self.root)?;
        let rest = match self.root.is_empty() || self.root.ends_with('/') {
            true => rest,
            false => rest.strip_prefix('/')?,
        };
        let parts: Vec<&str> = rest.split('/').filter(|p| !p.is_empty()).collect();
        matched(&self.parts, &parts, &Fields::new())
    }

    /// The pattern with `*` for every field, as other programs understand it.
    #[must_use]
    pub fn glob(&self) -> String {
        let part = |part: &Part| match part {
            Part::Folders => "**".to_owned(),
            Part::Name(pieces) => {
                let pieces = pieces.iter().map(|piece| match piece {
                    Piece::Literal(text) => text.as_str(),
                    _ => "*",
                });
                pieces.collect()
            }
        };
        let parts: Vec<String> = self.parts.iter().map(part).collect();
        match self.root.is_empty() || self.root.ends_with('/') {
            true => format!("{}{}", self.root, parts.join("/")),
            false => format!("{}/{}", self.root, parts.join("/")),
        }
    }
}

fn part_of(text: &str) -> Result<Part, (String, &'static str)> {
    if text == "**" {
        return Ok(Part::Folders);
    }
    if text.contains("**") {
        let found = format!("\"**\" inside \"{text}\"");
        return Err((found, "\"**\" as a folder of its own"));
    }
    let mut pieces = Vec::new();
    let mut literal = String::new();
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        let piece = match c {
            '*' => Piece::Any,
            '{' => {
                let name: String = rest.by_ref().take_while(|c| *c != '}').collect();
                let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
                if name.is_empty() || !name.chars().all(plain) || !text.contains('}') {
                    let found = format!("a field \"{{{name}\"");
                    return Err((found, "a name of letters, digits and _ between { and }"));
                }
                Piece::Field(name)
            }
            '}' => return Err(("a } without a {".to_owned(), "a field as {name}")),
            c => {
                literal.push(c);
                continue;
            }
        };
        if !literal.is_empty() {
            pieces.push(Piece::Literal(std::mem::take(&mut literal)));
        }
        pieces.push(piece);
    }
    if !literal.is_empty() {
        pieces.push(Piece::Literal(literal));
    }
    Ok(Part::Name(pieces))
}

fn matched(parts: &[Part], names: &[&str], known: &Fields) -> Option<Fields> {
    match (parts, names) {
        ([], []) => Some(known.clone()),
        ([Part::Folders, rest @ ..], _) => {
            (0..=names.len()).find_map(|skip| matched(rest, &names[skip..], known))
        }
        ([Part::Name(pieces), rest @ ..], [name, others @ ..]) => {
            let mut after = |fields: &Fields| matched(rest, others, fields);
            matched_name(pieces, name, known, &mut after)
        }
        _ => None,
    }
}

fn matched_name(
    pieces: &[Piece],
    text: &str,
    known: &Fields,
    after: &mut dyn FnMut(&Fields) -> Option<Fields>,
) -> Option<Fields> {
    let ends = |least: usize| {
        let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
        ends.filter(move |end| *end >= least)
    };
    match pieces {
        [] => text.is_empty().then(|| after(known)).flatten(),
        [Piece::Literal(literal), rest @ ..] => {
            matched_name(rest, text.strip_prefix(literal.as_str())?, known, after)
        }
        [Piece::Any, rest @ ..] => {
            ends(0).find_map(|end| matched_name(rest, &text[end..], known, after))
        }
        [Piece::Field(name), rest @ ..] => match known.get(name) {
            Some(value) => matched_name(rest, text.strip_prefix(value.as_str())?, known, after),
            None => ends(1).find_map(|end| {
                let mut fields = known.clone();
                fields.insert(name.clone(), text[..end].to_owned());
                matched_name(rest, &text[end..], &fields, after)
            }),
        },
    }
}

/// Whether a name is what a glob of `*` and literal text says.
#[must_use]
pub fn is_named(glob: &str, name: &str) -> bool {
    let mut pieces = Vec::new();
    for (index, literal) in glob.split('*').enumerate() {
        if index > 0 {
            pieces.push(Piece::Any);
        }
        if !literal.is_empty() {
            pieces.push(Piece::Literal(literal.to_owned()));
        }
    }
    matched_name(&pieces, name, &Fields::new(), &mut |f| Some(f.clone())).is_some()
}

/// Whether a path names a place that only other programs reach, such as `s3://bucket/key`.
#[must_use]
pub fn is_remote(path: &str) -> bool {
    path.contains("://")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(pattern: &str, path: &str) -> Option<String> {
        let fields = Pattern::parse(pattern).ok()?.fields_of(path)?;
        let told: Vec<String> = fields.iter().map(|(k, v)| format!("{k}={v}")).collect();
        Some(told.join(" "))
    }

    #[test]
    fn verify_fields_of_paths() {
        let found = |pattern, path| fields(pattern, path).unwrap_or_default();
        let hive = "d/machine={machine}/date={date}/{record}.parquet";
        let path = "d/machine=a b/date=2026-03-01/x.y.parquet";
        assert_eq!(found(hive, path), "date=2026-03-01 machine=a b record=x.y");
        assert_eq!(found("/d/{machine}-*.csv", "/d/m-1-x.csv"), "machine=m");
        assert_eq!(
            found("**/{machine}/{date}.csv", "a/b/m/1.csv"),
            "date=1 machine=m"
        );
        assert_eq!(
            found("s3://bucket/{machine}.csv", "s3://bucket/m.csv"),
            "machine=m"
        );
        // The same value in both places, and nothing else.
        let twice = "{machine}/{machine}_{date}.csv";
        assert_eq!(found(twice, "m1/m1_3.csv"), "date=3 machine=m1");
        assert_eq!(fields(twice, "m1/m2_3.csv"), None);
        assert_eq!(fields("d/{machine}/x.csv", "d/m/n/x.csv"), None);
        assert_eq!(fields("d/{machine}.csv", "d/.csv"), None);
    }

    #[test]
    fn verify_patterns_that_are_none() {
        for text in ["{", "a/{}/b", "a}/b", "a/b**", "{a b}.csv"] {
            assert!(Pattern::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn verify_globs() {
        let glob = |text: &str| Pattern::parse(text).map(|p| p.glob()).unwrap_or_default();
        assert_eq!(glob("a/{m}/**/{d}_*.csv"), "a/*/**/*_*.csv");
        assert_eq!(glob("s3://b/{m}.csv"), "s3://b/*.csv");
        assert_eq!(glob("/{m}.csv"), "/*.csv");
        assert!(is_named("check*", "check-1") && is_named("*", "") && is_named("a*b*", "a1b"));
        assert!(!is_named("check", "check-1") && !is_named("a*b", "abc"));
    }
}
