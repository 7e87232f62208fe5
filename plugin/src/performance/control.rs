//! What wheels, pedals and controllers of channels ask of the strings.

use super::channel::{Channel, Request};
use super::string::Manner;
use super::{CHANNELS, Channels, GestureSink, Performance};

/// Semitones of a full turn of the wheel in MPE, while no other range is announced: of a note's own
/// channel, and of the one that bends them all.
const MPE_RANGES: (f64, f64) = (48.0, 2.0);
/// The channel that acts on all in MPE.
pub(crate) const MPE_MANAGER: u8 = 0;
/// The one that would on those of an upper zone.
pub(crate) const MPE_UPPER_MANAGER: u8 = 15;

/// Of whose notes something is asked.
#[derive(Debug, Clone, Copy)]
pub(super) struct Whose {
    /// Those of this channel,
    pub channel: u8,
    /// and of these.
    pub others: Channels,
}

impl Whose {
    /// Those of a channel alone.
    pub fn one(channel: u8) -> Self {
        Self { channel, others: Channels::NONE }
    }

    /// Whether those of a channel are meant.
    pub fn is(self, channel: u8) -> bool {
        channel == self.channel || self.others.has(channel)
    }
}

impl Performance {
    /// Whether a pedal keeps the notes of a channel.
    pub(super) fn pedal(&self, channel: u8) -> bool {
        self.channels[usize::from(channel)].pedal || self.speaker(channel).is_some_and(|all| all.pedal)
    }

    /// Whether a sostenuto pedal keeps what it has caught of a channel.
    fn sostenuto(&self, channel: u8) -> bool {
        self.channels[usize::from(channel)].sostenuto
            || self.speaker(channel).is_some_and(|all| all.sostenuto)
    }

    /// Bend by the wheels that act on a channel, semitones.
    pub(super) fn bend(&self, channel: u8) -> f64 {
        let own = &self.channels[usize::from(channel)];
        let all = || self.channels[usize::from(MPE_MANAGER)].bend(Some(MPE_RANGES.1));
        match channel {
            MPE_MANAGER if self.is_mpe() => all(),
            _ if self.is_member(channel) => own.bend(Some(MPE_RANGES.0)) + all(),
            _ => own.bend(None) + self.speaker(channel).map_or(0.0, |all| all.bend(None)),
        }
    }

    /// How notes of a channel are played, as its controllers have it, and those of the channel that speaks for it.
    pub(super) fn manner(&self, channel: u8) -> Manner {
        let own = self.channels[usize::from(channel)].manner;
        self.speaker(channel).map_or(own, |all| own.under(&all.manner))
    }

    /// Changes a channel's state and carries the consequences to the strings.
    pub(super) fn control(
        &mut self,
        sender: u8,
        change: impl Fn(&mut Channel) -> Request,
        out: &mut impl GestureSink,
    ) {
        let before = self.spoken();
        let Some((request, whose)) = self.change_channels(sender, change) else { return };
        self.tell_chord(request, |channel| whose.is(channel));
        match request {
            Request::Members if sender == MPE_MANAGER => return self.take_members(before, out),
            // Others there may be of an upper zone, which are the first channel's, too; what it has said of its own stays.
            Request::Members => {
                self.follow_members(before);
                return self.follow_meaning(out);
            }
            Request::Capo(fret) => return self.set_capo(usize::from(fret)),
            Request::Switches(first) => return self.set_switches((first > 0).then_some(first)),
            Request::Hand(fret) => return self.hand.set_home((fret > 0).then_some(fret)),
            Request::ReleaseKeys => self.forget_keys(whose),
            Request::Silence => {
                self.forget_keys(whose);
                self.leave_out_late(|own| whose.is(own));
            }
            Request::Press | Request::Swing | Request::Touch => self.tell_keys_under(request, whose),
            Request::Catch => self.catch(whose),
            Request::LetFall => self.let_fall_under(whose),
            Request::Reset => {
                self.tell_keys_under(request, whose);
                self.let_fall_under(whose);
                // What no channel owns, any of them puts back; in MPE the one that speaks for all.
                if sender == MPE_MANAGER || !self.is_mpe() {
                    self.set_capo(self.touching.capo.into());
                    self.set_switches(self.touching.keyswitches);
                    self.hand.set_home(self.touching.hand_position);
                }
            }
            _ => {}
        }
        self.ask(request, whose, out);
        if request == Request::Touch {
            self.lay_palms(whose, out);
        }
    }

