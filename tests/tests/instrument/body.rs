//! Promise: instruments that have a body are heard by it and lose to it what strings on a guitar lose, more where the body swings
//! most, and yet every note sounds and is near its pitch. A body rings on when strings are stilled, comes to rest, and gives
//! the same bits however samples are asked for. What cannot be is refused in one line.

use low_action_dsp::setup::Pickup;
use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture};
use low_action_tests::numbers::{largest, rms};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, at_the_bridge, decibels, hertz, off, on, peak};

const RATE: f64 = 48_000.0;

/// Those that have one.
const BODIES: [&str; 5] = ["classical", "steel", "ukulele", "flamenco", "school-guitar"];

fn shipped(name: &str) -> Setup {
    Setup::shipped(name).expect("it comes with the program")
}

/// A string of a set-up alone, with its body, and the keys of frets 0 to one, or to the last.
fn each_note(name: &str, last: usize, mut heard: impl FnMut(usize, u8, &[f32])) {
    let setup = shipped(name);
    for (index, spec) in setup.string.iter().enumerate() {
        let mut stage = Stage::over_body(&Setup { string: vec![spec.clone()], ..setup.clone() });
        for fret in 0..=last.min(setup.neck.frets) {
            let key = spec.pitch.round() as u8 + fret as u8;
            let played = stage.play(&[(0.0, on(key, 90))], 1.0);
            heard(index, key, &played.strings[0]);
        }
    }
}

#[test]
fn instruments_have_bodies_where_guitars_have_them() {
    for name in Setup::SHIPPED {
        let setup = shipped(name);
        assert_eq!(setup.body.is_some(), BODIES.contains(&name), "{name}");
        assert_eq!(setup.pickup == (Pickup::Microphone {}), BODIES.contains(&name), "{name}");
    }
}

