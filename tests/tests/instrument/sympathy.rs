//! Promise: strings over a body hear each other by it: those that have a partial of what is played sing along, more than others, and
//! on when that is stilled. Hands that lie on strings nobody plays have this fade, and do nothing to what is played. Over a bridge
//! that stands still a string moves only when it is played itself.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture};
use low_action_tests::clicks::{click, smallest_jump, with_jump};
use low_action_tests::numbers::rms;
use low_action_tests::stage::{Stage, at_the_bridge, cc, decibels, off, on, peak};

const RATE: f64 = 48_000.0;

fn classical(idle_loss: f64) -> Setup {
    let mut setup = Setup::builtin("classical").expect("it is built in");
    setup.player.idle_loss = idle_loss;
    setup
}

/// An instrument, one string of which, the first, is plucked open and stilled after a second.
struct Plucked {
    instrument: Instrument,
    /// Stems.
    strings: Vec<Vec<f32>>,
    left: Vec<f32>,
}

impl Plucked {
    fn new(setup: &Setup) -> Self {
        let mut instrument = Instrument::new(setup, &Quality::Live.settings(RATE)).expect("it can be built");
        let length = instrument.geometry(0).length;
        for (time, gesture) in [
            (0, Gesture::Pluck { position: 0.8 * length, force: -1.0, duration: 0.003, release: 0.0 }),
            (48_000, Gesture::Still { loss: 300.0, duration: 0.3 }),
        ] {
            instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
        }
        let strings = vec![Vec::new(); instrument.string_count()];
        Plucked { instrument, strings, left: Vec::new() }
    }

    /// The largest motion of each string, m a step, in so many seconds.
    fn play(&mut self, seconds: f64) -> Vec<f64> {
        let mut most = vec![0.0_f64; self.strings.len()];
        for _ in 0..(seconds * RATE / 16.0) as usize {
            let mut stems = vec![[0.0; 16]; self.strings.len()];
            let mut slices: Vec<&mut [f32]> = stems.iter_mut().map(<[f32; 16]>::as_mut_slice).collect();
            let (mut left, mut right) = ([0.0; 16], [0.0; 16]);
            self.instrument.process_stems(&mut slices, &mut left, &mut right);
            self.left.extend(left);
            for (index, stem) in stems.iter().enumerate() {
                self.strings[index].extend(stem);
                let motion = self.instrument.state(index).motion();
                most[index] = motion.fold(most[index], |most, motion| most.max(motion.abs()));
            }
        }
        most
    }
}

/// The fundamental of E4 is the fourth partial of the low E and the third of A; D, G and B have it not.
#[test]
fn strings_sing_along_with_what_they_have_a_partial_of() {
    let mut plucked = Plucked::new(&classical(0.0));
    let motion = plucked.play(1.0);
    let db: Vec<f64> = motion.iter().map(|most| decibels(most / motion[0])).collect();
    println!("while it sounds: {db:.1?} dB of the plucked string");
    for near in [4, 5] {
        for far in [1, 2, 3] {
            assert!(db[near] > db[far] + 3.0, "string {near} sings more than string {far}: {db:?}");
        }
    }
    // And as docs/physics.md says, to the decibel.
    let sing = db[4].max(db[5]);
    assert!((-26.5..-25.5).contains(&sing) && db.iter().all(|&db| db <= 0.0), "{db:?}");
    assert!(db[1..4].iter().all(|db| (-42.5..-29.5).contains(db)), "{db:?}");
    // It is stilled, and they ring on.
    let sound = |plucked: &Plucked, from: usize| decibels(rms(&plucked.left[from..from + 4_800]));
    plucked.play(1.0);
    let (before, after) = (sound(&plucked, 43_000), sound(&plucked, 60_000));
    println!("{before:.1} dBFS, and {after:.1} dBFS once it is stilled");
    assert!(after < before && after > before - 20.0, "{before} and {after} dBFS");
}

#[test]
fn nobody_hears_another_at_a_bridge_that_stands_still() {
    let mut plucked = Plucked::new(&at_the_bridge(&classical(0.0)));
    let motion = plucked.play(1.0);
    assert!(motion[0] > 0.0 && motion[1..].iter().all(|&most| most == 0.0), "{motion:?}");
    assert!(plucked.strings[1..].iter().flatten().all(|&sample| sample == 0.0));
}

