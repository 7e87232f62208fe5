//! The CLAP and VST3 plugin: a host's notes go into the [`Engine`], its samples come out.
//!
//! Nothing is computed here but the output level, which leaves the samples untouched at 0 dB: a host
//! gets the same bits as an offline rendering of the same notes. The engine is built when the host
//! activates the plugin, and that is the only place where memory is allocated; so another instrument or
//! variation sounds from the next activation on, which the plugin asks the host for.

use std::sync::Arc;

use low_action_dsp::Setup;
use nice_plug::midi::{Channel, Key};
use nice_plug::prelude::*;

use crate::engine::{Engine, EngineOptions};
use crate::params::{InstrumentChoice, LowActionParams};
use crate::performance::PlayerEvent;

/// How long a host should keep the plugin running after the last event, s: the longest reverberation
/// time of the built-in strings (the open low strings of a classical or steel-string guitar, measured
/// at about 25 to 29 s for a decay of 60 dB), rounded up.
const TAIL: f32 = 30.0;

/// The softest note there is, as a velocity: the smallest of MIDI's that is not a note-off.
const SOFTEST: f32 = 1.0 / 127.0;

/// The plugin as a host sees it.
pub struct LowAction {
    /// What the host can set.
    params: Arc<LowActionParams>,
    /// What plays; there is one from the first activation on.
    playing: Option<Playing>,
}

/// What an engine is built from.
#[derive(Clone, Copy, PartialEq)]
struct Order {
    instrument: InstrumentChoice,
    /// 0 to 1.
    variation: f64,
    /// Hz.
    sample_rate: f32,
}

/// An engine and what it was built from.
struct Playing {
    engine: Engine,
    order: Order,
    /// How long the strings ring on, samples.
    tail: u32,
    /// Whether the host has been asked to activate the plugin anew since the engine was built.
    asked_for_restart: bool,
}

impl Default for LowAction {
    fn default() -> Self {
        Self { params: Arc::new(LowActionParams::default()), playing: None }
    }
}

impl Plugin for LowAction {
    const NAME: &'static str = "Low Action";
    const VENDOR: &'static str = "Low Action";
    const URL: &'static str = env!("CARGO_PKG_REPOSITORY");
    const EMAIL: &'static str = "";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");

    const AUDIO_IO_LAYOUTS: &'static [AudioIOLayout] = &[AudioIOLayout {
        main_input_channels: None,
        main_output_channels: NonZeroU32::new(2),
        ..AudioIOLayout::const_default()
    }];
    // Controllers and pitch bend reach a VST3 plugin only as 130 hidden parameters a channel; without
    // them there would be no sustain pedal.
    const MIDI_INPUT: MidiConfig = MidiConfig::MidiCCs;
    const SAMPLE_ACCURATE_AUTOMATION: bool = true;

    type Editor = ();
    type SysExMessage = ();
    type BackgroundTask = ();

    fn params(&self) -> Arc<dyn Params> {
        self.params.clone()
    }

    fn activate(
        &mut self,
        _layout: &AudioIOLayout,
        buffers: &BufferConfig,
        _context: &mut impl ActivateContext<Self>,
    ) -> bool {
        let order = Order::of(&self.params, buffers.sample_rate);
        match &mut self.playing {
            // Hosts activate often, and building takes a tenth of a second: the same order is the same
            // engine, silent and at its first sample again.
            Some(playing) if playing.order == order => {
                playing.engine.reset();
                playing.asked_for_restart = false;
            }
            playing => match Playing::new(order) {
                Ok(new) => *playing = Some(new),
                Err(error) => {
                    nice_error!("{error}");
                    return false;
                }
            },
        }
        true
    }

    fn reset(&mut self) {
        if let Some(playing) = &mut self.playing {
            playing.engine.reset();
        }
    }

    fn process(
        &mut self,
        buffer: &mut Buffer,
        _aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        let (Some(playing), [left, right]) = (&mut self.playing, buffer.as_slice()) else {
            return ProcessStatus::Error("processing without a stereo output or before activation");
        };
        while let Some(event) = context.next_event() {
            playing.hand_over(event);
        }
        playing.engine.process(left, right);
        set_level(&self.params.level.smoothed, left, right);

        // Also after a session is loaded into the running plugin: the framework activates it for neither.
        if !playing.asked_for_restart && playing.order != Order::of(&self.params, playing.order.sample_rate) {
            playing.asked_for_restart = true;
            context.request_restart();
        }
        ProcessStatus::Tail(playing.tail)
    }
}

impl Order {
    /// What the parameters ask for.
    fn of(params: &LowActionParams, sample_rate: f32) -> Self {
        Self { instrument: params.instrument.value(), variation: params.exact_variation(), sample_rate }
    }
}

impl Playing {
    /// Builds the engine; allocates.
    fn new(order: Order) -> Result<Self, String> {
        let name = order.instrument.set_up();
        let setup = Setup::builtin(name).ok_or_else(|| format!("there is no built-in set-up {name}"))?;
        let options = EngineOptions {
            variation: order.variation,
            ..EngineOptions::new(setup, f64::from(order.sample_rate))
        };
        let engine = Engine::new(&options).map_err(|error| error.to_string())?;
        let tail = (TAIL * order.sample_rate) as u32;
        Ok(Self { engine, order, tail, asked_for_restart: false })
    }

