//! The promise: a bend is in tune on every fret, the last ones, too: a finger presses as hard as the tighter string asks for.

use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{Stage, at, cc, on};

/// How far off a string alone sounds at a fret, over a capo or not (0), straight and bent as far as pulling goes, cents.
fn off_keys(name: &str, string: usize, fret: u8, capo: u8) -> [f64; 2] {
    let setup = Setup::shipped(name).expect("it comes with the program");
    let key = setup.string[string].pitch.round() as u8 + fret;
    let semitones = setup.max_bend;
    let wheel = PlayerEvent::PitchBend { channel: 0, value: (semitones / 12.0) as f32 };
    let octave = [(0.0, cc(101, 0)), (0.0, cc(100, 0)), (0.0, cc(6, 12))];
    let events = [&octave[..], &[(0.0, cc(26, capo)), (0.0, on(key, 90)), (0.25, wheel)]].concat();
    let sound = &Stage::alone(name, string).play(&events, 0.6).strings[0];
    let key = f64::from(key);
    [off_key(&sound[at(0.1)..at(0.25)], key), off_key(&sound[at(0.35)..at(0.55)], key + semitones)]
}

/// As `docs/gestures.md` has it, a full bend ends up to 8 cents short, since grids bear no more; what pressing adds to a tighter
/// string is known within 5 more on the highest frets.
const SHORT: f64 = 14.0;

/// Bends strings of a set-up on some of their frets, over a capo there or without. Strings without compensation are sharp, and the
/// less so the tighter they are.
fn are_in_tune(name: &str, frets: impl Fn(u8) -> Vec<u8>, capo: bool) {
    let setup = Setup::shipped(name).expect("it comes with the program");
    for string in 0..setup.string.len() {
        for fret in frets(setup.neck.frets as u8) {
            let [straight, bent] = off_keys(name, string, fret, if capo { fret } else { 0 });
            println!("{name} {string}, fret {fret}: {straight:.1} cents off, bent {bent:.1}");
            assert!(
                straight > -2.0 && bent > -SHORT && bent < straight + 2.0,
                "{name} {string}, fret {fret}: {straight} cents off, bent {bent}"
            );
        }
    }
}

#[test]
fn a_bend_is_in_tune_on_every_fret() {
    for name in ["steel", "electric", "classical", "bass", "school-guitar", "baritone", "ukulele"] {
        are_in_tune(name, |last| vec![1, last - 2, last - 1, last], false);
    }
}

/// A capo holds the tighter string, too.
#[test]
fn a_bend_is_in_tune_over_a_capo() {
    for name in ["steel", "electric", "classical", "school-guitar"] {
        are_in_tune(name, |_| vec![2, 5, 12], true);
    }
}
