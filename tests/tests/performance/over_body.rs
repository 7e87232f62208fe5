//! The promise: over a body a note that is let go of falls as fast as `docs/gestures.md` says.

use low_action_dsp::Setup;
use low_action_tests::pages::must_say;
use low_action_tests::stage::{Stage, at, decibels, off, on, peak};

/// As without one ([`crate::sound`]), which takes 40 dB.
#[test]
fn the_first_decibels_of_a_note_are_gone_within_150_ms() {
    let mut least = f64::NEG_INFINITY;
    for name in ["steel", "classical", "ukulele"] {
        let setup = Setup::shipped(name).expect("it comes with the program");
        for (index, spec) in setup.string.iter().enumerate() {
            let mut stage = Stage::over_body(&Setup { string: vec![spec.clone()], ..setup.clone() });
            for fret in [0, 1, 5, 12] {
                let key = spec.pitch as u8 + fret;
                stage.performance.reset();
                stage.instrument.reset();
                let sound = stage.play(&[(0.0, on(key, 100)), (0.3, off(key))], 0.5).strings.remove(0);
                let before = peak(&sound[at(0.27)..at(0.3)]);
                let down = decibels(peak(&sound[at(0.45)..]) / before);
                println!("{name}, string {}, fret {fret}: {down:.1} dB", index + 1);
                least = least.max(down);
            }
        }
    }
    let least = -least.ceil();
    must_say(
        "gestures.md",
        &format!("The first 40 dB are gone within 150 ms, over a body at least {least:.0},"),
    );
    must_say(
        "formats.md",
        &format!("(after that it falls by 40 dB in 150 ms, over a body by {least:.0} at least,"),
    );
}
