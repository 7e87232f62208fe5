//! Promise: a host that hands events over in another order than that of their times, or with times past the end of
//! the block, breaks nothing: in disorder they sound as they would in order, and those too late count at the
//! block's last sample. CLAP forbids both, and the plugin framework would stop or leave the host's memory.

use clack_host::events::event_types::NoteExpressionType;
use low_action_tests::host::{Action, Host, Score, parameter};

const RATE: f64 = 48_000.0;
const LENGTH: usize = 24_000;
const BLOCK: u64 = 480;

/// Notes, controllers, parameters, modulation, expression and the transport, no two at one sample.
fn score() -> Score {
    let mut score = vec![
        (3, Action::Transport(true)),
        (17, Action::NoteOn { channel: 0, key: 45, velocity: 100 }),
        (18, Action::Modulate { parameter: parameter("finger_force"), key: 45, amount: 0.1 }),
        (101, Action::NoteOn { channel: 0, key: 57, velocity: 90 }),
        (140, Action::Express { what: NoteExpressionType::Tuning, channel: 0, key: 57, value: 0.5 }),
        (222, Action::Parameter(parameter("pluck_force"), 0.3)),
        (333, Action::Parameter(parameter("action"), 0.4)),
        (479, Action::NoteOff { channel: 0, key: 45 }),
        (15_002, Action::Midi([0x90, 52, 90])),
        (15_003, Action::Parameter(parameter("level"), 0.7)),
        (15_300, Action::Midi([0x80, 52, 0])),
        (15_350, Action::Transport(false)),
    ];
    score.extend((0..200).map(|step: u16| {
        let bend = 8192 + step * 20;
        (480 + 31 * u64::from(step), Action::Midi([0xE0, (bend & 127) as u8, (bend >> 7) as u8]))
    }));
    score.sort_by_key(|&(at, _)| at);
    score
}

fn play(host: &mut Host, score: &Score) -> [Vec<f32>; 2] {
    host.play(RATE, score, LENGTH, &[BLOCK as u32])
}

#[test]
fn disorder_sounds_as_order_does() {
    let expected = play(&mut Host::new(), &score());
    assert!(expected[0].iter().any(|&sample| sample.abs() > 1e-3));
    let backwards: Score = score().into_iter().rev().collect();
    assert!(play(&mut Host::new(), &backwards) == expected, "backwards");
    // Every third first, then the next ones.
    let dealt: Score = (0..3).flat_map(|first| score().into_iter().skip(first).step_by(3)).collect();
    assert!(play(&mut Host::new(), &dealt) == expected, "dealt out");
}

#[test]
fn what_comes_too_late_counts_at_the_last_sample() {
    let last = |at: u64| at - at % BLOCK + BLOCK - 1;
    let expected: Score = score().into_iter().map(|(at, action)| (last(at), action)).collect();
    let expected = play(&mut Host::new(), &expected);
    for mistake in [|time: u32| time + BLOCK as u32, |time: u32| u32::MAX - time] {
        let mut host = Host::new();
        host.mistaken = Some(mistake);
        // Counted from the end they come backwards, which is put right before they are late alike.
        assert!(play(&mut host, &score()) == expected);
        // And it still plays.
        host.mistaken = None;
        assert!(play(&mut host, &score())[0].iter().any(|&sample| sample.abs() > 1e-3));
    }
}

#[test]
fn ten_thousand_in_disorder_do_no_harm() {
    let wild: Score = (0..10_000_u64)
        .map(|step| {
            let (n, at) = (step as u8, step * 7919 % BLOCK);
            let action = match step % 4 {
                0 => Action::NoteOn { channel: n % 16, key: n % 128, velocity: n % 128 },
                1 => Action::NoteOff { channel: n % 16, key: n % 128 },
                2 => Action::Parameter(parameter("pluck_position"), f64::from(n) / 255.0),
                _ => Action::Transport(n % 2 == 0),
            };
            (at, action)
        })
        .collect();
    let mut host = Host::new();
    let far = |time: u32| if time.is_multiple_of(3) { time + 1_000_000 } else { time };
    for mistake in [None, Some(far as fn(u32) -> u32)] {
        host.mistaken = mistake;
        let [left, right] = play(&mut host, &wild);
        assert!(left.iter().chain(&right).all(|sample| sample.is_finite()));
    }
    host.mistaken = None;
    assert!(play(&mut host, &score())[0].iter().any(|&sample| sample.abs() > 1e-3));
}
