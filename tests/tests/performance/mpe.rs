//! The promise: in MPE the first channel speaks for all, of what it speaks of and of nothing else. What another channel has
//! been told for itself stays: hands, pedals, and the chord it is part of.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, control, note, play, wheel};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// What hands make of events, each with its sample.
fn mpe(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    GUITAR.told(InputMode::Mpe, &Touching::default(), events)
}

/// Times of the plucks.
fn plucks(gestures: &[TimedGesture]) -> Vec<u64> {
    gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. })).map(|g| g.time).collect()
}

/// Lightest thumb, kg; what of a palm falls on a string is lighter.
const THUMB: f64 = 0.01;

/// Whether the thumb was thrown at the string that is struck, and whether the palm lay on it then.
fn slap_and_palm(gestures: &[TimedGesture]) -> [bool; 2] {
    let is_thumb =
        |g: &TimedGesture| matches!(g.gesture, Gesture::Throw { finger: 4, touch, .. } if touch.mass > THUMB);
    let strikes = |g: &&TimedGesture| matches!(g.gesture, Gesture::Pluck { .. }) || is_thumb(g);
    let stroke = gestures.iter().find(strikes).expect("there is a note");
    let on_it = gestures.iter().filter(|g| g.string == stroke.string);
    let laid = on_it.take_while(|g| g != &stroke).fold(false, |laid, g| match g.gesture {
        Gesture::Place { finger: 4, .. } | Gesture::Throw { finger: 4, .. } => true,
        Gesture::Lift { finger: 4, .. } => false,
        _ => laid,
    });
    [is_thumb(stroke), laid]
}

#[test]
fn the_first_channel_leaves_what_another_has_been_told_of_something_else() {
    let told = [(0, control(2, 22, 4)), (0, control(2, 20, 100))];
    let after = |message: &[PlayerEvent]| {
        let message: Vec<_> = message.iter().map(|&event| (2400, event)).collect();
        slap_and_palm(&mpe(&[&told[..], &message, &[(4800, note(2, 60))]].concat()))
    };
    for message in [
        wheel(0, 0.5),
        control(0, 1, 20),
        control(0, 7, 100),
        control(0, 64, 127),
        PlayerEvent::ChannelPressure { channel: 0, pressure: 0.5 },
        // Hands, but neither thumb nor palm.
        control(0, 24, 100),
        control(0, 21, 0),
    ] {
        assert_eq!(after(&[message]), [true, true], "{message:?}");
    }
    // What it says of these holds for all, if it is what it has said before, too.
    assert_eq!(after(&[control(0, 22, 0)]), [false, true]);
    assert_eq!(after(&[control(0, 20, 0)]), [true, false]);
    assert_eq!(after(&[control(0, 121, 0)]), [false, false]);
    // And until the other is told otherwise.
    assert_eq!(after(&[control(0, 22, 0), control(2, 22, 4)]), [true, true]);
}

#[test]
fn a_palm_for_all_leaves_the_tremolo_of_one() {
    let strokes = |palm: &[(u64, PlayerEvent)]| {
        let one = [(0, control(2, 25, 127)), (0, note(2, 60))];
        let end = [(48_000, PlayerEvent::NoteOff { channel: 2, key: 60 })];
        plucks(&mpe(&[&one[..], palm, &end].concat())).len()
    };
    assert!(strokes(&[]) >= 20);
    assert_eq!(strokes(&[(2400, control(0, 20, 100))]), strokes(&[]));
}

#[test]
fn what_the_first_channel_said_before_it_spoke_for_all_counts_from_then_on() {
    let announced = [(101, 0), (100, 6), (6, 15)].map(|(number, value)| (2400, control(0, number, value)));
    let told = [(0, control(0, 22, 4)), (0, control(2, 20, 100))];
    let played = [(4800, note(2, 60))];
    let auto = |events: &[&[(u64, PlayerEvent)]]| {
        GUITAR.told(InputMode::Auto, &Touching::default(), &events.concat())
    };
    assert_eq!(slap_and_palm(&auto(&[&told, &played])), [false, true]);
    assert_eq!(slap_and_palm(&auto(&[&told, &announced, &played])), [true, true]);
    // Or when the input is said to be such a keyboard.
    let mut player = GUITAR.player(EXACT);
    player.set_input(InputMode::Keyboard);
    play(&mut player, &told);
    player.set_input(InputMode::Mpe);
    assert_eq!(slap_and_palm(&play(&mut player, &[(200_000, note(2, 60))])), [true, true]);
}

