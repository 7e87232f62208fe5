//! The promise: whatever hands are told, in whatever order, no finger stays on a string after everything has
//! stopped, no force or place is absurd, and how time is cut into blocks changes nothing.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{Expression, InputMode, Performance, PlayerEvent, StringDeed, Style};
use low_action_dsp::{FINGERS_PER_STRING, Gesture, TimedGesture};
use low_action_tests::cases::cases;
use low_action_tests::hands::{Neck, RATE, of_string, play, play_in_blocks};
use proptest::prelude::*;

/// One with frets, one without, and one where nothing can be stopped.
static NECKS: LazyLock<[Neck; 3]> = LazyLock::new(|| ["electric", "fretless-bass", "tanpura"].map(Neck::of));

fn player(neck: usize, input: InputMode, touching: &Touching) -> Performance {
    let mut performance = NECKS[neck].player(Style { variation: 0.5, seed: 1, bend_range: 2.0 });
    performance.set_input(input);
    performance.touch(0, touching, &mut Vec::new());
    performance
}

const CONTROLLERS: [u8; 22] =
    [1, 2, 5, 6, 11, 20, 21, 22, 23, 24, 25, 26, 27, 64, 65, 66, 68, 74, 100, 101, 121, 123];

/// What somebody may do who sees a string: at any place, on it or not, as hard as one likes, or by numbers that
/// are none.
fn any_deed() -> impl Strategy<Value = StringDeed> {
    let place = prop_oneof![6 => -0.2_f32..1.2, 1 => prop::num::f32::ANY];
    let force = prop_oneof![6 => -60.0_f32..60.0, 1 => prop::num::f32::ANY];
    prop_oneof![
        3 => (place.clone(), force).prop_map(|(position, force)| StringDeed::Pluck { position, force }),
        3 => place.prop_map(|position| StringDeed::Press { position }),
        2 => Just(StringDeed::Lift),
        1 => Just(StringDeed::Damp),
    ]
}

/// What a note can have for itself, but for forces, which a host may ask for without documented bounds.
fn any_expression(
    unit: impl Strategy<Value = f32> + Clone,
    turn: impl Strategy<Value = f32>,
) -> impl Strategy<Value = Expression> {
    prop_oneof![
        unit.clone().prop_map(Expression::Vibrato),
        unit.clone().prop_map(Expression::Pressure),
        unit.prop_map(Expression::Brightness),
        turn.prop_map(|semitones| Expression::Tuning(3.0 * semitones)),
    ]
}

/// Any event: many controllers, and among notes many that are held over one another.
fn any_event() -> impl Strategy<Value = PlayerEvent> {
    let channel = 0..4_u8;
    // Now and then as a host with a fault would have it: far out, endless, or no number.
    let unit = prop_oneof![12 => 0.0_f32..=1.0, 1 => prop::num::f32::ANY];
    let turn = prop_oneof![12 => -1.0_f32..=1.0, 1 => prop::num::f32::ANY];
    prop_oneof![
        8 => (channel.clone(), 24..90_u8, unit.clone())
            .prop_map(|(channel, key, velocity)| PlayerEvent::NoteOn { channel, key, velocity }),
        6 => (channel.clone(), 24..90_u8).prop_map(|(channel, key)| PlayerEvent::NoteOff { channel, key }),
        // The low numbers of 22 and 23 are the ones that mean something.
        8 => (channel.clone(), prop::sample::select(CONTROLLERS.to_vec()), prop_oneof![0..9_u8, 0..128_u8])
            .prop_map(|(channel, number, value)| {
                PlayerEvent::Controller { channel, number, value: f32::from(value) / 127.0 }
            }),
        2 => (channel.clone(), turn.clone())
            .prop_map(|(channel, value)| PlayerEvent::PitchBend { channel, value }),
        1 => (channel.clone(), 24..90_u8, any_expression(unit.clone(), turn))
            .prop_map(|(channel, key, expression)| PlayerEvent::Note { channel, key, expression }),
        1 => (prop::option::of(channel.clone()), prop::option::of(24..90_u8), any_expression(unit.clone(), -1e10..1e10_f32))
            .prop_map(|(channel, key, expression)| PlayerEvent::Notes { channel, key, expression }),
        2 => (channel.clone(), 24..90_u8).prop_map(|(channel, key)| PlayerEvent::NoteEnd { channel, key }),
        1 => (channel, unit).prop_map(|(channel, pressure)| PlayerEvent::ChannelPressure { channel, pressure }),
        // There are four to six strings; others are ignored.
        3 => (0..7_u8, any_deed()).prop_map(|(string, deed)| PlayerEvent::Touched { string, deed }),
        1 => Just(PlayerEvent::AllNotesOff),
    ]
}

