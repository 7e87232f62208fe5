//! What a host can set on the plugin: every identifier, unit and range, in this one place.
//!
//! The identifiers are part of every saved session: they never change their meaning, and none is ever
//! used for something else. What belongs to a set-up is given relative to it, as a factor or a shift,
//! so that another instrument needs no other values and 100 % is always as its maker meant it.

mod choices;

use nice_plug::prelude::*;

pub use choices::{InputChoice, InstrumentChoice, QualityChoice, RenderChoice};

use crate::engine::EngineOptions;
use crate::plugin::state::Marked;

/// Strings that have a tuning parameter of their own; those beyond stay as the set-up has them.
pub const TUNED_STRINGS: usize = 8;

/// Everything a host can set, automate and save, in the groups in which hosts show it.
#[derive(Params)]
pub struct LowActionParams {
    /// Whose state a session saves, and in which form.
    #[persist = "state"]
    pub mark: Marked,
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
    /// How much computing.
    #[id = "quality"]
    pub quality: EnumParam<QualityChoice>,
    /// How much computing when the host renders offline.
    #[id = "render_quality"]
    pub render_quality: EnumParam<RenderChoice>,
    /// Newton iterations at most in a sample; 0 is as many as the quality has.
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
    /// Factor of how long a pluck pushes.
    #[id = "pluck_duration"]
    pub pluck_duration: FloatParam,
    /// Power of the velocity with which the force goes.
    #[id = "velocity_curve"]
    pub velocity_curve: FloatParam,
    /// How much the place, force and time of each pluck vary, 0 (exact) to 1.
    #[id = "variation"]
    pub variation: FloatParam,
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
}

