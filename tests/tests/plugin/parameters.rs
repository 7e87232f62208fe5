//! Promise: every parameter of the plugin does what it says, from one end of its range to the other, at the
//! sample at which it is set.
//!
//! Where a parameter stands for a value of the set-up, the sound must be that of an engine built from a
//! set-up in which that value was changed by hand. Elsewhere what is heard must change as predicted.

use std::collections::BTreeSet;

use low_action::controls::Touching;
use low_action::engine::{Engine, EngineOptions, Quality};
use low_action::params::LowActionParams;
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;
use low_action_dsp::setup::Pickup;
use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::parameters::{LENGTH, RATE, host_with, score, with};
use low_action_tests::user::isolate;
use nice_plug::prelude::Params;

/// The left channel of an engine.
fn engine(options: &EngineOptions, score: &Score) -> Vec<f32> {
    let touching = Touching::new(options.variation, options.bend_range);
    touched_engine(options, &Touching { take: options.seed, ..touching }, score)
}

/// The left channel of an engine played by such hands.
fn touched_engine(options: &EngineOptions, touching: &Touching, score: &Score) -> Vec<f32> {
    let mut engine = Engine::new(options).expect("the set-up is sound");
    engine.touch(touching);
    for &(at, action) in score {
        let event = match action {
            Action::NoteOn { channel, key, velocity } => {
                PlayerEvent::NoteOn { channel, key, velocity: f32::from(velocity) / 127.0 }
            }
            Action::NoteOff { channel, key } => PlayerEvent::NoteOff { channel, key },
            other => panic!("the score has no {other:?}"),
        };
        engine.event(at as u32, event);
    }
    let (mut left, mut right) = (vec![0.0; LENGTH], vec![0.0; LENGTH]);
    engine.process(&mut left, &mut right);
    left
}

fn options() -> EngineOptions {
    EngineOptions::new(Setup::builtin("electric").expect("it is built in"), RATE)
}

/// A parameter that stands for something an engine is built from: its ends, as hosts send them, and what
/// each means.
struct Built {
    id: &'static str,
    ends: [f64; 2],
    means: fn(&mut EngineOptions, high: bool),
}

fn pick(high: bool, low_value: f64, high_value: f64) -> f64 {
    if high { high_value } else { low_value }
}

const BUILT: &[Built] = &[
    Built {
        id: "instrument",
        ends: [0.0, 19.0],
        means: |options, high| {
            let name = if high { "five-string-bass" } else { "electric" };
            options.setup = Setup::shipped(name).expect("it comes with the program");
        },
    },
    Built {
        id: "quality",
        ends: [0.0, 3.0],
        means: |options, high| options.quality = if high { Quality::Reference } else { Quality::Draft },
    },
    Built {
        id: "render_quality",
        ends: [0.0, 4.0],
        means: |options, high| options.quality = if high { Quality::Reference } else { Quality::Live },
    },
    Built {
        id: "iterations",
        ends: [0.0, 200.0],
        means: |options, high| options.iterations = high.then_some(200),
    },
    Built {
        id: "action",
        ends: [0.0, 1.0],
        means: |options, high| {
            let neck = &mut options.setup.neck;
            neck.nut_clearance *= pick(high, 0.1, 3.0);
            neck.action *= pick(high, 0.1, 3.0);
            // As low as that, the last crowns would stand above the strings.
            neck.relief = neck.relief.min(neck.most_relief());
        },
    },
    Built {
        id: "relief",
        ends: [0.0, 1.0],
        means: |options, high| {
            let neck = &mut options.setup.neck;
            neck.relief = pick(high, 0.0, 0.0022).min(neck.most_relief());
        },
    },
    Built {
        id: "fret_height",
        ends: [0.0, 1.0],
        means: |options, high| options.setup.neck.fret_height *= pick(high, 0.1, 3.0),
    },
    Built {
        id: "loss_0",
        ends: [0.0, 1.0],
        means: |options, high| {
            options.setup.string.iter_mut().for_each(|string| string.loss_0 *= pick(high, 0.05, 20.0));
        },
    },
    Built {
        id: "loss_1",
        ends: [0.0, 1.0],
        means: |options, high| {
            options.setup.string.iter_mut().for_each(|string| string.loss_1 *= pick(high, 0.05, 20.0));
        },
    },
    Built {
        id: "tension_modulation",
        ends: [0.0, 1.0],
        means: |options, high| options.setup.tension_modulation = high,
    },
    Built {
        id: "pickup_position",
        ends: [0.0, 1.0],
        means: |options, high| {
            let Pickup::Magnetic { position, .. } = &mut options.setup.pickup else { panic!("no coil") };
            *position += pick(high, -0.12, 0.24);
        },
    },
    Built {
        id: "pickup_blend",
        ends: [0.0, 1.0],
        means: |options, high| options.setup.blend = pick(high, 0.0, 1.0),
    },
    Built {
        id: "tuning",
        ends: [0.0, 1.0],
        means: |options, high| options.setup.tuning = pick(high, -1.0, 1.0),
    },
    Built {
        id: "pluck_position",
        ends: [0.0, 1.0],
        means: |options, high| options.setup.player.pluck_position += pick(high, -0.1, 0.2),
    },
    Built {
        id: "pluck_force",
        ends: [0.0, 1.0],
        means: |options, high| options.setup.player.pluck_force *= pick(high, 0.05, 5.0),
    },
    Built {
        id: "pluck_duration",
        ends: [0.0, 1.0],
        means: |options, high| options.setup.player.pluck_duration *= pick(high, 0.1, 5.0),
    },
    Built {
        id: "pluck_release",
        // Less than nothing is nothing: as a wire does, at once.
        ends: [0.0, 1.0],
        means: |options, high| {
            let own = options.setup.player.pluck_release;
            options.setup.player.pluck_release = (own + pick(high, -0.001, 0.004)).max(0.0);
        },
    },
    Built {
        id: "variation",
        ends: [0.0, 1.0],
        means: |options, high| options.variation = pick(high, 0.0, 1.0),
    },
    Built {
        id: "take",
        ends: [0.0, 9_999.0],
        means: |options, high| options.seed = if high { 9_999 } else { 0 },
    },
];

