//! Tuning, from rendered sound at 48 kHz, `live`: the first partial between 0.25 and 1.35 s after a note
//! at velocity 60 lies within a cent of equal temperament on every fret and every open string of the four
//! built-in set-ups, at a bridge that stands still (how far a body puts notes off is in `body`), and on open strings and every third
//! fret of presets that are to be in tune, or as near as what they show lets them be; and every semitone on a bare board within 10.

use std::f64::consts::TAU;

use low_action::engine::{Engine, EngineOptions, Quality};
use low_action::performance::PlayerEvent;
use low_action_dsp::intonation::{intonate, stopped_frequencies};
use low_action_dsp::setup::{Intonation, frequency};
use low_action_dsp::{Gesture, Instrument, Setup, TimedGesture};
use low_action_tests::numbers::{largest, smallest};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::at_the_bridge;

const RATE: f64 = 48_000.0;
const FROM: f64 = 0.25;
const TO: f64 = 1.35;

/// The part of a sound that is measured.
fn measured(sound: &[f32]) -> &[f32] {
    &sound[(FROM * RATE) as usize..(TO * RATE) as usize]
}

/// The instrument with only one of its strings.
fn alone(setup: &Setup, string: usize) -> Setup {
    Setup { string: vec![setup.string[string].clone()], ..setup.clone() }
}

/// The same, ready to be handled without an engine.
fn string_alone(setup: &Setup, string: usize) -> Instrument {
    Instrument::new(&alone(setup, string), &Quality::Live.settings(RATE)).unwrap()
}

/// Errors in cents of frets, 0 for the open string, played by the engine on an instrument that has
/// only this string, so that it is played on this string.
fn errors(setup: &Setup, string: usize, frets: &[usize]) -> Vec<f64> {
    let options = EngineOptions { variation: 0.0, ..EngineOptions::new(alone(setup, string), RATE) };
    let mut engine = Engine::new(&options).unwrap();
    let samples = (TO * RATE) as usize;
    frets
        .iter()
        .map(|&fret| {
            let key = setup.string[string].pitch as u8 + fret as u8;
            engine.reset();
            engine.event(0, PlayerEvent::NoteOn { channel: 0, key, velocity: 60.0 / 127.0 });
            let [mut left, mut right, mut sound] = [(); 3].map(|()| vec![0.0; samples]);
            engine.process_stems(&mut [&mut sound], &mut left, &mut right);
            let target = frequency(f64::from(key));
            cents(frequency_near(measured(&sound), RATE, target), target)
        })
        .collect()
}

/// Errors of every string of a set-up at some of its frets, the open string first, two strings at a time, with a line of report
/// for each.
fn errors_at(setup: &Setup, frets: impl Fn(usize) -> Vec<usize> + Sync) -> Vec<Vec<f64>> {
    let mut all: Vec<Vec<f64>> = vec![Vec::new(); setup.string.len()];
    for (pair, slots) in all.chunks_mut(2).enumerate() {
        std::thread::scope(|scope| {
            for (string, slot) in (2 * pair..).zip(slots) {
                let frets = &frets;
                scope.spawn(move || *slot = errors(setup, string, &frets(string)));
            }
        });
    }
    for (string, errors) in setup.string.iter().zip(&all) {
        let cents: Vec<String> = errors.iter().map(|error| format!("{error:.2}")).collect();
        println!("{} {}: {}", setup.name, string.name, cents.join(" "));
    }
    let fretted = || all.iter().flat_map(|errors| &errors[1..]).map(|error| error.abs());
    let open = largest(all.iter().map(|errors| errors[0].abs()));
    println!(
        "{}: open at most {open:.2} cents off, fretted at most {:.2}, on average {:.2}",
        setup.name,
        largest(fretted()),
        fretted().sum::<f64>() / fretted().count() as f64,
    );
    all
}

/// The same at every fret.
fn all_errors(setup: &Setup) -> Vec<Vec<f64>> {
    errors_at(setup, |_| (0..=setup.neck.frets).collect())
}