/// They lie on strings nobody plays only: one over a body by itself rings as long.
#[test]
fn idle_hands_have_what_others_hear_fade() {
    let after = |idle_loss: f64| {
        let mut plucked = Plucked::new(&classical(idle_loss));
        plucked.play(2.0);
        decibels(rms(&plucked.left[67_200..72_000]))
    };
    let [free, light, firm] = [0.0, 6.0, 30.0].map(after);
    println!("0.4 s after it is stilled: {free:.1} dBFS, under hands {light:.1} and {firm:.1} dBFS");
    assert!(light < free - 6.0 && firm < light - 20.0, "{free}, {light} and {firm} dBFS");
    let alone = |idle_loss: f64| {
        let setup = classical(idle_loss);
        let mut plucked = Plucked::new(&Setup { string: vec![setup.string[0].clone()], ..setup });
        plucked.play(1.0);
        plucked.left
    };
    assert!(alone(0.0) == alone(30.0), "hands are off what is played");
}

/// The hand that stills what sounds for a stroke goes when that has begun, and idle ones do not come.
#[test]
fn what_is_struck_again_is_played() {
    let one_string = |idle_loss: f64| {
        let setup = classical(idle_loss);
        Setup { string: vec![setup.string[0].clone()], ..setup }
    };
    let again = |idle_loss: f64| {
        let mut plucked = Plucked::new(&one_string(idle_loss));
        let pluck = Gesture::Pluck { position: 0.5, force: -1.0, duration: 0.003, release: 0.0 };
        for (time, gesture) in [(12_000, Gesture::Still { loss: 1_000.0, duration: 0.003 }), (12_043, pluck)]
        {
            plucked.instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
        }
        plucked.play(1.0);
        plucked.left
    };
    assert!(again(0.0) == again(30.0), "hands are off what is played");
    // So it is where somebody plays it: 6 1/s would have it lose 31 dB more.
    let mut stage = Stage::over_body(&one_string(6.0));
    let sound = &stage.play(&[(0.0, on(64, 90)), (1.0, off(64)), (1.0, on(64, 90))], 2.0).strings[0];
    let lost = |from: usize| {
        let level = |from: usize| decibels(rms(&sound[from..from + 4_800]));
        level(from + 9_600) - level(from + 38_400)
    };
    let (first, second) = (lost(0), lost(48_000));
    println!("in 0.6 s the first note loses {first:.1} dB, the second {second:.1} dB");
    assert!((first - second).abs() < 1.0, "{first} and {second} dB");
}

/// Firmer hands and lighter ones act from the hand-over on; where the bridge stands still from then on, those that lay there stay.
#[test]
fn idle_hands_change_at_once() {
    let rigid = at_the_bridge(&classical(6.0));
    // What is left of the motion of the low E after it has been stilled, and half a second after a hand-over then, dB.
    let lost = |before: f64, after: &Setup| {
        let mut plucked = Plucked::new(&classical(before));
        plucked.play(1.4);
        let successor = Instrument::new(after, &Quality::Live.settings(RATE)).expect("it can be built");
        assert!(plucked.instrument.hand_over(Box::new(successor)).is_ok(), "it is free");
        let first = plucked.play(0.05)[5];
        plucked.play(0.45);
        decibels(first / plucked.play(0.05)[5])
    };
    let [free, lay, stay] = [lost(0.0, &classical(0.0)), lost(6.0, &classical(6.0)), lost(6.0, &rigid)];
    let [let_go, laid] = [lost(6.0, &classical(0.0)), lost(0.0, &classical(6.0))];
    println!("free {free:.1} dB, let go of {let_go:.1}; under hands {lay:.1}, {laid:.1} and {stay:.1} dB");
    // 6 1/s takes 26 dB in half a second.
    assert!(free < 10.0 && lay > free + 15.0, "{free} and {lay} dB");
    assert!((let_go - free).abs() < 3.0, "{let_go} dB after lighter hands, free {free} dB");
    assert!(
        (laid - lay).abs() < 3.0 && stay > free + 15.0,
        "{laid} and {stay} dB under hands, {lay} dB before"
    );
}

/// A palm that has lain on all strings for a while, and a string that was pulled up and let go of, leave them to idle hands.
#[test]
fn what_is_only_touched_is_not_played() {
    let left = |events: &[(f64, PlayerEvent)]| {
        let mut stage = Stage::over_body(&classical(6.0));
        let note = [(1.0, on(52, 90)), (2.0, off(52))];
        let played = stage.play(&[events, &note].concat(), 2.6);
        // What the low E, an octave below, hears of it.
        decibels(rms(&played.strings[5][120_000..124_800]))
    };
    let (usual, palmed) = (left(&[]), left(&[(0.0, cc(20, 80)), (0.5, cc(20, 0))]));
    println!("{usual:.1} dBFS, after a palm {palmed:.1} dBFS");
    assert!(usual < -70.0 && (palmed - usual).abs() < 1.0, "{usual} and {palmed} dBFS");
}

