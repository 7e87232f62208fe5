//! Keyswitches: keys that tell the hands how to play instead of being played.

use super::articulation::SWITCHES;
use super::{CHANNELS, InputMode, Performance};

/// Strings that have a keyswitch.
const STRINGS: u8 = 8;

impl Performance {
    /// Keyswitches begin at this key, or there are none.
    pub(super) fn set_switches(&mut self, first: Option<u8>) {
        self.switches = first;
        self.forced = None;
    }

    /// A key goes down; `true` if it is a keyswitch. One for the hands counts until the next one, also for
    /// notes of the same instant; one for a string while it is down.
    pub(super) fn press_switch(&mut self, channel: u8, key: u8) -> bool {
        let Some(number) = self.switch(key) else { return false };
        if let Some(string) = number.checked_sub(SWITCHES) {
            self.forced = Some(usize::from(string));
            self.want_again();
            return true;
        }
        let all = self.is_mpe() || matches!(self.input, InputMode::Strings { .. });
        let own = |number: usize| all || number == usize::from(channel);
        for number in (0..CHANNELS).filter(|&number| own(number)) {
            self.channels[number].articulation.switch(key.wrapping_sub(self.switches.unwrap_or(0)));
        }
        for struck in &mut self.chord {
            struck.articulation = self.channels[usize::from(struck.wanted.channel)].articulation;
        }
        self.want_again();
        true
    }

    /// A key goes up that may be a keyswitch.
    pub(super) fn release_switch(&mut self, key: u8) {
        let Some(number) = self.switch(key) else { return };
        let string = number.checked_sub(SWITCHES).map(usize::from);
        if string.is_some() && self.forced == string {
            self.forced = None;
        }
    }

    /// The number of a keyswitch.
    fn switch(&self, key: u8) -> Option<u8> {
        key.checked_sub(self.switches?).filter(|&number| number < SWITCHES + STRINGS)
    }
}
