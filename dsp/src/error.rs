//! What can be wrong with a description. Errors arise when something is built, never while it runs.

use crate::digits::plain;

/// Why a scene, a set-up or a model was refused: one line that names the thing, its value and what
/// is accepted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value outside its range.
    #[error("{name} = {value} is refused: {accepted}")]
    OutOfRange {
        /// Where the value stands, as in the file: `string[1].tension`.
        name: String,
        /// The value given.
        value: String,
        /// What is accepted, with its unit.
        accepted: String,
    },
    /// Text that is not TOML of the expected form.
    #[error("{0}")]
    Syntax(String),
}

impl Error {
    /// A value outside its range.
    pub fn range(
        name: impl Into<String>,
        value: impl std::fmt::Display,
        accepted: impl Into<String>,
    ) -> Self {
        Error::OutOfRange { name: name.into(), value: value.to_string(), accepted: accepted.into() }
    }

    /// A text that is none of those accepted. (It may stand in a file, which may hold anything.)
    pub(crate) fn text(name: &str, value: &str, accepted: String) -> Self {
        Error::range(name, format!("\"{}\"", printable(value)), accepted)
    }

    /// The same error with the place it arose in before the name; of a fretboard, neck, bridge, body or hand that several
    /// strings share, the place after what is accepted.
    pub(crate) fn under(self, place: &str) -> Self {
        match self {
            Error::OutOfRange { name, value, accepted }
                if ["fretboard", "neck.", "bridge.", "body."]
                    .iter()
                    .any(|shared| name.starts_with(shared)) =>
            {
                Error::OutOfRange { name, value, accepted: format!("{accepted} (under {place})") }
            }
            Error::OutOfRange { name, value, accepted } if name.starts_with("player.") => {
                Error::OutOfRange { name, value, accepted: format!("{accepted} (on {place})") }
            }
            Error::OutOfRange { name, value, accepted } => {
                let name = name.rsplit('.').next().unwrap_or(&name);
                Error::OutOfRange { name: format!("{place}.{name}"), value, accepted }
            }
            other => other,
        }
    }

    /// The same error of a model in the words of a set-up: what a scene calls its fretboard is the neck, and the
    /// length of a string follows from the scale.
    pub(crate) fn of_setup(self) -> Self {
        match self {
            // The length that the model asks for is no limit here: a longer string of the same pitch is tauter, too.
            Error::OutOfRange { name, value, .. } if name == "length" => {
                Error::range("neck.scale_length", value, TOO_COARSE)
            }
            Error::OutOfRange { name, value, accepted } => {
                let name = name.strip_prefix("fretboard.").map(|key| format!("neck.{key}")).unwrap_or(name);
                Error::OutOfRange { name, value, accepted }
            }
            other => other,
        }
    }

    /// An error of a description that is put together from several texts: where, which key, what was expected.
    pub(crate) fn merged(error: &toml::de::Error, place: Option<&str>) -> Self {
        let message = in_plain_words(error.message());
        let message = place.map_or(message.clone(), |place| format!("{place}: {message}"));
        Error::Syntax(printable(&message))
    }

    /// A TOML error folded into one line: where it is, what is wrong there, what was expected.
    pub(crate) fn syntax(error: &toml::de::Error, text: &str) -> Self {
        let before = error.span().and_then(|span| text.get(..span.start)).unwrap_or_default();
        let line_end = text[before.len()..].find('\n').map_or(text.len(), |rest| before.len() + rest);
        let thing = thing_at_end(&text[..line_end]).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        let message = in_plain_words(error.message());
        let is_table = thing.starts_with('[');
        let is_inline = text[before.len()..].starts_with('{');
        let message = if thing.starts_with("[[") && message.starts_with("invalid type: table") {
            format!("line {line}, {thing}: there is only one: write {}", &thing[1..thing.len() - 1])
        } else if is_table && message.starts_with("invalid type: table") {
            format!("line {line}, {thing}: there may be several: write [{thing}]")
        } else if message.starts_with("missing key") && !is_table && !is_inline {
            // Of the file as a whole: no line is to blame.
            message
        } else if thing.is_empty() || OF_NO_KEY.iter().any(|words| message.starts_with(words)) {
            format!("line {line}: {message}")
        } else {
            format!("line {line}, {thing}: {message}")
        };
        Error::Syntax(printable(&message))
    }
}

/// Why a string of a set-up is refused that is too short for its grid.
const TOO_COARSE: &str = "at this sample rate the grid is too coarse for a string of such pitch, core_radius \
                          and loss_1: one of these must be less";

/// The last key or table header that begins a line of a text: what an error at the text's end is about.
fn thing_at_end(text: &str) -> Option<&str> {
    let bare = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    let is_name = |name: &str| name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(bare);
    text.lines().rev().find_map(|line| {
        let line = line.trim();
        let header = line.split_once('#').map_or(line, |(header, _)| header.trim_end());
        if header.starts_with('[') && is_name(header.trim_matches(['[', ']'])) {
            return Some(header);
        }
        line.split_once('=').map(|(key, _)| key.trim_end()).filter(|key| is_name(key))
    })
}

