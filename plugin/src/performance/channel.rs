//! What one MIDI channel remembers: its pedals, its wheel and how far that reaches, and what its
//! controllers say of notes to come.

use super::articulation::Articulation;
use super::controller;
use super::parameter::ChosenParameter;
use super::string::Manner;
use super::technique::{BRIGHTNESS_REACH, FIRMEST};

/// Farthest a wheel may be asked to reach, by whom ever, semitones.
pub(crate) const WIDEST_BEND_RANGE: f64 = 96.0;

/// State of one channel.
#[derive(Debug, Clone)]
pub(crate) struct Channel {
    /// Whether the sustain pedal is down.
    pub pedal: bool,
    /// Whether the sostenuto pedal is down.
    pub sostenuto: bool,
    /// How its notes are played.
    pub manner: Manner,
    /// What the hands are told to do with them.
    pub articulation: Articulation,
    /// The string that a keyswitch asks for while it is down, and the channel that struck it.
    pub forced: Option<(usize, u8)>,
    /// Expression and breath, each a factor of the pluck's force.
    swell: [f64; 2],
    /// Whether an announced reach of the wheel is passed over.
    ignores_range: bool,
    /// Channels of MPE announced (registered parameter 6), if they were.
    pub members: Option<u8>,
    /// Position of the wheel, −1 to 1.
    wheel: f64,
    /// Reach of the wheel when set up, semitones.
    usual_range: f64,
    /// Reach of the wheel now: whole semitones and hundredths.
    range: (f64, f64),
    /// Whether that was announced: what is announced counts in MPE, too, even if it is what was set up.
    announced: bool,
    /// The registered parameter that data entry sets.
    parameter: ChosenParameter,
}

/// What a controller asks of the strings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Request {
    /// Nothing.
    None,
    /// So many channels as it has now are members of MPE.
    Members,
    /// The pedal went up: notes it kept must stop.
    PedalUp,
    /// The sostenuto pedal went down: it keeps what sounds.
    Catch,
    /// It went up.
    LetFall,
    /// Fingers press harder or less hard.
    Press,
    /// The vibrato changed.
    Swing,
    /// The wheel's pitch changed.
    Bend,
    /// The palm presses more or less, or the tremolo is faster or slower.
    Touch,
    /// A capo goes to this fret of all strings, 0 for none.
    Capo(u8),
    /// Keyswitches begin at this key, 0 for none.
    Switches(u8),
    /// The left hand plays about this fret, 0 for wherever it has the least to move.
    Hand(u8),
    /// Keys are to be let go of; the pedal goes on holding.
    ReleaseKeys,
    /// Silence at once, pedal or not.
    Silence,
    /// The pedal went up and the wheel to its middle.
    Reset,
}

impl Channel {
    /// A channel at rest whose wheel reaches `range` semitones each way.
    pub(crate) fn new(range: f64) -> Self {
        Self {
            pedal: false,
            sostenuto: false,
            manner: Manner::PLAIN,
            articulation: Articulation::PLAIN,
            forced: None,
            swell: [1.0; 2],
            ignores_range: false,
            members: None,
            wheel: 0.0,
            usual_range: range,
            range: (range, 0.0),
            announced: false,
            parameter: ChosenParameter::NONE,
        }
    }

    /// The wheel reaches so far from now on, semitones, until the file or keyboard announces another
    /// reach; that is passed over if `ignores_announced`.
    pub(crate) fn set_range(&mut self, range: f64, ignores_announced: bool) {
        if range != self.usual_range || ignores_announced != self.ignores_range {
            self.usual_range = range;
            self.ignores_range = ignores_announced;
            self.range = (range, 0.0);
            self.announced = false;
        }
    }

    /// The reach while nothing is announced, semitones: another one in MPE.
    pub(crate) fn reach(&self, mpe: Option<f64>) -> (f64, f64) {
        match mpe {
            Some(reach) if !self.announced => (reach, 0.0),
            _ => self.range,
        }
    }

    /// The reach that was announced, semitones and hundredths, if one was.
    pub(crate) fn announced_reach(&self) -> Option<(f64, f64)> {
        self.announced.then_some(self.range)
    }

    /// Takes over a reach that another channel has announced for all, or this one before.
    pub(crate) fn take_reach(&mut self, announced: Option<(f64, f64)>) {
        if let Some(range) = announced.filter(|_| !self.ignores_range) {
            (self.range, self.announced) = (range, true);
        }
    }

    /// Nothing is announced of its reach.
    pub(crate) fn forget_reach(&mut self) {
        (self.range, self.announced) = ((self.usual_range, 0.0), false);
    }

    /// No pedal holds anything any more, wherever it stands: what is pressed next goes down anew.
    pub(crate) fn forget_pedals(&mut self) {
        (self.pedal, self.sostenuto) = (false, false);
    }

    /// Back to rest.
    pub(crate) fn reset(&mut self) {
        *self = Self { ignores_range: self.ignores_range, ..Self::new(self.usual_range) };
    }

    /// Present bend, semitones.
    pub(crate) fn bend(&self, mpe: Option<f64>) -> f64 {
        let (semitones, cents) = self.reach(mpe);
        self.wheel * (semitones + 0.01 * cents)
    }

    /// What a message for all says of hands is said to its own, too.
    pub(crate) fn hear(&mut self, message: impl Fn(&mut Self) -> Request) {
        let mut heard = Self { articulation: self.articulation, ..Self::new(self.usual_range) };
        message(&mut heard);
        self.articulation = heard.articulation;
    }

