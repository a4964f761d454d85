//! Numbers, names and text as they stand in messages.

/// A number with the digits that matter in a message.
pub(crate) fn digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Names as a list for a message; a long list is cut.
pub(crate) fn name_list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    const SHOWN: usize = 12;
    let names: Vec<&str> = names.collect();
    if names.is_empty() {
        return "no others".to_owned();
    }
    let mut list = names
        .iter()
        .take(SHOWN)
        .map(|name| format!("'{}'", shortened(name)))
        .collect::<Vec<_>>()
        .join(", ");
    if names.len() > SHOWN {
        list += &format!(" and {} more", names.len() - SHOWN);
    }
    list
}

/// Text from a file as it may stand in a message: one line, not too long.
pub(crate) fn shortened(text: &str) -> String {
    const SHOWN: usize = 40;
    let mut short: String = text
        .chars()
        .take(SHOWN)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.chars().nth(SHOWN).is_some() {
        short.push('…');
    }
    short
}