fn check(name: &str) {
    let setup = at_the_bridge(&Setup::builtin(name).unwrap());
    for (string, errors) in setup.string.iter().zip(all_errors(&setup)) {
        for (fret, error) in errors.iter().enumerate() {
            assert!(error.abs() <= 1.0, "{name} {} fret {fret}: {error:.2} cents off", string.name);
        }
    }
}

#[test]
fn electric_plays_in_tune() {
    check("electric");
}

#[test]
fn classical_plays_in_tune() {
    check("classical");
}

#[test]
fn steel_plays_in_tune() {
    check("steel");
}

#[test]
fn bass_plays_in_tune() {
    check("bass");
}

/// How far open strings and frets of a preset may be off, cents; nothing where frets are looked at elsewhere, or are not to be in tune
/// at all.
fn preset_tolerances(name: &str) -> (f64, Option<f64>) {
    match name {
        // The semitones of a bare board are below, fingers of `light-fingers` do not hold strings down, and nobody has set up the
        // `school-guitar`.
        "fretless-bass" | "light-fingers" | "school-guitar" => (1.0, None),
        // While it swings a string holds less of a curved bridge than at rest, which is what frets and strings are tuned for.
        "sitar" => (1.5, Some(16.0)),
        "tanpura" => (2.5, None),
        // Plucked so hard that a low E is still stretched by as much.
        "slap-bass" => (1.25, Some(1.25)),
        _ => (1.0, Some(1.0)),
    }
}

/// Every third fret, beginning with another on each string.
#[test]
fn presets_play_in_tune() {
    for name in Setup::PRESETS {
        let setup = at_the_bridge(&Setup::shipped(name).unwrap());
        let (open, fretted) = preset_tolerances(name);
        let frets = if fretted.is_some() { setup.neck.frets } else { 0 };
        let third = |string: usize| -> Vec<usize> {
            (0..=frets).filter(|fret| *fret == 0 || (string + fret).is_multiple_of(3)).collect()
        };
        for (string, errors) in errors_at(&setup, third).into_iter().enumerate() {
            for (fret, error) in third(string).into_iter().zip(errors) {
                let most = if fret == 0 { open } else { fretted.expect("others are not played") };
                let what = format!("{name} {} fret {fret}", setup.string[string].name);
                assert!(error.abs() <= most, "{what}: {error:.2} cents off");
            }
        }
    }
}

/// Checks semitones of a string on a bare board at a velocity: within 10 cents of equal temperament, and within 2 of what is said of
/// it before it is played. Gives back how far each is off the one and the other.
fn check_bare(
    setup: &Setup,
    string: usize,
    semitones: std::ops::RangeInclusive<usize>,
    rate: f64,
    velocity: f32,
) -> Vec<[f64; 2]> {
    let setup = alone(setup, string);
    let options = EngineOptions { variation: 0.0, ..EngineOptions::new(setup.clone(), rate) };
    let settings = options.quality.settings(rate);
    let spec = &setup.string[0];
    let step_rate = settings.ratio(&setup, spec).value() * rate;
    let placed = intonate(&setup, spec, settings.stencil, step_rate).unwrap();
    let said = stopped_frequencies(&setup, spec, &placed, settings.stencil, step_rate).unwrap();
    let mut engine = Engine::new(&options).unwrap();
    let [from, to] = [0.15, 0.65].map(|seconds| (seconds * rate) as usize);
    let check = |semitone: usize| {
        let key = spec.pitch as u8 + semitone as u8;
        engine.reset();
        engine.event(0, PlayerEvent::NoteOn { channel: 0, key, velocity: velocity / 127.0 });
        let [mut left, mut right, mut sound] = [(); 3].map(|()| vec![0.0; to]);
        engine.process_stems(&mut [&mut sound], &mut left, &mut right);
        let target = frequency(f64::from(key));
        let heard = frequency_near(&sound[from..], rate, target);
        let (off, apart) = (cents(heard, target), cents(heard, said[semitone - 1]));
        let what =
            format!("{} {} semitone {semitone} at {rate} Hz, velocity {velocity}", setup.name, spec.name);
        println!("{what}: {off:.2} cents off, {apart:.2} from what is said");
        assert!(off.abs() < 10.0, "{what}: {off:.2} cents off");
        assert!(apart.abs() < 2.0, "{what}: {apart:.2} cents from what is said");
        [off, apart]
    };
    semitones.map(check).collect()
}

