//! The promise: a finger that slides goes on from where it is. The next note counts from there, and a wheel or a vibrato on
//! the way does not hurry it. What lies beyond the neck takes no time.

use low_action::performance::{Annotation, GestureSink, InputMode, PlayerEvent, Style, TimedAnnotation};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, control, note, play};
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{LOOK, Stage, at, cc, decibels, off, on, peak};

const RATE: f64 = 48_000.0;

fn wheel(value: f32) -> PlayerEvent {
    PlayerEvent::PitchBend { channel: 0, value }
}

/// The wheel has slid the finger to the very fret of the next note, which is then that note's own.
#[test]
fn a_note_where_the_wheel_has_slid_the_finger_counts_from_there() {
    let octave = [(0.0, cc(101, 0)), (0.0, cc(100, 0)), (0.0, cc(6, 12)), (0.0, cc(68, 127))];
    let slid = [(0.0, on(60, 110)), (0.3, wheel(5.0 / 12.0)), (0.8, on(65, 110))];
    let back = [(1.3, wheel(0.0)), (1.8, off(65))];
    let mut stage = Stage::alone("electric", 1);
    let sound = &stage.play(&[&octave[..], &slid, &back].concat(), 2.4).strings[0];
    for (from, to, key) in [(0.5, 0.8, 65.0), (1.0, 1.3, 70.0), (1.5, 1.8, 65.0), (2.0, 2.4, 60.0)] {
        let off = off_key(&sound[at(from)..at(to)], key);
        assert!(off.abs() < 8.0, "from {from} s: {off} cents off {key}");
    }
}

/// Where a finger is half way through a slide of half a second, as a part of its way, and where it has come to.
fn on_the_way(setup: &str, string: usize, events: &[(f64, PlayerEvent)]) -> [f64; 2] {
    let mut places = Vec::new();
    let events = [&[(0.0, cc(5, 86)), (0.0, cc(68, 127))], events].concat();
    Stage::alone(setup, string).watch(&events, 1.6, |_, instrument| {
        places
            .push(instrument.state(0).fingers().iter().take(2).flatten().next().map_or(0.0, |f| f.position));
    });
    let place = |seconds: f64| places[(seconds * RATE / LOOK as f64) as usize];
    let [from, half, to] = [0.49, 0.75, 1.1].map(place);
    [(half - from) / (to - from), to]
}

#[test]
fn neither_wheel_nor_vibrato_hurries_a_slide() {
    let bar = [(0.0, cc(23, 3)), (0.0, on(58, 90)), (0.5, on(63, 90))];
    let bare = [(0.0, cc(65, 127)), (0.0, on(36, 90)), (0.5, on(41, 90))];
    for (setup, string, notes) in [("electric", 2, &bar), ("fretless-bass", 2, &bare)] {
        let [_, plain] = on_the_way(setup, string, notes);
        for (what, asked) in [("vibrato", cc(1, 64)), ("wheel", wheel(0.15)), ("straight", wheel(0.0))] {
            let [part, to] = on_the_way(setup, string, &[&[(0.0, asked)], &notes[..]].concat());
            assert!((0.45..0.6).contains(&part), "{setup}, {what}: {part} of the way at half time");
            assert!((to - plain).abs() < 0.02, "{setup}, {what}: it comes {} m from there", to - plain);
            // A wheel that is turned on the way.
            let [part, _] = on_the_way(setup, string, &[&notes[..], &[(0.55, asked)]].concat());
            assert!((0.45..0.6).contains(&part), "{setup}, {what} on the way: {part} at half time");
        }
    }
}

/// Nor one over frets that a wheel is to carry on, past the reach of pulling.
#[test]
fn a_wheel_that_slides_waits_for_the_note() {
    let octave = [(0.0, cc(101, 0)), (0.0, cc(100, 0)), (0.0, cc(6, 12)), (0.0, cc(65, 127))];
    let notes = [(0.0, wheel(-5.0 / 12.0)), (0.0, on(62, 90)), (0.5, on(69, 90))];
    let [part, _] = on_the_way("electric", 2, &[&octave[..], &notes].concat());
    assert!((0.4..0.6).contains(&part), "{part} of the way at half time");
}