#[test]
fn what_is_built_is_what_was_asked_for() {
    let usual = engine(&options(), &score());
    for Built { id, ends, means } in BUILT {
        let mut sounds = Vec::new();
        for (high, end) in [false, true].into_iter().zip(*ends) {
            let mut options = options();
            means(&mut options, high);
            let (expected, found) = (engine(&options, &score()), with(&[(id, end)], &score()));
            let differs = expected.iter().zip(&found).position(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!(differs, None, "{id} at {end}: not the sound of that set-up");
            sounds.push(found);
        }
        // A cap of 200 is never reached in these notes, and 0 stands for the quality's own. (What a low one does is heard below.)
        if *id != "iterations" {
            assert_ne!(sounds[0], sounds[1], "{id} changes nothing");
            assert!(sounds.iter().any(|sound| *sound != usual), "{id} changes nothing");
        }
    }
}

/// What hands do to a string is not what its set-up is made for, so these are no values of the set-up: parameter,
/// what it is at its ends, and what that is of the hands.
type Hands = (&'static str, [f64; 2], fn(&mut Touching) -> &mut f64);

const HANDS: &[Hands] = &[
    ("velocity_curve", [0.0, 4.0], |hands| &mut hands.velocity_curve),
    ("pluck_softest", [0.0, 1.0], |hands| &mut hands.pluck_softest),
    ("finger_force", [0.02, 4.0], |hands| &mut hands.finger_force),
    ("finger_hardness", [0.01, 10.0], |hands| &mut hands.finger_hardness),
    ("finger_mass", [0.1, 10.0], |hands| &mut hands.finger_mass),
    ("finger_hover", [0.0, 30.0], |hands| &mut hands.finger_hover),
    ("hand_damping", [0.05, 5.0], |hands| &mut hands.hand_damping),
];

#[test]
fn hands_are_what_was_asked_for() {
    // And a soft note on a high string, whose finger has the time to be more or less slow.
    let mut score = score();
    score.push((21_000, Action::NoteOn { channel: 0, key: 72, velocity: 20 }));
    let usual = engine(&options(), &score);
    for &(id, values, place) in HANDS {
        let mut sounds = Vec::new();
        for (end, value) in [0.0, 1.0].into_iter().zip(values) {
            let mut touching = Touching::default();
            *place(&mut touching) = value;
            let found = with(&[(id, end)], &score);
            assert!(found == touched_engine(&options(), &touching, &score), "{id} at {end}");
            sounds.push(found);
        }
        assert_ne!(sounds[0], sounds[1], "{id} changes nothing");
        assert!(sounds.iter().any(|sound| *sound != usual), "{id} changes nothing");
    }
}

/// How many strings are tuned here, by their own parameters: those of an electric guitar.
const TUNED_HERE: usize = 6;

#[test]
fn each_string_has_a_tuning() {
    // One key on each string.
    let keys: [u8; TUNED_HERE] = [40, 45, 50, 55, 59, 64];
    let chord: Score =
        keys.map(|key| (0, Action::NoteOn { channel: 0, key, velocity: 90 })).into_iter().collect();
    let usual = engine(&options(), &chord);
    for string in 0..keys.len() {
        for (end, semitones) in [(0.0, -12.0), (1.0, 7.0)] {
            let mut options = options();
            options.setup.string[string].pitch += semitones;
            let id = format!("string_tuning_{}", string + 1);
            let found = with(&[(&id, end)], &chord);
            assert!(found == engine(&options, &chord), "{id} at {end}: not the sound of that set-up");
            assert!(found != usual, "{id} at {end} changes nothing");
        }
    }
}

#[test]
fn everything_at_its_end_at_once_plays() {
    isolate();
    let params = LowActionParams::default();
    let params_of = params.param_map();
    // What would leave nothing to be heard, or another instrument.
    let kept = ["instrument", "instrument_file", "bypass", "level", "input_mode"];
    for instrument in 0..4 {
        for (end, rate) in [(0.0, 8000.0), (1.0, 8000.0), (0.0, 96_000.0), (1.0, 96_000.0)] {
            let mut settings: Score = params_of
                .iter()
                .filter(|(id, ..)| !kept.contains(&id.as_str()))
                .map(|(id, param, _)| {
                    // SAFETY: it is one of `params`, which live on.
                    let steps = unsafe { param.step_count() }.unwrap_or(1);
                    (0, Action::Parameter(parameter(id), end * steps as f64))
                })
                .collect();
            // The best quality takes minutes.
            settings.push((0, Action::Parameter(parameter("quality"), 1.0)));
            settings.push((0, Action::Parameter(parameter("render_quality"), 0.0)));
            settings.push((0, Action::Parameter(parameter("instrument"), f64::from(instrument))));
            let mut host = Host::new();
            host.play(rate, &settings, 64, &[64]);
            let length = (0.1 * rate) as usize;
            let notes = vec![(0, Action::NoteOn { channel: 0, key: 45, velocity: 110 })];
            let [left, _] = host.play(rate, &notes, length, &[512]);
            assert!(left.iter().all(|sample| sample.is_finite()), "{instrument}, {end}, {rate} Hz");
            assert!(left.iter().any(|&sample| sample != 0.0), "silent: {instrument}, {end}, {rate} Hz");
        }
    }
}

#[test]
fn a_change_counts_from_its_sample() {
    // The sixth instrument has other strings; those of the ninth go on, under hands that press less.
    for (id, value) in [
        ("pluck_force", 0.1),
        ("take", 7.0),
        ("action", 0.9),
        ("loss_1", 1.0),
        ("instrument", 6.0),
        ("instrument", 9.0),
    ] {
        let at = 12_345;
        let usual = with(&[], &score());
        let mut changed = score();
        changed.insert(2, (at, Action::Parameter(parameter(id), value)));
        changed.push((at + 1000, Action::NoteOn { channel: 0, key: 55, velocity: 100 }));
        let sounds =
            [64, 512, 8192, 24_000].map(|block| host_with(&[]).play(RATE, &changed, LENGTH, &[block]));
        let [first, ..] = &sounds;
        assert_eq!(first[0][..at as usize], usual[..at as usize], "{id} counts too early");
        assert_ne!(first[0][at as usize..], usual[at as usize..], "{id} never counts");
        for other in &sounds[1..] {
            assert!(first == other, "{id}: a rendering depends on the size of blocks");
        }
    }
}

/// A parameter that stands for nothing that an engine is built from or hands are given: how it is heard at all. (As what, other
/// files say.)
struct Heard {
    id: &'static str,
    /// Two of its values, as hosts send them.
    values: [f64; 2],
    /// What is set beside it.
    beside: &'static [(&'static str, f64)],
    /// What is played.
    score: fn() -> Score,
}

