//! Parameters of which nothing comes on an instrument, and why: the editor veils them, and commands warn of them.

use low_action_dsp::Setup;
use low_action_dsp::setup::Pickup;

/// Why nothing comes of the parameter of some identifier on an instrument, in a sentence; nothing if something does.
pub(crate) fn why(id: &str, setup: &Setup) -> Option<&'static str> {
    let string = || id.strip_prefix(STRING_TUNING)?.parse::<usize>().ok();
    match id {
        "pickup_position" if !matches!(setup.pickup, Pickup::Magnetic { .. }) => {
            Some("This instrument is heard without a coil.")
        }
        "idle_hands" if setup.body.is_none() => {
            Some("This instrument has no body by which strings could sing along.")
        }
        _ if string().is_some_and(|number| number > setup.string.len()) => {
            Some("This instrument has no such string.")
        }
        _ => None,
    }
}

/// How the identifiers of the strings' tunings begin; the string's number follows, from 1.
pub(crate) const STRING_TUNING: &str = "string_tuning_";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::settings;

    #[test]
    fn what_an_instrument_has_not_is_told_by_its_parameters() {
        let idle = |name: &str| -> Vec<String> {
            let setup = Setup::shipped(name).unwrap();
            settings::ids().into_iter().filter(|id| why(id, &setup).is_some()).collect()
        };
        assert_eq!(idle("electric"), ["string_tuning_7", "string_tuning_8", "idle_hands"]);
        assert_eq!(idle("classical"), ["pickup_position", "string_tuning_7", "string_tuning_8"]);
        assert_eq!(idle("five-string-bass").len(), 4);
    }
}
