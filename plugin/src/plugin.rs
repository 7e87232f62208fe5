//! The CLAP and VST3 plugin: a host's notes go into the [`Engine`](crate::engine::Engine), its samples
//! come out.
//!
//! Nothing is computed here but the output level, which leaves the samples untouched at 0 dB: a host
//! gets the same bits as an offline rendering of the same notes. What parameters ask for (`order`) is
//! built by a thread of the plugin's own (`workshop`) and put under the ringing strings (`playing`): as
//! soon as it is ready in real time, at the very sample of the change when the host renders offline.

mod budget;
mod clap;
mod door;
mod events;
pub mod layout;
mod level;
pub mod meters;
pub(crate) mod order;
mod playing;
pub mod shelf;
pub mod state;
mod transport;
mod voices;
mod vst3;
mod waiting;
mod workshop;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use low_action_dsp::setup::MOST_STRINGS;
use nice_plug::prelude::*;

use crate::display::{Health, Writer, display};
#[cfg(feature = "editor")]
use crate::editor::Link;
use crate::engine::EngineOptions;
use crate::params::{LowActionParams, start};
use crate::performance::Announced;
use crate::pointer::{Played, pointer};
pub use clap::clap_entry;
use door::Door;
use level::Output;
use meters::Meters;
use order::Order;
use playing::Playing;
use transport::{Transport, Turn};

/// Strings that have an output of their own, where a host asks for them.
const STRING_OUTPUTS: usize = crate::params::TUNED_STRINGS;

/// The plugin as a host sees it.
pub struct LowAction {
    /// What the host can set.
    params: Arc<LowActionParams>,
    /// What others may look at.
    meters: Arc<Meters>,
    /// What plays; there is one from the first activation on.
    playing: Option<Playing>,
    /// What was announced to those that played in real time, for those to come: who plays says it only once, and a host may
    /// have rendered offline meanwhile, or changed the sample rate.
    announced: Option<Announced>,
    output: Output,
    /// How the host's transport ran so far.
    transport: Transport,
    /// Takes pictures of the strings while an editor is open.
    display: Writer,
    /// What is played in those pictures.
    played: Played,
    /// What it shares with the door through which the host came in.
    door: Arc<Door>,
    /// Blocks asked for so far, for whoever wants to know whether there are any.
    blocks: Arc<AtomicU64>,
    #[cfg(feature = "editor")]
    editor: Link,
}

impl Default for LowAction {
    fn default() -> Self {
        let (params, meters) = (Arc::new(LowActionParams::default()), Arc::new(Meters::default()));
        let (display, _reader) = display();
        let (_pointer, played) = pointer();
        Self {
            #[cfg(feature = "editor")]
            editor: Link::new(params.clone(), meters.clone(), _reader, _pointer),
            params,
            meters,
            playing: None,
            announced: None,
            output: Output::default(),
            transport: Transport::default(),
            display,
            played,
            door: Door::of_the_new(),
            blocks: start().blocks,
        }
    }
}

impl LowAction {
    /// Whether an editor is open, and seen.
    fn is_looked_at(&self) -> bool {
        #[cfg(feature = "editor")]
        let is_open = self.editor.is_open();
        #[cfg(not(feature = "editor"))]
        let is_open = false;
        is_open && !self.door.is_hidden()
    }

    /// Has the editor, if there is one, show what is new.
    fn show(&self) {
        #[cfg(feature = "editor")]
        self.editor.repaint();
    }
}

impl Plugin for LowAction {
    const NAME: &'static str = "Low Action";
    const VENDOR: &'static str = "Low Action";
    const URL: &'static str = env!("CARGO_PKG_REPOSITORY");
    const EMAIL: &'static str = "";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");

