//! Channels begin to be notes of MPE, or cease to be: what then becomes of the notes that sound.

use super::channel::{Channel, Request};
use super::control::{MANAGER, Whose};
use super::{CHANNELS, GestureSink, InputMode, Performance};

impl Performance {
    /// Channels mean something else from now on.
    pub fn set_input(&mut self, input: InputMode) {
        if input == self.input {
            return;
        }
        let was_mpe = self.is_mpe();
        self.input = input;
        let mpe = self.is_mpe();
        if mpe && !was_mpe {
            self.begin_mpe();
        }
        self.follow_wheels();
        // What hands do then has to wait until there is somebody to do it.
        self.means_otherwise |= mpe != was_mpe;
    }

    /// A keyboard has announced how many members there are.
    pub(super) fn take_members(&mut self, was_mpe: bool, out: &mut impl GestureSink) {
        let mpe = self.is_mpe();
        if !mpe && !was_mpe {
            return;
        }
        if mpe {
            // So the specification of MPE has it: whatever reach was announced before is past.
            self.channels.iter_mut().for_each(Channel::forget_reach);
        }
        if mpe && !was_mpe {
            self.begin_mpe();
        }
        self.follow_wheels();
        self.means_otherwise |= mpe != was_mpe;
        self.follow_meaning(out);
    }

    /// From now on the first channel speaks for all, with what it has said before.
    fn begin_mpe(&mut self) {
        let all = self.channels[usize::from(MANAGER)].articulation;
        for member in &mut self.channels[usize::from(MANAGER) + 1..] {
            member.articulation = member.articulation.under(&all);
        }
        self.agree_on_reach();
    }

    /// What has been announced of one member counts for all, if it was announced when they were none yet.
    pub(super) fn agree_on_reach(&mut self) {
        let members = &mut self.channels[usize::from(MANAGER) + 1..];
        let announced = members.iter().find_map(Channel::announced_reach);
        members.iter_mut().for_each(|member| member.take_reach(announced));
    }

    /// If channels have come to mean something else: notes end that no pedal keeps any more, and those that the first channel's
    /// pressure and vibrato act on from now on, or no longer, have what is theirs.
    pub(super) fn follow_meaning(&mut self, out: &mut impl GestureSink) {
        if !std::mem::take(&mut self.means_otherwise) {
            return;
        }
        let every = Whose { channel: MANAGER, all: true };
        self.let_fall_under(every);
        self.ask(Request::LetFall, every, out);
        self.ask(Request::PedalUp, every, out);
        let all = self.channels[usize::from(MANAGER)].manner;
        for channel in MANAGER + 1..CHANNELS as u8 {
            let (whose, own) = (Whose { channel, all: false }, self.channels[usize::from(channel)].manner);
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
