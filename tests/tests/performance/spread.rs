//! The promise: a chord whose notes come up to 30 ms one after another, as from hands on a keyboard or in a strum, is a chord:
//! whatever fits on the strings when it begins at one sample sounds then, too, none of it hammered on another's string. A note that
//! has to make room is struck once more on a string of its own, and that is counted.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{
    Annotation, Compromises, Excitation, GestureSink, InputMode, Performance, PlayerEvent, Technique,
    TimedAnnotation,
};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::cases::cases;
use low_action_tests::hands::{Neck, note};
use low_action_tests::stage::{cc, off, on};
use proptest::prelude::*;

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
/// Samples: as far as a note of a chord may be from the next.
const TOGETHER: u64 = 1_440;

/// How strings were made to sound: sample, string, and by what.
#[derive(Default)]
struct Heard(Vec<(u64, usize, Technique)>);

impl Heard {
    fn strings(&self) -> Vec<usize> {
        self.0.iter().map(|sounds| sounds.1).collect()
    }

    fn techniques(&self) -> Vec<Technique> {
        self.0.iter().map(|sounds| sounds.2).collect()
    }
}

impl GestureSink for Heard {
    fn gesture(&mut self, _gesture: TimedGesture) {}

    fn annotation(&mut self, TimedAnnotation { time, string, annotation }: TimedAnnotation) {
        if let Annotation::Sounds(Excitation { technique, .. }) = annotation {
            self.0.push((time, string, technique));
        }
    }
}

/// Plays events and what follows up to some sample.
fn played(events: &[(u64, PlayerEvent)], until: u64) -> (Performance, Heard) {
    GUITAR.after(events, until, Heard::default())
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn what_fits_at_once_sounds(
        notes in prop::collection::hash_map(36..84_u8, 0..=TOGETHER, 1..=6),
        legato: bool,
    ) {
        let mut notes: Vec<_> = notes.into_iter().map(|(key, after)| (after, key)).collect();
        notes.sort_unstable();
        let mut time = 4_800;
        let in_turn = |(after, key)| {
            time += after;
            (time, on(key, 90))
        };
        let notes: Vec<_> = notes.into_iter().map(in_turn).collect();
        let told = [(0, cc(68, if legato { 127 } else { 0 }))];
        let at_once: Vec<_> = notes.iter().map(|&(_, note)| (4_800, note)).collect();
        let sounding = |notes: &[(u64, PlayerEvent)]| {
            let (player, heard) = played(&[&told[..], notes].concat(), 24_000);
            let keys: Vec<_> = (0..128).filter(|&key| player.sounds(0, key)).collect();
            (keys, player.compromises(), heard.techniques())
        };
        let (keys, compromises, _) = sounding(&at_once);
        prop_assume!(compromises == Compromises::default());
        prop_assert_eq!(keys.len(), notes.len());
        let (spread, compromises, techniques) = sounding(&notes);
        prop_assert_eq!(&spread, &keys);
        let moved_strings = compromises.moved_strings;
        prop_assert_eq!(compromises, Compromises { moved_strings, ..Compromises::default() });
        prop_assert_eq!(techniques.len() as u64, keys.len() as u64 + moved_strings);
        prop_assert!(techniques.iter().all(|&technique| technique == Technique::Pluck), "{techniques:?}");
    }
}

/// Only the highest string gives the third note; as long as nothing is known of that, the second is played there. Hands still
/// the string before they strike it once more.
#[test]
fn a_note_makes_room_for_one_that_follows() {
    let chord = [(0, on(59, 90)), (100, on(64, 90)), (200, on(84, 90))];
    let (player, heard) = played(&chord, 4_800);
    let struck: Vec<_> = heard.0.iter().map(|&(time, string, _)| (time, string)).collect();
    assert_eq!(struck, [(0, 1), (100, 0), (200, 4), (243, 0)]);
    assert!([59, 64, 84].iter().all(|&key| player.sounds(0, key)));
    assert_eq!(player.compromises().moved_strings, 1);
}

