//! Promise: looking at the strings costs next to nothing and alters nothing. The sound is the same bits whether or not
//! anybody looks, a snapshot allocates nothing, and what it shows is what the strings do.

use low_action::display::{Health, POINTS, Reader, Writer, display};
use low_action::engine::{Engine, EngineOptions};
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;
use low_action_dsp::pickup::stretch_tension;
use low_action_tests::numbers::largest;
use low_action_tests::watch;
use nice_assert_no_alloc::assert_no_alloc;

const RATE: f64 = 48_000.0;
const BLOCK: usize = 256;

fn engine(setup: &str) -> Engine {
    let setup = Setup::shipped(setup).expect("it comes with the program");
    Engine::new(&EngineOptions { variation: 0.0, ..EngineOptions::new(setup, RATE) })
        .expect("it can be built")
}

fn on(key: u8, velocity: f32) -> PlayerEvent {
    PlayerEvent::NoteOn { channel: 0, key, velocity }
}

/// Plays blocks, with somebody who looks or not; gives the bits of the sound.
fn play(
    engine: &mut Engine,
    blocks: usize,
    writer: &mut Writer,
    looked_at: impl Fn(usize) -> bool,
) -> Vec<u32> {
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    let mut bits = Vec::with_capacity(2 * BLOCK * blocks);
    for block in 0..blocks {
        for (at, key) in [(0, 40), (20, 47), (40, 52), (60, 59), (61, 40)] {
            if block == at {
                engine.event(17, on(key, 1.0));
            }
        }
        assert_no_alloc(|| {
            writer.look(looked_at(block), engine);
            engine.process(&mut left, &mut right);
            writer.write(engine, BLOCK, Health::default());
        });
        bits.extend(left.iter().chain(&right).map(|sample| sample.to_bits()));
    }
    bits
}

/// The latest picture after so many blocks of a hard low E.
fn seen(blocks: usize) -> (Engine, Reader) {
    let (mut writer, mut reader) = display();
    let mut engine = engine("electric");
    play(&mut engine, blocks, &mut writer, |_| true);
    assert!(reader.fetch(), "there is no picture");
    (engine, reader)
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "in a release build nobody keeps watch over allocations")]
fn the_watch_over_allocations_is_kept() {
    watch::assert_it_is_kept(module_path!(), "the_watch_over_allocations_is_kept");
}

#[test]
fn the_sound_is_the_same_bits() {
    let (mut unseen, _reader) = display();
    let bits = play(&mut engine("electric"), 120, &mut unseen, |_| false);
    assert!(bits.iter().any(|bits| f32::from_bits(*bits).abs() > 1e-2), "nothing sounds");
    let (mut writer, mut reader) = display();
    assert!(play(&mut engine("electric"), 120, &mut writer, |_| true) == bits, "looked at");
    assert!(reader.fetch());
    let (mut writer, _reader) = display();
    let now_and_then = |block: usize| (block / 7).is_multiple_of(2);
    assert!(play(&mut engine("electric"), 120, &mut writer, now_and_then) == bits, "now and then");
}

#[test]
fn nothing_is_written_while_nobody_looks() {
    let (mut writer, mut reader) = display();
    play(&mut engine("electric"), 60, &mut writer, |_| false);
    assert!(!reader.fetch());
    assert_eq!(reader.latest().number, 0);
    assert!(reader.latest().strings().is_empty());
}

#[test]
fn sixty_a_second_at_most_and_only_the_latest() {
    let (mut writer, mut reader) = display();
    let mut engine = engine("electric");
    let seconds = 2.0;
    play(&mut engine, (seconds * RATE) as usize / BLOCK, &mut writer, |_| true);
    assert!(reader.fetch());
    // A picture comes with the block in which 800 samples are over, a sixtieth of a second, since the last: with the first of 375, and
    // then, where blocks are 256, with every fourth. That is 94.
    let number = reader.latest().number;
    assert!((93..=95).contains(&number), "{number}");
    assert!(!reader.fetch(), "seen twice");
    play(&mut engine, 8, &mut writer, |_| true);
    assert!(reader.fetch());
}

/// One more block.
fn go_on(engine: &mut Engine, writer: &mut Writer, looked_at: bool) {
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    writer.look(looked_at, engine);
    engine.process(&mut left, &mut right);
    assert_no_alloc(|| writer.write(engine, BLOCK, Health::default()));
}

