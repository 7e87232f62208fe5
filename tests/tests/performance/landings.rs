//! The promise: a note is as loud where its finger has yet to land as where it is down already. What sets the string down takes
//! whole periods of what sounds, and so takes up again what it sends along the string.

use low_action_dsp::Setup;
use low_action_tests::numbers::{largest, root_mean_square};
use low_action_tests::stage::{Stage, level, off, on};

const RATE: f64 = 48_000.0;
/// When the string sounds no more of a note too soft to be heard, and its finger is down, s.
const DOWN: f64 = 0.5;

const FRETS: [u8; 9] = [1, 2, 3, 5, 7, 9, 12, 15, 18];
/// Set-up, string, its open key.
const STRINGS: [(&str, usize, u8); 13] = [
    ("electric", 0, 64),
    ("electric", 1, 59),
    ("electric", 2, 55),
    ("electric", 3, 50),
    ("electric", 5, 40),
    ("classical", 4, 45),
    ("steel", 0, 64),
    ("steel", 5, 40),
    ("bass", 1, 38),
    ("bass", 2, 33),
    ("bass", 3, 28),
    ("fretless-bass", 2, 33),
    ("ukulele", 1, 64),
];

/// Level of the last of some notes, dB, 20 to 150 ms after it.
fn heard(stage: &mut Stage, notes: &[(f64, u8, u8)]) -> f64 {
    let mut events = Vec::new();
    for (n, &(time, key, velocity)) in notes.iter().enumerate() {
        if let Some(before) = n.checked_sub(1) {
            events.push((time, off(notes[before].1)));
        }
        events.push((time, on(key, velocity)));
    }
    let start = notes[notes.len() - 1].0;
    let sound = &stage.play(&events, start + 0.15).strings[0];
    level(&sound[((start + 0.02) * RATE) as usize..])
}

/// (A finger that comes down in any other time is heard a third as loud as the pluck, and as loud at worst; how the two fall together made 3 dB
/// root mean square at every velocity. What is left at velocity 20 is that: the finger needs a tenth of a second to be as soft as
/// that pluck, and lets the string leak past it meanwhile. The hand that stills the string for the second note is 0.8 dB of it.)
#[test]
fn a_finger_that_lands_makes_a_note_no_louder_and_no_softer() {
    let velocities = [
        (20, 4.0, 12.0),
        (24, 4.0, 12.0),
        (30, 2.5, 7.5),
        (45, 1.5, 4.5),
        (64, 1.2, 3.5),
        (100, 1.2, 3.5),
        (127, 1.2, 3.5),
    ];
    let mut rows = String::new();
    for (velocity, usual, most) in velocities {
        let mut found = Vec::new();
        for (setup, string, open) in STRINGS {
            let mut stage = Stage::alone(setup, string);
            for fret in FRETS {
                let key = open + fret;
                let lands = heard(&mut stage, &[(0.0, key, velocity)]);
                let stays = heard(&mut stage, &[(0.0, key, 1), (DOWN, key, velocity)]);
                let off = lands - stays;
                assert!(off.abs() < most, "{setup} {string}, fret {fret}, velocity {velocity}: {off} dB");
                found.push(off);
            }
        }
        let spread = root_mean_square(&found);
        assert!(spread < usual, "velocity {velocity}: {spread} dB");
        let most = largest(found.iter().map(|off| off.abs()));
        rows += &format!("| {velocity} | {spread:.1} dB | {most:.1} dB |\n");
    }
    let page = include_str!("../../../docs/gestures.md");
    assert!(page.contains(&rows), "docs/gestures.md has other numbers than\n{rows}");
}

/// By itself: under a plectrum without force. (In times of their own fingers were heard 10 dB below the pluck on average, and
/// some as loud.)
#[test]
fn a_finger_that_lands_is_hardly_heard_by_itself() {
    let mut found = Vec::new();
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let mut setup = Setup::shipped(setup).expect("it comes with the program");
        setup.player.pluck_force = 1e-3;
        let mut soft = Stage::new(&Setup { string: vec![setup.string[string].clone()], ..setup });
        for fret in FRETS {
            let key = open + fret;
            let plucked = heard(&mut stage, &[(0.0, key, 1), (DOWN, key, 64)]);
            found.push(plucked - heard(&mut soft, &[(0.0, key, 64)]));
        }
    }
    let least = found.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    assert!(least > 3.0 && mean > 15.0, "{least} dB below the pluck at least, {mean} on average");
    let sentence =
        format!("is {mean:.0} dB below a pluck of velocity 64 on average, and {least:.0} at least");
    let page = include_str!("../../../docs/gestures.md");
    assert!(page.contains(&sentence), "docs/gestures.md does not say: {sentence}");
}

/// Once it is down, the string stays on its fret: no finger bounces. (One of 5 g pressed by 6 N and braked by nothing would, for
/// 40 ms.)
#[test]
fn a_finger_comes_down_once() {
    for (setup, string, open) in STRINGS {
        let frets = Setup::shipped(setup).expect("it comes with the program").neck.frets;
        let mut stage = Stage::alone(setup, string);
        for fret in FRETS.into_iter().filter(|&fret| usize::from(fret) <= frets) {
            // (Harder notes swing by as much as they are pressed down.)
            for velocity in [1, 64] {
                let mut depths = Vec::new();
                stage.watch(&[(0.0, on(open + fret, velocity))], 0.2, |_, instrument| {
                    let crown = instrument.geometry(0).frets[usize::from(fret) - 1];
                    let reading = instrument.model(0).grid.reading(crown);
                    depths.push(-instrument.state(0).displacement_at(&reading));
                });
                let stays = depths[depths.len() - 100..].iter().sum::<f64>() / 100.0;
                let there = depths.iter().position(|depth| *depth >= 0.98 * stays).expect("it comes down");
                let lifted = 1.0 - depths[there..].iter().copied().fold(f64::INFINITY, f64::min) / stays;
                // At most 0.07 of the way; a bounce would be most of it.
                assert!(lifted < 0.15, "{setup} {string}, fret {fret}, velocity {velocity}: {lifted}");
            }
        }
    }
}