/// From two frets before the end of the neck: a hand bends a hundred semitones in a second.
#[test]
fn what_lies_beyond_the_neck_takes_no_time() {
    let guitar = Neck::of("electric");
    let last = guitar.strings[0].geometry.frets.len() as u8;
    let key = guitar.strings[0].geometry.open_pitch.round() as u8 + last - 2;
    let mut player = guitar.player(EXACT);
    player.set_input(InputMode::Mpe);
    let member = |value| PlayerEvent::PitchBend { channel: 1, value };
    let up = [
        (0, PlayerEvent::NoteOn { channel: 1, key, velocity: 0.8 }),
        (9_600, member(1.0)),
        (48_000, member(0.0)),
    ];
    let slides: Vec<f64> = play(&mut player, &up)
        .iter()
        .filter_map(|g| match g.gesture {
            Gesture::Slide { duration, .. } => Some(duration),
            _ => None,
        })
        .collect();
    assert_eq!(slides.len(), 2, "{slides:?}");
    assert!(slides.iter().all(|&duration| duration < 0.03), "{slides:?}");
}

/// How long bends take, s: as they are done, and as they are told for labels.
#[derive(Default)]
struct Bends([Vec<f64>; 2]);

impl GestureSink for Bends {
    fn gesture(&mut self, timed: TimedGesture) {
        if let Gesture::Bend { duration, .. } = timed.gesture {
            self.0[0].push(duration);
        }
    }

    fn annotation(&mut self, told: TimedAnnotation) {
        if let Annotation::Bent { duration, .. } = told.annotation {
            self.0[1].push(duration);
        }
    }
}

/// No finger slides on an open string that sounds, however far past the reach of pulling the wheel goes.
#[test]
fn an_open_string_is_bent_in_the_time_that_pulling_takes() {
    let mut player = Neck::of("electric").player(Style { variation: 0.0, seed: 0, bend_range: 12.0 });
    let mut bends = Bends::default();
    let events = [(0, on(64, 90)), (9_600, wheel(1.0))];
    events.into_iter().for_each(|(time, event)| player.event(time, event, &mut bends));
    player.advance(48_000, &mut bends);
    let [done, told] = bends.0;
    assert!(done.len() == 1 && done == told, "{done:?} s, {told:?} s");
}

/// Frets that go by pluck the string. (In 30 ms over seven frets, each in time with what the one before had left, they made a soft
/// note 21 dB louder.)
#[test]
fn a_slide_is_about_as_loud_as_the_note_before() {
    let strings = [
        ("electric", 0, 64),
        ("electric", 3, 50),
        ("electric", 5, 40),
        ("classical", 3, 50),
        ("steel", 0, 64),
        ("bass", 2, 33),
    ];
    for (setup, string, open) in strings {
        let mut stage = Stage::alone(setup, string);
        for (from, to) in [(5, 12), (2, 12), (12, 5), (5, 10), (2, 9), (9, 4), (5, 7), (3, 15)] {
            for (velocity, most) in [(30, 8.0), (64, 7.0), (100, 4.0)] {
                let connected = [(0.0, cc(68, 127)), (0.0, cc(65, 127))];
                let notes = [(0.0, on(open + from, velocity)), (0.5, on(open + to, velocity))];
                let sound = &stage.play(&[connected, notes].concat(), 1.2).strings[0];
                let louder = decibels(peak(&sound[at(0.5)..]) / peak(&sound[..at(0.4)]));
                assert!(
                    louder < most,
                    "{setup} {string}, {from} to {to}, velocity {velocity}: {louder} dB louder"
                );
            }
        }
    }
}

