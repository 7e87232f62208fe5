//! Promise: a host that plays its music a second time hears the same as the first time, whatever was played meanwhile.

use low_action_tests::host::{Action, Host, Score};
use low_action_tests::numbers::rms;

const RATE: f64 = 48_000.0;
/// When each pass begins, samples, at the beginning of a block, and how long it sounds.
const PASSES: [u64; 2] = [0, 480_256];
const MUSIC: usize = 96_000;

#[test]
fn the_second_pass_is_the_first_one() {
    let mut score: Score = vec![(0, Action::Midi([0xB0, 22, 2]))];
    for from in PASSES {
        score.push((from, Action::Transport(true)));
        for (index, key) in (0..).zip([52, 59, 64, 71, 76]) {
            score.push((from + 100 + 9_600 * index, Action::NoteOn { channel: 0, key, velocity: 100 }));
            score.push((from + 9_000 + 9_600 * index, Action::NoteOff { channel: 0, key }));
        }
        score.push((from + 60_000, Action::Transport(false)));
    }
    // Somebody plays while it stands still.
    score.push((144_000, Action::NoteOn { channel: 0, key: 83, velocity: 100 }));
    score.push((150_000, Action::NoteOff { channel: 0, key: 83 }));
    score.sort_by_key(|&(at, _)| at);
    let [left, _] = Host::new().play(RATE, &score, PASSES[1] as usize + MUSIC, &[512]);
    let [first, second] = PASSES.map(|from| &left[from as usize..from as usize + MUSIC]);
    assert!(first.iter().any(|&sample| sample != 0.0));
    let apart: Vec<f32> = first.iter().zip(second).map(|(a, b)| a - b).collect();
    // To rounding: two fingers of a string take turns, and either may be the first one's.
    assert!(rms(&apart) < 1e-6 * rms(first), "{} of {}", rms(&apart), rms(first));
}

/// Music that is played and played again from a sample on, in a song of which more is told.
fn twice(second: u64, told: &[(u64, Action)]) -> Vec<f32> {
    let mut score: Score = vec![(0, Action::Midi([0xB0, 22, 2])), (0, Action::Place(0))];
    for from in [0, second] {
        for (index, key) in (0..).zip([52, 59, 64, 71, 76]) {
            score.push((from + 1_000 + 9_600 * index, Action::NoteOn { channel: 0, key, velocity: 100 }));
            score.push((from + 9_900 + 9_600 * index, Action::NoteOff { channel: 0, key }));
        }
    }
    score.extend(told);
    score.sort_by_key(|&(at, _)| at);
    let [left, _] = Host::new().play(RATE, &score, second as usize + MUSIC, &[512]);
    left
}

/// The framework is ahead of the host's position by up to a block where that is told within one.
#[test]
fn a_position_that_is_told_within_a_block_goes_back_nowhere() {
    // At a block's beginning.
    let second = 512 * 200;
    let plain = twice(second, &[]);
    for late in [1, 400, 511] {
        let at = second - 512 + late;
        assert!(twice(second, &[(at, Action::Place(at))]) == plain, "{late} samples late");
        // A loop goes back, wherever in the block.
        let loops = twice(second, &[(at, Action::Place(0))]);
        assert!(loops != plain, "{late} samples late");
    }
}