    /// Puts back what controllers that tell hands what to do have set, as they are heard no more.
    pub(super) fn forget_hand_controllers(&mut self, out: &mut impl GestureSink) {
        let whose = Whose { channel: MPE_MANAGER, others: Channels::ALL };
        self.begin_chord(out);
        self.channels.iter_mut().for_each(|channel| channel.articulation.forget_hands());
        self.set_capo(self.touching.capo.into());
        self.set_switches(self.touching.keyswitches);
        self.hand.set_home(self.touching.hand_position);
        self.tell_chord(Request::Touch, |_| true);
        self.tell_keys_under(Request::Touch, whose);
        self.ask(Request::Touch, whose, out);
        self.lay_palms(whose, out);
    }

    /// Does to every string what is asked.
    pub(super) fn ask(&mut self, request: Request, whose: Whose, out: &mut impl GestureSink) {
        for index in 0..self.strings.len() {
            self.carry_out(request, whose, index, out);
        }
    }

    /// Changes the state of a channel, and of those that it speaks for. Gives back what that asks of the strings, and of
    /// whose; nothing if there is no such channel.
    fn change_channels(
        &mut self,
        sender: u8,
        change: impl Fn(&mut Channel) -> Request,
    ) -> Option<(Request, Whose)> {
        let channel = self.channels.get_mut(usize::from(sender))?;
        let before = channel.announced_reach();
        let request = change(channel);
        let reach = channel.announced_reach();
        let (members, spoken) = (self.members(), self.spoken().with(sender));
        // The reach of the wheel that one member of MPE announces is that of all; its first channel has one of its own. Where each
        // string has a channel the one that speaks for them announces theirs.
        let of_one_reach = match members {
            Channels::NONE => spoken,
            members if members.has(sender) => members,
            _ => Channels::NONE,
        };
        let announces = of_one_reach != Channels::NONE && reach != before;
        if announces {
            self.each_of(of_one_reach).for_each(|other| other.take_reach(reach));
        } else {
            // Most messages say nothing of hands: what other channels have been told stays.
            self.each_of(spoken).for_each(|member| member.hear(&change));
        }
        let others = if announces { of_one_reach } else { spoken };
        Some((request, Whose { channel: sender, others }))
    }

    /// All keys of a channel go up, in MPE of the first one its own alone.
    pub(super) fn release_keys(&mut self, channel: u8, out: &mut impl GestureSink) {
        let whose = Whose::one(channel);
        self.forget_keys(whose);
        self.ask(Request::ReleaseKeys, whose, out);
    }

    /// All keys go up: also keyswitches, those of notes that come late and are heard nevertheless, and those under the ones that sound.
    fn forget_keys(&mut self, whose: Whose) {
        for own in &mut self.channels {
            own.forced = own.forced.filter(|&(_, by)| !whose.is(by));
        }
        let late = self.late.iter_mut().filter(|late| whose.is(late.note.wanted.channel));
        late.for_each(|late| late.releases = late.note.presses);
        self.strings.iter_mut().for_each(|string| string.forget_under(|note| whose.is(note.channel)));
    }

    /// Notes whose keys are down under the ones that sound hear how they are to be played when they come back.
    pub(super) fn tell_keys_under(&mut self, request: Request, whose: Whose) {
        let told = |channel: usize| (self.manner(channel as u8), self.channels[channel].articulation.palm);
        let told: [(Manner, f64); CHANNELS] = std::array::from_fn(told);
        let said = |own: u8| whose.is(own).then(|| told[usize::from(own)]);
        self.strings.iter_mut().for_each(|string| string.hear(request, said));
    }

    /// A sostenuto pedal goes down: it catches keys that are down, also those of notes that wait for a string.
    fn catch(&mut self, whose: Whose) {
        self.strings.iter_mut().for_each(|string| string.catch(|own| whose.is(own)));
        let waiting = self.late.iter_mut().filter(|late| whose.is(late.note.wanted.channel));
        waiting.for_each(|late| late.note.caught |= late.key_down());
    }

