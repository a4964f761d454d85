//! Words and names as text.

use std::path::Path;

/// Words as a shell takes them.
#[must_use]
pub fn command(words: &[String]) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./+=:,@%".contains(c);
    let quoted = |word: &String| {
        if !word.is_empty() && word.chars().all(plain) {
            word.clone()
        } else {
            format!("'{}'", word.replace('\'', "'\\''"))
        }
    };
    words.iter().map(quoted).collect::<Vec<_>>().join(" ")
}

/// Text from a file as a terminal or a message may show it: control characters become spaces.
#[must_use]
pub fn shown(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// The name of a file without its folder and its extension.
#[must_use]
pub fn stem(path: &Path) -> String {
    path.file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// The name of a file without its folder.
#[must_use]
pub fn file_name(path: &Path) -> String {
    path.file_name()
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_shell_takes_the_words_of_a_command() {
        let words = ["y=Pos", "y=Pos [mm]", "it's", ""].map(str::to_owned);
        assert_eq!(command(&words), r"y=Pos 'y=Pos [mm]' 'it'\''s' ''");
    }

    #[test]
    fn verify_names_of_files() {
        let path = Path::new("runs/run3.csv");
        assert_eq!(
            (stem(path), file_name(path)),
            ("run3".into(), "run3.csv".into())
        );
    }
}
