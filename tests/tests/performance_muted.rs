//! The promise: a muted note is a knock. What it has of a pitch is gone before it is heard as one, wherever the hand lies.

use low_action_tests::stage::{Stage, cc, level, off, on};

const RATE: f64 = 48_000.0;

/// Set-up, string, its open key, and how far it falls from its first 20 ms to the time from 60 to 100 ms, dB. (The longer a
/// string's period, the fewer times it has met the fingers by then.)
const STRINGS: [(&str, usize, u8, f64); 6] = [
    ("electric", 0, 64, 30.0),
    ("electric", 3, 50, 24.0),
    ("electric", 5, 40, 18.0),
    ("classical", 2, 55, 20.0),
    ("steel", 1, 59, 25.0),
    ("bass", 3, 28, 9.0),
];

/// (Under one finger alone the partials with a node there rang on: 82 to 98 % of what was heard of an open string was one of them,
/// and a low fret left the open string 3 to 9 dB below the knock.)
#[test]
fn a_muted_note_is_a_knock() {
    for (setup, string, open, falls) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        for fret in [0, 2, 5, 7, 12] {
            let key = open + fret;
            let sound =
                &stage.play(&[(0.0, cc(23, 2)), (0.0, on(key, 100)), (0.4, off(key))], 0.2).strings[0];
            let heard = |from: f64, to: f64| level(&sound[(from * RATE) as usize..(to * RATE) as usize]);
            let fallen = heard(0.0, 0.02) - heard(0.06, 0.1);
            assert!(fallen > falls, "{setup} {string}, fret {fret}: only {fallen} dB down");
        }
    }
}