    const AUDIO_IO_LAYOUTS: &'static [AudioIOLayout] = &[
        AudioIOLayout {
            main_input_channels: None,
            main_output_channels: NonZeroU32::new(2),
            names: PortNames { layout: Some("Stereo"), ..PortNames::const_default() },
            ..AudioIOLayout::const_default()
        },
        AudioIOLayout {
            main_input_channels: None,
            main_output_channels: NonZeroU32::new(2),
            aux_output_ports: &[new_nonzero_u32(1); STRING_OUTPUTS],
            names: PortNames {
                layout: Some("Stereo and strings"),
                aux_outputs: &[
                    "String 1", "String 2", "String 3", "String 4", "String 5", "String 6", "String 7",
                    "String 8",
                ],
                ..PortNames::const_default()
            },
            ..AudioIOLayout::const_default()
        },
    ];
    // Controllers and pitch bend reach a VST3 plugin only as 130 hidden parameters a channel; without
    // them there would be no sustain pedal.
    const MIDI_INPUT: MidiConfig = MidiConfig::MidiCCs;
    const SAMPLE_ACCURATE_AUTOMATION: bool = true;
    // Hosts that send more in one block make the framework allocate.
    const INPUT_EVENT_CAPACITY: usize = 16_384;

    #[cfg(feature = "editor")]
    type Editor = crate::editor::Window;
    #[cfg(not(feature = "editor"))]
    type Editor = ();
    type SysExMessage = ();
    type BackgroundTask = ();

    fn params(&self) -> Arc<dyn Params> {
        self.params.clone()
    }

    #[cfg(feature = "editor")]
    fn editor(&mut self, _: AsyncExecutor<Self>) -> Option<Self::Editor> {
        self.editor.window()
    }

    fn filter_state(state: &mut PluginState) {
        state::admit(state);
    }

    fn activate(
        &mut self,
        _layout: &AudioIOLayout,
        buffers: &BufferConfig,
        context: &mut impl ActivateContext<Self>,
    ) -> bool {
        let offline = buffers.process_mode == ProcessMode::Offline;
        let order = Order::of(&self.params, buffers.sample_rate, offline);
        self.output.activate(buffers.sample_rate, self.params.output.bypass.value());
        self.transport = Transport::of_blocks(buffers.max_buffer_size);
        self.played.clear();
        self.door.waiting.make_room();
        self.announced = self.playing.as_ref().and_then(Playing::announced).or(self.announced);
        // A host that asks for another rate is better off with a silent instrument, which says so in the log, than with one that
        // cannot be activated.
        let (lowest, highest) = EngineOptions::SAMPLE_RATES.into_inner();
        if !(lowest as f32..=highest as f32).contains(&buffers.sample_rate) {
            nice_error!(
                "nothing sounds at {} Hz: the sample rate must be {lowest} to {highest} Hz",
                buffers.sample_rate
            );
            self.playing = None;
            self.door.ring(0);
            self.door.be_active(true);
            return true;
        }
        match &mut self.playing {
            // Hosts activate often, and building takes a tenth of a second: the same order is the same
            // engine, silent and at its first sample again.
            Some(playing) if playing.is(&order) => playing.reset(offline),
            playing => match Playing::new(order, offline, self.params.shelf.clone(), self.meters.clone()) {
                Ok(new) => *playing = Some(new),
                Err(error) => {
                    nice_error!("{error}");
                    return false;
                }
            },
        }
        if let Some(playing) = &mut self.playing {
            if let Some(announced) = &self.announced {
                playing.announce(&self.params, announced);
            }
            context.set_current_voice_capacity(playing.string_count());
            self.door.ring(playing.tail());
            self.door.be_active(true);
        }
        true
    }

    fn deactivate(&mut self) {
        self.door.be_active(false);
    }

    fn reset(&mut self) {
        self.played.clear();
        if self.playing.as_mut().is_none_or(Playing::begin_again) {
            self.door.waiting.forget();
        }
    }

    fn process(
        &mut self,
        buffer: &mut Buffer,
        aux: &mut AuxiliaryBuffers,
        context: &mut impl ProcessContext<Self>,
    ) -> ProcessStatus {
        let [left, right] = buffer.as_slice() else {
            return ProcessStatus::Error("processing without a stereo output");
        };
        self.blocks.fetch_add(1, Ordering::Relaxed);
        let looked_at = self.is_looked_at();
        let Some(playing) = &mut self.playing else {
            self.door.waiting.forget();
            left.fill(0.0);
            right.fill(0.0);
            return ProcessStatus::Normal;
        };
        let started = playing.start_clock();
        match self.transport.follow(context.transport()) {
            Some(Turn::Stops) => playing.silence(),
            Some(Turn::Begins) => playing.begin_anew(),
            None => {}
        }
        playing.follow(&self.params);
        playing.take_up(&self.played);
        self.door.waiting.hand_over(|event| playing.event(event, &self.params));
        let is_vst3 = context.plugin_api() == PluginApi::Vst3;
        while let Some(event) = context.next_event() {
            playing.event(if is_vst3 { vst3::mended(event) } else { event }, &self.params);
        }
        self.display.look(looked_at, playing.engine());
        let mut stems: [&mut [f32]; STRING_OUTPUTS] = std::array::from_fn(|_| Default::default());
        let mut count = 0;
        for (stem, port) in stems.iter_mut().zip(aux.outputs.iter_mut()) {
            if let Some(channel) = port.as_slice().first_mut() {
                *stem = channel;
                count += 1;
            }
        }
        playing.play(&self.params, left, right, &mut stems[..count]);
        // Another instrument may have come in; the host hears of it if it has other strings.
        context.set_current_voice_capacity(playing.string_count());
        self.door.ring(playing.tail());
        self.output.shape(&self.params.output, left, right, &mut stems[..count]);
        self.meters.see_output(left, right);
        playing.end_voices(left.len(), |event| context.try_send_event(event).is_ok());
        playing.stop_clock(started, left.len(), self.params.instrument.relax.value());
        let health = Health { load: self.meters.load(), relaxed: self.meters.relaxed() };
        let status = playing.status(looked_at);
        if self.display.write(playing.engine(), left.len(), health) {
            self.show();
        }
        status
    }
}

