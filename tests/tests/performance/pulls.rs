//! The promise: a pull-off is about as loud as the note plucked as hard. It is the finger's pluck and the string that rises
//! from it that are heard, and both follow velocity.

use low_action_dsp::Gesture;
use low_action_tests::numbers::largest;
use low_action_tests::stage::{Stage, cc, hertz, level, off, on};

const RATE: f64 = 48_000.0;
/// When the finger pulls off, s.
const PULL: f64 = 0.5;

/// Set-up, string, its open key.
const STRINGS: [(&str, usize, u8); 8] = [
    ("electric", 1, 59),
    ("electric", 4, 45),
    ("electric", 5, 40),
    ("classical", 0, 64),
    ("classical", 4, 45),
    ("steel", 4, 45),
    ("bass", 0, 43),
    ("bass", 3, 28),
];

/// Level from 20 to 200 ms after a moment (s), dB.
fn level_after(sound: &[f32], moment: f64) -> f64 {
    level(&sound[((moment + 0.02) * RATE) as usize..((moment + 0.2) * RATE) as usize])
}

/// How many dB louder each pull-off from one fret to another is than its note plucked as hard, alone or after the same note,
/// whichever is louder: soft ones are louder after another, by the finger that is set down behind it.
fn louder_than_plucked(velocity: u8) -> Vec<(String, f64)> {
    let mut found = Vec::new();
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        for [from, to] in [[10, 5], [7, 5], [3, 0]] {
            let [before, after] = [open + from, open + to].map(|key| on(key, velocity));
            let alone = level_after(&stage.play(&[(0.0, after)], 0.2).strings[0], 0.0);
            let mut second = |legato| {
                let events = [(0.0, cc(68, legato)), (0.0, before), (PULL, after)];
                level_after(&stage.play(&events, PULL + 0.2).strings[0], PULL)
            };
            let [plucked, pulled] = [second(0), second(127)];
            let louder = pulled - alone.max(plucked);
            found.push((format!("{setup} {string}, fret {from} to {to}"), louder));
        }
    }
    found
}

/// What is heard is the finger's pluck, the string that rises from the fret, and what is left of the note before, none of them
/// louder than the plucked note: 20 log 3 = 9.5 dB if they are as loud and fall together, 10 log 3 = 4.8 dB on average. (A
/// string let go of at once is up to 20 dB louder than soft notes.)
#[test]
fn a_pull_off_is_as_loud_as_the_note_plucked_as_hard() {
    // And as the page says.
    let (page, mut wrong) = (include_str!("../../../docs/gestures.md"), Vec::new());
    for velocity in [10, 20, 30, 45, 64, 100] {
        let found = louder_than_plucked(velocity);
        for (which, louder) in &found {
            assert!(*louder < 9.5, "{which}, velocity {velocity}: {louder} dB louder than plucked");
        }
        let mean = found.iter().map(|(_, louder)| louder).sum::<f64>() / found.len() as f64;
        assert!(mean.abs() < 4.8, "velocity {velocity}: {mean} dB louder than plucked, on average");
        let most = largest(found.iter().map(|(_, louder)| *louder));
        let row = format!("| {velocity} | {mean:.1} dB | {most:.1} dB | ");
        wrong.extend((!page.contains(&row)).then_some(row));
    }
    assert!(wrong.is_empty(), "docs/gestures.md has other numbers than {wrong:#?}");
}

/// A trill goes back by the same pull: the finger leaves in 1 ms after the hardest hammer, and in most of a period of the open
/// string after a soft one. (What is heard then is what is left of the hammer, too.)
#[test]
fn the_key_that_comes_back_is_pulled_as_hard_as_the_other_was_hammered() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let mut leaving = |velocity| {
            let events = [
                (0.0, cc(68, 127)),
                (0.0, on(open + 5, 80)),
                (0.1, on(open + 7, velocity)),
                (0.2, off(open + 7)),
            ];
            let lift = stage.play(&events, 0.21).gestures.into_iter().find_map(|timed| match timed.gesture {
                Gesture::Lift { duration, .. } if timed.time >= (0.2 * RATE) as u64 => Some(duration),
                _ => None,
            });
            lift.expect("it pulls off")
        };
        let [soft, hard] = [leaving(16), leaving(127)];
        let period = 1.0 / hertz(f64::from(open));
        assert!((hard - 0.001).abs() < 1e-9, "{setup} {string}: {hard} s at the hardest");
        assert!((0.5..1.5).contains(&(soft / period)), "{setup} {string}: {soft} s");
    }
}
