//! A small CLAP host inside the test: it loads the plugin without a bundle and plays events through it.

use std::sync::atomic::{AtomicBool, Ordering};

use clack_extensions::audio_ports_config::PluginAudioPortsConfig;
use clack_extensions::render::{PluginRender, RenderMode};
use clack_extensions::state::PluginState;
use clack_extensions::tail::{PluginTail, TailLength};
use clack_host::events::event_types::{
    MidiEvent, NoteChokeEvent, NoteEndEvent, NoteExpressionEvent, NoteExpressionType, NoteOffEvent,
    NoteOnEvent, ParamModEvent, ParamValueEvent, TransportEvent, TransportFlags,
};
use clack_host::events::{EventFlags, EventHeader};
use clack_host::prelude::*;

/// What a performer or a host does to the plugin.
#[derive(Clone, Copy, Debug)]
pub enum Action {
    /// A key goes down.
    NoteOn {
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
        /// How hard, 0 to 127; 0 is the softest a host can ask for, not a release.
        velocity: u8,
    },
    /// A key goes up.
    NoteOff {
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
    },
    /// Every note is cut short.
    ChokeAll,
    /// Three bytes of MIDI.
    Midi([u8; 3]),
    /// A parameter is set, by its CLAP identifier, in the units CLAP shows to a host: 0 to 1, or 0 to the
    /// number of steps.
    Parameter(u32, f64),
    /// The same for one note alone, which the host has numbered by its key: added to what holds for all.
    Modulate {
        /// The parameter.
        parameter: u32,
        /// Number of the note.
        key: u8,
        /// What is added, 0 to 1.
        amount: f64,
    },
    /// A note expression.
    Express {
        /// What is expressed.
        what: NoteExpressionType,
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
        /// How much.
        value: f64,
    },
    /// The transport starts or stops.
    Transport(bool),
}

/// The number under which CLAP hosts know the parameter that is saved as `id`: the framework's hash.
pub fn parameter(id: &str) -> u32 {
    let hash = id.bytes().fold(0_u32, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)));
    hash & !(1 << 31)
}

/// An action and the sample at which it happens, counted from the start of the performance.
pub type Score = Vec<(u64, Action)>;

/// The host's side of the conversation.
pub struct Listener {
    restart_requested: AtomicBool,
}

impl SharedHandler<'_> for Listener {
    fn request_restart(&self) {
        self.restart_requested.store(true, Ordering::Relaxed);
    }
    fn request_process(&self) {}
    fn request_callback(&self) {}
}

/// Names the types of the three threads of a host.
pub struct Handlers;

impl HostHandlers for Handlers {
    type Shared<'a> = Listener;
    type MainThread<'a> = ();
    type AudioProcessor<'a> = ();
}

/// What came out of the plugin.
pub struct Performed {
    /// Both channels.
    pub stereo: [Vec<f32>; 2],
    /// The mono outputs.
    pub stems: Vec<Vec<f32>>,
    /// Keys of the notes that the plugin says have ended, and the end of the block in which it said so.
    pub ended: Vec<(u64, u8)>,
    /// How long the plugin says at the end that it still sounds, samples; the largest number is endless.
    pub tail: u32,
}

/// The plugin, loaded and ready to be activated.
pub struct Host {
    instance: PluginInstance<Handlers>,
    /// What the host makes of the times of events within a block, in place of the truth.
    pub mistaken: Option<fn(u32) -> u32>,
    /// Whether the host stops asking a plugin for sound that says it is at rest, until there are events.
    pub sleepy: bool,
}

impl Default for Host {
    fn default() -> Self {
        Self::new()
    }
}

impl Host {
    /// Loads the plugin out of the library linked into the test, for rendering offline: then its sound
    /// depends on nothing but what it is told.
    pub fn new() -> Self {
        let mut host = Self::in_real_time();
        host.set_mode(RenderMode::Offline);
        host
    }