/// Keyboards and tracks send the portamento switch by itself, and mean that overlapping notes slide.
#[test]
fn the_portamento_switch_alone_connects_overlapping_notes_by_slides() {
    let guitar = Neck::of("electric");
    // A note, another over it six frets up, and back.
    let phrase = |channels: [u8; 2]| {
        let ends = PlayerEvent::NoteOff { channel: channels[1], key: 63 };
        [(4_800, note(channels[0], 57)), (24_000, note(channels[1], 63)), (48_000, ends)]
    };
    let played = |input, told: &[PlayerEvent], channels| {
        let mut player = guitar.player(EXACT);
        player.set_input(input);
        let told = told.iter().map(|&event| (0, event)).collect::<Vec<_>>();
        play(&mut player, &[&told[..], &phrase(channels)].concat())
    };
    let counts = |input, told: &[PlayerEvent], channels| {
        let gestures = played(input, told, channels);
        let count =
            |meant: fn(&Gesture) -> bool| gestures.iter().filter(|timed| meant(&timed.gesture)).count();
        [count(|g| matches!(g, Gesture::Pluck { .. })), count(|g| matches!(g, Gesture::Slide { .. }))]
    };
    let (plucked, slid, hammered) = ([2, 0], [1, 2], [1, 0]);
    let (on, off) = (control(0, 65, 127), control(0, 65, 0));
    let (legato, plucks, reset) = (control(0, 68, 127), control(0, 68, 0), control(0, 121, 0));
    let switch = |number: u8| [control(0, 27, 12), note(0, 12 + number)];
    for (told, expected) in [
        (&[on][..], slid),
        (&[on, plucks], slid),
        (&[control(0, 65, 64)], slid),
        (&[control(0, 65, 63)], plucked),
        (&[on, off], plucked),
        (&[on, reset], plucked),
        (&[control(1, 65, 127)], plucked),
        // Each keyswitch takes the place of what was told before.
        (&[&[on], &switch(0)[..]].concat(), plucked),
        (&[&switch(0)[..], &[on]].concat(), slid),
        (&[&switch(10)[..], &[on]].concat(), slid),
        (&switch(11), slid),
    ] {
        assert_eq!(counts(InputMode::Keyboard, told, [0, 0]), expected, "{told:?}");
    }
    assert_eq!(
        played(InputMode::Keyboard, &[on], [0, 0]),
        played(InputMode::Keyboard, &[legato, on], [0, 0])
    );
    // Within a hammer's reach, too: of that the switch says nothing.
    let near = |told: PlayerEvent| {
        let notes = [(0, told), (4_800, note(0, 57)), (24_000, note(0, 60))];
        let gestures = play(&mut guitar.player(EXACT), &notes);
        let count =
            |meant: fn(&Gesture) -> bool| gestures.iter().filter(|timed| meant(&timed.gesture)).count();
        [count(|g| matches!(g, Gesture::Pluck { .. })), count(|g| matches!(g, Gesture::Slide { .. }))]
    };
    assert_eq!((near(on), near(legato)), ([1, 1], hammered));
    // In MPE the first channel's holds for all, and a member's for its own notes; its reset puts back what it has said.
    let members = [1, 2];
    assert_eq!(counts(InputMode::Mpe, &[on], members), slid);
    assert_eq!(counts(InputMode::Mpe, &[control(2, 65, 127)], members), slid);
    assert_eq!(counts(InputMode::Mpe, &[control(1, 65, 127)], members), plucked);
    assert_eq!(counts(InputMode::Mpe, &[on, reset], members), plucked);
    // Where each string has a channel, its own.
    let strings = InputMode::Strings { first: 0, from_last: false };
    for (channel, expected) in [(2, slid), (1, plucked)] {
        assert_eq!(counts(strings, &[control(channel, 65, 127)], [2, 2]), expected, "channel {channel}");
    }
}

/// What the string of the note before does not have, or only beyond a slide's reach, is plucked.
#[test]
fn notes_that_were_to_be_slid_to_and_are_not_are_counted() {
    let neck = Neck::of("electric");
    let count = |told: &[(u8, u8)], keys: &[(u64, u8)]| {
        let told = told.iter().map(|&(number, value)| (0, control(0, number, value)));
        let notes = keys.iter().map(|&(time, key)| (time, note(0, key)));
        let (player, _) = neck.after(&told.chain(notes).collect::<Vec<_>>(), 48_000, Vec::new());
        player.compromises().not_slid
    };
    // The A on the D string's seventh fret or nearer, where no string has E2 but the lowest.
    let low = [(0, 57), (9_600, 40)];
    let slide = (65, 127);
    assert_eq!(count(&[slide], &low), 1);
    assert_eq!(count(&[slide], &[(0, 57), (9_600, 59)]), 0, "near enough");
    assert_eq!(count(&[slide], &[(0, 41), (9_600, 54)]), 1, "thirteen frets");
    assert_eq!(count(&[slide, (23, 1)], &[(0, 76), (9_600, 83)]), 0, "harmonics are asked for as such");
    assert_eq!(count(&[(68, 127)], &low), 0, "a pull was asked for");
    // A pair is no melody.
    assert_eq!(count(&[slide], &[(0, 57), (9_600, 40), (9_600, 45)]), 0);
}