/// A C3 on a channel, 0 to 15, and messages of that channel before it.
fn on_channel(channel: u8, messages: &[[u8; 3]]) -> Score {
    let messages = messages.iter().map(|&[status, a, b]| (0, Action::Midi([status | channel, a, b])));
    messages.chain([(0, Action::NoteOn { channel, key: 48, velocity: 100 })]).collect()
}

const HEARD: &[Heard] = &[
    // In one iteration the blows of a hard pluck are not solved as in many.
    Heard { id: "iterations", values: [0.0, 1.0], beside: &[("pluck_force", 0.8)], score },
    Heard { id: "input_mode", values: [0.0, 2.0], beside: &[], score: || on_channel(1, &[]) },
    Heard {
        id: "first_channel",
        values: [0.0, 10.0],
        beside: &[("input_mode", 2.0)],
        score: || on_channel(1, &[]),
    },
    Heard {
        id: "string_order",
        values: [0.0, 1.0],
        beside: &[("input_mode", 2.0)],
        score: || on_channel(1, &[]),
    },
    Heard { id: "bend_range", values: [2.0, 3.0], beside: &[], score: || on_channel(0, &[[0xE0, 127, 127]]) },
    // A range of one semitone is announced.
    Heard {
        id: "ignore_rpn",
        values: [0.0, 1.0],
        beside: &[],
        score: || on_channel(0, &[[0xB0, 101, 0], [0xB0, 100, 0], [0xB0, 6, 1], [0xE0, 127, 127]]),
    },
    Heard { id: "tremolo_arm", values: [0.0, 1.0], beside: &[], score },
    // Two notes on one string.
    Heard {
        id: "legato",
        values: [0.0, 1.0],
        beside: &[("input_mode", 2.0)],
        score: || {
            let next = (6000, Action::NoteOn { channel: 2, key: 62, velocity: 100 });
            [on_channel(2, &[]), vec![next]].concat()
        },
    },
    // From key 46 on a C3 is the third keyswitch.
    Heard { id: "keyswitches", values: [0.0, 47.0], beside: &[], score: || on_channel(0, &[]) },
    Heard { id: "hand_position", values: [0.0, 12.0], beside: &[], score },
    Heard { id: "capo", values: [0.0, 5.0], beside: &[], score },
    // A palm.
    Heard {
        id: "hand_controllers",
        values: [0.0, 1.0],
        beside: &[],
        score: || on_channel(0, &[[0xB0, 20, 100]]),
    },
    // What the other strings of an instrument with a body hear.
    Heard { id: "idle_hands", values: [0.0, 1.0], beside: &[("instrument", 1.0)], score },
    Heard { id: "level", values: [0.0, 1.0], beside: &[], score },
    Heard { id: "bypass", values: [0.0, 1.0], beside: &[], score },
];

