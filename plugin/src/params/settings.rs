//! Values of parameters by their identifiers, as people write them: what the parameters themselves make of a text.

use nice_plug::params::internals::ParamPtr;
use nice_plug::prelude::Params;

use super::LowActionParams;
use super::ranges::number;
use super::start::Start;
use crate::plugin::shelf::Shelf;

/// A value for a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    id: String,
    /// As hosts send it, 0 to 1.
    normalized: f32,
    /// As hosts show it.
    shown: String,
}

impl Setting {
    /// Reads a value for the parameter of some identifier.
    ///
    /// # Errors
    /// When there is no such parameter, or it does not take that.
    pub fn read(id: &str, text: &str) -> Result<Self, String> {
        let params = usual();
        let found = params.param_map().into_iter().find(|(known, ..)| known == id);
        let (_, param, _) = found.ok_or_else(|| format!("there is no parameter {id}"))?;
        let normalized = value(param, text).map_err(|range| format!("{id} must be {range}"))?;
        // SAFETY: the pointer leads into `params`, which are here until the end.
        let shown = unsafe { param.normalized_value_to_string(normalized, true) };
        Ok(Self { id: id.to_owned(), normalized, shown })
    }

    /// The identifier of the parameter.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The value as hosts show it.
    pub fn shown(&self) -> &str {
        &self.shown
    }
}

/// The identifiers of all that hands and luthiers have to do with: what is played, how exactly, and what becomes of the sound is
/// not of it.
pub(crate) fn ids() -> Vec<String> {
    let is_other = |group: &str| ["Instrument", "Output"].contains(&group);
    usual().param_map().into_iter().filter(|(.., group)| !is_other(group)).map(|(id, ..)| id).collect()
}

/// The parameters with such values, the later ones in place of those before, and everything else as usual.
pub(crate) fn with(settings: &[Setting]) -> LowActionParams {
    LowActionParams::new(Shelf::new(Vec::new()), &Start { settings: settings.to_vec(), ..Start::default() })
}

fn usual() -> LowActionParams {
    with(&[])
}

/// Gives parameters such values.
pub(super) fn apply(params: &LowActionParams, settings: &[Setting]) {
    let known = params.param_map();
    for Setting { id, normalized, .. } in settings {
        for (_, param, _) in known.iter().filter(|(known, ..)| known == id) {
            // SAFETY: the pointers lead into `params`, which outlive this.
            unsafe { param._internal_set_normalized_value(*normalized) };
        }
    }
}

/// What a parameter makes of a text, 0 to 1. Where it does not take that, as where a number is out of the range and would become
/// the nearest in it, what it takes.
pub(crate) fn value(param: ParamPtr, text: &str) -> Result<f32, String> {
    // SAFETY: whoever calls this has the parameters.
    let show = |normalized: f32| unsafe { param.normalized_value_to_string(normalized, true) };
    // SAFETY: as above.
    let (read, steps, unit) =
        unsafe { (param.string_to_normalized_value(text), param.step_count(), param.unit()) };
    let number = |text: &str| number(text, unit);
    if let ParamPtr::BoolParam(_) | ParamPtr::EnumParam(_) = param {
        let count = steps.unwrap_or(1);
        let words: Vec<String> = (0..=count).map(|step| show(step as f32 / count as f32)).collect();
        let place = words.iter().position(|word| word.eq_ignore_ascii_case(text.trim()));
        return place.map(|place| place as f32 / count as f32).ok_or_else(|| words.join(" or "));
    }
    let (low, high) = (show(0.0), show(1.0));
    // (The least of some is a word, and numbers begin at the next step.)
    let first = steps.map_or(0.0, |count| 1.0 / count as f32);
    let (range, least) = match number(&low) {
        Some(least) => (format!("{low} to {high}"), least),
        None => (format!("{low}, or {} to {high}", show(first)), number(&show(first)).unwrap_or(f32::MIN)),
    };
    let most = number(&high).unwrap_or(f32::MAX);
    let lies_in = number(text).is_none_or(|number| (least..=most).contains(&number));
    read.filter(|_| lies_in).ok_or(range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_what_the_parameters_take_them_for() {
        for (id, text, expected) in [
            ("pluck_force", "80", "80 %"),
            ("pluck_force", "80 %", "80 %"),
            ("relief", "-0,5 mm", "-0.50 mm"),
            ("velocity_curve", "2", "2.00"),
            ("keyswitches", "36", "36"),
            ("keyswitches", "off", "off"),
            ("capo", "none", "none"),
            ("tension_modulation", "off", "Off"),
            ("input_mode", "mpe", "MPE"),
            ("take", "9999", "9999"),
        ] {
            let setting = Setting::read(id, text);
            assert_eq!(setting.as_ref().map(Setting::shown), Ok(expected), "{id}={text}");
        }
    }

    #[test]
    fn what_they_do_not_take_is_told_with_what_they_do() {
        for (id, text, expected) in [
            ("plucks", "80", "there is no parameter plucks"),
            ("pluck_force", "501", "pluck_force must be 5 % to 500 %"),
            ("pluck_force", "hard", "pluck_force must be 5 % to 500 %"),
            ("pluck_force", "nan", "pluck_force must be 5 % to 500 %"),
            ("velocity_curve", "-1", "velocity_curve must be 0.00 to 4.00"),
            ("keyswitches", "109", "keyswitches must be off, or 0 to 108"),
            ("keyswitches", "-1", "keyswitches must be off, or 0 to 108"),
            ("take", "1.5", "take must be 0 to 9999"),
            ("take", "10000", "take must be 0 to 9999"),
            ("tension_modulation", "1", "tension_modulation must be Off or On"),
            ("input_mode", "guitar", "input_mode must be Auto or Keyboard or Channel per string or MPE"),
        ] {
            assert_eq!(Setting::read(id, text).unwrap_err(), expected, "{id}={text}");
        }
    }

    #[test]
    fn the_later_value_counts_and_all_else_is_as_usual() {
        let settings = [("take", "3"), ("bend_range", "12"), ("take", "5")]
            .map(|(id, text)| Setting::read(id, text).unwrap());
        let params = with(&settings);
        assert_eq!((params.player.take.value(), params.control.bend_range.value()), (5, 12));
        for (id, param, _) in params.param_map() {
            // SAFETY: the pointers lead into `params`.
            let (value, usual) =
                unsafe { (param.unmodulated_normalized_value(), param.default_normalized_value()) };
            assert_eq!(value != usual, ["take", "bend_range"].contains(&id.as_str()), "{id}");
        }
    }
}