    /// What a sostenuto pedal no longer holds of them, or of notes that wait for a string, comes back held by its key alone.
    pub(super) fn let_fall_under(&mut self, whose: Whose) {
        let caught: [bool; CHANNELS] = std::array::from_fn(|channel| self.sostenuto(channel as u8));
        let fallen = |own: u8| whose.is(own) && !caught[usize::from(own)];
        self.strings.iter_mut().for_each(|string| string.let_fall_under(fallen));
        let waiting = self.late.iter_mut().map(|late| &mut late.note);
        waiting.filter(|note| fallen(note.wanted.channel)).for_each(|note| note.caught = false);
    }

    /// Does to a string what is asked, if its last note is one of those that are meant.
    fn carry_out(&mut self, request: Request, whose: Whose, index: usize, out: &mut impl GestureSink) {
        let Some(channel) = self.strings[index].channel().filter(|&own| whose.is(own)) else { return };
        let time = self.now;
        let (pedal, bend, manner) = (self.pedal(channel), self.bend(channel), self.manner(channel));
        let (articulation, caught) =
            (self.channels[usize::from(channel)].articulation, self.sostenuto(channel));
        let string = &mut self.strings[index];
        match request {
            Request::None | Request::Members | Request::Catch => {}
            Request::Capo(_) | Request::Switches(_) | Request::Hand(_) => {}
            Request::Touch => string.set_touch(time, &articulation, out),
            Request::PedalUp if pedal => {}
            Request::PedalUp => string.pedal_up(time, channel, out),
            Request::LetFall if caught => {}
            Request::LetFall => string.let_fall(time, channel, pedal, out),
            Request::Bend => string.bend(time, channel, bend),
            Request::Press => string.press(time, manner.pressure, out),
            Request::Swing => string.swing(time, manner.vibrato),
            Request::ReleaseKeys => string.release_channel(time, channel, pedal, out),
            Request::Silence => string.silence(time, Some(channel)),
            Request::Reset => {
                // In MPE the pedals of the first channel go on holding when another one is reset.
                if !caught {
                    string.let_fall(time, channel, pedal, out);
                }
                if !pedal {
                    string.pedal_up(time, channel, out);
                }
                string.bend(time, channel, bend);
                // A note of another channel that has come back is as that has it.
                if string.channel() == Some(channel) {
                    string.press(time, manner.pressure, out);
                    string.swing(time, manner.vibrato);
                }
                string.set_touch(time, &articulation, out);
            }
        }
        self.welcome_back(index, out);
    }

    /// The palms of channels wait for notes on strings where nobody plays: those of their last notes, and those that have had none.
    pub(super) fn lay_palms(&mut self, whose: Whose, out: &mut impl GestureSink) {
        let (by_strings, count) = (self.is_by_strings(), self.strings.len());
        for (index, string) in self.strings.iter_mut().enumerate() {
            let own = string.channel().or_else(|| self.input.channel_of(index, count));
            let meant = own.map_or(!by_strings, |own| whose.is(own));
            let told = self.channels.get(usize::from(own.unwrap_or(whose.channel)));
            if let Some(channel) = told.filter(|_| meant && !string.is_played()) {
                string.set_palm(self.now, channel.articulation.palm, out);
            }
        }
    }

    /// A note that has come back to a string has the wheel and the tremolo of its own channel.
    pub(super) fn welcome_back(&mut self, index: usize, out: &mut impl GestureSink) {
        let Some(channel) = self.strings[index].take_gone_back() else { return };
        let (time, bend) = (self.now, self.bend(channel));
        let tremolo = self.channels[usize::from(channel)].articulation.tremolo;
        self.strings[index].bend(time, channel, bend);
        self.strings[index].go_on_with_tremolo(time, tremolo, out);
    }

    /// What wheels stand for has changed: strings are bent as far as it is now.
    pub(super) fn follow_wheels(&mut self) {
        for index in 0..self.strings.len() {
            if let Some(channel) = self.strings[index].channel() {
                let bend = self.bend(channel);
                self.strings[index].bend(self.now, channel, bend);
            }
        }
    }

    /// A capo goes to a fret of all strings, 0 for none, as soon as each is played.
    pub(super) fn set_capo(&mut self, fret: usize) {
        self.hand.set_capo(fret);
        let fret = self.hand.capo();
        self.strings.iter_mut().for_each(|string| string.set_capo(fret));
    }
}
