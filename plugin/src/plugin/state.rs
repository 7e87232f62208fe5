//! What a session saves, and what is taken back out of one.
//!
//! The framework writes parameters by identifier, as the values hosts show. Beside them stands a mark: whose
//! state it is, and in which version of its form. A state of somebody else's, or of a form that is newer
//! than this program, is refused as a whole and what was set stays; an older one is brought up to date here;
//! values that a parameter cannot have become some that it can.

use std::cell::Cell;
use std::collections::BTreeMap;

use nice_plug::params::persist::PersistentField;
use nice_plug::plugin::ParamValue;
use nice_plug::prelude::*;
use serde::{Deserialize, Serialize};

use super::shelf::{KEPT, Saved, Shelf};
use crate::params::{LowActionParams, Start};

/// The form in which states are saved now. It grows when an older program could not read them rightly, or has to be
/// told what its own mean by now.
const VERSION: u32 = 2;
/// Whose state it is.
const OWNER: &str = "low-action";
/// Under which name the mark is saved.
pub(crate) const MARK: &str = "state";
/// The parameters of the form before there was a mark.
const UNMARKED: [&str; 3] = ["instrument", "variation", "level"];

/// The mark of a saved state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    owner: String,
    version: u32,
}

impl Default for Mark {
    fn default() -> Self {
        Self { owner: OWNER.into(), version: VERSION }
    }
}

/// Saves the mark; there is nothing to take back from one.
#[derive(Debug, Default)]
pub struct Marked;

impl<'a> PersistentField<'a, Mark> for Marked {
    fn set(&self, _mark: Mark) {}

    fn map<F, R>(&self, read: F) -> R
    where
        F: Fn(&Mark) -> R,
    {
        read(&Mark::default())
    }
}

thread_local! {
    /// Whether a state has been refused on this thread, which the framework has no way to hear of: to it one that has become
    /// empty is loaded.
    static REFUSED: Cell<bool> = const { Cell::new(false) };
}

/// What loading says, and whether what it has loaded was taken in. A host that does not hear of a refusal saves what is there
/// over what it had.
pub(super) fn taken_in<T>(load: impl FnOnce() -> T) -> (T, bool) {
    REFUSED.set(false);
    let said = load();
    (said, !REFUSED.take())
}

/// Makes of a saved state what can be loaded: all of it, brought up to date, or nothing.
pub(super) fn admit(state: &mut PluginState) {
    match judge(&state.fields, &state.params) {
        Ok(()) => {
            bring_up_to_date(&mut state.params);
            put_right(&mut state.params);
            // A state without a file keeps none.
            state.fields.entry(KEPT.into()).or_insert_with(|| "null".into());
        }
        Err(reason) => {
            nice_error!("the saved state is refused, and everything stays as it is: {reason}");
            state.params.clear();
            state.fields.clear();
            REFUSED.set(true);
        }
    }
}

/// Whether a state is one of ours that this program can read.
fn judge(fields: &BTreeMap<String, String>, params: &BTreeMap<String, ParamValue>) -> Result<(), String> {
    let Some(mark) = fields.get(MARK) else {
        // The first form had no mark: it can be told by its few parameters.
        let ours = !params.is_empty() && params.keys().all(|id| UNMARKED.contains(&id.as_str()));
        return if ours { Ok(()) } else { Err("it is not Low Action's".into()) };
    };
    let mark: Mark = serde_json::from_str(mark).map_err(|_| "its mark cannot be read".to_owned())?;
    if mark.owner != OWNER {
        return Err(format!("it is {}'s", mark.owner));
    }
    if mark.version > VERSION {
        return Err(format!("its form {} is newer than this program's {VERSION}", mark.version));
    }
    if fields.get(KEPT).is_some_and(|kept| serde_json::from_str::<Saved>(kept).is_err()) {
        return Err("its set-up file cannot be read".into());
    }
    Ok(())
}

/// Says in today's words what older forms said in theirs.
fn bring_up_to_date(values: &mut BTreeMap<String, ParamValue>) {
    // Before form 2 there was one input mode for channels from 1 and one for channels from 11.
    if let Some(ParamValue::String(mode)) = values.get_mut("input_mode")
        && mode == "strings_11"
    {
        "strings".clone_into(mode);
        values.insert("first_channel".into(), ParamValue::I32(11));
    }
}

/// Makes values of all parameters that they can have: numbers are brought into their range, and what is missing,
/// unknown or of another kind becomes the usual value, since what was set before has no place in the state.
fn put_right(values: &mut BTreeMap<String, ParamValue>) {
    let params = LowActionParams::new(Shelf::new(Vec::new()), &Start::default());
    for (id, param, _) in params.param_map() {
        let saved = values.remove(&id);
        // SAFETY: the pointers lead into `params`, which lives on.
        let possible = unsafe { possible(param, saved.as_ref()) };
        let value = possible.unwrap_or_else(|| {
            if let Some(saved) = saved {
                nice_error!("{id} cannot be {saved:?}: its usual value takes its place");
            }
            // SAFETY: as above.
            unsafe { usual(param) }
        });
        values.insert(id, value);
    }
}

/// What a parameter can have of a saved value; nothing if it is of another kind, or not among the choices.
///
/// # Safety
/// The parameter must be alive.
unsafe fn possible(param: ParamPtr, saved: Option<&ParamValue>) -> Option<ParamValue> {
    // SAFETY: as above.
    unsafe {
        match (param, saved?) {
            (ParamPtr::FloatParam(param), ParamValue::F32(value)) => {
                let (low, high) = ((*param).preview_plain(0.0), (*param).preview_plain(1.0));
                value.is_finite().then(|| ParamValue::F32(value.clamp(low, high)))
            }
            (ParamPtr::IntParam(param), ParamValue::I32(value)) => {
                let (low, high) = ((*param).preview_plain(0.0), (*param).preview_plain(1.0));
                Some(ParamValue::I32((*value).clamp(low, high)))
            }
            (ParamPtr::BoolParam(_), ParamValue::Bool(value)) => Some(ParamValue::Bool(*value)),
            (ParamPtr::EnumParam(param), ParamValue::String(choice)) => {
                (*param).set_from_id(choice).then(|| ParamValue::String(choice.clone()))
            }
            (ParamPtr::EnumParam(param), ParamValue::I32(place)) => {
                (0..(*param).len() as i32).contains(place).then_some(ParamValue::I32(*place))
            }
            _ => None,
        }
    }
}

/// The usual value of a parameter.
///
/// # Safety
/// The parameter must be alive.
unsafe fn usual(param: ParamPtr) -> ParamValue {
    // SAFETY: as above.
    unsafe {
        match param {
            ParamPtr::FloatParam(param) => ParamValue::F32((*param).default_plain_value()),
            ParamPtr::IntParam(param) => ParamValue::I32((*param).default_plain_value()),
            ParamPtr::BoolParam(param) => ParamValue::Bool((*param).default_plain_value()),
            ParamPtr::EnumParam(param) => ParamValue::I32((*param).default_plain_value()),
        }
    }
}
