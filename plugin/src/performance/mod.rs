//! From notes to gestures: what a player makes of the music.
//!
//! [`Performance`] takes [`PlayerEvent`]s at sample times and hands out
//! [`low_action_dsp::TimedGesture`]s: which string and fret (`hand`), notes that begin together or take over
//! from one another (`chord`), what fingers and plucks a note takes from its start to its silence (`string`),
//! how hands are told to play (`articulation`, `switches`), what pedals, wheels and controllers say (`channel`, their numbers
//! in `controller`) and do to it (`control`, `key_up`, `channels`, `meaning`, `expressions`, `bend`), and how one pluck differs from
//! the next (`variation`). Beside the gestures it
//! tells what becomes of the notes ([`Annotation`]), for labels. There are no host types here, nothing is allocated after
//! construction, and the result depends only on the events and their times, not on how the time between them is cut
//! into blocks.

// What clippy.toml lists differs from machine to machine.
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod anew;
mod annotation;
mod announced;
mod articulation;
mod beginning;
mod bend;
mod channel;
mod channels;
mod chord;
mod compromises;
mod control;
pub mod controller;
mod event;
mod expressions;
mod fingers;
mod hand;
mod input_mode;
mod key_up;
mod meaning;
mod moment;
mod parameter;
mod played;
mod right_hand;
mod string;
mod switches;
mod technique;
mod touch;
mod variation;

use low_action_dsp::setup::Player;

use crate::controls::Touching;
pub use annotation::{
    Annotation, Excitation, NewNote, Pull, Stopped, Technique, TimedAnnotation, Unplayed, Why,
};
pub use announced::Announced;
use articulation::Stop;
use channel::Channel;
pub(crate) use channel::WIDEST_BEND_RANGE;
pub(crate) use channels::{Channels, Spoken, announced_members};
use chord::{JustBegun, Late, Unplaced};
pub use compromises::Compromises;
pub(crate) use control::{MPE_MANAGER, MPE_UPPER_MANAGER};
pub use event::{Expression, PlayerEvent, StringDeed};
pub use hand::{HIGHEST_CAPO, highest_capo};
use hand::{Hand, LARGEST_CHORD, Placement, Range, Use, Wanted};
pub use input_mode::InputMode;
pub use moment::GestureSink;
pub(crate) use moment::Moment;
pub(crate) use parameter::ChosenParameter;
pub use played::PlayedString;
use string::StringPlayer;
pub(crate) use switches::HIGHEST_FIRST;
pub use technique::VELOCITY_CURVE;
pub(crate) use technique::{LONGEST_WAIT, NEAREST_PLUCK};
use variation::Variation;

/// MIDI channels.
const CHANNELS: usize = 16;

/// How a performance is played.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// Size of the small differences between plucks, 0 (none) to 1.
    pub variation: f64,
    /// Which sequence of differences.
    pub seed: u64,
    /// Semitones of a full turn of the pitch wheel until a file or keyboard sets its own
    /// (registered parameter 0). A string bends no farther than its set-up leaves room for.
    pub bend_range: f64,
}

/// A player with an instrument in hand.
#[derive(Debug)]
pub struct Performance {
    strings: Vec<StringPlayer>,
    sample_rate: f64,
    channels: [Channel; CHANNELS],
    hand: Hand,
    /// How strings are stopped where nothing is said of it.
    usual_stop: Stop,
    variation: Variation,
    input: InputMode,
    /// The channels that others have begun to speak for, as in MPE, or ceased to, of which the strings have yet to hear; and those
    /// others.
    means_otherwise: Channels,
    spoke: Channels,
    /// The hands as the set-up has them.
    hands: Player,
    /// Length of the strings, m; of the shortest.
    scale: f64,
    touching: Touching,
    /// Whether fingers on the strings are another's, and act as that had them until they are next told how.
    taken_over: bool,
    compromises: Compromises,
    /// Notes that are not played, of which nobody has been told yet.
    unplayed: Vec<Unplayed>,
    /// Notes that began at `now` and are not placed yet.
    chord: Vec<Unplaced>,
    just_begun: JustBegun,
    /// Keys that go up, of channels, once the chord has been placed.
    releases: Vec<(u8, u8)>,
    /// Notes of a chord that wait until its strings are free.
    late: Vec<Late>,
    /// Whether the next stroke back and forth goes back.
    upward: bool,
    /// Whether the next notes are the first of the music once more.
    begins_anew: bool,
    /// First of the keys that are keyswitches, if any are.
    switches: Option<u8>,
    now: u64,
    // Scratch of `begin_chord`.
    wanted: Vec<Wanted>,
    uses: Vec<Use>,
    placements: Vec<Option<Placement>>,
}