    /// Hands an event of the host to the engine, at its exact sample.
    fn hand_over(&mut self, event: NoteEvent<()>) {
        let offset = event.timing();
        match event {
            NoteEvent::NoteOn { channel, key: Key::Number(key), velocity, .. } => {
                let channel = channel.number().unwrap_or(0);
                // A host's velocity of 0 is a very soft note; only in MIDI's bytes it lifts the key, and
                // the framework has turned those into note-offs.
                let velocity = velocity.max(SOFTEST);
                self.engine.event(offset, PlayerEvent::NoteOn { channel, key, velocity });
            }
            NoteEvent::NoteOff { channel: Channel::Wildcard, key: Key::Wildcard, .. }
            | NoteEvent::Choke { channel: Channel::Wildcard, key: Key::Wildcard, .. } => {
                self.engine.event(offset, PlayerEvent::AllNotesOff);
            }
            // A string has no faster way to stop than a finger put on it, so a choke is a note-off.
            NoteEvent::NoteOff { channel, key, .. } | NoteEvent::Choke { channel, key, .. } => {
                for channel in matching_channels(channel) {
                    for key in matching_keys(key) {
                        self.engine.event(offset, PlayerEvent::NoteOff { channel, key });
                    }
                }
            }
            NoteEvent::MidiCC { channel, cc: number, value, .. } => {
                self.engine.event(offset, PlayerEvent::Controller { channel, number, value });
            }
            NoteEvent::MidiPitchBend { channel, value, .. } => {
                self.engine.event(offset, PlayerEvent::PitchBend { channel, value: signed_bend(value) });
            }
            _ => {}
        }
    }
}

/// The channels an event is meant for.
fn matching_channels(channel: Channel) -> std::ops::RangeInclusive<u8> {
    match channel {
        Channel::Number(number) => number..=number,
        Channel::Wildcard => 0..=15,
    }
}

/// The keys an event is meant for.
fn matching_keys(key: Key) -> std::ops::RangeInclusive<u8> {
    match key {
        Key::Number(number) => number..=number,
        Key::Wildcard => 0..=127,
    }
}

/// A pitch bend of −1 to 1 out of the framework's 0 to 1.
///
/// MIDI's 14 bits have their centre at 8192 of 0 to 16383, which is not the middle of 0 to 1: going back to
/// the 14 bits makes the centre exactly no bend, and every position the same number as in a MIDI file.
fn signed_bend(value: f32) -> f32 {
    ((value * 16383.0).round() - 8192.0) / 8192.0
}

/// Multiplies the samples by the output level; 0 dB leaves them as they are.
fn set_level(level: &Smoother<f32>, left: &mut [f32], right: &mut [f32]) {
    if level.is_smoothing() {
        for (left, right) in left.iter_mut().zip(right) {
            let gain = decibels_to_gain(level.next());
            *left *= gain;
            *right *= gain;
        }
        return;
    }
    let gain = decibels_to_gain(level.next());
    if gain != 1.0 {
        left.iter_mut().chain(right).for_each(|sample| *sample *= gain);
    }
}

/// A factor of the amplitude out of decibels; exactly 1 at 0 dB.
fn decibels_to_gain(decibels: f32) -> f32 {
    libm::powf(10.0, decibels / 20.0)
}

impl ClapPlugin for LowAction {
    const CLAP_ID: &'static str = "io.github.low-action.low-action";
    const CLAP_DESCRIPTION: Option<&'static str> =
        Some("A fretted string instrument, computed from the physics of its strings, frets and fingers");
    const CLAP_MANUAL_URL: Option<&'static str> = Some(Self::URL);
    const CLAP_SUPPORT_URL: Option<&'static str> = None;
    const CLAP_FEATURES: &'static [ClapFeature] =
        &[ClapFeature::Instrument, ClapFeature::Synthesizer, ClapFeature::Stereo];
}

impl Vst3Plugin for LowAction {
    const VST3_CLASS_ID: [u8; 16] = *b"LowActionStrings";
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] =
        &[Vst3SubCategory::Instrument, Vst3SubCategory::Synth, Vst3SubCategory::Stereo];
}

nice_export_clap!(LowAction);
nice_export_vst3!(LowAction);

#[cfg(test)]
mod tests {
    use super::{decibels_to_gain, signed_bend};

    #[test]
    fn bends_are_those_of_a_midi_file() {
        for raw in 0..16384_u16 {
            let from_host = f32::from(raw) / 16383.0;
            assert_eq!(signed_bend(from_host), (f32::from(raw) - 8192.0) / 8192.0);
        }
        // A VST3 host's centre.
        assert_eq!(signed_bend(0.5), 0.0);
    }

    #[test]
    fn no_decibels_are_a_factor_of_one() {
        assert_eq!(decibels_to_gain(0.0), 1.0);
        assert!((decibels_to_gain(-20.0) - 0.1).abs() < 1e-7);
    }
}
