//! The promise: what lets go of all keys lets go of those whose notes wait for a string, too, as their note-offs would; what silences
//! everything leaves these notes out, and counts them so.

use std::sync::LazyLock;

use low_action::performance::{Compromises, PlayerEvent};
use low_action_dsp::TimedGesture;
use low_action_tests::hands::{EXACT, Neck, count_plucks as plucks, play};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
/// Eight for six strings: two wait, for 70 and 140 ms.
const KEYS: [u8; 8] = [40, 45, 50, 55, 59, 64, 67, 71];
/// While both wait, samples.
const MEANWHILE: u64 = 2_400;

/// What hands do where all that is said meanwhile, and what has become of the notes.
fn played(told: &[PlayerEvent], meanwhile: &[PlayerEvent]) -> (Vec<TimedGesture>, Compromises) {
    let mut player = GUITAR.player(EXACT);
    let told = told.iter().map(|&event| (0, event)).chain(KEYS.map(|key| (0, on(key, 90))));
    let events = told.chain(meanwhile.iter().map(|&event| (MEANWHILE, event)));
    let gestures = play(&mut player, &events.collect::<Vec<_>>());
    (gestures, player.compromises())
}

#[test]
fn all_keys_up_is_a_note_off_for_each() {
    for told in [&[][..], &[cc(64, 127)], &[cc(68, 127)]] {
        let (each, compromises) = played(told, &KEYS.map(off));
        assert_eq!((plucks(&each), compromises.arpeggiated, compromises.left_out), (8, 2, 0), "{told:?}");
        for by in [cc(123, 0), cc(127, 0), PlayerEvent::KeysOff { channel: 0 }] {
            assert!(played(told, &[by]) == (each.clone(), compromises), "{by:?} after {told:?}");
        }
    }
}

#[test]
fn silence_leaves_out_what_waits() {
    for told in [&[][..], &[cc(64, 127)]] {
        for by in [cc(120, 0), PlayerEvent::AllNotesOff] {
            let (gestures, Compromises { arpeggiated, left_out, moved_by_octaves, .. }) = played(told, &[by]);
            assert_eq!((plucks(&gestures), arpeggiated, left_out), (6, 0, 2), "{by:?} after {told:?}");
            assert_eq!(moved_by_octaves, 0, "{by:?}");
        }
    }
}
