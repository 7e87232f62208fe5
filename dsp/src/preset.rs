//! Set-ups that are others with a few things changed, and those that come with the program.

use serde::de::DeserializeOwned;
use toml::{Table, Value};

use crate::error::Error;
use crate::setup::{self, Setup};
use crate::times::refuse_times;

/// The set-ups that show what strings over frets can do: name and file.
const FILES: [(&str, &str); 16] = [
    ("buzzing-bass", include_str!("../instruments/presets/buzzing-bass.toml")),
    ("slap-bass", include_str!("../instruments/presets/slap-bass.toml")),
    ("fretless-bass", include_str!("../instruments/presets/fretless-bass.toml")),
    ("low-action-funk", include_str!("../instruments/presets/low-action-funk.toml")),
    ("worn-fret", include_str!("../instruments/presets/worn-fret.toml")),
    ("light-fingers", include_str!("../instruments/presets/light-fingers.toml")),
    ("school-guitar", include_str!("../instruments/presets/school-guitar.toml")),
    ("flatwound-jazz", include_str!("../instruments/presets/flatwound-jazz.toml")),
    ("tanpura", include_str!("../instruments/presets/tanpura.toml")),
    ("sitar", include_str!("../instruments/presets/sitar.toml")),
    ("lap-steel", include_str!("../instruments/presets/lap-steel.toml")),
    ("baritone", include_str!("../instruments/presets/baritone.toml")),
    ("drop-d", include_str!("../instruments/presets/drop-d.toml")),
    ("flamenco", include_str!("../instruments/presets/flamenco.toml")),
    ("ukulele", include_str!("../instruments/presets/ukulele.toml")),
    ("five-string-bass", include_str!("../instruments/presets/five-string-bass.toml")),
];

/// The key by which a file names the set-up it changes.
const BASE: &str = "based_on";

impl Setup {
    /// Names of the set-ups that come with the program beside [`Setup::BUILTIN`].
    pub const PRESETS: [&'static str; FILES.len()] = names(&[&FILES]);

    /// Names of all set-ups that come with the program, those before these.
    pub const SHIPPED: [&'static str; setup::FILES.len() + FILES.len()] = names(&[&setup::FILES, &FILES]);

    /// Any set-up that comes with the program, by its name.
    pub fn shipped(name: &str) -> Option<Setup> {
        Setup::builtin(name).or_else(|| {
            let (_, text) = FILES.iter().find(|(known, _)| *known == name)?;
            Some(Setup::from_toml(text).expect("the files in instruments/presets are read by the tests"))
        })
    }
}

/// The names in lists of names and files, of which there must be so many in all.
pub(crate) const fn names<const COUNT: usize>(lists: &[&[(&'static str, &str)]]) -> [&'static str; COUNT] {
    let mut names = [""; COUNT];
    let (mut list, mut place, mut count) = (0, 0, 0);
    while list < lists.len() {
        if place < lists[list].len() {
            names[count] = lists[list][place].0;
            (place, count) = (place + 1, count + 1);
        } else {
            (list, place) = (list + 1, 0);
        }
    }
    assert!(count == COUNT, "one of them has no name");
    names
}

/// Reads a description that may be another with a few things changed: `based_on = "NAME"` stands for all of
/// that set-up, and what else the text has takes the place of what stands there. Tables are changed key by
/// key, and so are the strings, in their order. `base` gives the text of a set-up by its name.
pub(crate) fn read<T: DeserializeOwned>(
    text: &str,
    base: impl Fn(&str) -> Result<&'static str, Error>,
) -> Result<T, Error> {
    let mut table: Table = toml::from_str(text).map_err(|error| Error::syntax(&error, text))?;
    refuse_times(&table)?;
    let Some(name) = table.remove(BASE) else {
        return toml::from_str(text).map_err(|error| Error::syntax(&error, text));
    };
    let Value::String(name) = name else {
        return Err(Error::Syntax(format!("{BASE}: invalid type: expected the name of a set-up")));
    };
    let below = base(&name)?;
    let mut whole: Table = toml::from_str(below).map_err(|error| Error::syntax(&error, below))?;
    check_headers(&whole, &table)?;
    lay_over(&mut whole, table);
    // What is left is no longer any one text: lines cannot be named, keys can.
    T::deserialize(Value::Table(whole.clone()))
        .map_err(|error| Error::merged(&error, place::<T>(&whole, &error).as_deref()))
}

/// Refuses a list in the place of a table, and a table in the place of a list: the wrong brackets round a header.
fn check_headers(below: &Table, above: &Table) -> Result<(), Error> {
    let wrong = above.iter().find_map(|(key, value)| match (below.get(key)?, value) {
        (Value::Table(_), Value::Array(_)) => Some(format!("{key}: there is only one: write [{key}]")),
        (Value::Array(_), Value::Table(_)) => Some(format!("{key}: there may be several: write [[{key}]]")),
        _ => None,
    });
    wrong.map_or(Ok(()), |wrong| Err(Error::Syntax(wrong)))
}

/// Where in a description an error stands, as errors of values say it: `neck.action`, `string[7].pitch`.
fn place<T: DeserializeOwned>(whole: &Table, error: &toml::de::Error) -> Option<String> {
    let keys = keys(error)?;
    let section = keys.split('.').next()?.to_owned();
    let Some(Value::Array(entries)) = whole.get(&section) else { return Some(keys) };
    // The reader does not say which entry of a list it is. Entries are read in their order, so it is the last of
    // the fewest with which the same error arises.
    let arises_within = |count: usize| {
        let mut part = whole.clone();
        part.insert(section.clone(), Value::Array(entries[..count].to_vec()));
        T::deserialize(Value::Table(part)).is_err_and(|found| found == *error)
    };
    if arises_within(0) {
        return Some(keys);
    }
    let (mut fine, mut wrong) = (0, entries.len());
    while wrong - fine > 1 {
        let middle = fine + (wrong - fine) / 2;
        if arises_within(middle) { wrong = middle } else { fine = middle }
    }
    Some(format!("{section}[{wrong}]{}", &keys[section.len()..]))
}

/// The keys that lead to an error, joined by dots. The reader knows them, and tells them only where it shows the error.
fn keys(error: &toml::de::Error) -> Option<String> {
    let shown = error.to_string();
    let keys = shown.strip_prefix(error.message())?.trim().strip_prefix("in `")?.strip_suffix('`')?;
    Some(keys.to_owned())
}

/// Puts the values of one table in the place of another's.
fn lay_over(below: &mut Table, above: Table) {
    for (key, value) in above {
        match (below.get_mut(&key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => {
                // Another kind of thing has other keys.
                if new.get("kind").is_some_and(|kind| old.get("kind") != Some(kind)) {
                    *old = new;
                } else {
                    lay_over(old, new);
                }
            }
            (Some(Value::Array(old)), Value::Array(new))
                if new.iter().all(Value::is_table) && !new.is_empty() =>
            {
                for (index, entry) in new.into_iter().enumerate() {
                    match (old.get_mut(index), entry) {
                        (Some(Value::Table(old)), Value::Table(new)) => lay_over(old, new),
                        (_, entry) => old.push(entry),
                    }
                }
            }
            (_, value) => {
                below.insert(key, value);
            }
        }
    }
}
