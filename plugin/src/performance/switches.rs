//! Keyswitches: keys that tell the hands how to play instead of being played.

use super::articulation::SWITCHES;
use super::control::Whose;
use super::{Channels, Performance};

/// Strings that have a keyswitch, after those of the hands. (One more for the hands would move them in songs that are there: it
/// has to come after the strings.)
const STRINGS: u8 = 8;

/// The highest key from which all are within the 128 keys there are.
pub(crate) const HIGHEST_FIRST: u8 = 128 - (SWITCHES + STRINGS);

impl Performance {
    /// Keyswitches begin at this key, or there are none.
    pub(super) fn set_switches(&mut self, first: Option<u8>) {
        self.switches = first;
        self.force_none();
    }

    /// No string is asked for any more.
    pub(super) fn force_none(&mut self) {
        self.channels.iter_mut().for_each(|channel| channel.forced = None);
    }

    /// A key goes down; `true` if it is a keyswitch. One for the hands counts until the next one, also for
    /// notes of the same instant; one for a string while it is down.
    pub(super) fn press_switch(&mut self, channel: u8, key: u8) -> bool {
        let Some(switch) = self.switch(key) else { return false };
        let whose = self.switched_by(channel);
        for (_, own) in (0..).zip(&mut self.channels).filter(|&(channel, _)| whose.is(channel)) {
            match switch.checked_sub(SWITCHES) {
                Some(string) => own.forced = Some((usize::from(string), channel)),
                None => own.articulation.switch(switch),
            }
        }
        for note in &mut self.chord {
            note.articulation = self.channels[usize::from(note.wanted.channel)].articulation;
        }
        self.want_again();
        true
    }

    /// A key goes up that may be a keyswitch.
    pub(super) fn release_switch(&mut self, channel: u8, key: u8) {
        let Some(switch) = self.switch(key) else { return };
        let struck = switch.checked_sub(SWITCHES).map(|string| (usize::from(string), channel));
        // Wherever it counted when it went down.
        for own in self.channels.iter_mut().filter(|own| own.forced == struck) {
            own.forced = None;
        }
    }

    /// Whether a key is a keyswitch that is down and asks for a string.
    pub fn forces(&self, channel: u8, key: u8) -> bool {
        let string = self.switch(key).and_then(|switch| switch.checked_sub(SWITCHES));
        let asks =
            |string| self.channels.iter().any(|own| own.forced == Some((usize::from(string), channel)));
        string.is_some_and(asks)
    }

    /// Of whose notes a keyswitch of a channel speaks: of all where each string has its own channel, or each note its own in MPE.
    pub(super) fn switched_by(&self, channel: u8) -> Whose {
        let others = if self.is_by_strings() { Channels::ALL } else { self.of_one_hand(channel) };
        Whose { channel, others }
    }

    /// The number of a keyswitch.
    fn switch(&self, key: u8) -> Option<u8> {
        key.checked_sub(self.switches?).filter(|&switch| switch < SWITCHES + STRINGS)
    }
}