/// A string ends at a point of its grid there, by half a spacing beside where its pitch wants it at most: 9.6 cents at the last
/// semitone. How hard it swings makes no more than 2.
#[test]
fn a_bare_board_plays_in_tune() {
    let setup = Setup::shipped("fretless-bass").unwrap();
    let mut usual = Vec::new();
    for rate in [44_100.0, 48_000.0, 96_000.0] {
        std::thread::scope(|scope| {
            let halves = [[0, 1], [2, 3]].map(|strings| {
                let setup = &setup;
                scope.spawn(move || strings.map(|string| check_bare(setup, string, 1..=20, rate, 60.0)))
            });
            usual.extend(halves.into_iter().flat_map(|half| half.join().expect("all are in tune")));
        });
    }
    // As hard as can be where the string swings farthest beside its length, and softly.
    let [_, hard] = [20.0, 127.0].map(|velocity| check_bare(&setup, 3, 13..=20, RATE, velocity));
    // And as the page says.
    let most = |found: &[[f64; 2]], which: usize| largest(found.iter().map(|both| both[which].abs()));
    let mean = |string: &Vec<[f64; 2]>| {
        (string.iter().map(|both| both[0] * both[0]).sum::<f64>() / string.len() as f64).sqrt()
    };
    let all = usual.concat();
    let page = include_str!("../../../docs/trade.md");
    for said in [
        format!("All semitones of `fretless-bass` are within {:.1} cents", most(&all, 0)),
        format!(
            "{:.1} to {:.1} root mean square a string",
            smallest(usual.iter().map(mean)),
            largest(usual.iter().map(mean))
        ),
        format!("within {:.1} of what is said of them", most(&all, 1)),
        format!("at velocity 60, {:.1} at 127", most(&hard, 1)),
    ] {
        assert!(page.contains(&said), "docs/trade.md does not say: {said}");
    }
}

/// Where the part behind the finger is as long as the one that sounds, twice as long or three times, it has a partial of the same pitch:
/// the one is not taken for the other.
#[test]
fn a_string_behind_the_finger_does_not_mislead_it() {
    let bare = |base: &str, neck: &str, rest: &str| {
        let text = format!("name = \"bare\"\nbased_on = \"{base}\"\n[neck]\nfretless = true\n{neck}\n{rest}");
        Setup::from_toml(&text).unwrap()
    };
    let guitar = bare(
        "electric",
        "fret_height = 0.0\nstiffness = 1e9",
        "[player.fretting]\nstiffness = 1e8\nforce = 10.0",
    );
    check_bare(&guitar, 2, 11..=13, RATE, 60.0);
    check_bare(&guitar, 3, 11..=13, RATE, 60.0);
    check_bare(&guitar, 3, 18..=20, RATE, 60.0);
    let bass = bare("bass", "frets = 24", "[player.fretting]\nstiffness = 1e8\nforce = 15.0");
    check_bare(&bass, 0, 23..=24, RATE, 60.0);
}

/// Without compensation, pressing sharpens: this is what the fret places make up for.
#[test]
fn raw_intonation_is_sharp_by_what_pressing_does() {
    let mut setup = Setup::builtin("electric").unwrap();
    setup.intonation = Intonation::Physical;
    setup.string = vec![setup.string[2].clone(), setup.string[5].clone()];
    for errors in all_errors(&setup) {
        assert!(errors[0].abs() <= 1.0, "the open string is tuned: {:.2} cents", errors[0]);
        assert!(errors[1..].iter().all(|&error| (3.0..40.0).contains(&error)), "{errors:.1?}");
    }
}

