//! The promise: no note is lost without being counted. One whose string another takes before a strum, or the finger of a tap, has
//! got there is left out, as by hands that turn to something else meanwhile; where the hand is on the string already it strikes.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{Annotation, GestureSink, InputMode, PlayerEvent, TimedAnnotation};
use low_action_dsp::{Gesture, Setup, TimedGesture};
use low_action_tests::cases::cases;
use low_action_tests::hands::{EXACT, Neck, RATE};
use low_action_tests::stage::{Stage, at, cc, level, off, on};
use proptest::prelude::*;

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
const CHORD: [u8; 6] = [40, 47, 52, 56, 59, 64];

/// How often strings were made to sound.
#[derive(Default)]
struct Heard(u64);

impl GestureSink for Heard {
    fn gesture(&mut self, _gesture: TimedGesture) {}

    fn annotation(&mut self, told: TimedAnnotation) {
        self.0 += u64::from(matches!(told.annotation, Annotation::Sounds(_)));
    }
}

/// How often strings were made to sound for the first time, and the notes that were overtaken, and left out otherwise.
fn fate(events: &[(u64, PlayerEvent)]) -> (u64, [u64; 2]) {
    let (mut player, mut heard) = (GUITAR.player(EXACT), Heard::default());
    player.set_input(InputMode::Keyboard);
    player.touch(0, &Touching::new(0.0, 2.0), &mut heard);
    for &(time, event) in events {
        player.event(time, event, &mut heard);
    }
    player.advance(events[events.len() - 1].0 + 10 * RATE as u64, &mut heard);
    assert!(!player.is_behind());
    let compromises = player.compromises();
    let lost =
        [compromises.overtaken, compromises.left_out + compromises.without_string + compromises.doubled];
    (heard.0 - compromises.moved_strings, lost)
}

fn strummed_again(after: u64) -> (u64, [u64; 2]) {
    let chord = |time| CHORD.map(|key| (time, on(key, 90)));
    let up = CHORD.map(|key| (after - 1, off(key)));
    fate(&[&[(0, cc(21, 127))], &chord(0)[..], &up, &chord(after)].concat())
}

/// A strum of 0.4 s: 3840 samples from one string to the next.
#[test]
fn strings_that_a_strum_has_not_reached_are_left_to_the_next() {
    for (after, reached) in [(100, 1), (7_100, 2), (11_600, 4), (24_000, 6)] {
        assert_eq!(strummed_again(after), (reached + 6, [6 - reached, 0]), "{after}");
    }
    // The hand is less than 10 ms away, and strikes at once.
    assert_eq!(strummed_again(7_300), (3 + 6, [3, 0]));
}

/// All sound off on the channel, or all notes at their end at once: what the hand has not reached is left out, whether its key is
/// down or up.
#[test]
fn strings_that_are_silenced_before_the_hand_has_reached_them_are_left_out() {
    for end in [cc(120, 0), PlayerEvent::AllNotesOff] {
        for keys in [&[][..], &CHORD] {
            for (after, reached) in [(100, 1), (4_000, 2), (11_600, 4), (24_000, 6)] {
                let chord = CHORD.map(|key| (0, on(key, 90)));
                let up: Vec<_> = keys.iter().map(|&key| (50, off(key))).collect();
                let song = [&[(0, cc(21, 127))], &chord[..], &up, &[(after, end)]].concat();
                assert_eq!(fate(&song), (reached, [0, 6 - reached]), "{end:?} after {after}");
            }
        }
    }
    // A tremolo has been heard, though its next stroke is on the way.
    for after in 2_000..2_600 {
        assert_eq!(fate(&[(0, cc(25, 127)), (0, on(57, 90)), (after, cc(120, 0))]).1, [0, 0], "{after}");
    }
}

#[test]
fn a_note_that_takes_over_a_string_before_a_strum_is_the_one_it_strikes() {
    let [low, high] = [(0, on(64, 90)), (0, on(40, 90))];
    let told = [(0, cc(21, 127)), (0, cc(68, 127))];
    let hammered = (4_800, on(67, 90));
    // The hammer, and two strokes.
    assert_eq!(fate(&[&told[..], &[low, high, hammered]].concat()), (3, [1, 0]));
    assert_eq!(fate(&[&told[..], &[low, high, (24_000, on(67, 90))]].concat()), (3, [0, 0]));
}

/// A strum of strings that sound, one way or back, whose last stroke falls at 1.4 s, and a note that is hammered on its string at
/// some time: key, string.
fn hammered_before_the_last_stroke(back: u8, stroke: u8, time: f64) -> (Vec<(f64, PlayerEvent)>, usize) {
    let (key, string) = if back > 0 { (43, 5) } else { (67, 0) };
    let open = |time, event: fn(u8) -> PlayerEvent| [40, 45, 50, 55, 59, 64].map(|key| (time, event(key)));
    let struck = |key| on(key, 90);
    let told = [(0.0, cc(21, 127)), (0.0, cc(22, back.max(stroke)))];
    let strums = [open(0.1, struck), open(0.99, off), open(1.0, struck)].concat();
    ([&told[..], &strums, &[(1.2, cc(68, 127)), (time, on(key, 90))]].concat(), string)
}