    /// The same in real time.
    pub fn in_real_time() -> Self {
        // SAFETY: the entry is the one that the plugin framework generates for CLAP hosts.
        let entry = unsafe { PluginEntry::load_from_raw(&low_action::plugin::clap_entry, c"") }
            .expect("the entry initialises");
        let factory = entry.get_plugin_factory().expect("the entry has a plugin factory");
        let descriptor = factory.plugin_descriptor(0).expect("the factory describes a plugin");
        assert_eq!(factory.plugin_count(), 1);
        let id = descriptor.id().expect("the plugin has an identifier").to_owned();
        let info = HostInfo::new("Low Action tests", "Low Action", "", "0").expect("no zero bytes");
        let instance = PluginInstance::new(
            |_| Listener { restart_requested: AtomicBool::new(false) },
            |_| (),
            &entry,
            &id,
            &info,
        )
        .expect("the plugin can be created");
        Self { instance, mistaken: None, sleepy: false }
    }

    /// Activates the plugin at a sample rate in Hz, plays the score for `length` samples in blocks of the
    /// given sizes (repeated as often as needed), deactivates it, and gives back both channels.
    pub fn play(&mut self, sample_rate: f64, score: &Score, length: usize, blocks: &[u32]) -> [Vec<f32>; 2] {
        let Performed { stereo, .. } = self.perform(sample_rate, score, length, blocks, 0);
        stereo
    }

    /// The same with so many mono outputs beside the stereo one; gives back all that came out.
    pub fn perform(
        &mut self,
        sample_rate: f64,
        score: &Score,
        length: usize,
        blocks: &[u32],
        strings: usize,
    ) -> Performed {
        let largest = blocks.iter().copied().max().expect("there is a block size");
        let configuration =
            PluginAudioConfiguration { sample_rate, min_frames_count: 1, max_frames_count: largest };
        let stopped = self.instance.activate(|_, _| (), configuration).expect("the plugin activates");
        let mut processor = stopped.start_processing().expect("processing starts");

        let mut stereo = [vec![0.0; length], vec![0.0; length]];
        let mut stems = vec![vec![0.0; length]; strings];
        let mut ended = Vec::new();
        let mut ports = AudioPorts::with_capacity(2 + strings, 1 + strings);
        let mut block_sizes = blocks.iter().cycle();
        let mut start = 0;
        let mut running = None;
        let mut rests = false;
        while start < length {
            let size = *block_sizes.next().expect("a cycle has no end") as usize;
            let end = length.min(start + size);
            let events =
                events_between(score, start as u64, end as u64, self.mistaken.unwrap_or(|time| time));
            let block_transport = running.map(|running| transport(0, running));
            for &(at, action) in score {
                if let Action::Transport(playing) = action
                    && (start as u64..end as u64).contains(&at)
                {
                    running = Some(playing);
                }
            }
            let mut parts: Vec<Vec<&mut [f32]>> =
                vec![stereo.iter_mut().map(|channel| &mut channel[start..end]).collect()];
            parts.extend(stems.iter_mut().map(|channel| vec![&mut channel[start..end]]));
            let mut buffers = ports.with_output_buffers(parts.into_iter().map(|channels| AudioPortBuffer {
                latency: 0,
                channels: AudioPortBufferType::f32_output_only(channels.into_iter()),
            }));
            let mut said = EventBuffer::with_capacity(256 + 2 * score.len());
            let status = processor
                .process(
                    &InputAudioBuffers::empty(),
                    &mut buffers,
                    &events.as_input(),
                    &mut said.as_output(),
                    Some(start as u64),
                    block_transport.as_ref(),
                )
                .expect("processing succeeds");
            // A host may put a plugin to sleep that says so, until there are events.
            if rests && events.is_empty() {
                let quiet = stereo.iter().all(|channel| channel[start..end].iter().all(|&x| x == 0.0));
                assert!(quiet, "sound between samples {start} and {end}, while the plugin could have slept");
            }
            rests = match status {
                ProcessStatus::Continue => false,
                ProcessStatus::ContinueIfNotQuiet => true,
                other => panic!("the plugin asks for {other:?}"),
            };
            ended.extend(
                said.iter()
                    .filter_map(|event| event.as_event::<NoteEndEvent>())
                    .filter_map(|event| event.pckn().key.into_specific().map(|key| (end as u64, key as u8))),
            );
            start = end;
        }
        let handle = processor.plugin_handle();
        let tail = handle.get_extension::<PluginTail>().expect("the plugin tells its tail");
        let tail = match tail.get(&handle) {
            TailLength::Finite(samples) => samples,
            TailLength::Infinite => u32::MAX,
        };
        self.instance.deactivate(processor.stop_processing());
        Performed { stereo, stems, ended, tail }
    }