#[test]
fn keys_that_have_gone_up_or_long_sounded_make_no_room() {
    // A run, whose notes do not overlap, and one whose notes are 30 ms apart and one sample.
    let run = [(0, on(64, 90)), (400, off(64)), (401, on(84, 90))];
    let slow = [(0, on(64, 90)), (TOGETHER + 1, on(84, 90))];
    for notes in [&run[..], &slow] {
        let (player, heard) = played(notes, 9_600);
        assert_eq!(heard.strings(), [0, 0]);
        assert_eq!(player.compromises(), Compromises::default());
    }
    let (player, _) = played(&[(0, on(64, 90)), (TOGETHER, on(84, 90))], 9_600);
    assert_eq!(player.compromises().moved_strings, 1);
}

/// Nothing that is there goes: what no string is left for moves by an octave, or comes a moment later.
#[test]
fn a_note_too_many_takes_no_string() {
    // The lowest string alone has both.
    let (player, _) = played(&[(0, on(40, 90)), (300, on(41, 90))], 9_600);
    assert!(player.sounds(0, 40) && player.sounds(0, 41));
    assert_eq!(player.compromises(), Compromises { moved_by_octaves: 1, ..Compromises::default() });
    let keys = [40, 45, 50, 55, 59, 64];
    let six = keys.iter().zip(0..).map(|(&key, index)| (100 * index, on(key, 90)));
    let (player, _) = played(&six.chain([(700, on(67, 90))]).collect::<Vec<_>>(), 1_500);
    assert!(keys.iter().all(|&key| player.sounds(0, key)));
    assert_eq!(player.compromises(), Compromises { arpeggiated: 1, ..Compromises::default() });
}

#[test]
fn a_key_struck_again_and_a_string_asked_for_count_more() {
    let (_, heard) = played(&[(0, on(64, 90)), (500, off(64)), (600, on(64, 90))], 9_600);
    assert_eq!(heard.strings(), [0, 0]);
    // The first string of keyswitches from 0 on, held: it has one note after the other.
    let told = [(0, cc(27, 1)), (0, on(13, 90))];
    let (_, heard) = played(&[&told[..], &[(4_800, on(64, 90)), (5_000, on(66, 90))]].concat(), 9_600);
    assert_eq!(heard.strings(), [0, 0]);
    // Where each string has a channel, what it sends last is right.
    let by_strings = InputMode::Strings { first: 0, from_last: false };
    let notes = [(0, note(0, 64)), (300, note(0, 66))];
    let gestures = GUITAR.told(by_strings, &Touching::new(0.0, 2.0), &notes);
    let plucked = gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. })).map(|g| g.string);
    assert_eq!(plucked.collect::<Vec<_>>(), [0, 0]);
}

/// The notes of a strum that come apart are struck in the way of the first, and the next strum in the other.
#[test]
fn a_stroke_back_and_forth_turns_once_for_a_chord() {
    let told = [(0, cc(22, 2))];
    let chord = |time: u64, apart: u64| {
        let time = move |index: u64| time + index * apart;
        [40, 47, 52, 56].into_iter().zip(0..).map(move |(key, index)| (time(index), on(key, 90)))
    };
    let strokes = |apart| {
        let events: Vec<_> =
            told.into_iter().chain(chord(4_800, apart)).chain(chord(48_000, apart)).collect();
        played(&events, 96_000).1.techniques()
    };
    assert_eq!(strokes(0), [[Technique::Pluck; 4], [Technique::UpStroke; 4]].concat());
    assert_eq!(strokes(200), strokes(0));
}

