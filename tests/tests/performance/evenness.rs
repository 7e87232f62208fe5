//! The promise: a note sounds as its own velocity has it, whatever was on its string before. What stopped the string lets go
//! of it so that no string that comes up is heard in a soft note's place; a finger that stays down behind leaves the pitch alone.

use low_action::performance::PlayerEvent;
use low_action_tests::numbers::{largest, root_mean_square};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, cc, hertz, level, off, on};

const RATE: f64 = 48_000.0;
/// When the second note begins, s.
const NEXT: f64 = 0.5;

/// Set-up, string, its open key.
const STRINGS: [(&str, usize, u8); 5] =
    [("electric", 2, 55), ("electric", 5, 40), ("classical", 4, 45), ("steel", 5, 40), ("bass", 3, 28)];

fn part(sound: &[f32], from: f64, to: f64) -> &[f32] {
    &sound[(from * RATE) as usize..(to * RATE) as usize]
}

/// Frets played one after another, so loud, with a rest between them, and when the last of them begins, s.
fn notes(open: u8, frets: &[u8], velocity: u8, rest: f64) -> (Vec<(f64, PlayerEvent)>, f64) {
    let mut events = Vec::new();
    for (n, fret) in frets.iter().enumerate() {
        let start = NEXT * n as f64;
        events.push((start, on(open + fret, velocity)));
        events.push((start + NEXT - rest, off(open + fret)));
    }
    (events, NEXT * (frets.len() - 1) as f64)
}

/// From 0.4 to 0.9 s after a note its finger lets the string up; before that it holds it down, after that it is gone. What comes in
/// between is no louder and no softer than what comes before and after by more than other rests make out, 3 dB. (Where the next
/// finger took the string to be down: up to 12 dB softer. Where one that was up was set down behind it: up to 5 dB louder.)
#[test]
fn a_note_sounds_as_well_while_the_finger_before_it_eases_off() {
    let steps = [
        ("electric", 5, 40, [12, 13]),
        ("electric", 4, 45, [12, 13]),
        ("steel", 3, 50, [7, 7]),
        ("electric", 5, 40, [12, 10]),
        ("bass", 3, 28, [12, 10]),
    ];
    for (setup, string, open, [before, fret]) in steps {
        let mut stage = Stage::alone(setup, string);
        let mut heard = |rest: f64| {
            let start = 0.5 + rest;
            let events =
                [(0.0, on(open + before, 90)), (0.5, off(open + before)), (start, on(open + fret, 90))];
            let sound = &stage.play(&events, start + 0.16).strings[0];
            level(part(sound, start + 0.02, start + 0.15))
        };
        let held = [0.3, 0.45].map(&mut heard);
        let gone = [1.0, 1.6].map(&mut heard);
        let least = held.into_iter().chain(gone).fold(f64::INFINITY, f64::min) - 3.0;
        let most = held.into_iter().chain(gone).fold(f64::NEG_INFINITY, f64::max) + 3.0;
        for rest in [0.55, 0.65, 0.7, 0.75, 0.8, 0.85, 0.89] {
            let level = heard(rest);
            assert!(
                (least..=most).contains(&level),
                "{setup} {string}, fret {fret} after {before} and {rest} s: {level} dB, not {least} to {most}"
            );
        }
    }
}

/// A capo comes with the first note, and is set down as fingers are. (As slowly as its hand's damping had it: 4 to 6 dB softer.)
#[test]
fn the_first_note_under_a_capo_is_as_loud_as_the_next() {
    for (setup, string, open) in
        [("electric", 0, 64), ("steel", 0, 64), ("ukulele", 1, 64), ("classical", 4, 45)]
    {
        let mut stage = Stage::alone(setup, string);
        for capo in [2, 5, 7] {
            let note = |start: f64| [(start, on(open + capo, 90)), (start + 0.4, off(open + capo))];
            let events = [&[(0.0, cc(26, capo))][..], &note(0.1), &note(0.6)].concat();
            let sound = &stage.play(&events, 0.8).strings[0];
            let [first, next] = [0.1, 0.6].map(|start| level(part(sound, start + 0.02, start + 0.15)));
            let louder = first - next;
            assert!(louder.abs() < 2.5, "{setup} {string}, capo {capo}: the first is {louder} dB louder");
        }
    }
}

