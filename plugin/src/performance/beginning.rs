//! How a player begins who is not new: in the place of another in the middle of the music, or again at its first sample.

use super::channel::Channel;
use super::string::StringPlayer;
use super::{Channels, Compromises, Performance};

impl Performance {
    /// Takes over from another player in the middle of the music: pedals, wheels and, if the strings go on
    /// sounding, notes, fingers and the place of the hand. Nothing is allocated.
    pub fn take_over(&mut self, old: &Self, strings_go_on: bool) {
        self.channels.clone_from(&old.channels);
        self.variation.clone_from(&old.variation);
        self.input = old.input;
        (self.means_otherwise, self.spoke) = (old.means_otherwise, old.spoke);
        self.touching = old.touching;
        (self.compromises, self.now) = (old.compromises, old.now);
        self.chord.clear();
        self.chord.extend_from_slice(&old.chord);
        self.releases.clear();
        self.releases.extend_from_slice(&old.releases);
        self.late.clear();
        self.late.extend_from_slice(&old.late);
        (self.upward, self.begins_anew) = (old.upward, old.begins_anew);
        self.switches = old.switches;
        self.just_begun.take_over(&old.just_begun, strings_go_on);
        self.hand.set_home(old.hand.home());
        if strings_go_on {
            self.hand.take_over(&old.hand);
            for (string, old) in self.strings.iter_mut().zip(&old.strings) {
                string.take_over(old);
            }
            self.set_capo(self.hand.asked_capo());
        } else {
            // It may have played before.
            self.strings.iter_mut().for_each(StringPlayer::reset);
            self.hand.reset();
            self.set_capo(old.hand.asked_capo());
            self.pick_up_hands();
        }
        self.taken_over = strings_go_on;
    }

    /// Starts again at sample 0, but with the capo, the keyswitches, the place of the hand, and the reach of wheels and the channels
    /// for MPE that were announced: those who send them do so once.
    pub fn restart(&mut self) {
        let announced = self.announced();
        self.reset();
        self.announce(&announced);
    }

    /// Forgets everything and starts again at sample 0.
    pub fn reset(&mut self) {
        self.strings.iter_mut().for_each(StringPlayer::reset);
        self.channels.iter_mut().for_each(Channel::reset);
        self.hand.reset();
        self.variation.reset();
        self.compromises = Compromises::default();
        self.unplayed.clear();
        self.chord.clear();
        self.just_begun.reset();
        self.releases.clear();
        self.late.clear();
        (self.upward, self.begins_anew) = (false, false);
        (self.means_otherwise, self.spoke) = (Channels::NONE, Channels::NONE);
        self.switches = self.touching.keyswitches;
        self.hand.set_home(self.touching.hand_position);
        self.set_capo(self.touching.capo.into());
        self.now = 0;
        self.pick_up_hands();
    }

    /// Gives every string the hands and the tremolo arm as they are now.
    fn pick_up_hands(&mut self) {
        let hands = self.touching.hands(&self.hands, self.scale);
        for string in &mut self.strings {
            string.begin_with(self.now, &hands, self.touching.tremolo_arm);
        }
    }
}
