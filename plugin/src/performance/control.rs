//! What channels mean, and what controllers and note expressions do to the strings.

use super::channel::{Channel, Request, pressure_factor};
use super::chord::Unplaced;
use super::string::{Manner, Own};
use super::technique::BRIGHTNESS_REACH;
use super::{CHANNELS, Expression, GestureSink, Performance, PlayerEvent, seven_bits};

/// What the channels of notes mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InputMode {
    /// MPE once a keyboard announces it by registered parameter 6, a keyboard until then.
    #[default]
    Auto,
    /// The player picks string and fret for every note.
    Keyboard,
    /// Each string has a channel, and each channel one string; others are silent.
    Strings {
        /// The lowest of these channels, 0 to 15; the next string has the next one.
        first: u8,
        /// Whether it is the last string's, the lowest on guitars, instead of the first one's.
        from_last: bool,
    },
    /// Each note has a channel of its own; channel 0 acts on all.
    Mpe,
}

/// Semitones of a full turn of the wheel in MPE, while no other range is announced: of a note's own
/// channel, and of the one that bends all.
const MPE_RANGES: (f64, f64) = (48.0, 2.0);
/// The widest tuning of a note that is taken at its word, semitones: what CLAP's hosts may ask for.
const WIDEST: f64 = 120.0;
/// The channel that acts on all in MPE.
pub(super) const MANAGER: u8 = 0;

/// Whether MPE is announced by any of these events, which are in order of time.
pub(crate) fn announces_mpe(mut events: impl Iterator<Item = PlayerEvent>) -> bool {
    let mut manager = Channel::new(0.0);
    events.any(|event| match event {
        PlayerEvent::Controller { channel: MANAGER, number, value } => {
            manager.set_controller(number, seven_bits(value));
            manager.members.is_some_and(|members| members > 0)
        }
        _ => false,
    })
}

impl Performance {
    /// Whether channel 0 acts on the notes of all.
    pub(super) fn is_mpe(&self) -> bool {
        let announced = self.channels[usize::from(MANAGER)].members.is_some_and(|members| members > 0);
        self.input == InputMode::Mpe || (self.input == InputMode::Auto && announced)
    }

    /// Whether a pedal keeps the notes of a channel.
    pub(super) fn pedal(&self, channel: u8) -> bool {
        self.channels[usize::from(channel)].pedal
            || (self.is_mpe() && self.channels[usize::from(MANAGER)].pedal)
    }

    /// Whether a sostenuto pedal keeps what it has caught of a channel.
    fn sostenuto(&self, channel: u8) -> bool {
        self.channels[usize::from(channel)].sostenuto
            || (self.is_mpe() && self.channels[usize::from(MANAGER)].sostenuto)
    }

    /// Bend by the wheels that act on a channel, semitones.
    pub(super) fn bend(&self, channel: u8) -> f64 {
        let own = &self.channels[usize::from(channel)];
        if !self.is_mpe() {
            return own.bend(None);
        }
        let all = self.channels[usize::from(MANAGER)].bend(Some(MPE_RANGES.1));
        if channel == MANAGER { all } else { own.bend(Some(MPE_RANGES.0)) + all }
    }

    /// How notes of a channel are played, as its controllers have it, and in MPE those that act on all.
    pub(super) fn manner(&self, channel: u8) -> Manner {
        let own = self.channels[usize::from(channel)].manner;
        if channel == MANAGER || !self.is_mpe() {
            return own;
        }
        own.under(&self.channels[usize::from(MANAGER)].manner)
    }

