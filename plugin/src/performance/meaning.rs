//! Channels begin to be notes of MPE, or those of strings, or cease to be, and others speak for them: what then becomes of the notes
//! that sound.

use super::channel::{Channel, Request};
use super::channels::Spoken;
use super::control::{MPE_MANAGER, Whose};
use super::{CHANNELS, Channels, GestureSink, InputMode, Performance};

impl Performance {
    /// Channels mean something else from now on.
    pub fn set_input(&mut self, input: InputMode) {
        if input == self.input {
            return;
        }
        let before = self.spoken();
        self.input = input;
        // What hands do then has to wait until there is somebody to do it.
        self.follow_members(before);
    }

    /// A keyboard has announced how many members there are, where there were these before.
    pub(super) fn take_members(&mut self, before: Spoken, out: &mut impl GestureSink) {
        if self.is_mpe() {
            // So the specification of MPE has it: whatever reach was announced before is past.
            let zone = before.of.and(self.members()).and(Channels::one(MPE_MANAGER));
            self.each_of(zone).for_each(Channel::forget_reach);
        }
        self.follow_members(before);
        self.follow_meaning(out);
    }

    /// Another channel than before may speak for others, or for other ones.
    pub(super) fn follow_members(&mut self, before: Spoken) {
        let now = self.spoken();
        let (come, gone) = if now.by == before.by {
            (now.of.without(before.of), before.of.without(now.of))
        } else {
            (now.of, before.of)
        };
        if come != Channels::NONE {
            self.begin_speaking(now.by, come);
        }
        self.follow_wheels();
        self.means_otherwise = self.means_otherwise.and(come).and(gone);
        self.spoke = self.spoke.and(Channels::one(before.by)).and(Channels::one(now.by));
    }

    /// From now on a channel speaks for these, with what it has said before.
    fn begin_speaking(&mut self, by: u8, of: Channels) {
        let all = self.channels[usize::from(by)].articulation;
        self.each_of(of).for_each(|own| own.articulation = own.articulation.under(&all));
        self.agree_on_reach();
    }

    /// What has been announced of one member counts for all, if it was announced when they were none yet.
    pub(super) fn agree_on_reach(&mut self) {
        let members = self.members();
        let announced = self.each_of(members).find_map(|member| member.announced_reach());
        self.each_of(members).for_each(|member| member.take_reach(announced));
    }

    /// If channels have come to mean something else: notes of theirs end that no pedal keeps any more, and those that the pressure and
    /// vibrato of one that speaks for them act on from now on, or no longer, have what is theirs.
    pub(super) fn follow_meaning(&mut self, out: &mut impl GestureSink) {
        let others = std::mem::replace(&mut self.means_otherwise, Channels::NONE);
        let spoke = std::mem::replace(&mut self.spoke, Channels::NONE);
        if others == Channels::NONE {
            return;
        }
        let whose = Whose { channel: MPE_MANAGER, others };
        self.let_fall_under(whose);
        self.ask(Request::LetFall, whose, out);
        self.ask(Request::PedalUp, whose, out);
        for channel in (0..CHANNELS as u8).filter(|&channel| others.has(channel)) {
            let (whose, own) = (Whose::one(channel), self.channels[usize::from(channel)].manner);
            let speaking = (0..).zip(&self.channels).filter(|&(by, _)| spoke.has(by));
            let mut under = speaking.map(|(_, all)| own.under(&all.manner));
            // What they say nothing of stays: a note may have its own.
            for request in [
                under.clone().any(|under| under.pressure != own.pressure).then_some(Request::Press),
                under.any(|under| under.vibrato != own.vibrato).then_some(Request::Swing),
            ]
            .into_iter()
            .flatten()
            {
                self.tell_keys_under(request, whose);
                self.ask(request, whose, out);
            }
        }
    }
}