/// How messages begin in which the key before is not to blame.
const OF_NO_KEY: [&str; 3] = ["unknown key", "key with no value", "unquoted keys"];

/// What is said of something that is no value at all, such as `abc`, `5 mm` or `np.float64(5)`.
const NO_VALUE: &str =
    "this is no value: numbers look like 0.5 or 5e-3, texts stand in quotes, lists in square brackets";

/// What is said of a whole number that the reader has no room for, and names as one of 128 bits.
const TOO_LARGE: &str =
    ", expected one of at most 18 digits: larger numbers have a point or an exponent, as 1e20";

/// Words of the TOML reader, and what they are for who writes the file.
const WORDS: [(&str, &str); 21] = [
    ("string values must be quoted, expected literal string", NO_VALUE),
    ("invalid float, expected `nan`", NO_VALUE),
    ("invalid float, expected `inf`", NO_VALUE),
    ("invalid float, expected nothing", NO_VALUE),
    ("invalid mantissa, expected digits", "a number has digits before its point, as 0.5"),
    ("invalid fraction, expected digits", "a number has digits after its point, as 5.0"),
    ("invalid exponent, expected digits", "a number has digits after its e, as 5e-3"),
    ("missing field", "missing key"),
    ("there are no fields", "there are no others beside `kind`"),
    ("unknown field", "unknown key"),
    ("unknown variant", "unknown choice"),
    ("invalid type: map", "invalid type: table"),
    ("invalid type: sequence", "invalid type: list"),
    ("expected f64", "expected a number"),
    ("expected usize", "expected a whole number, 0 or more"),
    ("expected i64", "expected a whole number, 1 or more"),
    ("expected a sequence", "expected a list"),
    ("expected a tuple of size", "expected a list of"),
    ("expected a string", "expected a text"),
    ("expected a boolean", "expected `true` or `false`"),
    ("expected variant identifier", "expected a text"),
];

/// Kinds of types that have a name of their own, which follows, and what both are in a file.
const TYPES: [(&str, &str); 3] = [
    ("expected internally tagged enum ", "expected a table"),
    ("expected struct variant ", "expected a table"),
    ("expected struct ", "expected a table"),
];

/// A message of the TOML reader without Rust's names of types.
fn in_plain_words(message: &str) -> String {
    let large = message.split_once(" as i128").or_else(|| message.split_once(" as u128"));
    let message = large.map_or(message.to_owned(), |(number, _)| number.to_owned() + TOO_LARGE);
    let message = WORDS.iter().fold(message, |text, (rust, plain)| text.replace(rust, plain));
    TYPES.iter().fold(message, |text, (rust, plain)| match text.rsplit_once(*rust) {
        Some((before, after)) => {
            let rest = after.trim_start_matches(|c: char| c.is_alphanumeric() || "_:".contains(c));
            format!("{before}{plain}{rest}")
        }
        None => text,
    })
}

/// The longest message made of what stands in a file, characters.
const LONGEST: usize = 400;

/// One line of printable characters, cut where it gets too long: a file may hold anything.
fn printable(text: &str) -> String {
    let words: Vec<_> = text.split(|c: char| c.is_whitespace() || c.is_control()).collect();
    let line = words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} ...", &line[..end]),
        None => line,
    }
}

/// Refuses a number that is not finite or lies outside `[low, high]`.
pub(crate) fn within(name: &str, value: f64, low: f64, high: f64, unit: &str) -> Result<f64, Error> {
    if value.is_finite() && value >= low && value <= high {
        Ok(value)
    } else {
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let accepted = format!("it must lie between {} and {}{unit}", plain(low), plain(high));
        Err(Error::range(name, plain(value), accepted))
    }
}

/// The same for a range that is used elsewhere too.
pub(crate) fn ranged(name: &str, value: f64, [low, high]: [f64; 2], unit: &str) -> Result<f64, Error> {
    within(name, value, low, high, unit)
}

/// The nearest number that [`ranged`] accepts, and of what is no number the lowest. (Not by `clamp`, which keeps that.)
pub(crate) fn limited(value: f64, [low, high]: [f64; 2]) -> f64 {
    value.max(low).min(high)
}

/// Refuses a place, m from the nut, that is not strictly between the ends of a string.
pub(crate) fn on_string(name: &str, place: f64, length: f64) -> Result<f64, Error> {
    if place.is_finite() && place > 0.0 && place < length {
        return Ok(place);
    }
    let accepted = format!("it must lie on the string, above 0 and below {} m", plain(length));
    Err(Error::range(name, plain(place), accepted))
}
