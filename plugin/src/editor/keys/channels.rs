//! The channel of a note of the piano: where each channel is a string, a key has to say which string it is for.

use low_action_dsp::Setup;

use crate::performance::InputMode;

/// The channel, counted from 0, on which a MIDI key is played while others are taken by keys that are down: that of a string
/// that is free and has it at the lowest fret. Where channels are no strings it is the first, and the player finds the string.
pub(super) fn channel(input: InputMode, setup: &Setup, key: u8, taken: &[u8]) -> u8 {
    let InputMode::Strings { first, .. } = input else { return 0 };
    let count = setup.string.len();
    let strings = (0..count).filter_map(|string| Some((string, input.channel_of(string, count)?)));
    let best = strings.min_by_key(|&(string, channel)| {
        let fret = (f64::from(key) - setup.string[string].pitch).round();
        let has_it = (0.0..=setup.neck.frets as f64).contains(&fret);
        (taken.contains(&channel), !has_it, fret.abs() as u32)
    });
    best.map_or(first, |(_, channel)| channel)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channels(input: InputMode, taken: &[u8]) -> [u8; 4] {
        let setup = Setup::builtin("electric").expect("it is built in");
        // The open strings E2 and E4, a third on B3, and what no string has.
        [40, 64, 62, 20].map(|key| channel(input, &setup, key, taken))
    }

    #[test]
    fn a_key_goes_to_the_string_that_has_it_lowest() {
        assert_eq!(channels(InputMode::Auto, &[]), [0; 4]);
        let strings = |first, from_last| InputMode::Strings { first, from_last };
        assert_eq!(channels(strings(0, false), &[]), [5, 0, 1, 5]);
        assert_eq!(channels(strings(10, true), &[]), [10, 15, 14, 10]);
        assert_eq!(channels(strings(0, false), &[1])[2], 2, "the string beside it");
        assert_eq!(channels(strings(13, false), &[])[1], 13);
        assert!(channels(strings(13, false), &[]).iter().all(|channel| *channel < 16));
    }
}