/// Played on from a bridge that stands still, where strings sleep each for itself and share steps with the host each in its own
/// way, strings begin to hear each other, without a click; and back, from where on they sleep again.
#[test]
fn a_body_can_be_put_under_strings_and_taken_away() {
    let over = Setup::builtin("steel").expect("it is built in");
    let rigid = at_the_bridge(&over);
    let settings = Quality::Live.settings(RATE);
    let mut instrument = Instrument::new(&rigid, &settings).expect("it can be built");
    let pluck = Gesture::Pluck { position: 0.5, force: -1.0, duration: 0.003, release: 0.0 };
    for (time, string) in [(0, 5), (37, 0)] {
        instrument.schedule(TimedGesture { time, string, gesture: pluck }).expect("there is room");
    }
    let mut sound = Vec::new();
    let mut play = |instrument: &mut Instrument, samples: usize| {
        let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
        instrument.process(&mut left, &mut right);
        sound.extend(left);
    };
    play(&mut instrument, 24_001);
    assert!(instrument.state(3).motion().all(|motion| motion == 0.0), "string 3 sleeps");
    let successor = Instrument::new(&over, &settings).expect("it can be built");
    assert!(instrument.hand_over(Box::new(successor)).is_ok(), "it is free");
    play(&mut instrument, 24_001);
    let heard = instrument.state(3).motion().fold(0.0, |most: f64, motion| most.max(motion.abs()));
    assert!(heard > 0.0, "string 3 hears the others");
    drop(instrument.take_before());
    let successor = Instrument::new(&rigid, &settings).expect("it can be built");
    assert!(instrument.hand_over(Box::new(successor)).is_ok(), "it is free");
    for string in [0, 5] {
        let time = instrument.now();
        let gesture = Gesture::Still { loss: 300.0, duration: 0.5 };
        instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
    }
    play(&mut instrument, 48_000 * 15);
    assert!(instrument.is_silent(), "all sleep");
    for (change, until) in [(24_001, 48_002), (48_002, sound.len())] {
        assert_eq!(click(&sound[..until], change), None, "at {change}");
        // And one would be found.
        let jump = smallest_jump(&sound[..until], change);
        println!("at {change}: a jump of {:.1e} of the peak is a click", jump / peak(&sound));
        let jumps = with_jump(&sound[..until], change, jump);
        assert!(click(&jumps, change).is_some(), "at {change}: {jump:e}");
    }
}

/// What is left of a note that stops is what others sing along with: the worst is an octave over an open string.
#[test]
fn notes_end_soon_under_light_hands() {
    let (mut least, mut least_later) = (f64::INFINITY, f64::INFINITY);
    for name in ["classical", "steel", "ukulele", "flamenco", "school-guitar"] {
        let setup = Setup::shipped(name).expect("it comes with the program");
        let mut stage = Stage::over_body(&setup);
        let lowest = setup.string.iter().fold(f64::INFINITY, |low, spec| low.min(spec.pitch)) as u8;
        for key in [lowest + 12, lowest + 5, lowest + 7, lowest + 17] {
            let played = stage.play(&[(0.0, on(key, 90)), (1.0, off(key))], 2.0);
            let level = |from: f64| {
                let from = (from * RATE) as usize;
                let all =
                    |sample: usize| played.strings.iter().map(|stem| f64::from(stem[sample])).sum::<f64>();
                let sum: Vec<f64> = (from..from + 2_400).map(all).collect();
                decibels((sum.iter().map(|x| x * x).sum::<f64>() / 2_400.0).sqrt())
            };
            let (before, soon, later) = (level(0.95), level(1.15), level(1.5));
            println!(
                "{name}, key {key}: {:.1} dB after 0.15 s, {:.1} dB after 0.5 s",
                soon - before,
                later - before
            );
            least = least.min(before - soon);
            least_later = least_later.min(before - later);
        }
    }
    println!("at least {least:.1} dB after 0.15 s, {least_later:.1} dB after half a second");
    // What docs/gestures.md says is gone.
    assert!(least >= 19.0 && least_later >= 40.0, "{least} and {least_later} dB");
}

#[test]
fn a_loss_that_cannot_be_is_refused() {
    for (value, said) in [("-1.0", "-1"), ("1001.0", "1001"), ("nan", "NaN")] {
        let text = format!("based_on = \"steel\"\nname = \"x\"\n[player]\nidle_loss = {value}");
        let error = Setup::from_toml(&text).expect_err("it is out of range").to_string();
        assert_eq!(
            error,
            format!("player.idle_loss = {said} is refused: it must lie between 0 and 1000 1/s")
        );
    }
}
