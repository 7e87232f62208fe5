//! Names, ranges, units and usual values of the parameters.

mod numbers;

use std::sync::Arc;

use low_action_dsp::neck::Neck;
use nice_plug::prelude::*;

pub(super) use numbers::number;
use numbers::{reads, signed, whole};

use super::settings;
use super::start::{Start, start};
use super::{
    ControlParams, InputChoice, InstrumentParams, LegatoChoice, LowActionParams, OutputParams, PlayerParams,
    QualityChoice, RenderChoice, SetupParams, StringOrder, StringParams,
};
use crate::engine::EngineOptions;
use crate::performance::{HIGHEST_CAPO, HIGHEST_FIRST};
use crate::plugin::shelf::{MOST_FILES, Shelf};
use crate::plugin::state::Marked;

/// Time over which a change of level is spread, ms: short enough to follow a fader, long enough not
/// to click.
const LEVEL_RAMP: f32 = 20.0;

/// The last take: more than anybody plays of one part, and few enough to be typed.
const MOST_TAKES: i32 = 9_999;

/// Steps of factors and parts: what hosts send is rounded to these, and so the number meant in decimal
/// notation is recovered exactly.
const PART_STEP: f32 = 0.01;
/// Steps of lengths, mm, and of cents.
const FINE_STEP: f32 = 0.1;

impl Default for LowActionParams {
    fn default() -> Self {
        Self::new(Shelf::of_user(), &start())
    }
}

impl LowActionParams {
    /// Everything as usual but for the start, with such files of the user's.
    pub(crate) fn new(shelf: Shelf, start: &Start) -> Self {
        let new = Self {
            mark: Marked,
            layout: start.layout.clone(),
            instrument: InstrumentParams::new(&shelf, start),
            shelf,
            setup: SetupParams::default(),
            strings: std::array::from_fn(StringParams::new),
            player: PlayerParams::default(),
            control: ControlParams::default(),
            output: OutputParams::default(),
        };
        settings::apply(&new, &start.settings);
        new
    }
}

impl InstrumentParams {
    fn new(shelf: &Shelf, start: &Start) -> Self {
        let number = start.file.as_ref().map_or(0, |(name, text)| shelf.keep(name, text) as i32);
        let [chosen, titled, numbered] = std::array::from_fn(|_| shelf.clone());
        Self {
            instrument: EnumParam::new("Instrument", start.instrument),
            // What a number means depends on the folder, so nothing should move it by itself.
            file: IntParam::new(
                "Instrument file",
                number,
                IntRange::Linear { min: 0, max: MOST_FILES as i32 },
            )
            .non_automatable()
            .with_callback(Arc::new(move |number| chosen.choose(number.unsigned_abs())))
            .with_value_to_string(Arc::new(move |number| titled.title(number.unsigned_abs())))
            .with_string_to_value(Arc::new(move |title| numbered.number(title))),
            quality: EnumParam::new("Quality", QualityChoice(start.quality)),
            render_quality: EnumParam::new("Offline quality", RenderChoice::default()),
            iterations: number_or("as the quality", "Newton cap", 0, 200),
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
            pluck_softest: part("Softest pluck", 0.0),
            pluck_duration: factor("Pluck duration", 0.1, 5.0),
            pluck_release: shift("Pluck release", -1.0, 4.0, " ms", PART_STEP),
            velocity_curve: FloatParam::new("Velocity curve", 1.5, FloatRange::Linear { min: 0.0, max: 4.0 })
                .with_step_size(PART_STEP)
                .with_string_to_value(Arc::new(reads(""))),
            variation: part("Variation", EngineOptions::VARIATION as f32),
            take: IntParam::new("Take", 0, IntRange::Linear { min: 0, max: MOST_TAKES })
                .with_string_to_value(Arc::new(|text| whole(text, ""))),
            finger_force: factor("Finger force", 0.02, 4.0).with_poly_modulation_id(poly::FINGER_FORCE),
            finger_hardness: factor("Finger hardness", 0.01, 10.0),
            finger_mass: factor("Finger mass", 0.1, 10.0),
            finger_hover: factor("Finger hover", 0.0, 30.0),
            hand_damping: factor("Hand damping", 0.05, 5.0),
            idle_hands: factor("Idle hands", 0.0, 20.0),
        }
    }
}

impl Default for ControlParams {
    fn default() -> Self {
        let range = EngineOptions::BEND_RANGE as i32;
        let reach = IntRange::Linear { min: 0, max: EngineOptions::WIDEST_BEND_RANGE as i32 };
        Self {
            input_mode: EnumParam::new("Input mode", InputChoice::Auto),
            first_channel: IntParam::new("First channel", 1, IntRange::Linear { min: 1, max: 16 }),
            string_order: EnumParam::new("String order", StringOrder::FirstFirst),
            bend_range: IntParam::new("Bend range", range, reach)
                .with_unit(" semitones")
                .with_string_to_value(Arc::new(|text| whole(text, "semitones"))),
            ignore_rpn: BoolParam::new("Ignore announced bend range", false),
            tremolo_arm: shift("Tremolo arm", -12.0, 3.0, " semitones", PART_STEP),
            legato: EnumParam::new("Legato", LegatoChoice::Pedal),
            keyswitches: number_or("off", "Keyswitches from key", -1, HIGHEST_FIRST.into()),
            hand_position: number_or("anywhere", "Hand position", 0, Neck::MOST_FRETS as i32),
            capo: number_or("none", "Capo", 0, HIGHEST_CAPO as i32),
            hand_controllers: BoolParam::new("Hands by CC 20 to 28", true),
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
                .with_unit(" dB")
                .with_string_to_value(Arc::new(reads("dB"))),
            bypass: BoolParam::new("Bypass", false).make_bypass(),
        }
    }
}

