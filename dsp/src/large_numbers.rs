//! Whole numbers beyond those of the TOML reader, which a quantity may be: 1e20 written out.

use std::borrow::Cow;

/// A description in which they have a point, and so are read. All lines stay as they are otherwise.
pub(crate) fn with_points(text: &str) -> Cow<'_, str> {
    let (mut pointed, mut copied, mut at) = (String::new(), 0, 0);
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let length = token(rest);
        let (token, after) = rest.split_at(length);
        at += length;
        if is_large(token) && !after.trim_start().starts_with('=') {
            pointed += &text[copied..at];
            pointed += ".0";
            copied = at;
        }
    }
    if copied == 0 { text.into() } else { (pointed + &text[copied..]).into() }
}

/// Whether something is a whole number that the reader has no room for.
fn is_large(token: &str) -> bool {
    let digits = token.strip_prefix(['+', '-']).unwrap_or(token);
    let is_whole = digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.chars().all(|c| c.is_ascii_digit() || c == '_');
    is_whole && token.replace('_', "").parse::<i64>().is_err()
}

/// How long the first thing of a text is, bytes: a text in quotes, a comment, a bare word or number, or else one character.
fn token(text: &str) -> usize {
    let within = |end: Option<usize>| end.unwrap_or(text.len());
    for quotes in ["\"\"\"", "'''"] {
        if let Some(inside) = text.strip_prefix(quotes) {
            return within(closing(inside, quotes).map(|end| end + 2 * quotes.len()));
        }
    }
    let is_bare = |c: char| c.is_ascii_alphanumeric() || "+-_.".contains(c);
    match text.chars().next() {
        Some('#') => within(text.find('\n')),
        Some(quote @ ('"' | '\'')) => {
            let line = &text[1..within(text.find('\n'))];
            closing(line, &quote.to_string()).map_or(1 + line.len(), |end| end + 2)
        }
        Some(first) if is_bare(first) => within(text.find(|c| !is_bare(c))),
        first => first.map_or(0, char::len_utf8),
    }
}

/// Where a text in quotes ends. In double quotes a backslash takes the meaning from what follows it.
fn closing(inside: &str, quotes: &str) -> Option<usize> {
    let mut at = 0;
    while !inside.get(at..)?.starts_with(quotes) {
        let mut next = inside[at..].chars();
        let first = next.next()?;
        let escaped = if first == '\\' && quotes.starts_with('"') { next.next() } else { None };
        at += first.len_utf8() + escaped.map_or(0, char::len_utf8);
    }
    Some(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    #[test]
    fn only_large_whole_numbers_of_values_get_a_point() {
        for (text, expected) in [
            ("a = 9223372036854775807", "a = 9223372036854775807"),
            ("a = 9223372036854775808", "a = 9223372036854775808.0"),
            ("a=-1_00000_00000_00000_00000#é", "a=-1_00000_00000_00000_00000.0#é"),
            (
                "a = [[0, 99999999999999999999],[+99999999999999999999 ,1]]",
                "a = [[0, 99999999999999999999.0],[+99999999999999999999.0 ,1]]",
            ),
            ("99999999999999999999 = 1", "99999999999999999999 = 1"),
            ("a = 99999999999999999999.5", "a = 99999999999999999999.5"),
            ("a = 99999999999999999999e1", "a = 99999999999999999999e1"),
            ("a = 0xfffffffffffffffff", "a = 0xfffffffffffffffff"),
            ("# 99999999999999999999\nb = 1", "# 99999999999999999999\nb = 1"),
            ("a = \"\\\" 99999999999999999999 \"", "a = \"\\\" 99999999999999999999 \""),
            ("a = '\\' # 99999999999999999999 '", "a = '\\' # 99999999999999999999 '"),
            ("a = \"\"\"\n\" 99999999999999999999\n\"\"\"", "a = \"\"\"\n\" 99999999999999999999\n\"\"\""),
            ("a = '''é\n99999999999999999999'''", "a = '''é\n99999999999999999999'''"),
            ("a = \" 99999999999999999999", "a = \" 99999999999999999999"),
            ("", ""),
        ] {
            assert_eq!(with_points(text), expected);
        }
    }

    #[test]
    fn a_quantity_may_be_any_whole_number_in_its_range() {
        let scene = |rate: &str, stiffness: &str| {
            Scene::from_toml(&format!(
                "sample_rate = {rate}\nduration = 0.1\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\ntension = 60.0\n\
                 [fretboard]\nstiffness = {stiffness}\nexponent = 1.5\nboard = -0.002\n"
            ))
        };
        let written_out = format!("1{}", "0".repeat(20));
        assert_eq!(scene("44100", &written_out).unwrap(), scene("44100", "1e20").unwrap());
        let error = scene("99999999999999999999", "1e10").unwrap_err().to_string();
        assert!(error.contains("sample_rate") && error.contains("must lie between"), "{error}");
    }
}
