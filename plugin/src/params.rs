//! What a host can set on the plugin.
//!
//! The identifiers are part of every saved session: they never change their meaning, and none is ever
//! used for something else.

use nice_plug::prelude::*;

use crate::engine::EngineOptions;

/// The built-in instruments, as the host sees them. Saved by identifier, so they can be reordered.
#[derive(Enum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstrumentChoice {
    /// A six-string electric guitar, .010 to .046, 22 frets.
    #[id = "electric"]
    #[name = "Electric guitar"]
    Electric,
    /// A six-string classical guitar with nylon strings.
    #[id = "classical"]
    #[name = "Classical guitar"]
    Classical,
    /// A six-string steel-strung acoustic guitar.
    #[id = "steel"]
    #[name = "Steel-string guitar"]
    Steel,
    /// A four-string electric bass.
    #[id = "bass"]
    #[name = "Electric bass"]
    Bass,
}

impl InstrumentChoice {
    /// The name of the built-in set-up, as the command line knows it.
    pub fn set_up(self) -> &'static str {
        match self {
            Self::Electric => "electric",
            Self::Classical => "classical",
            Self::Steel => "steel",
            Self::Bass => "bass",
        }
    }
}

/// Everything a host can set, automate and save.
#[derive(Params)]
pub struct LowActionParams {
    /// The instrument being played. A change takes effect when the host activates the plugin the next
    /// time; the plugin asks for that at once.
    #[id = "instrument"]
    pub instrument: EnumParam<InstrumentChoice>,
    /// How much the place, force and time of each pluck vary, 0 (exact) to 1. Takes effect when the
    /// host activates the plugin the next time.
    #[id = "variation"]
    pub variation: FloatParam,
    /// Gain of the output, dB. At 0 dB the samples pass untouched.
    #[id = "level"]
    pub level: FloatParam,
}

/// Range of the output level, dB: enough to make up for the softest playing, and down to inaudible.
const LEVEL_RANGE: FloatRange = FloatRange::Linear { min: -60.0, max: 12.0 };

/// Time over which a change of level is spread, ms: short enough to follow a fader, long enough not
/// to click.
const LEVEL_RAMP: f32 = 20.0;

impl Default for LowActionParams {
    fn default() -> Self {
        Self {
            instrument: EnumParam::new("Instrument", InstrumentChoice::Electric).non_automatable(),
            variation: FloatParam::new(
                "Variation",
                EngineOptions::VARIATION as f32,
                FloatRange::Linear { min: 0.0, max: 1.0 },
            )
            .with_step_size(VARIATION_STEP)
            .with_unit(" %")
            .with_value_to_string(formatters::v2s_f32_percentage(0))
            .with_string_to_value(formatters::s2v_f32_percentage())
            .non_automatable(),
            // The step makes 0 dB survive the trip through the host's 0 to 1 exactly.
            level: FloatParam::new("Level", 0.0, LEVEL_RANGE)
                .with_step_size(0.1)
                .with_smoother(SmoothingStyle::Linear(LEVEL_RAMP))
                .with_unit(" dB"),
        }
    }
}

impl LowActionParams {
    /// The variation as the number its decimal notation means, so that 0.3 set in a host and 0.3 given
    /// on the command line are the same bits.
    pub fn exact_variation(&self) -> f64 {
        let steps = f64::from(1.0 / VARIATION_STEP).round();
        (f64::from(self.variation.value()) * steps).round() / steps
    }
}

/// The smallest change of the variation a host can make.
const VARIATION_STEP: f32 = 0.01;
