//! What the channels of notes mean: a keyboard's, a string each, or a note each.

use super::channels::Spoken;
use super::{CHANNELS, Channels};

/// What the channels of notes mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InputMode {
    /// MPE once a keyboard announces it by registered parameter 6, a keyboard until then.
    #[default]
    Auto,
    /// The player picks string and fret for every note.
    Keyboard,
    /// Each string has a channel, and each channel one string; others are silent.
    Strings {
        /// The lowest of these channels, 0 to 15; the next string has the next one.
        first: u8,
        /// Whether it is the last string's, the lowest on guitars, instead of the first one's.
        from_last: bool,
    },
    /// Each note has a channel of its own; channel 0 acts on all, or on as many as were announced.
    Mpe,
}

impl InputMode {
    /// The string, counted from 0, of a channel on an instrument of so many; `None` where channels are no strings, or this one
    /// is none.
    pub fn string_of(self, channel: u8, strings: usize) -> Option<usize> {
        let Self::Strings { first, from_last } = self else { return None };
        let place = usize::from(channel.checked_sub(first)?);
        let after = strings.checked_sub(place + 1)?;
        Some(if from_last { after } else { place })
    }

    /// The channel, counted from 0, of a string of an instrument of so many; `None` where strings have no channels, or none is
    /// left for this one.
    pub fn channel_of(self, string: usize, strings: usize) -> Option<u8> {
        let Self::Strings { first, from_last } = self else { return None };
        let after = strings.checked_sub(string + 1)?;
        let channel = usize::from(first) + if from_last { after } else { string };
        (channel < CHANNELS).then_some(channel as u8)
    }

    /// MIDI's global channel, which speaks for all strings of an instrument of so many where each has a channel: the one below these,
    /// and below the first one the last, if that is no string's.
    fn global_channel(self, strings: usize) -> Option<u8> {
        let Self::Strings { first, .. } = self else { return None };
        let below = first.checked_sub(1).unwrap_or(CHANNELS as u8 - 1);
        self.string_of(below, strings).is_none().then_some(below)
    }

    /// That channel, and those of the strings.
    pub(super) fn spoken(self, strings: usize) -> Option<Spoken> {
        let by = self.global_channel(strings)?;
        let own = (0..CHANNELS as u8).filter(|&channel| self.string_of(channel, strings).is_some());
        let of = own.fold(Channels::NONE, |all, channel| all.and(Channels::one(channel)));
        Some(Spoken { by, of })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_string_of_a_channel_has_that_channel() {
        let mut pairs = 0;
        for (first, from_last, strings) in
            [(0, false, 6), (0, true, 6), (12, false, 6), (12, true, 6), (3, true, 32)]
        {
            let input = InputMode::Strings { first, from_last };
            for channel in 0..CHANNELS as u8 {
                if let Some(string) = input.string_of(channel, strings) {
                    assert_eq!(input.channel_of(string, strings), Some(channel), "{input:?}");
                    pairs += 1;
                }
            }
            for string in 0..strings {
                if let Some(channel) = input.channel_of(string, strings) {
                    assert_eq!(input.string_of(channel, strings), Some(string), "{input:?}");
                }
            }
            assert_eq!(input.channel_of(strings, strings), None);
        }
        // Of 6, 6, 4, 4 and 32 strings those that find one of 16 channels.
        assert_eq!(pairs, 6 + 6 + 4 + 4 + 13);
        for input in [InputMode::Auto, InputMode::Keyboard, InputMode::Mpe] {
            assert_eq!((input.string_of(0, 6), input.channel_of(0, 6)), (None, None));
        }
    }
}