/// As where the editor draws less often than sixty times a second.
#[test]
fn what_happened_in_one_that_nobody_has_fetched_is_in_the_next() {
    let fetched = |every: usize| {
        let (mut writer, mut reader) = display();
        let mut engine = engine("electric");
        let (mut hit, mut highest, mut plucks) = (0.0_f32, 0.0_f32, 0);
        engine.event(0, on(40, 1.0));
        for block in 1..=60 {
            go_on(&mut engine, &mut writer, true);
            if block % every == 0 && reader.fetch() {
                let string = &reader.latest().strings()[5];
                hit = string.frets().iter().map(|fret| fret.hit).fold(hit, f32::max);
                highest = string.highest.iter().copied().fold(highest, f32::max);
                plucks += usize::from(string.pluck.is_some());
            }
        }
        (hit, highest, plucks)
    };
    let all = fetched(1);
    assert!(all.0 > 0.1 && all.1 > 1e-4 && all.2 == 1, "{all:?}");
    assert_eq!(fetched(60), all);
}

/// What happened before a window was closed is not seen in the next one.
#[test]
fn what_happened_before_somebody_looked_again_is_over() {
    let (mut writer, mut reader) = display();
    let mut engine = engine("electric");
    engine.event(0, on(40, 1.0));
    for block in 0..60 {
        go_on(&mut engine, &mut writer, !(50..59).contains(&block));
    }
    assert!(reader.fetch());
    assert!(reader.latest().strings().iter().all(|string| string.pluck.is_none()));
}

#[test]
fn still_strings_are_seen_less_often_and_at_once_when_they_move() {
    let (mut writer, mut reader) = display();
    let mut engine = engine("electric");
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    let mut block = |engine: &mut Engine| {
        writer.look(true, engine);
        engine.process(&mut left, &mut right);
        writer.write(engine, BLOCK, Health::default());
    };
    let mut in_two_seconds = |engine: &mut Engine, reader: &mut Reader| {
        let before = reader.latest().number;
        (0..(2.0 * RATE) as usize / BLOCK).for_each(|_| block(engine));
        reader.fetch();
        reader.latest().number - before
    };
    // At rest, ringing, and plucked so softly that they move, but nobody sees it.
    let resting = in_two_seconds(&mut engine, &mut reader);
    assert!((6..=10).contains(&resting), "{resting} at rest");
    engine.event(0, on(40, 1.0));
    let ringing = in_two_seconds(&mut engine, &mut reader);
    assert!(ringing > 80, "{ringing} while it rings");
    engine.event(0, PlayerEvent::AllNotesOff);
    in_two_seconds(&mut engine, &mut reader);
    engine.event(0, on(40, 0.004));
    let soft = in_two_seconds(&mut engine, &mut reader);
    assert!((6..=10).contains(&soft) && !engine.is_silent(), "{soft} after the softest pluck");
    let string = &reader.latest().strings()[5];
    let widest = largest(string.highest.iter().zip(string.lowest).map(|(high, low)| high - low));
    assert!(widest > 0.0 && widest < 5e-6, "{widest} m");
    engine.event(0, on(40, 1.0));
    (0..4).for_each(|_| block(&mut engine));
    assert!(reader.fetch(), "the pluck is not seen");
    assert!(reader.latest().strings()[5].displacement.iter().any(|u| u.abs() > 1e-4));
}

#[test]
fn strings_are_where_they_are() {
    // The picture after the fifth block is the second.
    let (engine, reader) = seen(5);
    assert_eq!(reader.latest().number, 2);
    let (instrument, low_e) = (engine.instrument(), 5);
    let string = &reader.latest().strings()[low_e];
    let (model, state) = (instrument.model(low_e), instrument.state(low_e));
    assert_eq!(reader.latest().strings().len(), 6);
    let largest = largest(string.displacement.iter().map(|u| u.abs()));
    assert!(largest > 1e-4, "it does not move: {largest} m");
    for point in 0..POINTS {
        let shown = string.displacement[point];
        let reading = model.grid.reading(f64::from(string.place(point)));
        let there = state.displacement_at(&reading) as f32;
        assert!(
            f64::from((shown - there).abs()) < 0.02 * largest,
            "point {point}: {shown} m instead of {there} m"
        );
        assert!((string.lowest[point]..=string.highest[point]).contains(&shown), "point {point}");
    }
    assert_eq!((string.displacement[0], string.displacement[POINTS - 1]), (0.0, 0.0));
    assert_eq!(string.frets().len(), 22);
    let resting = &reader.latest().strings()[0];
    assert!(resting.displacement.iter().all(|u| *u == 0.0) && resting.contacts == 0);
}

