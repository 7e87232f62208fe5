//! Promise: a body has no dead notes. On every string and fret of what comes with the program and has a body, no note is more than 8 dB
//! under the mean of those up to four frets away on its string, but for what the pluck itself makes of them: each is
//! heard beside the same note at a bridge that stands still.

use low_action_dsp::Setup;
use low_action_tests::numbers::{largest, smallest};
use low_action_tests::stage::{Stage, at, at_the_bridge, level, on};

/// As hard as most notes are played, and harder.
const VELOCITIES: [u8; 2] = [80, 100];

/// How far neighbours are, frets.
const NEAR: usize = 4;

/// The most a note may be under the mean of its neighbours, dB, from 20 to 150 ms: more than that players call dead. (Found is up to 7.)
const MOST: f64 = 8.0;

/// How loud each note of a string is, beside the same at a bridge that stands still, dB, from the open string to the last fret.
fn notes(setup: &Setup, string: usize, velocity: u8) -> Vec<f64> {
    let alone = Setup { string: vec![setup.string[string].clone()], ..setup.clone() };
    let mut stages = [Stage::over_body(&alone), Stage::over_body(&at_the_bridge(&alone))];
    let open = setup.string[string].pitch.round() as u8;
    let note = |fret| {
        let [over, beside] = stages.each_mut().map(|stage| {
            let played = stage.play(&[(0.0, on(open + fret as u8, velocity))], 0.15);
            level(&played.strings[0][at(0.02)..])
        });
        over - beside
    };
    (0..=setup.neck.frets).map(note).collect()
}

/// How much each is over the mean of its neighbours, dB.
fn over_neighbours(levels: &[f64]) -> Vec<f64> {
    let over = |fret: usize| {
        let near = fret.saturating_sub(NEAR)..(fret + NEAR + 1).min(levels.len());
        let others: Vec<f64> = near.filter(|other| *other != fret).map(|other| levels[other]).collect();
        levels[fret] - others.iter().sum::<f64>() / others.len() as f64
    };
    (0..levels.len()).map(over).collect()
}

#[test]
fn no_note_is_dead() {
    let page = include_str!("../../../docs/physics.md");
    let (mut softest, mut loudest): (f64, f64) = (0.0, 0.0);
    for name in Setup::SHIPPED {
        let setup = Setup::shipped(name).expect("it comes with the program");
        if setup.body.is_none() {
            continue;
        }
        let mut all = Vec::new();
        for string in 0..setup.string.len() {
            for velocity in VELOCITIES {
                let over = over_neighbours(&notes(&setup, string, velocity));
                for (fret, over) in over.iter().enumerate() {
                    let said = format!("{name}, string {string}, fret {fret} at {velocity}: {over:.1} dB");
                    println!("{said}");
                    assert!(*over > -MOST, "{said} over the mean of its neighbours");
                }
                all.extend(over);
            }
        }
        let (least, most) = (smallest(all.iter().copied()), largest(all.iter().copied()));
        println!("{name}: {least:.1} to {most:.1} dB over the mean of neighbours, {} notes", all.len());
        (softest, loudest) = (softest.max(-least), loudest.max(most));
    }
    let sentence = format!(
        "up to {softest:.0} dB softer than the mean of those up to four frets away, and up to {loudest:.0} louder"
    );
    assert!(page.contains(&sentence), "docs/physics.md does not say: {sentence}");
}
