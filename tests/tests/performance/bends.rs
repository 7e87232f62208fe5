//! The promise: a bend is in tune on every fret, the last ones, too: a finger presses as hard as the tighter string asks for.

use low_action::setups::SHIPPED;
use low_action_dsp::setup::Intonation;
use low_action_dsp::{Setup, StringGeometry};
use low_action_tests::hands::Neck;
use low_action_tests::numbers::largest;
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{Stage, at, cc, octave, on, wheel};

/// How far off a string alone sounds at a fret, over a capo or not (0), straight and bent as far as pulling goes, cents.
fn off_keys(stage: &mut Stage, key: u8, semitones: f64, capo: u8) -> [f64; 2] {
    let octave = octave();
    let events = [&octave[..], &[(0.0, cc(26, capo)), (0.0, on(key, 90)), (0.25, wheel(semitones))]].concat();
    let sound = &stage.play(&events, 0.6).strings[0];
    let key = f64::from(key);
    [off_key(&sound[at(0.1)..at(0.25)], key), off_key(&sound[at(0.35)..at(0.55)], key + semitones)]
}

/// How much of a full bend the grid does not bear at a fret, cents. A fret that stands nearer to the nut than equal temperament has it
/// makes up for what pressing adds to the tension, `added` of the open string's; on a string `alone` times as tight that is less,
/// `added`/√`alone`. A full bend of an open string is all that the two may ask for together.
fn short(geometry: &StringGeometry, fret: u8) -> f64 {
    let most = geometry.highest_ratio;
    let sounding = 1.0 - geometry.frets[usize::from(fret) - 1] / geometry.length;
    let added = (sounding * (f64::from(fret) / 12.0).exp2()).powi(2) - 1.0;
    let (mut low, mut high) = (1.0, most);
    for _ in 0..50 {
        let alone: f64 = 0.5 * (low + high);
        let borne = alone + added * (alone - 1.0 / alone.sqrt()) < most;
        if borne { low = alone } else { high = alone }
    }
    600.0 * (most / low).log2()
}

/// How well a full bend is known, cents: the root is fitted, and leaves up to 5.3 on the highest frets of `electric` and `baritone`.
const KNOWN: f64 = 6.0;

/// How far a full bend ends below its pitch at most, cents, as `docs/gestures.md` has it: on `baritone` and on others.
const SHORT: [f64; 2] = [13.5, 11.0];

/// Bends strings of a set-up on some of their frets, over a capo there or without.
fn are_in_tune(name: &str, frets: impl Fn(u8) -> Vec<u8>, capo: bool) {
    let setup = Setup::shipped(name).expect("it comes with the program");
    for (string, spec) in setup.string.iter().enumerate() {
        let mut stage = Stage::alone(name, string);
        for fret in frets(setup.neck.frets as u8) {
            let key = spec.pitch.round() as u8 + fret;
            let [straight, bent] = off_keys(&mut stage, key, setup.max_bend, if capo { fret } else { 0 });
            let short = short(stage.instrument.geometry(0), fret);
            println!(
                "{name} {string}, fret {fret}: {straight:.1} cents off, bent {bent:.1}, {short:.1} short"
            );
            let what =
                format!("{name} {string}, fret {fret}: {straight} cents off, bent {bent}, {short} short");
            if setup.intonation == Intonation::Compensated {
                let most = SHORT[usize::from(name != "baritone")];
                assert!(straight.abs() < 3.0 && bent > -most && (bent + short).abs() < KNOWN, "{what}");
            } else {
                // It is sharp by what pressing does, and the less so the tighter it is.
                assert!(straight > 0.0 && (0.0..straight).contains(&bent), "{what}");
            }
        }
    }
}

#[test]
fn a_bend_is_in_tune_on_every_fret() {
    for name in ["steel", "electric", "classical", "bass", "school-guitar", "baritone", "ukulele"] {
        are_in_tune(name, |last| (1..=last).collect(), false);
    }
}

/// A capo holds the tighter string, too.
#[test]
fn a_bend_is_in_tune_over_a_capo() {
    for name in ["steel", "electric", "classical", "school-guitar"] {
        are_in_tune(name, |_| vec![2, 5, 12], true);
    }
}

/// Its frets make up for far more where a string wraps over the bridge.
#[test]
fn the_page_says_what_grids_do_not_bear() {
    let most = |name: &str| {
        let strings = Neck::of(name).strings;
        let all = strings.iter().flat_map(|string| {
            (1..=string.geometry.frets.len()).map(|fret| short(&string.geometry, fret as u8))
        });
        largest(all)
    };
    let fretted = |name: &&str| {
        let setup = Setup::shipped(name).expect("it comes with the program");
        *name != "sitar" && !setup.neck.fretless && setup.neck.frets > 0
    };
    let said = format!(
        "up to {:.0} cents below a full `max_bend`, {:.0} on a `sitar`",
        largest(SHIPPED.iter().copied().filter(fretted).map(most)),
        most("sitar")
    );
    let page = include_str!("../../../docs/formats.md");
    assert!(page.contains(&said), "docs/formats.md does not say: {said}");
}