#[test]
fn fingers_plucks_and_forces_are_seen() {
    let (mut writer, mut reader) = display();
    let mut engine = engine("electric");
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    // F on the low string: first fret.
    engine.event(0, on(41, 1.0));
    let (mut plucked, mut hit, mut iterated) = (None, 0.0, 0.0);
    for _ in 0..40 {
        writer.look(true, &mut engine);
        engine.process(&mut left, &mut right);
        writer.write(&mut engine, BLOCK, Health { load: 0.25, relaxed: false });
        if reader.fetch() {
            let string = &reader.latest().strings()[5];
            plucked = plucked.or(string.pluck);
            hit = largest(string.frets().iter().map(|fret| f64::from(fret.hit)).chain([hit]));
            iterated = largest([iterated, f64::from(string.iterations)]);
        }
    }
    let string = &reader.latest().strings()[5];
    let pluck = plucked.expect("a pluck");
    let from_saddle = string.length - pluck.position;
    assert!((0.1..0.14).contains(&from_saddle) && pluck.force > 0.7, "{pluck:?}");
    assert!(hit > 0.5, "no fret was hit: {hit} N");
    assert!(iterated > 0.5, "{iterated} iterations a step");
    let finger = string.fingers.iter().flatten().next().expect("a finger");
    assert!((f64::from(finger.pressed) - 6.0).abs() < 0.01 && finger.force > 1.0, "{finger:?}");
    assert!(finger.position < string.frets()[0].position);
    let fret = string.frets()[0];
    assert!(fret.force > 0.1 && (0.0..1e-5).contains(&fret.penetration), "{fret:?}");
    assert!(string.tension > 50.0 && string.energy > 1e-8);
    assert_eq!(reader.latest().health.load, 0.25);
}

#[test]
fn what_stretching_adds_is_seen() {
    let (mut writer, mut reader) = display();
    let mut engine = engine("electric");
    engine.event(0, on(40, 1.0));
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    let mut most = 0.0;
    for _ in 0..40 {
        writer.look(true, &mut engine);
        engine.process(&mut left, &mut right);
        writer.write(&mut engine, BLOCK, Health::default());
        if !reader.fetch() {
            continue;
        }
        let (instrument, low_e) = (engine.instrument(), 5);
        let (model, scratch) = (instrument.model(low_e), instrument.scratch(low_e));
        let string = &reader.latest().strings()[low_e];
        let more = stretch_tension(model, scratch);
        assert_eq!(string.rest_tension, model.string.tension as f32);
        assert_eq!(string.tension, (model.string.tension + more) as f32);
        // A spring that pulls by so much more holds half the square of that over its stiffness EA/L.
        let stretched = 0.5 * more * more * model.string.length / model.string.axial_stiffness();
        let energy = (scratch.string_energy() + stretched) as f32;
        assert!((string.energy / energy - 1.0).abs() < 1e-6, "{} J instead of {energy} J", string.energy);
        most = largest([most, f64::from(string.tension / string.rest_tension) - 1.0]);
        let resting = &reader.latest().strings()[0];
        assert_eq!(resting.tension, resting.rest_tension);
    }
    assert!(most > 1e-3, "hardly stretched: {most}");
}

/// The latest picture of a low string after so many blocks, softly plucked where a finger stops it.
fn stopped(setup: &str, key: u8, blocks: usize) -> (Engine, Reader) {
    let (mut writer, mut reader) = display();
    let mut engine = engine(setup);
    engine.event(0, on(key, 0.02));
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    for _ in 0..blocks {
        writer.look(true, &mut engine);
        engine.process(&mut left, &mut right);
        writer.write(&mut engine, BLOCK, Health::default());
    }
    assert!(reader.fetch(), "there is no picture");
    (engine, reader)
}

#[test]
fn fingers_are_no_frets() {
    let (_engine, reader) = stopped("electric", 41, 161);
    let string = &reader.latest().strings()[5];
    let frets = string.frets().iter().filter(|fret| fret.force > 0.0).count();
    assert!(string.fingers.iter().flatten().any(|finger| finger.force > 1.0));
    assert!(string.board_force.iter().all(|&force| force == 0.0));
    assert_eq!((frets, string.contacts), (1, 1));
}

/// What lies on the board all the time is told from what hits it.
#[test]
fn a_string_that_rests_on_the_board_is_seen() {
    let (_engine, reader) = stopped("fretless-bass", 30, 161);
    let string = &reader.latest().strings()[3];
    let most = |forces: &[f32]| forces.iter().copied().fold(0.0, f32::max);
    assert!(most(&string.board_force) > 1.0, "{} N", most(&string.board_force));
    assert!(string.contacts >= 1);
    for (point, (hit, force)) in string.board_hit.iter().zip(string.board_force).enumerate() {
        assert!(*hit >= force, "point {point}: {hit} N at most, {force} N now");
    }
}