/// How notes and controllers are taken.
#[derive(Params)]
pub struct ControlParams {
    /// What channels mean.
    #[id = "input_mode"]
    pub input_mode: EnumParam<InputChoice>,
    /// Semitones of a full turn of the pitch wheel.
    #[id = "bend_range"]
    pub bend_range: IntParam,
    /// Whether a range announced by the keyboard or file (registered parameter 0) is passed over.
    #[id = "ignore_rpn"]
    pub ignore_rpn: BoolParam,
    /// Bends all strings at once, semitones.
    #[id = "tremolo_arm"]
    pub tremolo_arm: FloatParam,
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

/// Time over which a change of level is spread, ms: short enough to follow a fader, long enough not
/// to click.
const LEVEL_RAMP: f32 = 20.0;

/// Steps of factors and parts: what hosts send is rounded to these, and so the number meant in decimal
/// notation is recovered exactly.
const PART_STEP: f32 = 0.01;
/// Steps of lengths, mm, and of cents.
const FINE_STEP: f32 = 0.1;

impl Default for LowActionParams {
    fn default() -> Self {
        Self {
            mark: Marked,
            instrument: InstrumentParams::default(),
            setup: SetupParams::default(),
            strings: std::array::from_fn(StringParams::new),
            player: PlayerParams::default(),
            control: ControlParams::default(),
            output: OutputParams::default(),
        }
    }
}

impl Default for InstrumentParams {
    fn default() -> Self {
        Self {
            instrument: EnumParam::new("Instrument", InstrumentChoice::Electric),
            quality: EnumParam::new("Quality", QualityChoice::Live),
            render_quality: EnumParam::new("Offline quality", RenderChoice::Same),
            iterations: IntParam::new("Newton cap", 0, IntRange::Linear { min: 0, max: 200 })
                .with_value_to_string(std::sync::Arc::new(|cap| match cap {
                    0 => "as the quality".into(),
                    cap => cap.to_string(),
                }))
                .with_string_to_value(std::sync::Arc::new(|text| match text.trim().parse() {
                    Err(_) if text.contains("quality") => Some(0),
                    number => number.ok(),
                })),
            relax: BoolParam::new("Relax when late", true),
        }
    }
}

impl Default for SetupParams {
    fn default() -> Self {
        Self {
            action: factor("Action", 0.1, 3.0),
            relief: shift("Relief", -0.5, 2.0, " mm", FINE_STEP / 10.0),
            fret_height: factor("Fret height", 0.1, 3.0),
            loss_0: factor("Loss, all frequencies", 0.05, 20.0),
            loss_1: factor("Loss, high frequencies", 0.05, 20.0),
            tension_modulation: BoolParam::new("Tension modulation", true),
            pickup_position: shift("Pickup position", -120.0, 240.0, " mm", 1.0),
            pickup_blend: part("Pickup blend", 0.0),
            tuning: shift("Tuning", -100.0, 100.0, " cents", FINE_STEP),
        }
    }
}

impl StringParams {
    fn new(index: usize) -> Self {
        let name = format!("String {} tuning", index + 1);
        Self { tuning: shift(&name, -12.0, 7.0, " semitones", PART_STEP) }
    }
}

impl Default for PlayerParams {
    fn default() -> Self {
        Self {
            pluck_position: shift("Pluck position", -100.0, 200.0, " mm", 1.0)
                .with_poly_modulation_id(poly::PLUCK_POSITION),
            pluck_force: factor("Pluck force", 0.05, 5.0).with_poly_modulation_id(poly::PLUCK_FORCE),
            pluck_duration: factor("Pluck duration", 0.1, 5.0),
            velocity_curve: FloatParam::new("Velocity curve", 1.5, FloatRange::Linear { min: 0.0, max: 4.0 })
                .with_step_size(PART_STEP),
            variation: part("Variation", EngineOptions::VARIATION as f32),
            finger_force: factor("Finger force", 0.02, 4.0).with_poly_modulation_id(poly::FINGER_FORCE),
            finger_hardness: factor("Finger hardness", 0.01, 10.0),
            finger_mass: factor("Finger mass", 0.1, 10.0),
            finger_hover: factor("Finger hover", 0.0, 30.0),
            hand_damping: factor("Hand damping", 0.05, 5.0),
        }
    }
}

impl Default for ControlParams {
    fn default() -> Self {
        let range = EngineOptions::BEND_RANGE as i32;
        Self {
            input_mode: EnumParam::new("Input mode", InputChoice::Auto),
            bend_range: IntParam::new("Bend range", range, IntRange::Linear { min: 0, max: 96 })
                .with_unit(" semitones"),
            ignore_rpn: BoolParam::new("Ignore announced bend range", false),
            tremolo_arm: shift("Tremolo arm", -12.0, 3.0, " semitones", PART_STEP),
        }
    }
}

impl Default for OutputParams {
    fn default() -> Self {
        Self {
            // The step makes 0 dB survive the trip through the host's 0 to 1 exactly.
            level: FloatParam::new("Level", 0.0, FloatRange::Linear { min: -60.0, max: 12.0 })
                .with_step_size(FINE_STEP)
                .with_smoother(SmoothingStyle::Linear(LEVEL_RAMP))
                .with_unit(" dB"),
            bypass: BoolParam::new("Bypass", false).make_bypass(),
        }
    }
}

/// Identifiers of the parameters that a note can have for itself (CLAP's polyphonic modulation).
pub mod poly {
    /// Of [`super::PlayerParams::pluck_position`].
    pub const PLUCK_POSITION: u32 = 0;
    /// Of [`super::PlayerParams::pluck_force`].
    pub const PLUCK_FORCE: u32 = 1;
    /// Of [`super::PlayerParams::finger_force`].
    pub const FINGER_FORCE: u32 = 2;
}

/// A factor of what the set-up has, shown as a percentage; 100 % stands in the middle of the range.
fn factor(name: &str, min: f32, max: f32) -> FloatParam {
    FloatParam::new(name, 1.0, FloatRange::SymmetricalSkewed { min, max, factor: 1.0, center: 1.0 })
        .with_step_size(PART_STEP)
        .with_unit(" %")
        .with_value_to_string(formatters::v2s_f32_percentage(0))
        .with_string_to_value(formatters::s2v_f32_percentage())
}

/// A part from 0 to 1, shown as a percentage.
fn part(name: &str, default: f32) -> FloatParam {
    FloatParam::new(name, default, FloatRange::Linear { min: 0.0, max: 1.0 })
        .with_step_size(PART_STEP)
        .with_unit(" %")
        .with_value_to_string(formatters::v2s_f32_percentage(0))
        .with_string_to_value(formatters::s2v_f32_percentage())
}

/// Added to what the set-up has, 0 unless changed.
fn shift(name: &str, min: f32, max: f32, unit: &'static str, step: f32) -> FloatParam {
    FloatParam::new(name, 0.0, FloatRange::Linear { min, max }).with_step_size(step).with_unit(unit)
}

/// The value of a parameter as the number its decimal notation means, so that 0.3 set in a host and
/// 0.3 given on the command line are the same bits. No parameter has steps under a hundredth.
pub fn exact(param: &FloatParam) -> f64 {
    (f64::from(param.value()) * 1e3).round() / 1e3
}