    /// Chooses one of the plugin's port layouts; counts from the next activation on.
    pub fn choose_ports(&mut self, layout: u32) {
        let handle = self.instance.plugin_handle();
        let layouts = handle.get_extension::<PluginAudioPortsConfig>().expect("there are layouts");
        layouts.select(&handle, ClapId::new(layout)).expect("the layout can be chosen");
    }

    /// Tells the plugin how it is going to be run; counts from the next activation on.
    pub fn set_mode(&mut self, mode: RenderMode) {
        let handle = self.instance.plugin_handle();
        let render = handle.get_extension::<PluginRender>().expect("the plugin knows of offline rendering");
        render.set(&handle, mode).expect("the mode is accepted");
    }

    /// The plugin as it is, for its extensions.
    pub fn handle(&mut self) -> PluginMainThreadHandle<'_> {
        self.instance.plugin_handle()
    }

    /// What a session would save.
    pub fn save(&mut self) -> Vec<u8> {
        let handle = self.instance.plugin_handle();
        let state = handle.get_extension::<PluginState>().expect("the plugin has a state");
        let mut saved = Vec::new();
        state.save(&handle, &mut saved).expect("it can be saved");
        saved
    }

    /// Loads it again; gives back whether the plugin took it.
    pub fn load(&mut self, saved: &[u8]) -> bool {
        let handle = self.instance.plugin_handle();
        let state = handle.get_extension::<PluginState>().expect("the plugin has a state");
        let mut reader = saved;
        state.load(&handle, &mut reader).is_ok()
    }

    /// Whether the plugin has asked to be activated anew since the last time this was asked.
    pub fn take_restart_request(&self) -> bool {
        self.instance
            .access_shared_handler(|listener| listener.restart_requested.swap(false, Ordering::Relaxed))
    }
}

/// The events of the samples from `start` up to `end`, in the order of the score, timed from `start` as `clock`
/// says.
fn events_between(score: &Score, start: u64, end: u64, clock: fn(u32) -> u32) -> EventBuffer {
    let mut events = EventBuffer::new();
    for &(at, action) in score.iter().filter(|(at, _)| (start..end).contains(at)) {
        let time = clock((at - start) as u32);
        match action {
            Action::NoteOn { channel, key, velocity } => {
                let velocity = f64::from(velocity) / 127.0;
                events.push(&NoteOnEvent::new(time, note(channel, key), velocity));
            }
            Action::NoteOff { channel, key } => {
                events.push(&NoteOffEvent::new(time, note(channel, key), 0.0));
            }
            Action::ChokeAll => events.push(&NoteChokeEvent::new(time, Pckn::match_all())),
            Action::Midi(bytes) => events.push(&MidiEvent::new(time, 0, bytes)),
            Action::Parameter(id, value) => {
                events.push(&ParamValueEvent::new(time, ClapId::new(id), Pckn::match_all(), value));
            }
            Action::Modulate { parameter, key, amount } => {
                use clack_host::events::Match::All;
                let address = Pckn::new(All, All, All, u32::from(key));
                events.push(&ParamModEvent::new(time, ClapId::new(parameter), address, amount));
            }
            Action::Express { what, channel, key, value } => {
                events.push(&NoteExpressionEvent::new(time, note(channel, key), what, value));
            }
            Action::Transport(playing) => {
                events.push(&transport(time, playing));
            }
        }
    }
    events
}

/// A transport that tells nothing but whether it runs.
fn transport(time: u32, playing: bool) -> TransportEvent {
    TransportEvent {
        header: EventHeader::new_core(time, EventFlags::empty()),
        flags: if playing { TransportFlags::IS_PLAYING } else { TransportFlags::empty() },
        song_pos_beats: Default::default(),
        song_pos_seconds: Default::default(),
        tempo: 0.0,
        tempo_inc: 0.0,
        loop_start_beats: Default::default(),
        loop_end_beats: Default::default(),
        loop_start_seconds: Default::default(),
        loop_end_seconds: Default::default(),
        bar_start: Default::default(),
        bar_number: 0,
        time_signature_numerator: 0,
        time_signature_denominator: 0,
    }
}

/// CLAP's address of a key on a channel. This host numbers notes by their keys.
fn note(channel: u8, key: u8) -> Pckn {
    Pckn::new(0_u16, u16::from(channel), u16::from(key), u32::from(key))
}
