//! The prose of the reproduction has no number typed in.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

/// Units after which a typed number would be a measured or computed one.
const UNITS: [&str; 14] = [
    "kHz", "Hz", "kN", "MN", "GN", "N", "mm", "µm", "nm", "%", "ms", "GPa", "t", "s",
];

/// What names a row or a reading, in the paper's own words or ours.
const NAMES: [&str; 13] = [
    // Rows of the tables.
    "1 Hz", "2 Hz", "3 Hz", "4 Hz", "5 Hz", "6 Hz", "7 Hz",
    // The base of 50 − f, and what section 2.2.3 gives the two masses.
    "50 Hz", "49 Hz", "51 Hz", // A reading: two samples of the paper's.
    "20 ms", // Reasons that the diagnosed page gives when its story no longer holds.
    "100 Hz", "500 Hz",
];

/// Whether it is the number of a section of the paper, 2.1 or 2.1.2.
fn is_section(number: &str) -> bool {
    let parts: Vec<&str> = number.split('.').collect();
    let is_small = |part: &&str| part.len() == 1 && ("1"..="4").contains(part);
    (2..=3).contains(&parts.len()) && parts.iter().all(is_small)
}

/// Numbers in a text that have a unit or decimals, and name nothing.
fn typed_in(text: &str) -> Vec<String> {
    let mut found = vec![];
    let chars: Vec<char> = text.chars().collect();
    let mut at = 0;
    while at < chars.len() {
        let inside = at > 0 && (chars[at - 1].is_alphanumeric() || "._-{".contains(chars[at - 1]));
        if !chars[at].is_ascii_digit() || inside {
            at += 1;
            continue;
        }
        let from = at;
        while at < chars.len() && (chars[at].is_ascii_digit() || chars[at] == '.') {
            at += 1;
        }
        let number: String = chars[from..at].iter().collect();
        let number = number.trim_end_matches('.');
        let rest: String = chars[at..].iter().collect();
        let word = rest.strip_prefix(' ').unwrap_or_default().chars();
        let word: String = word
            .take_while(|c| c.is_alphabetic() || *c == '%')
            .collect();
        let shown = format!("{number} {word}");
        let has_unit = UNITS.contains(&word.as_str()) && !NAMES.contains(&shown.as_str());
        if has_unit || (number.contains('.') && !is_section(number)) {
            found.push(shown);
        }
    }
    found
}

#[test]
fn verify_typed_in_numbers_are_seen() {
    assert_eq!(
        typed_in("about 2.4 kN at 50 Hz and {x} Hz, {:.2}"),
        ["2.4 kN"]
    );
    assert_eq!(typed_in("R² = 0.994, section 2.1.2, row 6."), ["0.994 "]);
    assert_eq!(typed_in("low by 15 % in 3.1"), ["15 %"]);
}

/// Each number with a unit or decimals in a string of the pages is computed or read from the tables.
#[test]
fn verify_prose_has_no_typed_in_numbers() {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src/reproduce")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = fs::read_to_string(&path).unwrap();
            // Strings only: code and comments hold constants with their reasons.
            let is_code = |line: &&str| !line.trim_start().starts_with("//");
            let code: String = text.lines().filter(is_code).collect::<Vec<_>>().join("\n");
            for (i, part) in code.split('"').enumerate() {
                // A string that is a number and nothing else is a figure to be checked, not prose.
                if i % 2 == 1 && part.parse::<f64>().is_err() {
                    assert_eq!(typed_in(part), Vec::<String>::new(), "{}", path.display());
                }
            }
        }
    }
}
