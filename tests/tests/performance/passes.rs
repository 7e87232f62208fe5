//! The promise: a song that is played a second time has the same fingers, strokes and variations as the first time, whatever was
//! played before it.

use std::sync::LazyLock;

use low_action::performance::{Performance, PlayerEvent, Style};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::Neck;
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
/// How long the music is, and how long nothing sounds after it, samples.
const MUSIC: u64 = 48_000;
const PAUSE: u64 = 240_000;

fn player(capo: u8) -> Performance {
    let mut player = GUITAR.player(Style { variation: 1.0, seed: 5, bend_range: 2.0 });
    for told in [cc(26, capo), cc(22, 2)] {
        player.event(0, told, &mut Vec::new());
    }
    player
}

/// Music that has the hand far up the neck at the end, after an odd number of strokes: what is done to the strings, where and how,
/// counted from its first sample.
fn strokes(player: &mut Performance, from: u64) -> Vec<(u64, usize, Gesture)> {
    let mut gestures = Vec::new();
    for (index, key) in (0..).zip([52, 55, 59, 64, 67, 71, 76, 79, 83]) {
        let time = from + 4_800 * index;
        player.event(time, on(key, 90), &mut gestures);
        player.event(time + 4_000, off(key), &mut gestures);
    }
    player.advance(from + MUSIC, &mut gestures);
    let stroke = |&TimedGesture { time, string, gesture }: &TimedGesture| match gesture {
        Gesture::Pluck { .. } if time >= from => Some((time - from, string, gesture)),
        _ => None,
    };
    let strokes: Vec<_> = gestures.iter().filter_map(stroke).collect();
    assert_eq!(strokes.len(), 9);
    strokes
}

/// A transport that stops lets go of all notes.
#[test]
fn what_follows_a_stop_is_as_at_the_beginning() {
    for capo in [0, 3] {
        let mut player = player(capo);
        let first = strokes(&mut player, 0);
        let mut from = MUSIC;
        // Whether something sounds at the stop or not.
        for rings in [false, true] {
            if rings {
                player.event(from, on(83, 90), &mut Vec::new());
            }
            player.event(from + PAUSE, PlayerEvent::AllNotesOff, &mut Vec::new());
            assert_eq!(strokes(&mut player, from + 2 * PAUSE), first, "capo {capo}");
            from += 2 * PAUSE + MUSIC;
        }
    }
}

/// So does one that starts again without having stopped, or after somebody has played by hand.
#[test]
fn what_begins_anew_is_as_at_the_beginning() {
    let mut player = player(0);
    let first = strokes(&mut player, 0);
    let from = MUSIC + PAUSE;
    assert_ne!(strokes(&mut player, from), first, "it goes on where it was");
    let from = from + MUSIC + PAUSE;
    player.begin_anew();
    assert_eq!(strokes(&mut player, from), first);
    // To one who holds a key it is no beginning.
    let from = from + MUSIC + PAUSE;
    player.event(from - 100, on(40, 90), &mut Vec::new());
    player.begin_anew();
    assert_ne!(strokes(&mut player, from), first);
    // Nor are the notes after.
    player.event(from + MUSIC, off(40), &mut Vec::new());
    assert_ne!(strokes(&mut player, from + MUSIC + PAUSE), first);
}