fn any_input() -> impl Strategy<Value = InputMode> {
    prop_oneof![
        Just(InputMode::Keyboard),
        any::<bool>().prop_map(|from_last| InputMode::Strings { first: 0, from_last }),
        Just(InputMode::Mpe),
        Just(InputMode::Auto)
    ]
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn nothing_hangs_and_blocks_do_not_matter(
        neck in 0..3_usize,
        input in any_input(),
        legato: bool,
        keyswitches in prop::option::of(0..60_u8),
        steps in prop::collection::vec((prop_oneof![Just(0_u64), 0..9000_u64], any_event()), 1..100),
        block in 1..3000_u64,
    ) {
        let touching = Touching { legato, keyswitches, ..Touching::default() };
        let mut time = 0;
        let mut events: Vec<(u64, PlayerEvent)> = steps.into_iter().map(|(step, event)| {
            time += step;
            (time, event)
        }).collect();
        events.push((time, PlayerEvent::AllNotesOff));

        let mut performance = player(neck, input, &touching);
        let whole = play(&mut performance, &events);
        for channel in 0..4 {
            prop_assert!((0..128).all(|key| !performance.sounds(channel, key)));
        }

        let blocks = play_in_blocks(&mut player(neck, input, &touching), &events, block);

        let count = NECKS[neck].strings.len();
        let mut left = vec![[false; FINGERS_PER_STRING]; count];
        // A finger whose force has yet to turn is still there, and may be wanted back.
        let mut until = vec![[0; FINGERS_PER_STRING]; count];
        for string in 0..count {
            let done = of_string(&whole, string);
            prop_assert_eq!(&done, &of_string(&blocks, string));
            let length = NECKS[neck].strings[string].geometry.length;
            for TimedGesture { time, gesture, .. } in done {
                // How far forces, speeds and times may go, as far as documented: nobody plucks harder than who points, with
                // 50 N, throws a finger faster than a tap's 1.75 m/s (1.91 with a tenth more force, by half of the largest
                // variation), or takes longer for anything than for the slowest slide, 2 s.
                let (force, speed, duration) = match gesture {
                    Gesture::Pluck { force, duration, .. } => (force, 0.0, duration),
                    Gesture::Throw { speed, .. } => (0.0, speed, 0.0),
                    Gesture::Press { duration, .. }
                    | Gesture::Slide { duration, .. }
                    | Gesture::Lift { duration, .. }
                    | Gesture::Still { duration, .. }
                    | Gesture::Bend { duration, .. } => (0.0, 0.0, duration),
                    Gesture::Place { .. } => (0.0, 0.0, 0.0),
                };
                prop_assert!(force.abs() <= 50.0, "{gesture:?}");
                prop_assert!((0.0..=1.91 + 1e-9).contains(&speed), "{gesture:?}");
                prop_assert!((0.0..=2.0 + 1e-9).contains(&duration), "{gesture:?}");
                let place = match gesture {
                    Gesture::Place { finger, position, .. } | Gesture::Throw { finger, position, .. } => {
                        left[string][finger] = true;
                        position
                    }
                    Gesture::Lift { finger, force, .. } => {
                        prop_assert!(force > 0.0 && force < 200.0, "{gesture:?}");
                        left[string][finger] = false;
                        until[string][finger] = time + (duration * RATE).round() as u64;
                        0.5 * length
                    }
                    Gesture::Press { force, .. } => {
                        prop_assert!(force.abs() < 100.0, "{gesture:?}");
                        0.5 * length
                    }
                    Gesture::Slide { position, .. } | Gesture::Pluck { position, .. } => position,
                    Gesture::Still { loss, .. } => {
                        prop_assert!(loss > 0.0 && loss < 1e4, "{gesture:?}");
                        0.5 * length
                    }
                    Gesture::Bend { tension_ratio, .. } => {
                        prop_assert!(tension_ratio > 0.0, "{gesture:?}");
                        0.5 * length
                    }
                };
                // Who points may point at an end, and beyond it means it.
                prop_assert!((0.0..=length).contains(&place), "{gesture:?}");
                // A finger is moved only while it is there.
                if let Gesture::Slide { finger, .. } | Gesture::Press { finger, .. } = gesture {
                    prop_assert!(left[string][finger] || time < until[string][finger], "{gesture:?} of nobody");
                    left[string][finger] = true;
                }
            }
        }
        prop_assert_eq!(left, vec![[false; FINGERS_PER_STRING]; count]);
    }
}