/// The stroke is that of the chord also where it goes on with a note for which nothing of it makes room.
#[test]
fn a_chord_whose_notes_cannot_make_room_is_one_stroke() {
    // The lowest string alone has both; the second is played an octave higher.
    let told = [(0, cc(22, 2))];
    let events = [&told[..], &[(4_800, on(40, 90)), (5_088, on(41, 90)), (48_000, on(52, 90))]].concat();
    let techniques = played(&events, 96_000).1.techniques();
    assert_eq!(techniques, [Technique::Pluck, Technique::Pluck, Technique::UpStroke]);
}

/// Whatever hands have been told since: a capo that leaves a note no fret on its string, or harmonics, of which one that begins is
/// hardly heard on the string that it has.
#[test]
fn a_note_whose_string_nobody_takes_stays() {
    let capo = [(0, on(64, 90)), (240, cc(26, 3)), (480, on(59, 90)), (48_000, off(64)), (48_000, off(59))];
    let harmonics = [
        (0, on(50, 90)),
        (0, on(45, 90)),
        (48_000, cc(23, 1)),
        (48_000, on(64, 90)),
        (48_480, off(45)),
        (48_960, on(76, 90)),
        (96_000, off(50)),
        (96_000, off(64)),
        (96_000, off(76)),
    ];
    for events in [&capo[..], &harmonics] {
        let last = events[events.len() - 1].0;
        let (player, heard) = played(events, last + 1);
        assert_eq!(player.compromises(), Compromises::default());
        assert_eq!(
            heard.0.len(),
            events.iter().filter(|event| matches!(event.1, PlayerEvent::NoteOn { .. })).count()
        );
        let hanging: Vec<_> = (0..128).filter(|&key| player.sounds(0, key)).collect();
        assert!(hanging.is_empty(), "{hanging:?}");
    }
}

/// The first note of such a chord takes over from the one that is held, and is no reason for the others to do so from it.
#[test]
fn a_chord_after_a_held_note_is_hammered_once() {
    let told = [(0, cc(68, 127)), (0, on(40, 90))];
    let chord = [(48_000, on(45, 90)), (48_480, on(50, 90)), (48_960, on(55, 90))];
    let (player, heard) = played(&[&told[..], &chord].concat(), 96_000);
    let [pluck, hammer] = [Technique::Pluck, Technique::HammerOn];
    assert_eq!(heard.techniques(), [pluck, hammer, pluck, pluck]);
    assert_eq!(heard.strings()[0], heard.strings()[1]);
    assert!([45, 50, 55].iter().all(|&key| player.sounds(0, key)));
    // A note that an ornament goes back to has not begun with it: the next is hammered.
    let told = [(0, cc(68, 127)), (0, on(65, 90))];
    let ornament = [(48_000, on(67, 90)), (48_720, off(67)), (49_200, on(69, 90))];
    let (_, heard) = played(&[&told[..], &ornament].concat(), 96_000);
    assert_eq!(heard.techniques(), [pluck, hammer, Technique::PullOff, hammer]);
}

/// What channels have said between two notes of it is said of a note that is struck once more.
#[test]
fn a_note_that_makes_room_goes_under_the_palm() {
    let told = |time| (time, cc(20, 100));
    let notes = [(0, on(64, 90)), (480, on(84, 90))];
    let struck = |palm: u64| {
        let mut events = [&notes[..], &[told(palm)]].concat();
        events.sort_by_key(|event| event.0);
        let (player, heard) = played(&events, 960);
        assert_eq!(player.compromises().moved_strings, 1);
        // The string that has given way is stilled before it is struck for the other.
        let string = heard.strings()[1];
        let mut gestures = GUITAR.told(InputMode::Keyboard, &Touching::new(0.0, 2.0), &events);
        gestures.retain(|timed| timed.string == string && (480..9_600).contains(&timed.time));
        gestures.iter().filter(|timed| matches!(timed.gesture, Gesture::Lift { .. })).count()
    };
    assert_eq!(struck(240), struck(479));
    assert_eq!(struck(240), 0, "the palm stays on the string");
}