    /// Changes a channel's state and carries the consequences to the strings.
    pub(super) fn control(
        &mut self,
        number: u8,
        change: impl Fn(&mut Channel) -> Request,
        out: &mut impl GestureSink,
    ) {
        let was_mpe = self.is_mpe();
        let Some(channel) = self.channels.get_mut(usize::from(number)) else { return };
        let before = channel.announced_reach();
        let request = change(channel);
        let reach = channel.announced_reach();
        let (time, mpe) = (self.now, self.is_mpe());
        let announces = mpe && number != MANAGER && reach != before;
        let acts_on_all = (mpe && number == MANAGER) || announces;
        if announces {
            // The reach of the wheel that one member announces is that of all.
            self.channels[usize::from(MANAGER) + 1..].iter_mut().for_each(|member| member.take_reach(reach));
        } else if acts_on_all {
            // Most messages say nothing of hands: what other channels have been told stays.
            self.channels[usize::from(MANAGER) + 1..].iter_mut().for_each(|member| member.hear(&change));
        }
        if mpe && !was_mpe {
            self.begin_mpe();
        }
        match request {
            Request::Capo(fret) => return self.set_capo(usize::from(fret)),
            Request::Switches(first) => return self.set_switches((first > 0).then_some(first)),
            Request::ReleaseKeys | Request::Silence => {
                // A keyswitch is a key, too.
                for own in &mut self.channels {
                    own.forced = own.forced.filter(|&(_, by)| by != number && !acts_on_all);
                }
                self.late.retain(|late| late.note.wanted.channel != number && !acts_on_all);
            }
            _ => {}
        }
        if matches!(request, Request::Press | Request::Swing | Request::Reset) {
            let manners: [Manner; CHANNELS] = std::array::from_fn(|channel| self.manner(channel as u8));
            let said = |own: u8| (own == number || acts_on_all).then(|| manners[usize::from(own)]);
            self.strings.iter_mut().for_each(|string| string.hear(request, said));
        }
        if matches!(request, Request::LetFall | Request::Reset) {
            let caught: [bool; CHANNELS] = std::array::from_fn(|channel| self.sostenuto(channel as u8));
            let fallen = |own: u8| (own == number || acts_on_all) && !caught[usize::from(own)];
            self.strings.iter_mut().for_each(|string| string.let_fall_under(fallen));
        }
        for index in 0..self.strings.len() {
            if matches!(request, Request::ReleaseKeys | Request::Silence) {
                self.strings[index].forget_under((!acts_on_all).then_some(number));
            }
            let Some(channel) = self.strings[index].channel().filter(|&own| own == number || acts_on_all)
            else {
                continue;
            };
            let (pedal, bend, manner) = (self.pedal(channel), self.bend(channel), self.manner(channel));
            let (articulation, caught) =
                (self.channels[usize::from(channel)].articulation, self.sostenuto(channel));
            let string = &mut self.strings[index];
            match request {
                Request::None | Request::Capo(_) | Request::Switches(_) => {}
                Request::Touch => string.set_touch(time, &articulation, out),
                Request::PedalUp if pedal => {}
                Request::PedalUp => string.pedal_up(time, channel, out),
                Request::Catch => string.catch(channel),
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
        if matches!(request, Request::Touch) {
            self.lay_palm(number, out);
        }
    }

    /// The palm of a channel waits for notes on strings where nobody plays: those of its last notes, and those that have had none.
    pub(super) fn lay_palm(&mut self, number: u8, out: &mut impl GestureSink) {
        let Some(channel) = self.channels.get(usize::from(number)) else { return };
        let (palm, by_strings) = (channel.articulation.palm, self.is_by_strings());
        for string in &mut self.strings {
            if !string.is_played() && string.channel().map_or(!by_strings, |own| own == number) {
                string.set_palm(self.now, palm, out);
            }
        }
    }

    /// From now on the first channel speaks for all, with what it has said before.
    pub(super) fn begin_mpe(&mut self) {
        let all = self.channels[usize::from(MANAGER)].articulation;
        for member in &mut self.channels[usize::from(MANAGER) + 1..] {
            member.articulation = member.articulation.under(&all);
        }
    }

    /// A note that has come back to a string has the wheel, the palm and the tremolo of its own channel.
    pub(super) fn welcome_back(&mut self, index: usize, out: &mut impl GestureSink) {
        let Some(channel) = self.strings[index].take_gone_back() else { return };
        let (time, bend) = (self.now, self.bend(channel));
        let articulation = self.channels[usize::from(channel)].articulation;
        self.strings[index].bend(time, channel, bend);
        self.strings[index].set_touch(time, &articulation, out);
    }

    /// A capo goes to a fret of all strings, 0 for none, as soon as each is played.
    pub(super) fn set_capo(&mut self, fret: usize) {
        self.hand.set_capo(fret);
        let fret = self.hand.capo();
        self.strings.iter_mut().for_each(|string| string.set_capo(fret));
    }

    /// Something changes about all notes of a channel and a key (`None`: of any).
    pub(super) fn express_all(
        &mut self,
        (channel, key): (Option<u8>, Option<u8>),
        expression: Expression,
        out: &mut impl GestureSink,
    ) {
        let meant = |one: Option<u8>, own: u8| one.is_none_or(|one| one == own);
        for (own, keys) in (0..).zip(self.keys()).filter(|&(own, _)| meant(channel, own)) {
            let known = (0..128).filter(|&own| keys >> own & 1 == 1 && meant(key, own));
            known.for_each(|key| self.express(own, key, expression, out));
        }
    }

    /// The keys of each channel that notes have which sound, begin or are yet to come, a bit for each.
    fn keys(&self) -> [u128; CHANNELS] {
        let mut keys = [0; CHANNELS];
        let waiting = self.chord.iter().chain(self.late.iter().map(|late| &late.note));
        let waiting = waiting.map(|note| (note.wanted.channel, note.wanted.key));
        for (channel, key) in self.strings.iter().flat_map(|string| string.keys()).chain(waiting) {
            if let Some(keys) = keys.get_mut(usize::from(channel)) {
                *keys |= 1u128.checked_shl(u32::from(key)).unwrap_or(0);
            }
        }
        keys
    }

    /// Something changes about one note.
    pub(super) fn express(
        &mut self,
        channel: u8,
        key: u8,
        expression: Expression,
        out: &mut impl GestureSink,
    ) {
        if !expression.amount().is_finite() {
            return;
        }
        // The latest note of the key: one that begins now, or waits for a string, before any that sounds.
        let late = self.late.iter_mut().filter(|late| late.key_down()).map(|late| &mut late.note);
        let note = self
            .chord
            .iter_mut()
            .chain(late)
            .find(|other| (other.wanted.channel, other.wanted.key) == (channel, key));
        if let Some(Unplaced { manner, own, .. }) = note {
            match expression {
                Expression::Tuning(semitones) => manner.tuning = f64::from(semitones).clamp(-WIDEST, WIDEST),
                Expression::Pressure(pressure) => manner.pressure = pressure_factor(pressure),
                Expression::Brightness(part) => {
                    own.brightness = (1.0 - 2.0 * f64::from(part).clamp(0.0, 1.0)) * BRIGHTNESS_REACH;
                }
                Expression::Vibrato(depth) => manner.vibrato = f64::from(depth).clamp(0.0, 1.0),
                Expression::PluckPlace(metres) => own.place = f64::from(metres),
                Expression::PluckForce(factor) => own.force = f64::from(factor).clamp(0.0, 100.0),
                Expression::FingerForce(factor) => manner.pressure = f64::from(factor).clamp(0.0, 100.0),
            }
            return;
        }
        let own = match expression {
            Expression::Tuning(semitones) => Own::Tuning(f64::from(semitones).clamp(-WIDEST, WIDEST)),
            Expression::Pressure(pressure) => Own::Pressure(pressure_factor(pressure)),
            Expression::FingerForce(factor) => Own::Pressure(f64::from(factor).clamp(0.0, 100.0)),
            Expression::Vibrato(depth) => Own::Vibrato(f64::from(depth).clamp(0.0, 1.0)),
            // It has been plucked already.
            Expression::Brightness(_) | Expression::PluckPlace(_) | Expression::PluckForce(_) => return,
        };
        // Rather where the key's note sounds than where it is down under another.
        let sounding = self.strings.iter().position(|string| string.is_of(channel, key));
        let under = || self.strings.iter().position(|string| string.sounds(channel, key));
        if let Some(string) = sounding.or_else(under) {
            self.strings[string].express(self.now, (channel, key), own, out);
        }
    }
}
