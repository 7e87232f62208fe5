//! Dates and times of day, which TOML has and no description of ours.

use toml::value::Datetime;
use toml::{Table, Value};

use crate::error::Error;

/// Refuses dates and times of day by name: what reads a description takes them for tables.
pub(crate) fn refuse_times(table: &Table) -> Result<(), Error> {
    match time_in(table) {
        Some((key, time)) => {
            Err(Error::Syntax(format!("{key}: invalid type: date or time `{time}`, of which there are none")))
        }
        None => Ok(()),
    }
}

/// The first one in a description, and the keys that lead to it.
fn time_in(table: &Table) -> Option<(String, Datetime)> {
    fn within(value: &Value) -> Option<(String, Datetime)> {
        match value {
            Value::Datetime(time) => Some((String::new(), *time)),
            Value::Table(table) => time_in(table).map(|(key, time)| (format!(".{key}"), time)),
            Value::Array(entries) => (1..).zip(entries).find_map(|(number, entry)| {
                within(entry).map(|(key, time)| (format!("[{number}]{key}"), time))
            }),
            _ => None,
        }
    }
    table.iter().find_map(|(key, value)| within(value).map(|(rest, time)| (format!("{key}{rest}"), time)))
}
