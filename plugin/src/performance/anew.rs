//! The music begins anew, as where a host plays a song once more: hands go back to where they were before the first note, so that
//! the same notes have the same fingers, strokes and variations each time. What was said of how to play stays.

use super::Performance;

impl Performance {
    /// The next notes are the first of the music, unless a key is down by then: to one who is playing they are not.
    pub fn begin_anew(&mut self) {
        self.begins_anew = true;
    }

    /// Notes are about to begin: if they are the first of the music, hands go back for them.
    pub(super) fn go_back_if_anew(&mut self) {
        if std::mem::take(&mut self.begins_anew) && !self.any_key_down() {
            self.go_back_to_the_beginning();
        }
    }

    /// The left hand is where it was before the first note, the next stroke back and forth goes forth, and plucks differ from one
    /// another as from the first one on.
    pub(super) fn go_back_to_the_beginning(&mut self) {
        self.hand.go_back();
        self.variation.reset();
        self.just_begun.reset();
        (self.upward, self.begins_anew) = (false, false);
    }

    fn any_key_down(&self) -> bool {
        self.strings.iter().any(|string| string.has_key_down())
            || self.late.iter().any(|late| late.key_down())
    }
}