impl ClapPlugin for LowAction {
    const CLAP_ID: &'static str = "io.github.low-action.low-action";
    const CLAP_DESCRIPTION: Option<&'static str> =
        Some("A fretted string instrument, computed from the physics of its strings, frets and fingers");
    const CLAP_MANUAL_URL: Option<&'static str> = Some(Self::URL);
    const CLAP_SUPPORT_URL: Option<&'static str> = None;
    const CLAP_FEATURES: &'static [ClapFeature] =
        &[ClapFeature::Instrument, ClapFeature::Synthesizer, ClapFeature::Stereo];

    const CLAP_POLY_MODULATION_CONFIG: Option<PolyModulationConfig> = Some(PolyModulationConfig {
        // One note a string.
        max_voice_capacity: MOST_STRINGS as u32,
        // A key struck again is the same string plucked again.
        supports_overlapping_voices: false,
    });

    fn remote_controls(&self, context: &mut impl RemoteControlsContext) {
        order::remote_controls(&self.params, context);
    }
}

impl Vst3Plugin for LowAction {
    const VST3_CLASS_ID: [u8; 16] = *b"LowActionStrings";
    const VST3_SUBCATEGORIES: &'static [Vst3SubCategory] =
        &[Vst3SubCategory::Instrument, Vst3SubCategory::Synth, Vst3SubCategory::Stereo];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::performance::PlayerEvent;

    #[test]
    fn what_was_played_before_a_reset_is_forgotten() {
        let (pointer, played) = pointer();
        let mut plugin = LowAction { played, ..LowAction::default() };
        assert!(pointer.play(PlayerEvent::AllNotesOff));
        plugin.reset();
        assert!(plugin.played.next().is_none());
    }
}
