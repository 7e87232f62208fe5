//! The promise: a muted note is a knock. What it has of a pitch is gone before it is heard as one, wherever the hand lies, and the
//! hand leaves for what comes next. Its end is not heard.

use low_action_tests::pitch::off_key;
use low_action_tests::stage::{Stage, at, cc, decibels, level, off, on, peak};

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
            assert!(peak(sound) > 0.01, "{setup} {string}, fret {fret}: a knock of {}", peak(sound));
            let heard = |from: f64, to: f64| level(&sound[at(from)..at(to)]);
            let fallen = heard(0.0, 0.02) - heard(0.06, 0.1);
            assert!(fallen > falls, "{setup} {string}, fret {fret}: only {fallen} dB down");
        }
    }
}

#[test]
fn nothing_of_it_is_left_after_150_milliseconds() {
    let strings = [
        ("electric", 0, 64),
        ("electric", 2, 55),
        ("electric", 5, 40),
        ("classical", 0, 64),
        ("steel", 5, 40),
    ];
    for (setup, string, open) in strings {
        let mut stage = Stage::alone(setup, string);
        let sound = &stage.play(&[(0.0, cc(23, 2)), (0.0, on(open + 5, 100))], 0.5).strings[0];
        assert!(peak(sound) > 0.01);
        let down = decibels(peak(&sound[at(0.15)..at(0.25)]) / peak(&sound[..at(0.05)]));
        assert!(down < -20.0, "{setup} {string}: {down} dB after 150 ms");
    }
}

/// A hand that mutes a string stays where it is when the note is over. (One of its fingers was taken away to damp the string nearer to
/// the saddle: that let go of it, 4 to 10 dB below a soft knock.)
#[test]
fn the_end_of_a_muted_note_is_not_heard() {
    for (setup, string, open, _) in STRINGS {
        let mut stage = Stage::plucked_at_once(setup, string);
        for fret in [0, 2, 5, 12] {
            for velocity in [40, 100] {
                let key = open + fret;
                let events = [(0.0, cc(23, 2)), (0.0, on(key, velocity)), (0.2, off(key))];
                let sound = &stage.play(&events, 1.8).strings[0];
                let heard = |from: f64, to: f64| decibels(peak(&sound[at(from)..at(to)]));
                let (knock, before, after) = (heard(0.0, 0.05), heard(0.17, 0.2), heard(0.2, 1.8));
                println!(
                    "{setup} {string}, fret {fret}, velocity {velocity}: {knock:.1}, {before:.1}, {after:.1} dB"
                );
                assert!(
                    after < (knock - 50.0).max(before),
                    "{setup} {string}, fret {fret}, velocity {velocity}: {after} dB after a knock of {knock} dB"
                );
            }
        }
    }
}

/// The open string after a muted note: the finger that rests on it leaves, and it sounds.
#[test]
fn an_open_string_sounds_after_a_muted_note() {
    for (fret, capo) in [(1, 0), (5, 3)] {
        let events = [
            (0.0, cc(26, capo)),
            (0.0, cc(23, 2)),
            (0.0, on(59 + fret, 100)),
            (0.3, cc(23, 0)),
            (0.3, cc(68, 127)),
            (0.4, on(59 + capo, 100)),
        ];
        let sound = &Stage::alone("electric", 1).play(&events, 1.2).strings[0];
        let heard = &sound[at(0.6)..];
        let level = decibels(peak(heard));
        assert!(level > -30.0, "capo {capo}: {level} dB");
        let off = off_key(heard, f64::from(59 + capo));
        assert!(off.abs() < 8.0, "capo {capo}: {off} cents");
    }
}
