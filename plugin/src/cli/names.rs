//! Names of files and instruments as they are shown: on one line, and without orders to the terminal.

use std::path::Path;

/// A file's name.
pub(super) fn shown(path: &Path) -> String {
    escaped(&path.display().to_string())
}

/// A text whose control characters are spelt out, such as `\n` and `\u{1b}`.
pub(super) fn escaped(text: &str) -> String {
    let spelt = |letter: char| match letter.is_control() {
        true => letter.escape_default().to_string(),
        false => letter.to_string(),
    };
    text.chars().map(spelt).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_control_characters_are_spelt_out() {
        for (name, expected) in [
            ("Étude \"1\" \\ №.mid", "Étude \"1\" \\ №.mid"),
            ("a\nb\tc\r", "a\\nb\\tc\\r"),
            ("\u{1b}[31m\u{7f}\u{9b}", "\\u{1b}[31m\\u{7f}\\u{9b}"),
        ] {
            assert_eq!(escaped(name), expected);
            assert_eq!(shown(Path::new(name)), expected);
        }
    }
}
