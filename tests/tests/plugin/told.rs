//! Promise: hosts are told the truth: of the latency before anything is activated, of ports, voices, pages and parameters.

use std::collections::BTreeSet;

use clack_extensions::audio_ports::{AudioPortInfoBuffer, PluginAudioPorts};
use clack_extensions::latency::PluginLatency;
use clack_extensions::params::{ParamInfoBuffer, PluginParams};
use clack_extensions::remote_controls::{PluginRemoteControls, RemoteControlsPageBuffer};
use clack_extensions::voice_info::PluginVoiceInfo;
use low_action::engine::Engine;
use low_action::params::LowActionParams;
use low_action_tests::host::{Action, Host, Score, parameter};
use nice_plug::prelude::Params;

const RATE: f64 = 48_000.0;

fn score() -> Score {
    vec![(0, Action::NoteOn { channel: 0, key: 48, velocity: 100 })]
}

fn set(id: &str, value: f64) -> Score {
    vec![(0, Action::Parameter(parameter(id), value))]
}

#[test]
fn the_latency_is_known_before_anything_is_activated_and_asks_for_nothing() {
    let mut host = Host::new();
    let latency = |host: &mut Host| {
        let handle = host.handle();
        let latency = handle.get_extension::<PluginLatency>().expect("it tells its latency");
        latency.get(&handle)
    };
    assert_eq!(latency(&mut host), Engine::LATENCY);
    host.play(RATE, &Vec::new(), 480, &[480]);
    assert_eq!(latency(&mut host), Engine::LATENCY);
    assert!(!host.take_restart_request());
}

#[test]
fn hosts_are_told_the_truth() {
    let mut host = Host::new();
    host.play(RATE, &score(), 1024, &[256]);
    let handle = host.handle();
    let latency = handle.get_extension::<PluginLatency>().expect("it tells its latency");
    assert_eq!(latency.get(&handle), Engine::LATENCY);
    let voices = handle.get_extension::<PluginVoiceInfo>().expect("it tells its voices");
    let voices = voices.get(&handle).expect("it does");
    assert_eq!(voices.voice_count, 6);
    let ports = handle.get_extension::<PluginAudioPorts>().expect("it has ports");
    assert_eq!((ports.count(&handle, true), ports.count(&handle, false)), (0, 1));
    let mut buffer = AudioPortInfoBuffer::new();
    assert_eq!(ports.get(&handle, 0, false, &mut buffer).expect("there is one").channel_count, 2);
    let pages = handle.get_extension::<PluginRemoteControls>().expect("it has pages");
    assert_eq!(pages.count(&handle), 7);
    let mut buffer = RemoteControlsPageBuffer::new();
    let first = pages.get(&handle, 0, &mut buffer).expect("there is one");
    assert_eq!(first.param_ids[3].map(|id| id.get()), Some(parameter("action")));
    // Between them they hold every parameter, no page twice the same.
    let mut held = BTreeSet::new();
    for index in 0..pages.count(&handle) {
        let page = pages.get(&handle, index, &mut buffer).expect("there is one");
        let ids: Vec<u32> = page.param_ids.iter().flatten().map(|id| id.get()).collect();
        assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len(), "page {index}");
        held.extend(ids);
    }
    let all = LowActionParams::default().param_map().into_iter().map(|(id, ..)| parameter(&id));
    assert_eq!(held, all.collect());
    // As many voices as there are strings, from the block on in which the instrument comes.
    for (instrument, strings) in [(3.0, 4), (0.0, 6)] {
        host.play(RATE, &set("instrument", instrument), 64, &[64]);
        for _ in 0..2 {
            let handle = host.handle();
            let voices = handle.get_extension::<PluginVoiceInfo>().expect("it tells its voices");
            assert_eq!(voices.get(&handle).expect("it does").voice_count, strings);
            host.play(RATE, &score(), 64, &[64]);
        }
    }
}

#[test]
fn parameters_are_those_that_there_are() {
    let mut host = Host::new();
    let handle = host.handle();
    let params = handle.get_extension::<PluginParams>().expect("it has parameters");
    let (count, mut buffer) = (params.count(&handle), ParamInfoBuffer::new());
    assert_eq!(count as usize, LowActionParams::default().param_map().len());
    assert!(params.get_info(&handle, count - 1, &mut buffer).is_some());
    for beyond in [count, count + 1, u32::MAX] {
        assert!(params.get_info(&handle, beyond, &mut buffer).is_none(), "{beyond} of {count}");
    }
}

/// What a host adds for the moment is the host's own: told of it as if it had been set, it would add it once more.
#[test]
fn what_is_added_for_the_moment_is_not_told_as_set() {
    let mut host = Host::new();
    for (id, value, amount) in [("pluck_force", 0.25, 0.5), ("instrument", 3.0, 1.0)] {
        let parameter = parameter(id);
        host.play(RATE, &set(id, value), 64, &[64]);
        let before = host.value(parameter);
        let added = vec![(32, Action::ModulateAll { parameter, amount })];
        host.play(RATE, &added, 64, &[64]);
        assert_eq!(host.value(parameter), before, "{id}");
    }
}
