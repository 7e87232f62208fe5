//! The promise: how loud a trill gets hardly hangs on its exact tempo. Where a machine has every hammer and every pull meet the string
//! at the same moment of its swing, each adds to what the others did, or takes from it, for as long as the trill goes on. Hands
//! are not so regular.

use low_action::controls::Touching;
use low_action::engine::EngineOptions;
use low_action::performance::PlayerEvent;
use low_action_tests::numbers::{largest, root_mean_square, smallest};
use low_action_tests::stage::{Stage, at, cc, level, off, on};

/// As the page has it, set-up, string, its open key, frets of the key that is held and of the other.
const TRILLS: [(&str, &str, usize, u8, [u8; 2]); 7] = [
    ("steel, E4 and G4", "steel", 0, 64, [0, 3]),
    ("electric, C4 and D4", "electric", 2, 55, [5, 7]),
    ("electric, G2 and A2", "electric", 5, 40, [3, 5]),
    ("classical, C3 and D3", "classical", 4, 45, [3, 5]),
    ("ukulele, A4 and C5", "ukulele", 0, 69, [0, 3]),
    ("bass, D2 and E2", "bass", 1, 38, [0, 2]),
    ("bass, A1 and B1", "bass", 3, 28, [5, 7]),
];
const VELOCITY: u8 = 80;
/// Hammers of a trill, and from which on it is listened to.
const HAMMERS: usize = 16;
const SETTLED: usize = 8;
/// When the first one comes, s.
const FIRST: f64 = 0.25;

/// From 20 to 150 ms after a note, or to the next one, s.
fn listened_to(start: f64, apart: f64) -> std::ops::Range<usize> {
    at(start + 0.02)..at(start + apart.min(0.15))
}

/// How much louder the notes of a trill are at last than the same ones plucked alone, on the mean, dB.
fn settled(stage: &mut Stage, held: u8, other: u8, apart: f64, alone: &[Vec<f32>; 2]) -> f64 {
    let start = |note: usize| FIRST + apart * note as f64;
    let strikes = (0..HAMMERS)
        .flat_map(|turn| [(start(2 * turn), on(other, VELOCITY)), (start(2 * turn + 1), off(other))]);
    let events: Vec<(f64, PlayerEvent)> =
        [(0.0, cc(68, 127)), (0.05, on(held, VELOCITY))].into_iter().chain(strikes).collect();
    let sound = &stage.play(&events, start(2 * HAMMERS)).strings[0];
    let powers = (2 * SETTLED..2 * HAMMERS).map(|note| {
        let louder =
            level(&sound[listened_to(start(note), apart)]) - level(&alone[note % 2][listened_to(0.0, apart)]);
        10.0_f64.powf(0.1 * louder)
    });
    10.0 * (powers.sum::<f64>() / (2 * (HAMMERS - SETTLED)) as f64).log10()
}

/// What is left of a note when the next is struck is some 0.7 times as loud as that. How loud both are together spreads by 8.7 dB ·
/// √(½ Li₂(0.7²)) = 4.7 dB with how they fall together, and so does a trill of which all notes fall together alike. If each of 16
/// notes fell together by chance, a trill would spread by 1.2 dB. Fingers that are late by up to 3 ms are so on thin strings
/// only: those of the bass swing in 10 to 18 ms.
#[test]
fn a_trill_is_about_as_loud_at_any_tempo() {
    let (mut rows, mut spreads) = (String::new(), [Vec::new(), Vec::new()]);
    for (name, setup, string, open, frets) in TRILLS {
        let mut row = format!("| {name} |");
        let [held, other] = frets.map(|fret| open + fret);
        let mut stage = Stage::alone(setup, string);
        let alone = [other, held].map(|key| stage.play(&[(0.0, on(key, VELOCITY))], 0.2).strings.remove(0));
        for (variation, spreads) in [0.0, EngineOptions::VARIATION].into_iter().zip(&mut spreads) {
            stage.performance.touch(0, &Touching::new(variation, 2.0), &mut Vec::new());
            let found: Vec<f64> = (80..=200)
                .step_by(10)
                .map(|apart| settled(&mut stage, held, other, 0.001 * f64::from(apart), &alone))
                .collect();
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            let spread = root_mean_square(&found.iter().map(|level| level - mean).collect::<Vec<_>>());
            row += &format!(
                " {spread:.1} dB | {:.1} to {:.1} dB |",
                smallest(found.iter().copied()),
                largest(found.iter().copied())
            );
            spreads.push(spread);
        }
        rows += &(row + "\n");
    }
    println!("{rows}");
    let [exact, usual] = spreads.map(|spreads| root_mean_square(&spreads));
    assert!(usual < 2.5, "{usual} dB, and {exact} dB where each is on time");
    let page = include_str!("../../../docs/gestures.md");
    assert!(page.contains(&rows), "docs/gestures.md has other numbers than\n{rows}");
}
