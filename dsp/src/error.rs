//! What can be wrong with a description. Errors arise when something is built, never while it runs.

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
    /// A name that nothing goes by.
    #[error("{kind} `{name}` is unknown: {accepted}")]
    Unknown {
        /// What kind of thing was looked for.
        kind: &'static str,
        /// The name given.
        name: String,
        /// The names there are.
        accepted: String,
    },
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

    /// The same error with the place it arose in before the name.
    pub(crate) fn under(self, place: &str) -> Self {
        match self {
            Error::OutOfRange { name, value, accepted } if !name.starts_with("fretboard") => {
                let name = name.rsplit('.').next().unwrap_or(&name);
                Error::OutOfRange { name: format!("{place}.{name}"), value, accepted }
            }
            other => other,
        }
    }

    /// A TOML error folded into one line.
    pub(crate) fn syntax(error: &toml::de::Error, text: &str) -> Self {
        let place = error.span().map(|span| {
            let before = &text[..span.start.min(text.len())];
            let line = before.matches('\n').count() + 1;
            format!("line {line}: ")
        });
        let message = error.message().split_whitespace().collect::<Vec<_>>().join(" ");
        Error::Syntax(format!("{}{message}", place.unwrap_or_default()))
    }
}

/// Refuses a number that is not finite or lies outside `[low, high]`.
pub(crate) fn within(name: &str, value: f64, low: f64, high: f64, unit: &str) -> Result<f64, Error> {
    if value.is_finite() && value >= low && value <= high {
        Ok(value)
    } else {
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        Err(Error::range(name, value, format!("it must lie between {low:e} and {high:e}{unit}")))
    }
}
