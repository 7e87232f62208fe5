//! Labels that are there already: whether they are of what would be rendered.

use std::fmt;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use serde::de::{Deserialize, Deserializer, IgnoredAny, MapAccess, Visitor};
use serde_json::{Map, Value};

use super::source::About;

/// What is not compared: what the song is called, which its bytes tell better, and what only a rendering shows.
const NOT_COMPARED: [&str; 3] = ["song", "samples", "duration"];

/// Lists and what else stands behind what a sound was made from is long, and passed over.
const FIRST_BEHIND: &str = "peak";

/// What a sound was made from, by its keys.
struct Header(Map<String, Value>);

/// How many samples the sound has that labels which are there are of; or how they differ from those of a rendering, in words.
pub(super) fn samples_of(path: &Path, about: &About) -> Result<u64, String> {
    // (As a number is read from its text, so that equal texts are equal numbers.)
    let wanted = serde_json::to_string(about).map_err(Into::into).and_then(|text| read(text.as_bytes()));
    let there = fs::read(path).map_err(Into::into).and_then(|text| read(&text));
    let (Header(there), Header(wanted)) = match (there, wanted) {
        (Ok(there), Ok(wanted)) => (there, wanted),
        (Err(error), _) | (_, Err(error)) => return Err(format!("its labels cannot be read: {error:#}")),
    };
    let compared = wanted.iter().filter(|(key, _)| !NOT_COMPARED.contains(&key.as_str()));
    let mut different = compared.filter(|(key, wanted)| there.get(*key) != Some(wanted));
    let Some((key, wanted)) = different.next() else {
        let samples = there.get("samples").and_then(Value::as_u64);
        return samples.ok_or_else(|| "its labels do not say how many samples it has".to_owned());
    };
    let first = told(key, there.get(key), wanted);
    Err(match different.count() {
        0 => first,
        others => format!("{first}, and {others} more"),
    })
}

fn read(text: &[u8]) -> Result<Header> {
    serde_json::from_slice(text).context("they are not as they were written")
}

/// How a value differs, which may be a whole set-up.
fn told(key: &str, was: Option<&Value>, wanted: &Value) -> String {
    let short = |value: &Value| !value.is_object() && !value.is_array();
    match was {
        Some(was) if short(was) && short(wanted) => format!("{key} was {was} and is {wanted}"),
        Some(_) => format!("{key} is another"),
        None => format!("{key} was not said"),
    }
}

impl<'de> Deserialize<'de> for Header {
    fn deserialize<D: Deserializer<'de>>(text: D) -> Result<Self, D::Error> {
        text.deserialize_map(Keys)
    }
}

/// Reads keys and values up to those that are passed over.
struct Keys;

impl<'de> Visitor<'de> for Keys {
    type Value = Header;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("labels")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Header, M::Error> {
        let mut header = Map::new();
        let mut behind = false;
        while let Some(key) = map.next_key::<String>()? {
            behind |= key == FIRST_BEHIND;
            if behind {
                map.next_value::<IgnoredAny>()?;
            } else {
                header.insert(key, map.next_value()?);
            }
        }
        Ok(Header(header))
    }
}