    /// A channel's pressure, 0 to 1.
    pub(crate) fn set_pressure(&mut self, pressure: f32) -> Request {
        self.manner.pressure = pressure_factor(pressure);
        Request::Press
    }

    /// Moves the wheel; anything but a number is ignored.
    pub(crate) fn set_wheel(&mut self, value: f32) -> Request {
        if value.is_nan() {
            return Request::None;
        }
        self.wheel = f64::from(value.clamp(-1.0, 1.0));
        Request::Bend
    }

    /// Moves a controller (value 0 to 127).
    pub(crate) fn set_controller(&mut self, number: u8, value: u8) -> Request {
        self.parameter.hear(number, value);
        match number {
            controller::VIBRATO => {
                self.manner.vibrato = f64::from(value) / 127.0;
                Request::Swing
            }
            controller::BREATH | controller::EXPRESSION => {
                self.swell[usize::from(number == controller::BREATH)] = f64::from(value) / 127.0;
                self.manner.force = self.swell[0] * self.swell[1];
                Request::None
            }
            controller::SOSTENUTO => {
                let was_down = std::mem::replace(&mut self.sostenuto, value >= 64);
                match (was_down, self.sostenuto) {
                    (false, true) => Request::Catch,
                    (true, false) => Request::LetFall,
                    _ => Request::None,
                }
            }
            controller::BRIGHTNESS => {
                self.manner.place = (64.0 - f64::from(value)) / 64.0 * BRIGHTNESS_REACH;
                Request::None
            }
            controller::DATA_ENTRY | controller::DATA_ENTRY_LOWER => self.enter_data(number, value),
            controller::PEDAL => {
                let was_down = std::mem::replace(&mut self.pedal, value >= 64);
                if was_down && !self.pedal { Request::PedalUp } else { Request::None }
            }
            controller::PALM | controller::TREMOLO => {
                self.articulation.set_controller(number, value);
                Request::Touch
            }
            controller::CAPO => Request::Capo(value),
            controller::SWITCHES => Request::Switches(value),
            controller::HAND => Request::Hand(value),
            controller::SILENCE => Request::Silence,
            // Reset all controllers leaves the wheel's reach and sound controllers, 70 to 79, alone (MIDI recommended practice 15).
            controller::RESET => {
                self.pedal = false;
                self.sostenuto = false;
                self.manner = Manner { place: self.manner.place, ..Manner::PLAIN };
                self.articulation = Articulation::PLAIN;
                self.swell = [1.0; 2];
                self.wheel = 0.0;
                Request::Reset
            }
            controller::KEYS_OFF..=controller::LAST => Request::ReleaseKeys,
            _ => {
                self.articulation.set_controller(number, value);
                Request::None
            }
        }
    }

    /// Takes the upper or the lower half of what the chosen parameter is set to.
    fn enter_data(&mut self, half: u8, value: u8) -> Request {
        match (self.parameter.number(), half) {
            // So many member channels, 0 for none.
            (Some(ChosenParameter::MEMBERS), controller::DATA_ENTRY) => {
                self.members = Some(value.min(15));
                return Request::Members;
            }
            _ if self.ignores_range => return Request::None,
            (Some(ChosenParameter::WHEEL), controller::DATA_ENTRY) => {
                self.range = (f64::from(value).min(WIDEST_BEND_RANGE), 0.0);
            }
            (Some(ChosenParameter::WHEEL), _) => self.range.1 = f64::from(value).min(99.0),
            _ => return Request::None,
        }
        self.announced = true;
        Request::Bend
    }
}

/// The factor of a finger's force for a pressure of 0 to 1; anything but a number counts as none.
pub(crate) fn pressure_factor(pressure: f32) -> f64 {
    1.0 + (FIRMEST - 1.0) * f64::from(pressure.clamp(0.0, 1.0).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wheel_follows_its_announced_range() {
        let mut channel = Channel::new(2.0);
        channel.set_wheel(-0.5);
        assert_eq!(channel.bend(None), -1.0);
        for (number, value) in [(101, 0), (100, 0), (6, 12), (38, 50)] {
            channel.set_controller(number, value);
        }
        assert_eq!(channel.bend(None), -6.25);
        // A parameter of some maker's own must not change it.
        for (number, value) in [(99, 0), (98, 0), (6, 1)] {
            channel.set_controller(number, value);
        }
        assert_eq!(channel.bend(None), -6.25);
    }

    #[test]
    fn what_is_announced_counts_in_mpe_whatever_was_set_up() {
        let mut channel = Channel::new(2.0);
        channel.set_wheel(1.0);
        assert_eq!(channel.bend(Some(48.0)), 48.0);
        for (number, value) in [(101, 0), (100, 0), (6, 2)] {
            channel.set_controller(number, value);
        }
        assert_eq!(channel.bend(Some(48.0)), 2.0);
        // Passed over if that is asked for.
        channel.set_range(2.0, true);
        channel.set_controller(6, 12);
        assert_eq!(channel.bend(Some(48.0)), 48.0);
    }

    #[test]
    fn only_a_pedal_that_was_down_goes_up() {
        let mut channel = Channel::new(2.0);
        assert_eq!(channel.set_controller(64, 0), Request::None);
        assert_eq!(channel.set_controller(64, 64), Request::None);
        assert_eq!(channel.set_controller(64, 127), Request::None);
        assert_eq!(channel.set_controller(64, 63), Request::PedalUp);
    }
}