/// The pitch of a string whose finger is handled by `hand` and which is plucked 0.4 s later.
fn handled(setup: &Setup, string: usize, hand: &[(f64, Gesture)], target: f64) -> f64 {
    const PLUCK: f64 = 0.4;
    let mut instrument = string_alone(setup, string);
    let player = &setup.player;
    let pluck = Gesture::Pluck {
        position: instrument.geometry(0).length - player.pluck_position,
        force: 0.3 * player.pluck_force,
        duration: player.pluck_duration,
        release: 0.0,
    };
    for &(time, gesture) in hand.iter().chain([&(PLUCK, pluck)]) {
        let time = (time * RATE) as u64;
        instrument.schedule(TimedGesture { time, string: 0, gesture }).unwrap();
    }
    let samples = ((PLUCK + TO) * RATE) as usize;
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; samples]);
    instrument.process(&mut left, &mut right);
    cents(frequency_near(measured(&left[(PLUCK * RATE) as usize..]), RATE, target), target)
}

/// A straight barré lies at one place across strings whose frets differ a little: still in tune.
#[test]
fn barres_are_in_tune() {
    for name in ["electric", "classical"] {
        let setup = at_the_bridge(&Setup::builtin(name).unwrap());
        let fretting = setup.player.fretting;
        for fret in [1, 5] {
            // The finger lies where it would on the middle of a neck with straight frets.
            let (crown, below) =
                (setup.neck.equal_place(f64::from(fret)), setup.neck.equal_place(f64::from(fret - 1)));
            let position = crown - 0.5 * (crown - below);
            let hand = [
                (
                    0.0,
                    Gesture::Place { finger: 0, touch: fretting.touch, position, clearance: fretting.hover },
                ),
                (0.0, Gesture::Press { finger: 0, force: fretting.force, duration: fretting.landing }),
            ];
            for (index, string) in setup.string.iter().enumerate() {
                let target = frequency(string.pitch + f64::from(fret));
                let error = handled(&setup, index, &hand, target);
                println!("{name} barré {fret} {}: {error:.2} cents", string.name);
                assert!(error.abs() <= 3.0, "{name} {} barré at {fret}: {error:.2} cents", string.name);
            }
        }
    }
}

/// A finger that slides to a fret stops the string as one that landed there.
#[test]
fn slides_end_in_tune() {
    let setup = Setup::builtin("electric").unwrap();
    let fretting = setup.player.fretting;
    for (string, from, to) in [(0, 5, 7), (2, 12, 9), (5, 2, 7)] {
        let instrument = string_alone(&setup, string);
        let place = |fret| instrument.geometry(0).finger_position(fret);
        let touch = fretting.touch;
        let hand = [
            (0.0, Gesture::Place { finger: 0, touch, position: place(from), clearance: fretting.hover }),
            (0.0, Gesture::Press { finger: 0, force: fretting.force, duration: fretting.landing }),
            (0.1, Gesture::Slide { finger: 0, position: place(to), duration: 0.15 }),
        ];
        let target = frequency(setup.string[string].pitch + to as f64);
        let error = handled(&setup, string, &hand, target);
        println!("slide on {} from {from} to {to}: {error:.2} cents", setup.string[string].name);
        assert!(error.abs() <= 3.0, "{error:.2} cents");
    }
}

/// The measure itself: partials of a stiff string with known frequency and decay, to 0.05 cents.
#[test]
fn the_measure_finds_known_frequencies() {
    for (pitch, offset, t60) in
        [(28.0, 0.0, 25.0), (28.0, 2.5, 3.0), (40.0, -11.0, 8.0), (64.0, 0.9, 2.0), (86.0, -29.0, 0.5)]
    {
        let first = frequency(pitch) * (offset / 1200.0_f64).exp2();
        let partials = 12;
        let sound: Vec<f32> = (0..(TO * RATE) as usize)
            .map(|n| {
                let t = n as f64 / RATE;
                let sum: f64 = (1..=partials)
                    .map(|k| {
                        let k = f64::from(k);
                        let inharmonic = (1.0 + 1e-4 * (k * k - 1.0)).sqrt();
                        let decay = 1000.0_f64.ln() / t60 * (1.0 + 0.1 * (k * k - 1.0));
                        (TAU * first * k * inharmonic * t + k).sin() * (-decay * t).exp()
                    })
                    .sum();
                (0.1 * sum) as f32
            })
            .collect();
        let found = frequency_near(measured(&sound), RATE, frequency(pitch));
        let error = cents(found, first);
        assert!(error.abs() < 0.05, "{first} Hz: {error:.4} cents off");
    }
}