#[test]
fn what_is_neither_built_nor_of_the_hands_is_heard() {
    for Heard { id, values, beside, score } in HEARD {
        let [one, other] = values.map(|value| with(&[beside, &[(*id, value)][..]].concat(), &score()));
        assert!(one != other, "{id} changes nothing");
    }
}

/// Parameters that are not heard of one plugin that renders by itself, but with set-up files or in a hurry, and the tests in
/// which they are.
const ELSEWHERE: [(&str, &str); 4] = [
    ("instrument_file", include_str!("../plugin_files.rs")),
    ("string_tuning_7", include_str!("../plugin_files.rs")),
    ("string_tuning_8", include_str!("../plugin_files.rs")),
    ("relax", include_str!("budget.rs")),
];

#[test]
fn every_parameter_is_tested() {
    for (id, tests) in ELSEWHERE {
        assert!(tests.contains(&format!("\"{id}\"")), "{id} is set nowhere in those tests");
    }
    let tunings = (1..=TUNED_HERE).map(|number| format!("string_tuning_{number}"));
    let here = BUILT.iter().map(|built| built.id).chain(HANDS.iter().map(|hands| hands.0));
    let here = here.chain(HEARD.iter().map(|heard| heard.id)).chain(ELSEWHERE.map(|(id, _)| id));
    let tested: BTreeSet<String> = here.map(str::to_owned).chain(tunings).collect();
    isolate();
    let all: BTreeSet<String> =
        LowActionParams::default().param_map().into_iter().map(|(id, ..)| id).collect();
    assert_eq!(all, tested);
}

/// Who renders has time: a host that says so gets at least `studio`, without being asked.
#[test]
fn offline_means_studio_or_better() {
    let usual = |quality: f64| {
        let mut host = Host::new();
        host.play(RATE, &vec![(0, Action::Parameter(parameter("quality"), quality))], 64, &[64]);
        let [left, _] = host.play(RATE, &score(), LENGTH, &[512]);
        left
    };
    for (quality, expected) in [(0.0, Quality::Studio), (1.0, Quality::Studio), (3.0, Quality::Reference)] {
        let expected = engine(&EngineOptions { quality: expected, ..options() }, &score());
        let found = usual(quality);
        assert!(expected.iter().zip(&found).all(|(a, b)| a.to_bits() == b.to_bits()), "quality {quality}");
    }
}
