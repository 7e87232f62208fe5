//! What those who play say once and never again, whatever becomes of the player who has heard it.

use super::{CHANNELS, Performance};

/// What was announced: the capo, keyswitches, where the hand plays, and what each channel was told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Announced {
    /// The fret of a capo or that there is none, if a controller said so.
    capo: Option<usize>,
    /// Where keyswitches begin or that there are none, if a controller said so.
    switches: Option<Option<u8>>,
    /// The fret that the hand plays about or that it goes where it likes, if a controller said so.
    home: Option<Option<u8>>,
    channels: [Channel; CHANNELS],
}

/// What was announced on one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Channel {
    /// How far its wheel reaches, semitones and hundredths.
    reach: Option<(f64, f64)>,
    /// How many channels of MPE there are.
    members: Option<u8>,
}

impl Performance {
    /// What has been announced so far.
    pub fn announced(&self) -> Announced {
        let channel = |number: usize| {
            let channel = &self.channels[number];
            Channel { reach: channel.announced_reach(), members: channel.members }
        };
        Announced {
            capo: Some(self.hand.asked_capo()).filter(|&capo| capo != usize::from(self.touching.capo)),
            switches: (self.switches != self.touching.keyswitches).then_some(self.switches),
            home: (self.hand.home() != self.touching.hand_position).then_some(self.hand.home()),
            channels: std::array::from_fn(channel),
        }
    }

    /// Wheels reach as far from the next sample on as before any reach was announced.
    pub fn forget_reach(&mut self) {
        self.channels.iter_mut().for_each(super::Channel::forget_reach);
        self.follow_wheels();
    }

    /// Takes it as announced to this player, to whom nothing has been since the last [reset](Performance::reset).
    pub fn announce(&mut self, announced: &Announced) {
        for (channel, &Channel { reach, members }) in self.channels.iter_mut().zip(&announced.channels) {
            channel.take_reach(reach);
            channel.members = members;
        }
        if self.is_mpe() {
            self.agree_on_reach();
        }
        if !self.touching.hand_controllers {
            return;
        }
        self.switches = announced.switches.unwrap_or(self.switches);
        self.hand.set_home(announced.home.unwrap_or(self.hand.home()));
        self.set_capo(announced.capo.unwrap_or(self.hand.asked_capo()));
    }
}
