//! The lines, the bytes and the numbers of a universal file.

use crate::Place;
use crate::faults::FormatFault;
use crate::raw::within_limit;

/// Lines of a file that may hold bytes of any kind between them.
pub(crate) struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Number of the line that was taken last.
    pub(crate) line: u64,
    /// Numbers of text so far.
    values: u64,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Lines<'a> {
        Lines {
            bytes,
            at: 0,
            line: 0,
            values: 0,
        }
    }

    pub(crate) fn next(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = rest.iter().position(|&byte| byte == b'\n');
        let line = &rest[..end.unwrap_or(rest.len())];
        self.at += end.map_or(rest.len(), |end| end + 1);
        self.line += 1;
        // A line of text is short; what is not, is none.
        const LONGEST: usize = 1000;
        let line = &line[..line.len().min(LONGEST)];
        Some(
            String::from_utf8_lossy(line)
                .trim_end_matches('\r')
                .to_owned(),
        )
    }

    pub(crate) fn cut_off(&self, what: &'static str, needed: u64, left: u64) -> FormatFault {
        FormatFault::Truncated {
            at: Place::Line(self.line),
            what,
            needed,
            left,
        }
    }

    /// Passes over lines up to one that ends a dataset.
    pub(crate) fn skip_dataset(&mut self) {
        while let Some(line) = self.next() {
            if line.trim() == "-1" {
                return;
            }
        }
    }

    pub(crate) fn bytes(&mut self, count: u64) -> Result<&'a [u8], FormatFault> {
        let left = self.bytes.len() - self.at;
        match usize::try_from(count) {
            Ok(count) if count <= left => {
                let taken = &self.bytes[self.at..self.at + count];
                self.at += count;
                Ok(taken)
            }
            _ => Err(FormatFault::Truncated {
                at: Place::Byte(self.at as u64),
                what: "values of a function",
                needed: count,
                left: left as u64,
            }),
        }
    }

    /// All numbers up to the end of the dataset.
    pub(crate) fn numbers(&mut self) -> Result<Vec<f64>, FormatFault> {
        let mut numbers = Vec::new();
        while let Some(line) = self.next() {
            if line.trim() == "-1" {
                self.values += numbers.len() as u64;
                return Ok(numbers);
            }
            for word in apart(&line) {
                let number = fortran(word).ok_or_else(|| FormatFault::Malformed {
                    at: Place::Line(self.line),
                    found: format!("'{}'", crate::words::shortened(word)),
                    needed: "a number",
                })?;
                numbers.push(number);
            }
            within_limit(self.values + numbers.len() as u64)?;
        }
        Err(self.cut_off("the line that ends a dataset", 1, 0))
    }
}

/// The numbers of a line, which may touch: `1.0E+00-2.0E+00`.
fn apart(line: &str) -> impl Iterator<Item = &str> {
    line.split_whitespace().flat_map(|word| {
        let bytes = word.as_bytes();
        let starts = (1..bytes.len()).filter(move |&k| {
            matches!(bytes[k], b'+' | b'-') && !matches!(bytes[k - 1], b'e' | b'E' | b'd' | b'D')
        });
        let mut ends: Vec<usize> = starts.collect();
        ends.push(word.len());
        let mut from = 0;
        ends.into_iter().map(move |end| {
            // Signs are ASCII, and so no character is cut.
            let part = &word[from..end];
            from = end;
            part
        })
    })
}

/// A number as Fortran writes it: `1.5D+03` too.
pub(crate) fn fortran(word: &str) -> Option<f64> {
    let value = match word.parse::<f64>() {
        Ok(value) => value,
        Err(_) => word.replace(['d', 'D'], "e").parse().ok()?,
    };
    Some(value)
}
