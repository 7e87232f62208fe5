//! Makes a trial that fails as small as it can be while it still fails in the same way.

use std::time::{Duration, Instant};

use toml::{Table, Value};

use super::trial::{Fault, Outcome, Trial};

/// How long one trial may be made smaller.
const LONGEST: Duration = Duration::from_secs(15);

/// The smallest trial found that fails as this one does, whose fault is given.
pub fn shrink(trial: &Trial, fault: &Fault) -> Trial {
    let mut best = trial.clone();
    let begun = Instant::now();
    loop {
        let before = best.clone();
        for table in simpler(&best.table) {
            let candidate = Trial { table };
            if begun.elapsed() > LONGEST {
                return best;
            }
            // One change may make way for another: take the list as it was drawn up, as far as it still helps.
            if candidate.size() < best.size() && candidate.fails_like(fault) {
                best = candidate;
                break;
            }
        }
        if best == before {
            return best;
        }
    }
}

impl Trial {
    fn fails_like(&self, fault: &Fault) -> bool {
        match self.run() {
            Outcome::Computed(record) => record.fault.is_some_and(|found| found.is_like(fault)),
            Outcome::Refused(_) => false,
        }
    }

    /// How much there is to it: characters of its file, and how long it lasts.
    fn size(&self) -> (usize, i64) {
        let samples = number(&self.table, "duration") * number(&self.table, "sample_rate");
        (self.to_toml().len(), samples as i64)
    }
}

fn number(table: &Table, key: &str) -> f64 {
    table.get(key).and_then(Value::as_float).unwrap_or(0.0)
}

/// Every table that differs by one simplification, the boldest first.
fn simpler(table: &Table) -> Vec<Table> {
    let mut found = Vec::new();
    let here = Value::Table(table.clone());
    let mut paths = Vec::new();
    walk(&here, &mut Vec::new(), &mut paths);
    let mut without: Vec<_> = paths.iter().filter_map(|path| changed(&here, path, |_| None)).collect();
    // Things first, then what belongs to them.
    found.append(&mut without);
    for path in &paths {
        found.extend(changed(&here, path, |value| halved(value, 0)));
        found.extend(changed(&here, path, |value| halved(value, 1)));
        found.extend(changed(&here, path, first_value));
    }
    for digits in [1, 2, 4] {
        found.extend(paths.iter().filter_map(|path| changed(&here, path, |value| rounded(value, digits))));
    }
    found
        .into_iter()
        .filter_map(|value| if let Value::Table(table) = value { Some(table) } else { None })
        .collect()
}

/// A step into a value.
#[derive(Debug, Clone)]
enum Step {
    Key(String),
    Index(usize),
}

/// Paths to everything inside, from the outside in.
fn walk(value: &Value, path: &mut Vec<Step>, found: &mut Vec<Vec<Step>>) {
    if !path.is_empty() {
        found.push(path.clone());
    }
    let inner: Vec<(Step, &Value)> = match value {
        Value::Table(table) => table.iter().map(|(key, value)| (Step::Key(key.clone()), value)).collect(),
        Value::Array(array) => array.iter().enumerate().map(|(i, value)| (Step::Index(i), value)).collect(),
        _ => return,
    };
    for (step, value) in inner {
        path.push(step);
        walk(value, path, found);
        path.pop();
    }
}

/// The value with what is at the path changed, or left out where the change is nothing.
fn changed(value: &Value, path: &[Step], change: impl FnOnce(&Value) -> Option<Value>) -> Option<Value> {
    let mut result = value.clone();
    let (last, parents) = path.split_last()?;
    let mut inner = &mut result;
    for step in parents {
        inner = match step {
            Step::Key(key) => inner.get_mut(key)?,
            Step::Index(index) => inner.get_mut(*index)?,
        };
    }
    match (inner, last) {
        (Value::Table(table), Step::Key(key)) => match change(table.get(key)?) {
            Some(value) => drop(table.insert(key.clone(), value)),
            None => drop(table.remove(key)),
        },
        (Value::Array(array), Step::Index(index)) => match change(array.get(*index)?) {
            Some(value) => array[*index] = value,
            None => drop(array.remove(*index)),
        },
        _ => return None,
    }
    (result != *value).then_some(result)
}

/// One half of a long list; a number halved, if it is a length of time.
fn halved(value: &Value, half: usize) -> Option<Value> {
    match value {
        Value::Array(array) if array.len() > 3 => {
            let parts = array.split_at(array.len() / 2);
            Some(Value::Array(if half == 0 { parts.0.to_vec() } else { parts.1.to_vec() }))
        }
        Value::Float(number) => Some(Value::Float(if half == 0 { 0.5 * number } else { 0.9 * number })),
        other => Some(other.clone()),
    }
}

/// A course or a list made one number.
fn first_value(value: &Value) -> Option<Value> {
    match value {
        Value::Array(array) => match array.first() {
            Some(Value::Array(pair)) if pair.len() == 2 => Some(pair[1].clone()),
            Some(Value::Float(number)) => Some(Value::Float(*number)),
            _ => Some(value.clone()),
        },
        other => Some(other.clone()),
    }
}

/// A number of so many digits.
fn rounded(value: &Value, digits: usize) -> Option<Value> {
    match value {
        Value::Float(number) => {
            let text = format!("{number:.*e}", digits - 1);
            Some(text.parse().map_or_else(|_| value.clone(), Value::Float))
        }
        other => Some(other.clone()),
    }
}
