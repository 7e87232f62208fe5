//! Keys go up, and notes end by themselves.

use super::{CHANNELS, GestureSink, Performance};

impl Performance {
    /// The note of a key ends, however often that went down and whatever the pedals say.
    pub(super) fn cut(&mut self, channel: u8, key: u8, out: &mut impl GestureSink) {
        self.release_switch(channel, key);
        for index in 0..self.strings.len() {
            if self.strings[index].cut(self.now, channel, key, out) {
                self.welcome_back(index, out);
            }
        }
        // A note that has yet to come is heard nevertheless.
        for late in self.late.iter_mut().filter(|late| late.is(channel, key)) {
            (late.releases, late.cut) = (late.note.presses, true);
            late.note.caught = false;
        }
    }

    /// A key goes up.
    pub(super) fn let_go(&mut self, channel: u8, key: u8, out: &mut impl GestureSink) {
        if usize::from(channel) >= CHANNELS {
            return;
        }
        // (It may sound, too, if it was no keyswitch when it went down.)
        self.release_switch(channel, key);
        let pedal = self.pedal(channel);
        for index in 0..self.strings.len() {
            if self.strings[index].release(self.now, channel, key, pedal, out) {
                return self.welcome_back(index, out);
            }
        }
        // A note that has yet to come is heard nevertheless.
        if let Some(late) = self.late.iter_mut().find(|late| late.key_down() && late.is(channel, key)) {
            late.releases += 1;
        }
    }
}
