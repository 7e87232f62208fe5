//! Keys of a file whose value is one of a few names.

use std::fmt::{self, Formatter};

use serde::Deserializer;
use serde::de::{Error, Visitor};

/// Reads one of these names and returns what it stands for; whatever else is there is refused with all of them.
pub(crate) fn choice<'de, D: Deserializer<'de>, T: Copy>(
    deserializer: D,
    names: &'static [(&'static str, T)],
) -> Result<T, D::Error> {
    deserializer.deserialize_any(Choice(names))
}

struct Choice<T: 'static>(&'static [(&'static str, T)]);

impl<T: Copy> Visitor<'_> for Choice<T> {
    type Value = T;

    fn expecting(&self, f: &mut Formatter) -> fmt::Result {
        let names: Vec<_> = self.0.iter().map(|(name, _)| format!("`{name}`")).collect();
        match &names[..] {
            [one, other] => write!(f, "{one} or {other}"),
            names => write!(f, "one of {}", names.join(", ")),
        }
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<T, E> {
        let found = self.0.iter().find(|(name, _)| *name == value);
        let expected: &dyn serde::de::Expected = &self;
        found
            .map(|&(_, meaning)| meaning)
            .ok_or_else(|| E::custom(format_args!("unknown choice `{value}`, expected {expected}")))
    }
}