/// Whether a note of channel 3 goes on after its key is up and then something is said, up to the end.
fn goes_on(before: &[PlayerEvent], after: PlayerEvent) -> bool {
    let mut player = GUITAR.player(EXACT);
    player.set_input(InputMode::Mpe);
    let pedals = before.iter().map(|&event| (2400, event));
    let rest = [(4800, PlayerEvent::NoteOff { channel: 3, key: 60 }), (24_000, after)];
    play(&mut player, &[(0, note(3, 60))].into_iter().chain(pedals).chain(rest).collect::<Vec<_>>());
    player.sounds(3, 60)
}

#[test]
fn a_channel_that_is_reset_leaves_what_the_pedals_of_the_first_hold() {
    for pedal in [64, 66] {
        let [first, own] = [control(0, pedal, 127), control(3, pedal, 127)];
        for reset in [control(3, 121, 0), control(3, pedal, 0)] {
            assert!(goes_on(&[first, own], reset), "CC {pedal}, {reset:?}");
            assert!(!goes_on(&[own], reset), "CC {pedal}, {reset:?}");
        }
        for reset in [control(0, 121, 0), control(0, pedal, 0)] {
            assert!(!goes_on(&[first], reset), "CC {pedal}, {reset:?}");
            assert!(goes_on(&[first, own], reset), "CC {pedal}, {reset:?}");
        }
    }
}

#[test]
fn keys_that_a_host_lifts_are_those_of_the_channel_that_it_names() {
    for lifted in [0, 3, 5] {
        let mut player = GUITAR.player(EXACT);
        player.set_input(InputMode::Mpe);
        // One of them twice, and a pedal.
        let down = [(0, note(0, 40)), (0, note(3, 60)), (4800, note(3, 60)), (4800, control(5, 64, 127))];
        let host = [(4800, note(5, 64)), (24_000, PlayerEvent::KeysOff { channel: lifted })];
        play(&mut player, &[&down[..], &host].concat());
        let sounds = [(0, 40), (3, 60), (5, 64)].map(|(channel, key)| player.sounds(channel, key));
        assert_eq!(sounds, [lifted != 0, lifted != 3, true], "{lifted}");
    }
}

#[test]
fn what_two_sostenuto_pedals_hold_ends_when_both_are_up() {
    for ups in [[3, 0], [0, 3]] {
        let mut player = GUITAR.player(EXACT);
        player.set_input(InputMode::Mpe);
        // The first channel's comes down when the key is up already.
        let caught = [(0, note(3, 60)), (2400, control(3, 66, 127))];
        let held = [(4800, PlayerEvent::NoteOff { channel: 3, key: 60 }), (9600, control(0, 66, 127))];
        play(&mut player, &[&caught[..], &held, &[(24_000, control(ups[0], 66, 0))]].concat());
        assert!(player.sounds(3, 60), "one pedal is down, {ups:?}");
        play(&mut player, &[(200_000, control(ups[1], 66, 0))]);
        assert!(!player.sounds(3, 60), "{ups:?}");
    }
}

#[test]
fn a_note_that_comes_back_when_another_channel_is_reset_swings_as_its_own_has_it() {
    let swings = |reset: PlayerEvent| {
        let told = [(0, control(0, 68, 127)), (0, control(1, 1, 127)), (0, control(2, 64, 127))];
        // B3 over A3, kept by its pedal.
        let notes = [(0, note(1, 57)), (24_000, note(2, 59))];
        let up = [(36_000, PlayerEvent::NoteOff { channel: 2, key: 59 }), (48_000, reset)];
        let gestures = mpe(&[&told[..], &notes, &up].concat());
        let bent = |g: &&TimedGesture| g.time > 60_000 && matches!(g.gesture, Gesture::Bend { .. });
        gestures.iter().filter(bent).count()
    };
    assert!(swings(control(2, 64, 0)) > 20, "the pedal goes up");
    assert!(swings(control(2, 121, 0)) > 20, "all of its channel is put back");
}