/// Identifiers of the parameters that a note can have for itself (CLAP's polyphonic modulation).
pub mod poly {
    /// Of [`crate::params::PlayerParams::pluck_position`].
    pub const PLUCK_POSITION: u32 = 0;
    /// Of [`crate::params::PlayerParams::pluck_force`].
    pub const PLUCK_FORCE: u32 = 1;
    /// Of [`crate::params::PlayerParams::finger_force`].
    pub const FINGER_FORCE: u32 = 2;
    /// How many there are, from 0 on.
    pub const COUNT: usize = 3;
}

/// A whole number that has a word in the place of the least, which is also usual. The last of several words is enough of it.
fn number_or(word: &'static str, name: &str, least: i32, most: i32) -> IntParam {
    let enough = word.rsplit(' ').next().unwrap_or(word);
    IntParam::new(name, least, IntRange::Linear { min: least, max: most })
        .with_value_to_string(Arc::new(move |number| match number {
            number if number <= least => word.into(),
            number => number.to_string(),
        }))
        .with_string_to_value(Arc::new(move |text| {
            if text.to_lowercase().contains(enough) { Some(least) } else { whole(text, "") }
        }))
}

/// A factor of what the set-up has, shown as a percentage; 100 % stands in the middle of the range.
fn factor(name: &str, min: f32, max: f32) -> FloatParam {
    FloatParam::new(name, 1.0, FloatRange::SymmetricalSkewed { min, max, factor: 1.0, center: 1.0 })
        .with_step_size(PART_STEP)
        .with_unit(" %")
        .with_value_to_string(formatters::v2s_f32_percentage(0))
        .with_string_to_value(Arc::new(|text| Some(number(text, "%")? / 100.0)))
}

/// A part from 0 to 1, shown as a percentage.
fn part(name: &str, default: f32) -> FloatParam {
    FloatParam::new(name, default, FloatRange::Linear { min: 0.0, max: 1.0 })
        .with_step_size(PART_STEP)
        .with_unit(" %")
        .with_value_to_string(formatters::v2s_f32_percentage(0))
        .with_string_to_value(Arc::new(|text| Some(number(text, "%")? / 100.0)))
}

/// Added to what the set-up has, 0 unless changed. Its sign says that it is no place or height by itself.
fn shift(name: &str, min: f32, max: f32, unit: &'static str, step: f32) -> FloatParam {
    let decimals = (-step.log10()).round().max(0.0) as usize;
    FloatParam::new(name, 0.0, FloatRange::Linear { min, max })
        .with_step_size(step)
        .with_unit(unit)
        .with_value_to_string(Arc::new(move |value| signed(value, decimals)))
        .with_string_to_value(Arc::new(reads(unit)))
}

/// The value of a parameter as the number its decimal notation means, so that 0.3 set in a host and
/// 0.3 given on the command line are the same bits. No parameter has steps under a hundredth. Should a host send what is no
/// number, the usual value takes its place: nothing that is built from it would ever be what was asked for.
pub fn exact(param: &FloatParam) -> f64 {
    exactly(param, param.value())
}

/// The same without what a host adds to it for the moment.
pub fn exact_without_modulation(param: &FloatParam) -> f64 {
    exactly(param, param.unmodulated_plain_value())
}

fn exactly(param: &FloatParam, value: f32) -> f64 {
    let value = if value.is_nan() { param.default_plain_value() } else { value };
    (f64::from(value) * 1e3).round() / 1e3
}

#[cfg(test)]
mod tests {
    use nice_plug::prelude::Params;

    use super::{LowActionParams, Shelf, Start};

    /// Hosts have fields of their own for them. Words for one of a few things are the framework's, which takes them as they are.
    #[test]
    fn every_parameter_takes_its_text_with_a_comma_and_in_capitals() {
        let params = LowActionParams::new(Shelf::new(Vec::new()), &Start::default());
        for (id, param, _) in params.param_map() {
            if matches!(param, nice_plug::params::internals::ParamPtr::EnumParam(_)) {
                continue;
            }
            for value in [0.0, 0.1, 0.37, 0.5, 0.9, 1.0] {
                // SAFETY: the pointers lead into the parameters, which are there until the end.
                let (shown, read) = unsafe {
                    let shown = param.normalized_value_to_string(value, true);
                    let typed = shown.replace('.', ",").to_uppercase();
                    let read = param.string_to_normalized_value(&typed);
                    (shown, read.map(|value| param.normalized_value_to_string(value, true)))
                };
                assert_eq!(read.as_ref(), Some(&shown), "{id}");
            }
        }
    }
}