/// The hand that was to still the string for it does not come any more, or goes. (A note that began up to 10 ms before the stroke was 30
/// to 40 dB below the others.)
#[test]
fn a_hand_on_its_way_does_not_still_what_is_hammered_meanwhile() {
    let mut stage = Stage::new(&Setup::shipped("electric").expect("it comes with the program"));
    for back in [0, 1] {
        let mut heard = |time| {
            let (events, string) = hammered_before_the_last_stroke(back, 0, time);
            level(&stage.play(&events, 1.6).strings[string][at(1.45)..])
        };
        // Long before it, and long after it.
        let usual = heard(1.35).min(heard(1.41));
        for time in [1.391, 1.394, 1.397, 1.3985, 1.3995] {
            let lower = usual - heard(time);
            println!("way {back}, hammered at {time} s: {lower:.1} dB lower");
            assert!(lower < 6.0, "way {back}, hammered at {time} s: {lower} dB lower");
        }
    }
}

/// Nor does the thumb of a pinch come to it.
#[test]
fn no_thumb_grazes_what_is_hammered_before_its_stroke() {
    for time in [1.394, 1.4005] {
        let (events, string) = hammered_before_the_last_stroke(0, 6, time);
        let events = events.into_iter().map(|(time, event)| (at(time) as u64, event)).collect::<Vec<_>>();
        let gestures = GUITAR.told(InputMode::Keyboard, &Touching::new(0.0, 2.0), &events);
        let thumbs = |g: &&TimedGesture| matches!(g.gesture, Gesture::Place { finger: 4, .. });
        let grazed: Vec<_> =
            gestures.iter().filter(|g| g.string == string).filter(thumbs).map(|g| g.time).collect();
        assert!(grazed.len() == 1 && grazed[0] < at(1.0) as u64, "{time}: {grazed:?}");
    }
}

/// The finger of the tap before leaves first, in 3 ms.
#[test]
fn a_finger_that_has_not_come_down_leaves_its_string_to_another_note() {
    // On the lowest string, which alone has them. (A key that is still down would be of a chord with the next.)
    let third = |legato, after: u64| {
        let told = [(0, cc(22, 7)), (0, cc(68, legato)), (0, on(43, 90))];
        let again =
            [(4_800, off(43)), (4_801, on(42, 90)), (4_800 + after, off(42)), (4_801 + after, on(44, 90))];
        fate(&[&told[..], &again].concat())
    };
    for legato in [0, 127] {
        assert_eq!(third(legato, 4_800), (3, [0, 0]), "{legato}");
        assert_eq!(third(legato, 20), (2, [1, 0]), "{legato}");
    }
}

proptest! {
    #![proptest_config(cases(200))]

    /// Chords of any keys, some before the hand has gone over the one before.
    #[test]
    fn each_note_is_played_or_counted(
        chords in prop::collection::vec((1..9_600_u64, prop::collection::hash_set(36..80_u8, 1..=8)), 1..6),
        strum in 0..128_u8,
        stroke in 0..4_u8,
        taps: bool,
    ) {
        let mut time = 0;
        let mut events = vec![(0, cc(21, strum)), (0, cc(22, if taps { 7 } else { stroke }))];
        for (step, keys) in &chords {
            time += step;
            events.extend(keys.iter().map(|&key| (time, on(key, 90))));
        }
        let notes: usize = chords.iter().map(|(_, keys)| keys.len()).sum();
        let (sounds, [overtaken, lost]) = fate(&events);
        prop_assert_eq!(sounds + overtaken + lost, notes as u64);
    }
}

/// Nor does the thumb of a slap linger that has not bounced off yet. (Lifted like a palm, which weighs less, it was on the string for
/// 2 ms longer.)
#[test]
fn a_thumb_that_has_just_struck_leaves_its_string_to_another_note() {
    let mut stage = Stage::alone("electric", 2);
    for after in [0.002, 0.003] {
        let next = 0.1 + after;
        let events =
            [(0.0, cc(22, 4)), (0.1, on(55, 100)), (next, off(55)), (next, cc(22, 0)), (next, on(55, 100))];
        let mut off_at = 0.0;
        stage.watch(&events, 0.2, |time, instrument| {
            let state = instrument.state(0);
            let Some(thumb) = &state.fingers()[4] else { return };
            if thumb.height - state.displacement_at(&thumb.reading) < 1e-3 {
                off_at = time;
            }
        });
        assert!(off_at - next < 0.005, "struck again after {after} s: it is there for {} s", off_at - next);
    }
}
