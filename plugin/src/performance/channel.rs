//! What one MIDI channel remembers: its pedal, its wheel, and how far the wheel reaches.

/// Farthest a file or keyboard may set its wheel's reach to, semitones.
const WIDEST_RANGE: f64 = 96.0;

/// A parameter number with nothing behind it: both halves 127.
const NO_PARAMETER: (u8, u8) = (127, 127);

/// State of one channel.
#[derive(Debug, Clone)]
pub(crate) struct Channel {
    /// Whether the sustain pedal is down.
    pub pedal: bool,
    /// Position of the wheel, −1 to 1.
    wheel: f64,
    /// Reach of the wheel when set up, semitones.
    usual_range: f64,
    /// Reach of the wheel now: whole semitones and hundredths.
    range: (f64, f64),
    /// The registered parameter that data entry sets: upper and lower half.
    parameter: (u8, u8),
}

/// What a controller asks of the strings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Request {
    /// Nothing.
    None,
    /// The pedal went up: notes it kept must stop.
    PedalUp,
    /// The wheel's pitch changed.
    Bend,
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
        Self { pedal: false, wheel: 0.0, usual_range: range, range: (range, 0.0), parameter: NO_PARAMETER }
    }

    /// Back to rest.
    pub(crate) fn reset(&mut self) {
        *self = Self::new(self.usual_range);
    }

    /// Present bend, semitones.
    pub(crate) fn bend(&self) -> f64 {
        self.wheel * (self.range.0 + 0.01 * self.range.1)
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
        match number {
            // Data entry: the reach of the wheel is registered parameter 0, in semitones and cents.
            6 if self.parameter == (0, 0) => {
                self.range = (f64::from(value).min(WIDEST_RANGE), 0.0);
                Request::Bend
            }
            38 if self.parameter == (0, 0) => {
                self.range.1 = f64::from(value).min(99.0);
                Request::Bend
            }
            64 => {
                let was_down = std::mem::replace(&mut self.pedal, value >= 64);
                if was_down && !self.pedal { Request::PedalUp } else { Request::None }
            }
            // A non-registered parameter takes data entry away from the registered one.
            98 | 99 => {
                self.parameter = NO_PARAMETER;
                Request::None
            }
            100 => {
                self.parameter.1 = value;
                Request::None
            }
            101 => {
                self.parameter.0 = value;
                Request::None
            }
            120 => Request::Silence,
            // Reset all controllers leaves the wheel's reach alone (MIDI recommended practice 15).
            121 => {
                self.pedal = false;
                self.wheel = 0.0;
                self.parameter = NO_PARAMETER;
                Request::Reset
            }
            // All notes off, and the four mode messages that imply it.
            123..=127 => Request::ReleaseKeys,
            _ => Request::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wheel_follows_its_announced_range() {
        let mut channel = Channel::new(2.0);
        channel.set_wheel(-0.5);
        assert_eq!(channel.bend(), -1.0);
        for (number, value) in [(101, 0), (100, 0), (6, 12), (38, 50)] {
            channel.set_controller(number, value);
        }
        assert_eq!(channel.bend(), -6.25);
        // A parameter of some maker's own must not change it.
        for (number, value) in [(99, 0), (98, 0), (6, 1)] {
            channel.set_controller(number, value);
        }
        assert_eq!(channel.bend(), -6.25);
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