impl Performance {
    /// A player who has touched nothing yet, with the hands the set-up describes. `strings` are in
    /// the instrument's order.
    pub fn new(strings: Vec<PlayedString>, hands: &Player, style: Style, sample_rate: f64) -> Self {
        let ranges = strings.iter().map(|PlayedString { geometry, coil, .. }| Range {
            open_pitch: geometry.open_pitch,
            frets: geometry.frets.len(),
            coil: coil.map(|from_saddle| from_saddle / geometry.length),
        });
        let count = strings.len();
        let barred = strings.iter().any(|string| string.barred);
        let lengths = strings.iter().map(|string| string.geometry.length);
        Self {
            scale: lengths.fold(f64::INFINITY, f64::min),
            hand: Hand::new(ranges.collect(), !barred),
            usual_stop: if barred { Stop::Bar } else { Stop::Press },
            strings: strings
                .into_iter()
                .enumerate()
                .map(|(index, string)| StringPlayer::new(index, string, hands.clone(), sample_rate))
                .collect(),
            sample_rate,
            channels: std::array::from_fn(|_| Channel::new(style.bend_range)),
            variation: Variation::new(style.variation, style.seed),
            input: InputMode::default(),
            means_otherwise: Channels::NONE,
            spoke: Channels::NONE,
            hands: hands.clone(),
            touching: Touching { take: style.seed, ..Touching::new(style.variation, style.bend_range) },
            taken_over: false,
            compromises: Compromises::default(),
            unplayed: Vec::with_capacity(2 * LARGEST_CHORD),
            chord: Vec::with_capacity(LARGEST_CHORD),
            just_begun: JustBegun::new(count),
            releases: Vec::with_capacity(LARGEST_CHORD),
            late: Vec::with_capacity(LARGEST_CHORD),
            upward: false,
            begins_anew: false,
            switches: None,
            now: 0,
            wanted: Vec::with_capacity(LARGEST_CHORD),
            uses: Vec::with_capacity(count),
            placements: Vec::with_capacity(LARGEST_CHORD),
        }
    }

    /// Takes an event at a sample time. Times never go back; an earlier one counts as the latest.
    pub fn event(&mut self, time: u64, event: PlayerEvent, out: &mut impl GestureSink) {
        let time = time.max(self.now);
        self.advance(time, out);
        self.follow_meaning(out);
        match event {
            PlayerEvent::NoteOn { channel, key, velocity } if velocity > 0.0 => {
                if self.press_switch(channel, key) {
                    self.lay_palms(self.switched_by(channel), out);
                } else {
                    self.release_before(channel, key, out);
                    self.strike(channel, key, f64::from(velocity.min(1.0)));
                }
            }
            PlayerEvent::NoteOn { channel, key, .. } | PlayerEvent::NoteOff { channel, key } => {
                self.release(channel, key, out);
            }
            PlayerEvent::NoteEnd { channel, key } => {
                if self.chord_needs(channel, key) {
                    self.begin_chord(out);
                }
                self.cut(channel, key, out);
            }
            PlayerEvent::KeysOff { channel } => {
                if self.chord.iter().any(|note| note.wanted.channel == channel) {
                    self.begin_chord(out);
                }
                self.release_keys(channel, out);
            }
            PlayerEvent::Controller { number, .. }
                if controller::is_of_hands(number) && !self.touching.hand_controllers => {}
            PlayerEvent::Controller { channel, number, value } => {
                if self.changes_chord(channel, number) {
                    self.begin_chord(out);
                }
                self.control(channel, |channel| channel.set_controller(number, seven_bits(value)), out);
            }
            PlayerEvent::PitchBend { channel, value } => {
                self.control(channel, |channel| channel.set_wheel(value), out);
            }
            PlayerEvent::ChannelPressure { channel, pressure } => {
                self.control(channel, |channel| channel.set_pressure(pressure), out);
            }
            PlayerEvent::Note { channel, key, expression } => self.express(channel, key, expression, out),
            PlayerEvent::Notes { channel, key, expression } => {
                self.express_all((channel, key), expression, out);
            }
            PlayerEvent::Touched { string, deed } => {
                self.begin_chord(out);
                if let Some(string) = self.strings.get_mut(usize::from(string)) {
                    string.undergo(time, deed, out);
                }
            }
            PlayerEvent::AllNotesOff => {
                self.begin_chord(out);
                self.leave_out_late(|_| true);
                self.force_none();
                for string in &mut self.strings {
                    string.silence(time, None);
                }
                self.channels.iter_mut().for_each(Channel::forget_pedals);
                self.go_back_to_the_beginning();
            }
        }
        self.tell_unplayed(out);
    }

    /// Does everything that falls due before sample `until`. Events at `until` and later may still
    /// follow.
    pub fn advance(&mut self, until: u64, out: &mut impl GestureSink) {
        if until > self.now {
            self.follow_meaning(out);
            self.begin_chord(out);
            self.begin_late(until, out);
            self.advance_strings(until, out);
            self.tell_unplayed(out);
        }
    }

    /// Tells of notes that are not played.
    fn tell_unplayed(&mut self, out: &mut impl GestureSink) {
        self.unplayed.drain(..).for_each(|note| out.unplayed(note));
    }

    fn advance_strings(&mut self, until: u64, out: &mut impl GestureSink) {
        for string in &mut self.strings {
            string.advance(until, out);
            self.compromises.bent_short += string.take_bent_short();
            self.compromises.overtaken += string.take_overtaken();
            self.compromises.left_out += string.take_called_off();
        }
        self.now = until;
    }

    /// Whether a string sounds a key of a channel, held or kept by a pedal.
    pub fn sounds(&self, channel: u8, key: u8) -> bool {
        self.strings.iter().any(|string| string.sounds(channel, key))
    }

    /// Whether a key of a channel, still down, waits for a string.
    pub fn awaits(&self, channel: u8, key: u8) -> bool {
        self.late.iter().any(|late| late.key_down() && late.is(channel, key))
    }

    /// Whether notes are yet to come that wait for strings.
    pub fn is_behind(&self) -> bool {
        !self.late.is_empty()
    }

    /// What could not be played as written so far.
    pub fn compromises(&self) -> Compromises {
        self.compromises
    }
}

/// A controller's value as MIDI sends it, 0 to 127; not a number counts as 0.
fn seven_bits(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 127.0).round() as u8
}
