//! What a host can set on the plugin: every identifier, unit and range, in this one place.
//!
//! The identifiers are part of every saved session: they never change their meaning, and none is ever
//! used for something else. What belongs to a set-up is given relative to it, as a factor or a shift,
//! so that another instrument needs no other values and 100 % is always as its maker meant it.

mod choices;
pub(crate) mod idle;
mod ranges;
pub(crate) mod settings;
mod start;
pub mod words;

use nice_plug::prelude::*;

pub use choices::{InputChoice, InstrumentChoice, LegatoChoice, QualityChoice, RenderChoice, StringOrder};
pub use ranges::{exact, exact_without_modulation, poly};
pub use settings::Setting;
pub(crate) use start::start;
pub use start::{Start, begin_with};

use crate::plugin::layout::Layout;
use crate::plugin::shelf::Shelf;
use crate::plugin::state::Marked;

/// Strings that have a tuning parameter of their own; those beyond stay as the set-up has them.
pub const TUNED_STRINGS: usize = 8;

/// Everything a host can set, automate and save, in the groups in which hosts show it.
#[derive(Params)]
pub struct LowActionParams {
    /// Whose state a session saves, and in which form.
    #[persist = "state"]
    pub mark: Marked,
    /// The user's own set-ups; a session saves the one that is played.
    #[persist = "instrument_file"]
    pub shelf: Shelf,
    /// How the editor was left.
    #[persist = "editor"]
    pub layout: Layout,
    /// What is played, and how exactly.
    #[nested(group = "Instrument")]
    pub instrument: InstrumentParams,
    /// What a luthier can change.
    #[nested(group = "Set-up")]
    pub setup: SetupParams,
    /// The pitch of each string.
    #[nested(array, group = "Strings")]
    pub strings: [StringParams; TUNED_STRINGS],
    /// How the hands act.
    #[nested(group = "Player")]
    pub player: PlayerParams,
    /// How notes and controllers are taken.
    #[nested(group = "Control")]
    pub control: ControlParams,
    /// What becomes of the sound.
    #[nested(group = "Output")]
    pub output: OutputParams,
}

/// What is played, and how exactly.
#[derive(Params)]
pub struct InstrumentParams {
    /// The instrument.
    #[id = "instrument"]
    pub instrument: EnumParam<InstrumentChoice>,
    /// The number of a set-up file of the user's that is played instead, 0 for none.
    #[id = "instrument_file"]
    pub file: IntParam,
    /// How much computing.
    #[id = "quality"]
    pub quality: EnumParam<QualityChoice>,
    /// How much computing when the host renders offline.
    #[id = "render_quality"]
    pub render_quality: EnumParam<RenderChoice>,
    /// Newton iterations at most in a solution; 0 is as many as the quality has.
    #[id = "iterations"]
    pub iterations: IntParam,
    /// Whether contacts may be solved less exactly, in real time only, when there is not time enough.
    #[id = "relax"]
    pub relax: BoolParam,
}

/// What a luthier can change. Each of these compiles the strings anew, beside the audio thread, and puts
/// them under the ringing ones.
#[derive(Params)]
pub struct SetupParams {
    /// Factor of the height of the strings over the frets, at fret 1 and 12 alike.
    #[id = "action"]
    pub action: FloatParam,
    /// Added to the relief, mm; together at least 0.
    #[id = "relief"]
    pub relief: FloatParam,
    /// Factor of the height of the frets over the board.
    #[id = "fret_height"]
    pub fret_height: FloatParam,
    /// Factor of the loss of all frequencies alike.
    #[id = "loss_0"]
    pub loss_0: FloatParam,
    /// Factor of the loss that grows with frequency.
    #[id = "loss_1"]
    pub loss_1: FloatParam,
    /// Whether stretching raises the tension.
    #[id = "tension_modulation"]
    pub tension_modulation: BoolParam,
    /// Moves the coil away from the saddle, mm, as far as the string goes.
    #[id = "pickup_position"]
    pub pickup_position: FloatParam,
    /// How much of the other kind of pickup is heard; a set-up's own blend is the least.
    #[id = "pickup_blend"]
    pub pickup_blend: FloatParam,
    /// Raises all strings, cents; keys keep their frets.
    #[id = "tuning"]
    pub tuning: FloatParam,
}