/// (How pluck, landing finger and what still moves fall together differs from one note to the next, and is some decibels of
/// soft notes. A string that comes up at once is 10 to 18 of them.)
#[test]
fn a_note_is_as_loud_after_another_on_its_string_as_alone() {
    let velocities = [(30, 4.5, 11.0), (50, 3.5, 8.0), (80, 3.0, 8.0), (110, 2.5, 8.0)];
    let mut found = velocities.map(|_| Vec::new());
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        for ((velocity, _, most), found) in velocities.into_iter().zip(&mut found) {
            let mut heard = |frets: &[u8], rest| {
                let (events, last) = notes(open, frets, velocity, rest);
                let sound = &stage.play(&events, last + 0.2).strings[0];
                level(part(sound, last + 0.02, last + 0.2))
            };
            for [before, fret] in [[5, 8], [8, 5], [12, 3], [5, 0], [12, 0], [5, 5], [0, 5]] {
                let alone = heard(&[fret], 0.3);
                for rest in [0.001, 0.1, 0.3] {
                    let off = heard(&[before, fret], rest) - alone;
                    assert!(
                        off.abs() < most,
                        "{setup} {string}, fret {fret} after {before} and {rest} s, velocity {velocity}: {off} dB"
                    );
                    found.push(off);
                }
            }
        }
    }
    // And they are what the page says.
    let page = include_str!("../../../docs/gestures.md");
    let mut rows = String::new();
    for ((velocity, usual, _), found) in velocities.into_iter().zip(found) {
        let spread = root_mean_square(&found);
        assert!(spread < usual, "velocity {velocity}: {spread} dB");
        let most = largest(found.iter().map(|off| off.abs()));
        rows += &format!("| {velocity} | {spread:.1} dB | {most:.1} dB |\n");
    }
    assert!(page.contains(&rows), "docs/gestures.md has other numbers than\n{rows}");
}

#[test]
fn a_finger_behind_leaves_the_pitch_alone() {
    let mut most: f64 = 0.0;
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let mut heard = |frets: &[u8]| {
            let (events, last) = notes(open, frets, 80, 0.001);
            let sound = &stage.play(&events[..events.len() - 1], last + 1.5).strings[0];
            let pitch = hertz(f64::from(open + frets[frets.len() - 1]));
            cents(frequency_near(part(sound, last + 0.3, last + 1.5), RATE, pitch), pitch)
        };
        for [before, fret] in [[5, 8], [2, 3], [8, 5], [3, 2], [1, 12], [12, 1]] {
            let [alone, after] = [heard(&[fret]), heard(&[before, fret])];
            let apart = (after - alone).abs();
            assert!(apart < 0.5, "{setup} {string}, {fret} after {before}: {alone}, {after} cents");
            most = most.max(apart);
        }
    }
    println!("{most} cents");
    let sentence = format!("Pitches agree within {most:.1} cents.");
    let page = include_str!("../../../docs/gestures.md");
    assert!(page.contains(&sentence), "docs/gestures.md does not say: {sentence}");
}

/// Fingers that have yet to leave are not in the way of the next.
#[test]
fn quick_notes_end_on_the_pitch_of_the_last() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        for frets in
            [&[5, 8, 0][..], &[8, 5, 0], &[3, 5, 7, 0], &[5, 8, 3], &[12, 5, 7, 1], &[1, 3, 5, 7, 8, 2]]
        {
            for apart in [0.02, 0.06, 0.15] {
                let mut events = Vec::new();
                for (n, fret) in frets.iter().enumerate() {
                    events.push((apart * n as f64, on(open + fret, 60)));
                    if n + 1 < frets.len() {
                        events.push((apart * (n as f64 + 1.0) - 0.001, off(open + fret)));
                    }
                }
                let last = apart * (frets.len() - 1) as f64;
                let sound = &stage.play(&events, last + 0.2).strings[0];
                let pitch = hertz(f64::from(open + frets[frets.len() - 1]));
                let heard = part(sound, last + 0.06, last + 0.2);
                let off = cents(frequency_near(heard, RATE, pitch), pitch);
                // (Strings that still swing from the notes before are up to four cents sharp.)
                assert!(off.abs() < 6.0, "{setup} {string}, {frets:?} {apart} s apart: {off} cents");
            }
        }
    }
}
