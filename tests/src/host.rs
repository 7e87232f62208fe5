//! A small CLAP host inside the test: it loads the plugin without a bundle and plays events through it.

mod score;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use clack_extensions::audio_ports_config::PluginAudioPortsConfig;
use clack_extensions::latency::{HostLatency, HostLatencyImpl};
use clack_extensions::params::PluginParams;
use clack_extensions::render::{PluginRender, RenderMode};
use clack_extensions::state::PluginState;
use clack_extensions::tail::{PluginTail, TailLength};
use clack_extensions::voice_info::{HostVoiceInfo, HostVoiceInfoImpl};
use clack_host::events::event_types::NoteEndEvent;
use clack_host::prelude::*;

pub use score::{Action, Score, parameter};
use score::{Running, events_between};

use crate::user::isolate;

/// The host's side of the conversation.
pub struct Listener {
    restart_requested: AtomicBool,
    process_requested: AtomicBool,
}

impl SharedHandler<'_> for Listener {
    fn request_restart(&self) {
        self.restart_requested.store(true, Ordering::Relaxed);
    }
    fn request_process(&self) {
        self.process_requested.store(true, Ordering::Relaxed);
    }
    fn request_callback(&self) {}
}

/// What the plugin tells the host's main thread: it is asked for both anyway whenever they are needed.
pub struct MainListener;

impl<'a> MainThreadHandler<'a> for MainListener {}

impl HostLatencyImpl for MainListener {
    fn changed(&self) {}
}

impl HostVoiceInfoImpl for MainListener {
    fn changed(&self) {}
}

/// Names the types of the three threads of a host, and what it can be told.
pub struct Handlers;

impl HostHandlers for Handlers {
    type Shared<'a> = Listener;
    type MainThread<'a> = MainListener;
    type AudioProcessor<'a> = ();

    fn declare_extensions(builder: &mut HostExtensions<Self>, _: &Listener) {
        builder.register::<HostLatency>().register::<HostVoiceInfo>();
    }
}

/// What came out of the plugin.
pub struct Performed {
    /// Both channels.
    pub stereo: [Vec<f32>; 2],
    /// The mono outputs.
    pub stems: Vec<Vec<f32>>,
    /// Keys of the notes that the plugin says have ended, and the end of the block in which it said so.
    pub ended: Vec<(u64, u8)>,
    /// For how long the plugin says it may ring on, samples, before there is any sound and at the end; the largest number is
    /// endless.
    pub tails: [u32; 2],
    /// For how many samples a sleepy host has asked for nothing.
    pub slept: usize,
}

/// For how long a plugin says that it may ring on, samples.
fn tail(handle: &PluginAudioProcessorHandle<'_>) -> u32 {
    let tail = handle.get_extension::<PluginTail>().expect("the plugin tells its tail");
    match tail.get(handle) {
        TailLength::Finite(samples) => samples,
        TailLength::Infinite => u32::MAX,
    }
}

/// What is told outside of blocks.
fn events_of(told: &[Action]) -> EventBuffer {
    let score: Score = told.iter().map(|&action| (0, action)).collect();
    events_between(&score, [0, 1], |time| time, 1.0)
}

/// Somebody who looks at both channels, up to where they have sounded.
pub type Watch = Box<dyn FnMut([&[f32]; 2])>;

/// The plugin, loaded and ready to be activated.
pub struct Host {
    instance: PluginInstance<Handlers>,
    /// What the host makes of the times of events within a block, in place of the truth.
    pub mistaken: Option<fn(u32) -> u32>,
    /// Looks at all that has sounded after every block; may take its time.
    pub watch: Option<Watch>,
    /// Whether the host asks a plugin that says it is at rest for nothing until there are events, and plays silence.
    pub sleepy: bool,
    /// Whether it stops processing meanwhile, and starts again.
    pub stops: bool,
    /// The samples in which it has nothing to be played into: blocks that begin there are told of no outputs.
    pub deaf: Range<usize>,
    /// What it does before the first block that begins at a sample or after it.
    pub between: Vec<(u64, Between)>,
}

/// What a host does between blocks.
pub enum Between {
    /// Loads a session.
    Load(Vec<u8>),
    /// Tells the plugin something of its parameters.
    Flush(Vec<Action>),
    /// Has it play a block that has no samples.
    Nothing(Vec<Action>),
    /// Asks for silence.
    Reset,
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
        isolate();
        // SAFETY: the entry is the one that the plugin framework generates for CLAP hosts.
        let entry = unsafe { PluginEntry::load_from_raw(&low_action::plugin::clap_entry, c"") }
            .expect("the entry initialises");
        let factory = entry.get_plugin_factory().expect("the entry has a plugin factory");
        let descriptor = factory.plugin_descriptor(0).expect("the factory describes a plugin");
        assert_eq!(factory.plugin_count(), 1);
        let id = descriptor.id().expect("the plugin has an identifier").to_owned();
        let info = HostInfo::new("Low Action tests", "Low Action", "", "0").expect("no zero bytes");
        let instance = PluginInstance::new(
            |_| Listener {
                restart_requested: AtomicBool::new(false),
                process_requested: AtomicBool::new(false),
            },
            |_| MainListener,
            &entry,
            &id,
            &info,
        )
        .expect("the plugin can be created");
        Self {
            instance,
            mistaken: None,
            watch: None,
            sleepy: false,
            stops: false,
            deaf: 0..0,
            between: Vec::new(),
        }
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
        let tail_before = tail(&processor.plugin_handle());

