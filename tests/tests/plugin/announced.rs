//! Promise: what a keyboard announces once is known as long as the plugin plays in real time: it outlives another sample rate,
//! another quality and a rendering in between. A rendering knows nothing of it: it is the same every time; and what a rendered file
//! announces is forgotten with the rendering.

use clack_extensions::render::RenderMode;
use low_action_tests::host::{Action, Host, Score, parameter};

const RATE: f64 = 48_000.0;
const LENGTH: usize = 24_000;

/// A capo at the fifth fret, an octave for the wheel, keyswitches, MPE on all channels, a hand about the seventh fret.
fn announcements() -> [Score; 5] {
    let said = |messages: &[[u8; 3]]| messages.iter().map(|&bytes| (0, Action::Midi(bytes))).collect();
    let registered = |number, value| said(&[[0xB0, 101, 0], [0xB0, 100, number], [0xB0, 6, value]]);
    let [capo, switches, hand] =
        [[0xB0, 26, 5], [0xB0, 27, 1], [0xB0, 28, 7]].map(|message| said(&[message]));
    [capo, registered(0, 12), switches, registered(6, 15), hand]
}

/// A note that is too low with the capo, bent by the first channel's wheel and its own, with a keyswitch for the sixth string; and
/// one that three strings have, when no key is down that would keep the hand where it is.
fn notes() -> Score {
    vec![
        (0, Action::Parameter(parameter("relax"), 0.0)),
        (0, Action::NoteOn { channel: 0, key: 18, velocity: 100 }),
        (0, Action::NoteOn { channel: 2, key: 43, velocity: 100 }),
        (0, Action::Midi([0xE0, 0, 80])),
        (0, Action::Midi([0xE2, 0, 68])),
        (100, Action::NoteOn { channel: 0, key: 52, velocity: 100 }),
        (1_900, Action::NoteOff { channel: 0, key: 18 }),
        (1_900, Action::NoteOff { channel: 2, key: 43 }),
        (1_900, Action::NoteOff { channel: 0, key: 52 }),
        (2_000, Action::NoteOn { channel: 0, key: 64, velocity: 100 }),
    ]
}

fn played(host: &mut Host, score: &Score) -> Vec<f32> {
    let [left, _] = host.play(RATE, score, LENGTH, &[512]);
    left
}

/// What is heard of the notes after an announcement and whatever a host does then.
fn heard(announced: &Score, between: impl Fn(&mut Host)) -> Vec<f32> {
    let mut host = Host::in_real_time();
    played(&mut host, announced);
    between(&mut host);
    played(&mut host, &notes())
}

#[test]
fn what_was_announced_outlives_another_rate_and_a_rendering() {
    let nothing = heard(&Score::new(), |_| {});
    for (which, announced) in announcements().iter().enumerate() {
        let expected = heard(announced, |_| {});
        assert!(expected != nothing, "announcement {which} changes nothing");
        let after_rate = heard(announced, |host| {
            host.play(44_100.0, &Score::new(), 512, &[512]);
        });
        assert!(after_rate == expected, "announcement {which}, another rate");
        // Rendered as it is played, which is the same engine, or better.
        for quality in [0.0, 1.0] {
            let after_rendering = heard(announced, |host| {
                played(host, &vec![(0, Action::Parameter(parameter("render_quality"), quality))]);
                host.set_mode(RenderMode::Offline);
                played(host, &notes());
                host.set_mode(RenderMode::Realtime);
            });
            assert!(after_rendering == expected, "announcement {which}, rendered at {quality}");
            // What the file says itself is for the file alone, also where nothing was announced before or nothing played.
            let file = |host: &mut Host| {
                played(host, &vec![(0, Action::Parameter(parameter("render_quality"), quality))]);
                host.set_mode(RenderMode::Offline);
                for of_file in announcements() {
                    played(host, &of_file);
                }
                host.set_mode(RenderMode::Realtime);
            };
            assert!(
                heard(announced, file) == expected,
                "announcement {which} and others, rendered at {quality}"
            );
            let mut host = Host::new();
            played(&mut host, &vec![(0, Action::Parameter(parameter("render_quality"), quality))]);
            for of_file in announcements() {
                played(&mut host, &of_file);
            }
            host.set_mode(RenderMode::Realtime);
            assert!(played(&mut host, &notes()) == nothing, "announced in a rendering before anything else");
        }
    }
}

#[test]
fn a_rendering_does_not_know_of_it() {
    let rendered = |announced: &Score| {
        let mut host = Host::in_real_time();
        played(&mut host, announced);
        host.set_mode(RenderMode::Offline);
        played(&mut host, &notes())
    };
    let nothing = rendered(&Score::new());
    for (which, announced) in announcements().iter().enumerate() {
        assert!(rendered(announced) == nothing, "announcement {which}");
    }
}
