//! What has been asked of a host and has not come yet: a value becomes the parameter's own at the end of a block at the
//! earliest. What is done in the meantime goes on from what was asked for, or steps would be lost.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard};

use nice_plug::params::internals::ParamPtr;

use crate::locked::lock;
use crate::pointer::OLD;

/// How long a host has for it, s: as long as what is played may wait, more than the longest block takes.
const PATIENCE: f64 = OLD.as_secs_f64();
/// By how much values, 0 to 1, may differ that are the same; hosts round them. The finest steps are three times as wide.
const SAME: f32 = 5e-5;

/// Values of a parameter, 0 to 1: what it was, and then what was asked for, the last of which is wanted.
#[derive(Debug)]
struct Way {
    values: Vec<f32>,
    /// When it is given up, s.
    until: f64,
}

#[derive(Debug, Default)]
struct Inside {
    now: f64,
    ways: HashMap<ParamPtr, Way>,
}

/// What has been asked for.
#[derive(Debug, Default)]
pub struct Asked(Mutex<Inside>);

impl Asked {
    /// Looks at a time, s, what has come: that is forgotten, and so is what a host does not grant.
    pub fn look(&self, now: f64) {
        let mut inside = self.inside();
        inside.now = now;
        inside.ways.retain(|param, Way { values, until }| {
            let present = own(*param);
            // Where it comes back to a value that it had, it may not have set out yet; time tells.
            let reached = values.iter().position(|value| (value - present).abs() < SAME);
            // Where the host itself has moved it, that is what holds.
            let Some(reached) = reached else { return false };
            values.drain(..reached);
            values.len() > 1 && now < *until
        });
    }

    /// Time is counted from 0 again: what is left of what the host has stays as it is.
    pub fn restart(&self) {
        let mut inside = self.inside();
        let now = std::mem::take(&mut inside.now);
        inside.ways.values_mut().for_each(|way| way.until -= now);
    }

    /// The time of the last look, s.
    pub fn now(&self) -> f64 {
        self.inside().now
    }

    /// Something is asked for, 0 to 1.
    pub fn ask(&self, param: ParamPtr, value: f32) {
        let mut inside = self.inside();
        let until = inside.now + PATIENCE;
        let way = inside.ways.entry(param).or_insert_with(|| Way { values: vec![own(param)], until });
        // SAFETY: only the plugin's parameters are asked for, which live as long as its editor.
        let value = unsafe { param.preview_normalized(param.preview_plain(value)) };
        // What is there or on its way already is not waited for twice.
        if way.values.last().is_none_or(|last| (last - value).abs() >= SAME) {
            way.values.push(value);
        }
        way.until = until;
    }

    /// The value, 0 to 1, that a parameter has or is to have.
    pub fn value(&self, param: ParamPtr) -> f32 {
        let asked = self.inside().ways.get(&param).and_then(|way| way.values.last().copied());
        asked.unwrap_or_else(|| own(param))
    }

    /// Whether all that was asked for has come or was given up.
    pub fn is_settled(&self) -> bool {
        self.inside().ways.is_empty()
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        lock(&self.0)
    }
}

/// The value, 0 to 1, that a parameter has.
fn own(param: ParamPtr) -> f32 {
    // SAFETY: as above.
    unsafe { param.unmodulated_normalized_value() }
}
