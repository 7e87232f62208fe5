//! What the hands are told to do with notes to come, beside their keys: strokes of the right hand, ways
//! of the left to stop a string, and what connects one note with the next.

use super::controller;

/// What the right hand does when a note begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Stroke {
    /// Plucks as the set-up says: a stroke of the plectrum towards the high strings.
    #[default]
    Down,
    /// A stroke back.
    Up,
    /// The one and the other in turn.
    Alternate,
    /// A finger pushes the string towards the board and comes to rest on its neighbour.
    Rest,
    /// The thumb is thrown at the string over the last frets.
    Slap,
    /// A finger hooks under the string and snaps it against the frets.
    Pop,
    /// The thumb grazes the string just after the plectrum, where a partial has a node.
    Pinch,
    /// None: the finger that stops the string also makes it sound.
    Tap,
}

impl Stroke {
    /// In the order of [`controller::STROKE`].
    const ALL: [Self; 8] =
        [Self::Down, Self::Up, Self::Alternate, Self::Rest, Self::Slap, Self::Pop, Self::Pinch, Self::Tap];

    /// By its number; anything else is the usual one.
    pub(crate) fn of(number: u8) -> Self {
        Self::ALL.get(usize::from(number)).copied().unwrap_or_default()
    }
}

/// How the left hand stops a string.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Stop {
    /// Behind a fret.
    #[default]
    Press,
    /// With a light finger at a node, which is soon gone: a harmonic.
    Harmonic,
    /// With a finger that rests on the string and keeps it from ringing.
    Mute,
    /// With a bar that touches no fret.
    Bar,
}

impl Stop {
    /// In the order of [`controller::STOP`].
    const ALL: [Self; 4] = [Self::Press, Self::Harmonic, Self::Mute, Self::Bar];

    /// By its number; anything else is the usual one.
    pub(crate) fn of(number: u8) -> Self {
        Self::ALL.get(usize::from(number)).copied().unwrap_or_default()
    }
}

/// How notes to come are played, as far as keys and velocities do not say it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Articulation {
    /// What the right hand does.
    pub stroke: Stroke,
    /// What the left hand does.
    pub stop: Stop,
    /// How hard the palm rests on the strings near the saddle, 0 (not at all) to 1.
    pub palm: f64,
    /// Whether overlapping notes on one string are connected by hammers and pulls.
    pub legato: bool,
    /// Whether they are connected by slides instead, also where nothing else connects them.
    pub slide: bool,
    /// How long a slide takes, s.
    pub slide_time: f64,
    /// How long the hand takes over all strings of a chord, s.
    pub strum: f64,
    /// How much harder a strum grows on its way, −1 to 1: the last string's force has this part more than
    /// the middle one's, the first string's less.
    pub accent: f64,
    /// Strokes a second of a tremolo, 0 for none.
    pub tremolo: f64,
}

impl Articulation {
    /// Nothing special.
    pub const PLAIN: Self = Self {
        stroke: Stroke::Down,
        stop: Stop::Press,
        palm: 0.0,
        legato: false,
        slide: false,
        slide_time: SLIDE_TIME.0,
        strum: 0.0,
        accent: 0.0,
        tremolo: 0.0,
    };

    /// Whether overlapping notes on one string are connected. Who switches portamento on, by itself, means that they slide.
    pub(crate) fn connects(&self) -> bool {
        self.legato || self.slide
    }

    /// This, under what another channel says for all: where that is nothing special, what has been told stays.
    pub(crate) fn under(&self, all: &Self) -> Self {
        fn told<T: PartialEq>(own: T, all: T, plain: T) -> T {
            if all == plain { own } else { all }
        }
        let plain = Self::PLAIN;
        Self {
            stroke: told(self.stroke, all.stroke, plain.stroke),
            stop: told(self.stop, all.stop, plain.stop),
            palm: told(self.palm, all.palm, plain.palm),
            legato: told(self.legato, all.legato, plain.legato),
            slide: told(self.slide, all.slide, plain.slide),
            slide_time: told(self.slide_time, all.slide_time, plain.slide_time),
            strum: told(self.strum, all.strum, plain.strum),
            accent: told(self.accent, all.accent, plain.accent),
            tremolo: told(self.tremolo, all.tremolo, plain.tremolo),
        }
    }

    /// Follows a controller (0 to 127), if it is one of these.
    pub(crate) fn set_controller(&mut self, number: u8, value: u8) {
        let part = f64::from(value) / 127.0;
        match number {
            controller::SLIDE_TIME => {
                self.slide_time = SLIDE_TIME.0 * libm::pow(SLIDE_TIME.1 / SLIDE_TIME.0, part)
            }
            controller::SLIDE => self.slide = value >= 64,
            controller::LEGATO => self.legato = value >= 64,
            controller::PALM => self.palm = part,
            controller::STRUM => self.strum = LONGEST_STRUM * part,
            controller::STROKE => self.stroke = Stroke::of(value),
            controller::STOP => self.stop = Stop::of(value),
            controller::ACCENT => self.accent = ((f64::from(value) - 64.0) / 63.0).max(-1.0),
            controller::TREMOLO if value == 0 => self.tremolo = 0.0,
            controller::TREMOLO => self.tremolo = TREMOLO.0 + (TREMOLO.1 - TREMOLO.0) * part,
            _ => {}
        }
    }

    /// Puts back what controllers 20 to 25 have set, or keyswitches of it.
    pub(crate) fn forget_hands(&mut self) {
        let Self { legato, slide, slide_time, .. } = *self;
        *self = Self { legato, slide, slide_time, ..Self::PLAIN };
    }

    /// Follows a keyswitch, counted from the first, if there is one of that number. Each takes the
    /// place of the one before; how long slides and strums take stays.
    pub(crate) fn switch(&mut self, number: u8) {
        let Self { slide_time, strum, accent, .. } = *self;
        let plain = Self { slide_time, strum, accent, ..Self::PLAIN };
        *self = match number {
            0 => plain,
            1 => Self { stroke: Stroke::Alternate, ..plain },
            2 => Self { stroke: Stroke::Rest, ..plain },
            3 => Self { palm: SWITCHED_PALM, ..plain },
            4 => Self { stroke: Stroke::Slap, ..plain },
            5 => Self { stroke: Stroke::Pop, ..plain },
            6 => Self { stroke: Stroke::Pinch, ..plain },
            7 => Self { stroke: Stroke::Tap, ..plain },
            8 => Self { stop: Stop::Harmonic, ..plain },
            9 => Self { stop: Stop::Mute, ..plain },
            10 => Self { legato: true, ..plain },
            11 => Self { legato: true, slide: true, ..plain },
            _ => *self,
        };
    }
}

/// Number of keyswitches for articulations; those for strings follow.
pub(crate) const SWITCHES: u8 = 12;

/// Shortest and longest slide, s; controller 5 at 0 and at 127, and by equal factors between.
const SLIDE_TIME: (f64, f64) = (0.03, 2.0);
/// Longest way of the hand over the strings of a chord, s.
const LONGEST_STRUM: f64 = 0.4;
/// Slowest and fastest tremolo, strokes a second.
const TREMOLO: (f64, f64) = (3.0, 20.0);
/// How hard the palm rests when a keyswitch lays it on.
const SWITCHED_PALM: f64 = 0.6;