/// How loud notes are depends on the body: it swings most at two low notes, and least between its modes.
#[test]
fn every_note_sounds_and_is_near_its_pitch() {
    let (mut softest, mut loudest, mut farthest): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for name in BODIES {
        let mut levels = Vec::new();
        let mut worst: f64 = 0.0;
        // (Without compensation stopped notes are sharp by themselves.)
        let in_tune = name != "school-guitar";
        each_note(name, usize::MAX, |string, key, sound| {
            let level = decibels(rms(&sound[1440..19_200]));
            levels.push(level);
            let expected = hertz(f64::from(key));
            let found = cents(frequency_near(&sound[2400..], RATE, expected), expected);
            println!("{name}, string {string}, key {key}: {level:.1} dBFS, {found:.1} cents");
            if in_tune {
                worst = worst.max(found.abs());
                assert!(found.abs() < 15.0, "{name}, string {string}, key {key}: {found} cents");
            }
        });
        let mean = levels.iter().sum::<f64>() / levels.len() as f64;
        let (low, high) = levels.iter().fold((f64::MAX, f64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
        println!(
            "{name}: {:.1} to {:.1} dB about {mean:.1} dBFS, {worst:.1} cents at most",
            low - mean,
            high - mean
        );
        (softest, loudest) = (softest.max(mean - low), loudest.max(high - mean));
        farthest = farthest.max(worst);
    }
    assert!(softest < 14.5 && loudest < 9.5, "{loudest} dB louder, {softest} dB softer than the mean");
    let levels = format!("up to {loudest:.0} dB louder than on the mean, and up to {softest:.0} softer");
    let [physics, formats] =
        [include_str!("../../../docs/physics.md"), include_str!("../../../docs/formats.md")];
    for (page, name, sentence) in [
        (physics, "physics.md", levels),
        (physics, "physics.md", format!("are off by up to {farthest:.0} cents")),
        (
            formats,
            "formats.md",
            format!("are up to {farthest:.0} cents off (`tests/tests/instrument/body.rs`)"),
        ),
    ] {
        assert!(page.contains(&sentence), "docs/{name} does not say: {sentence}");
    }
}

/// The time in which a sound would fall by 60 dB as it does from its first to its second half second.
fn decay(sound: &[f32]) -> f64 {
    let [first, second] = [2400..24_000, 26_400..48_000].map(|part| decibels(rms(&sound[part])));
    60.0 / (first - second) * 0.5
}

/// By the mean rate of all notes: nylon and steel strings of guitars ring for seconds, not for half a minute. What is expected is what
/// is documented.
#[test]
fn strings_lose_to_the_body() {
    for (name, falls, rigid) in [("classical", 4.2, 15.0), ("steel", 4.0, 13.0), ("ukulele", 2.0, 8.0)] {
        let (mut with, mut without) = (Vec::new(), Vec::new());
        each_note(name, 12, |_, _, sound| with.push(1.0 / decay(sound)));
        let setup = at_the_bridge(&shipped(name));
        for spec in &setup.string {
            let mut stage = Stage::new(&Setup { string: vec![spec.clone()], ..setup.clone() });
            for fret in 0..=12 {
                let played = stage.play(&[(0.0, on(spec.pitch.round() as u8 + fret, 90))], 1.0);
                without.push(1.0 / decay(&played.strings[0]));
            }
        }
        let [with, without] = [with, without].map(|all| all.len() as f64 / all.iter().sum::<f64>());
        println!("{name}: {with:.1} s with the body, {without:.1} s without");
        let near = |time: f64, expected: f64| (time / expected - 1.0).abs() < 0.06;
        assert!(near(with, falls) && near(without, rigid), "{name}: {with} s and {without} s");
    }
}

/// A key goes up after half a second: hands still the string, and what is left is the body's, which then is silent to the last bit.
#[test]
fn a_body_rings_on_and_comes_to_rest() {
    for name in BODIES {
        let setup = shipped(name);
        let last = setup.string.len() - 1;
        let pitch = setup.string[last].pitch.round() as u8;
        let mut stage = Stage::over_body(&setup);
        // Where the string begins to be at rest for good.
        let mut rests = 0.0;
        let played = stage.watch(&[(0.0, on(pitch, 100)), (0.5, off(pitch))], 6.0, |time, instrument| {
            if instrument.state(last).motion().any(|motion| motion != 0.0) {
                rests = time;
            }
        });
        let sound = &played.strings[last];
        assert!(decibels(rms(&sound[43_200..48_000])) < decibels(rms(&sound[4800..24_000])) - 40.0, "{name}");
        let after =
            largest(sound[(rests * RATE) as usize + 64..].iter().map(|sample| f64::from(sample.abs())));
        println!("{name}: the string rests from {rests:.2} s on, the body is then heard by {after:e}");
        assert!(rests > 0.5 && after > 0.0, "{name}: only the body is heard from {rests} s on");
        assert!(rests < 3.5, "{name}: all strings are at rest 3 s after the key is up, not at {rests} s");
        assert!(stage.instrument.is_silent(), "{name} is at rest");
        assert!(sound[240_000..].iter().all(|&sample| sample == 0.0), "{name} is silent");
    }
}

/// The first sound comes as soon as without a body. When the hand comes down the body rings on, and yet what is heard falls fast.
#[test]
fn notes_begin_at_once_and_end_soon() {
    let (mut latest, mut least) = (0.0_f64, f64::INFINITY);
    for name in BODIES {
        let setup = shipped(name);
        for (index, spec) in setup.string.iter().enumerate() {
            let mut stage = Stage::over_body(&Setup { string: vec![spec.clone()], ..setup.clone() });
            for (fret, velocity) in [(0, 50), (5, 50), (12, 50), (0, 120), (5, 120), (12, 120)] {
                let key = spec.pitch.round() as u8 + fret;
                let played = stage.play(&[(0.0, on(key, velocity)), (0.3, off(key))], 0.6);
                let sound = &played.strings[0];
                let heard = 0.01 * peak(&sound[..1_920]);
                let first =
                    sound.iter().position(|&sample| f64::from(sample.abs()) > heard).expect("it sounds");
                latest = latest.max(1e3 * first as f64 / RATE);
                let before = decibels(peak(&sound[12_960..14_400]));
                let down = before - decibels(peak(&sound[21_600..24_000]));
                println!("{name}, string {index}, fret {fret} at {velocity}: {first}, {down:.1} dB down");
                least = least.min(down);
            }
        }
    }
    println!("first after {latest:.2} ms, at least {least:.1} dB down after 150 ms");
    assert!(latest < 3.0 && least > 33.0, "first after {latest} ms, {least} dB down");
}

/// Also while strings fall asleep, bodies ring out, and strings wake again.
#[test]
fn a_body_sounds_alike_however_it_is_asked_for() {
    let length = 150_000;
    let render = |block: usize| {
        let mut instrument =
            Instrument::new(&shipped("steel"), &Quality::Live.settings(RATE)).expect("it can be built");
        let mut at = |time, string, gesture| {
            instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
        };
        let pluck = Gesture::Pluck { position: 0.5, force: -1.0, duration: 0.003, release: 0.0 };
        for string in 0..6 {
            at(100 * string as u64, string, pluck);
            at(12_000 + 100 * string as u64, string, Gesture::Still { loss: 300.0, duration: 0.4 });
            at(60_001 + 10_000 * string as u64, string, pluck);
        }
        let (mut left, mut right) = (vec![0.0; length], vec![0.0; length]);
        for (left, right) in left.chunks_mut(block).zip(right.chunks_mut(block)) {
            instrument.process(left, right);
        }
        (left, right)
    };
    let whole = render(length);
    assert!(rms(&whole.0[..12_000]) > 1e-3 && rms(&whole.0[110_000..]) > 1e-4, "it sounds");
    assert!(rms(&whole.0[55_000..60_000]) < 1e-6, "it is still between");
    for block in [1, 7, 480] {
        assert!(render(block) == whole, "in blocks of {block}");
    }
}

/// A coil is as loud as a microphone beside which it is heard, within 6 dB, and so is a piezo under the saddle, whatever
/// the rate.
#[test]
fn other_pickups_are_about_as_loud() {
    for name in BODIES {
        let shipped = shipped(name);
        let level = |setup: &Setup| {
            let mut stage = Stage::over_body(setup);
            let keys = setup.string.iter().map(|spec| (0.0, on(spec.pitch.round() as u8, 90)));
            let played = stage.play(&keys.collect::<Vec<_>>(), 0.5);
            decibels(played.strings.iter().map(|sound| rms(&sound[1440..]).powi(2)).sum::<f64>().sqrt())
        };
        let microphone = level(&shipped);
        let coil = level(&Setup { blend: 1.0, ..shipped.clone() });
        let gain = shipped.gain * shipped.body.expect("it has one").pascals_per_newton();
        let piezo = level(&Setup { pickup: Pickup::Bridge {}, gain, ..shipped });
        println!("{name}: {microphone:.1} dBFS, by a coil {coil:.1}, by a piezo {piezo:.1}");
        assert!((coil - microphone).abs() < 6.0 && (piezo - microphone).abs() < 6.0, "{name}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let text = |body: &str, pickup: &str| {
        let base = "based_on = \"electric\"\nname = \"x\"\n[pickup]\n";
        let setup = Setup::from_toml(&format!("{base}{pickup}\n{body}"));
        setup.and_then(|setup| Instrument::new(&setup, &Quality::Live.settings(RATE)).map(drop))
    };
    let body = |key: &str, value: &str| {
        let keys = [
            ("frequency", "150.0"),
            ("mass", "0.2"),
            ("area", "0.06"),
            ("quality", "15.0"),
            ("spacing", "45.0"),
            ("volume", "0.0145"),
            ("hole", "0.0055"),
        ];
        let lines =
            keys.map(|(name, usual)| format!("{name} = {}\n", if name == key { value } else { usual }));
        format!("[body]\n{}", lines.concat())
    };
    let microphone = "kind = \"microphone\"";
    assert!(text(&body("", ""), microphone).is_ok());
    assert!(text(&body("", ""), "kind = \"bridge\"").is_ok(), "the bridge gives way, and is heard itself");
    for (key, value, accepted) in [
        ("frequency", "29.0", "body.frequency = 29 is refused: it must lie between 30 and 2000 Hz"),
        ("mass", "0.001", "body.mass = 0.001 is refused: it must lie between 0.01 and 1000 kg"),
        ("area", "2.0", "body.area = 2 is refused: it must lie between 1e-4 and 1 m²"),
        ("quality", "0.5", "body.quality = 0.5 is refused: it must lie between 1 and 200"),
        ("spacing", "1.0", "body.spacing = 1 is refused: it must lie between 5 and 1000 Hz"),
        ("volume", "2.0", "body.volume = 2 is refused: it must lie between 1e-4 and 1 m³"),
        ("hole", "1.0", "body.hole = 1 is refused: it must lie between 1e-5 and 0.1 m²"),
    ] {
        let error = text(&body(key, value), microphone).expect_err("it is out of range").to_string();
        assert_eq!(error, accepted);
    }
    let bridge = "[bridge]\nlength = 0.01\nradius = 1.0\n".to_owned();
    let error = text(&(bridge + &body("", "")), microphone).expect_err("a wide bridge rests").to_string();
    assert!(
        error.starts_with("body = a table is refused: there must be none beside a wide [bridge]"),
        "{error}"
    );
    // What a set-up is based on may be taken away, and nothing else may stand in its place.
    let rigid = "name = \"x\"\nbased_on = \"steel\"\nbody = false\npickup = { kind = \"bridge\" }";
    assert_eq!(Setup::from_toml(rigid).expect("it is valid").body, None);
    let error = Setup::from_toml(&rigid.replace("false", "true")).expect_err("it says nothing").to_string();
    assert!(error.contains("body") && error.contains("a table or `false`"), "{error}");
    let error = Setup::from_toml("based_on = \"steel\"\nbody = { mas = 1.0 }").expect_err("none").to_string();
    assert!(error.contains("mas") && error.contains("mass"), "{error}");
    let error = text("", microphone).expect_err("there is none").to_string();
    assert!(error.contains("pickup.kind") && error.contains("[body]"), "{error}");
    let crowded = body("mass", "0.01").replace("spacing = 45.0", "spacing = 5.0");
    let error = text(&crowded, microphone).expect_err("it is too light").to_string();
    let said = error
        .strip_prefix("body.mass = 0.01 is refused: it must be at least ")
        .and_then(|rest| rest.strip_suffix(" kg"));
    let least = said.unwrap_or_else(|| panic!("{error}"));
    let heavier = crowded.replace("mass = 0.01", &format!("mass = {least}"));
    assert!(text(&heavier, microphone).is_ok(), "{least} kg are enough");
}