        let mut stereo = [vec![0.0; length], vec![0.0; length]];
        let mut stems = vec![vec![0.0; length]; strings];
        let mut ended = Vec::new();
        let mut ports = AudioPorts::with_capacity(2 + strings, 1 + strings);
        let mut block_sizes = blocks.iter().cycle();
        let mut start = 0;
        let mut running = None;
        let (mut rests, mut slept, mut asleep) = (false, 0, false);
        while start < length {
            let size = *block_sizes.next().expect("a cycle has no end") as usize;
            let end = length.min(start + size);
            let span = [start as u64, end as u64];
            let clock = self.mistaken.unwrap_or(|time| time);
            let events = events_between(score, span, clock, sample_rate);
            let block_transport = running.map(|running: Running| running.said(start as u64, 0));
            let told = score.iter().filter(|(at, _)| (span[0]..span[1]).contains(at));
            let mut told = told.filter_map(|&(at, action)| Running::from(at, action, sample_rate));
            running = told.next_back().or(running);
            while self.between.first().is_some_and(|(at, _)| *at <= start as u64) {
                match self.between.remove(0).1 {
                    Between::Load(session) => assert!(self.load(&session), "the session is taken in"),
                    Between::Nothing(told) => {
                        let (events, mut said) = (events_of(&told), EventBuffer::new());
                        // SAFETY: there are no buffers that could be shorter.
                        let inputs = unsafe { InputAudioBuffers::from_raw_buffers(&[], 0) };
                        let (events, said) = (events.as_input(), &mut said.as_output());
                        let mut nowhere = OutputAudioBuffers::empty();
                        let status = processor
                            .process(&inputs, &mut nowhere, &events, said, None, None)
                            .expect("processing succeeds");
                        rests &= status != ProcessStatus::Continue;
                    }
                    Between::Reset => processor.reset(),
                    Between::Flush(told) => {
                        let (events, mut said) = (events_of(&told), EventBuffer::new());
                        let mut handle = processor.plugin_handle();
                        let params = handle.get_extension::<PluginParams>().expect("it has parameters");
                        params.flush_active(&mut handle, &events.as_input(), &mut said.as_output());
                    }
                }
            }
            if self.take_process_request() {
                rests = false;
            }
            if self.sleepy && rests && events.is_empty() {
                slept += end - start;
                asleep = true;
                start = end;
                continue;
            }
            if std::mem::take(&mut asleep) && self.stops {
                processor = processor.stop_processing().start_processing().expect("processing starts again");
            }
            let mut parts: Vec<Vec<&mut [f32]>> =
                vec![stereo.iter_mut().map(|channel| &mut channel[start..end]).collect()];
            let deaf = self.deaf.contains(&start);
            parts.extend(stems.iter_mut().map(|channel| vec![&mut channel[start..end]]));
            if deaf {
                parts.clear();
            }
            let mut buffers = ports.with_output_buffers(parts.into_iter().map(|channels| AudioPortBuffer {
                latency: 0,
                channels: AudioPortBufferType::f32_output_only(channels.into_iter()),
            }));
            // Where there are no outputs, how long the block is stands with the inputs.
            // SAFETY: there are no buffers that could be shorter.
            let inputs = unsafe { InputAudioBuffers::from_raw_buffers(&[], (end - start) as u32) };
            let mut said = EventBuffer::with_capacity(256 + 2 * score.len());
            let status = processor
                .process(
                    &inputs,
                    &mut buffers,
                    &events.as_input(),
                    &mut said.as_output(),
                    Some(start as u64),
                    block_transport.as_ref(),
                )
                .expect("processing succeeds");
            // A host may put a plugin to sleep that says so, until there are events; this one has not.
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
            if let Some(watch) = &mut self.watch {
                watch(stereo.each_ref().map(|channel| &channel[..end]));
            }
            start = end;
        }
        let tails = [tail_before, tail(&processor.plugin_handle())];
        self.instance.deactivate(processor.stop_processing());
        Performed { stereo, stems, ended, tails, slept }
    }

    /// Tells the plugin something of its parameters while it is not active.
    pub fn flush(&mut self, told: &[Action]) {
        let events = events_of(told);
        let mut handle = self.instance.inactive_plugin_handle().expect("it is not active");
        let params = handle.get_extension::<PluginParams>().expect("the plugin has parameters");
        let mut said = EventBuffer::new();
        params.flush(&mut handle, &events.as_input(), &mut said.as_output());
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

    /// What a parameter is set to, in the units CLAP shows to a host.
    pub fn value(&mut self, parameter: u32) -> Option<f64> {
        let handle = self.instance.plugin_handle();
        let params = handle.get_extension::<PluginParams>().expect("the plugin has parameters");
        params.get_value(&handle, ClapId::new(parameter))
    }

    /// Whether the plugin has asked to be processed since the last time this was asked.
    pub fn take_process_request(&self) -> bool {
        self.instance
            .access_shared_handler(|listener| listener.process_requested.swap(false, Ordering::Relaxed))
    }

    /// Whether the plugin has asked to be activated anew since the last time this was asked.
    pub fn take_restart_request(&self) -> bool {
        self.instance
            .access_shared_handler(|listener| listener.restart_requested.swap(false, Ordering::Relaxed))
    }
}