/// One string.
#[derive(Params)]
pub struct StringParams {
    /// Raises the open string, semitones; keys find their pitch on another fret.
    #[id = "string_tuning"]
    pub tuning: FloatParam,
}

/// How the hands act, from the next pluck on.
#[derive(Params)]
pub struct PlayerParams {
    /// Moves the pluck away from the saddle, mm.
    #[id = "pluck_position"]
    pub pluck_position: FloatParam,
    /// Factor of the hardest pluck's force.
    #[id = "pluck_force"]
    pub pluck_force: FloatParam,
    /// The softest pluck's force, as a part of the hardest one's.
    #[id = "pluck_softest"]
    pub pluck_softest: FloatParam,
    /// Factor of how long a pluck pushes.
    #[id = "pluck_duration"]
    pub pluck_duration: FloatParam,
    /// Adds to how long a pluck takes to let go, ms.
    #[id = "pluck_release"]
    pub pluck_release: FloatParam,
    /// Power of the velocity with which the force goes.
    #[id = "velocity_curve"]
    pub velocity_curve: FloatParam,
    /// How much the place, force and time of each pluck vary, 0 (exact) to 1.
    #[id = "variation"]
    pub variation: FloatParam,
    /// Which sequence of those differences: N is that of `render --seed N`.
    #[id = "take"]
    pub take: IntParam,
    /// Factor of the force of the finger that stops a string.
    #[id = "finger_force"]
    pub finger_force: FloatParam,
    /// Factor of the stiffness of its pad.
    #[id = "finger_hardness"]
    pub finger_hardness: FloatParam,
    /// Factor of its mass.
    #[id = "finger_mass"]
    pub finger_mass: FloatParam,
    /// Factor of the height from which it comes.
    #[id = "finger_hover"]
    pub finger_hover: FloatParam,
    /// Factor of the damping of the hand behind it.
    #[id = "hand_damping"]
    pub hand_damping: FloatParam,
    /// Factor of how much hands take of strings that nobody plays.
    #[id = "idle_hands"]
    pub idle_hands: FloatParam,
}

/// How notes and controllers are taken.
#[derive(Params)]
pub struct ControlParams {
    /// What channels mean.
    #[id = "input_mode"]
    pub input_mode: EnumParam<InputChoice>,
    /// The lowest channel, 1 to 16, that is a string's where each channel is a string.
    #[id = "first_channel"]
    pub first_channel: IntParam,
    /// Whose channel that is.
    #[id = "string_order"]
    pub string_order: EnumParam<StringOrder>,
    /// Semitones of a full turn of the pitch wheel.
    #[id = "bend_range"]
    pub bend_range: IntParam,
    /// Whether a range announced by the keyboard or file (registered parameter 0) is passed over.
    #[id = "ignore_rpn"]
    pub ignore_rpn: BoolParam,
    /// Bends all strings at once, semitones.
    #[id = "tremolo_arm"]
    pub tremolo_arm: FloatParam,
    /// When overlapping notes on one string are connected.
    #[id = "legato"]
    pub legato: EnumParam<LegatoChoice>,
    /// The first of the keys that tell the hands how to play, −1 for none.
    #[id = "keyswitches"]
    pub keyswitches: IntParam,
    /// The fret that the left hand plays about, 0 for wherever it has the least to move.
    #[id = "hand_position"]
    pub hand_position: IntParam,
    /// The fret of a capo on all strings, 0 for none.
    #[id = "capo"]
    pub capo: IntParam,
    /// Whether the hands listen to controllers 20 to 28.
    #[id = "hand_controllers"]
    pub hand_controllers: BoolParam,
}

/// What becomes of the sound.
#[derive(Params)]
pub struct OutputParams {
    /// Gain of the output, dB. At 0 dB the samples pass untouched.
    #[id = "level"]
    pub level: FloatParam,
    /// Silences the output; the strings go on.
    #[id = "bypass"]
    pub bypass: BoolParam,
}
