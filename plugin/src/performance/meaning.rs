//! Channels begin to be notes of MPE, or cease to be: what then becomes of the notes that sound.

use super::channel::{Channel, Request};
use super::control::{MANAGER, Whose};
use super::{CHANNELS, Channels, GestureSink, InputMode, Performance};

impl Performance {
    /// Channels mean something else from now on.
    pub fn set_input(&mut self, input: InputMode) {
        if input == self.input {
            return;
        }
        let before = self.members();
        self.input = input;
        // What hands do then has to wait until there is somebody to do it.
        self.follow_members(before);
    }

    /// A keyboard has announced how many members there are, where there were these before.
    pub(super) fn take_members(&mut self, before: Channels, out: &mut impl GestureSink) {
        if self.is_mpe() {
            // So the specification of MPE has it: whatever reach was announced before is past.
            let zone = before.and(self.members()).and(Channels::one(MANAGER));
            self.each_of(zone).for_each(Channel::forget_reach);
        }
        self.follow_members(before);
        self.follow_meaning(out);
    }

    /// There may be other members than before.
    pub(super) fn follow_members(&mut self, before: Channels) {
        let members = self.members();
        let (come, gone) = (members.without(before), before.without(members));
        if come != Channels::NONE {
            self.begin_mpe(come);
        }
        self.follow_wheels();
        self.means_otherwise = self.means_otherwise.and(come).and(gone);
    }

    /// From now on the first channel speaks for these, with what it has said before.
    fn begin_mpe(&mut self, members: Channels) {
        let all = self.channels[usize::from(MANAGER)].articulation;
        self.each_of(members).for_each(|member| member.articulation = member.articulation.under(&all));
        self.agree_on_reach();
    }

    /// What has been announced of one member counts for all, if it was announced when they were none yet.
    pub(super) fn agree_on_reach(&mut self) {
        let members = self.members();
        let announced = self.each_of(members).find_map(|member| member.announced_reach());
        self.each_of(members).for_each(|member| member.take_reach(announced));
    }

    /// If channels have come to mean something else: notes of theirs end that no pedal keeps any more, and those that the first
    /// channel's pressure and vibrato act on from now on, or no longer, have what is theirs.
    pub(super) fn follow_meaning(&mut self, out: &mut impl GestureSink) {
        let others = std::mem::replace(&mut self.means_otherwise, Channels::NONE);
        if others == Channels::NONE {
            return;
        }
        let whose = Whose { channel: MANAGER, others };
        self.let_fall_under(whose);
        self.ask(Request::LetFall, whose, out);
        self.ask(Request::PedalUp, whose, out);
        let all = self.channels[usize::from(MANAGER)].manner;
        for channel in (0..CHANNELS as u8).filter(|&channel| others.has(channel)) {
            let (whose, own) = (Whose::one(channel), self.channels[usize::from(channel)].manner);
            let under = own.under(&all);
            // What it says nothing of stays: a note may have its own.
            for request in [
                (under.pressure != own.pressure).then_some(Request::Press),
                (under.vibrato != own.vibrato).then_some(Request::Swing),
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
