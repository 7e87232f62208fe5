//! The promise: whatever hands are told, in whatever order, no finger stays on a string after everything has
//! stopped, no force or place is absurd, and how time is cut into blocks changes nothing.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::params::LowActionParams;
use low_action::performance::{Expression, InputMode, Performance, PlayerEvent, StringDeed, Style};
use low_action_dsp::{FINGERS_PER_STRING, Gesture, TimedGesture, Touch};
use low_action_tests::cases::cases;
use low_action_tests::hands::{Neck, RATE, of_string, play, play_in_blocks, stopped_at_last};
use low_action_tests::numbers::largest;
use low_action_tests::user::isolate;
use nice_plug::prelude::Param;
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

/// Hands set in any way that parameters allow, now and then as far as those go.
fn any_touching() -> impl Strategy<Value = Touching> {
    fn ranged<P: Param>(param: &P) -> impl Strategy<Value = f64> + use<P>
    where
        P::Plain: Into<f64>,
    {
        let [low, high] = [0.0, 1.0].map(|end| param.preview_plain(end).into());
        prop_oneof![4 => low..=high, 1 => Just(low), 1 => Just(high)]
    }
    isolate();
    let params = LowActionParams::default();
    let (player, control) = (&params.player, &params.control);
    let plucks = (
        ranged(&player.pluck_position),
        ranged(&player.pluck_force),
        ranged(&player.pluck_softest),
        ranged(&player.pluck_duration),
        ranged(&player.pluck_release),
        ranged(&player.velocity_curve),
        ranged(&player.variation),
    );
    let fingers = (
        ranged(&player.finger_force),
        ranged(&player.finger_hardness),
        ranged(&player.finger_mass),
        ranged(&player.finger_hover),
        ranged(&player.hand_damping),
    );
    // (Steps of the range of the wheel are whole, and keys from −1 on.)
    let told = (ranged(&control.bend_range), any::<bool>(), ranged(&control.tremolo_arm), any::<bool>());
    let keyswitches = prop_oneof![Just(-1.0), 0.0..60.0, ranged(&control.keyswitches)];
    let places = (keyswitches, any::<Option<u8>>());
    (plucks, fingers, told, places).prop_map(|(plucks, fingers, told, (keyswitches, hand_position))| {
        let (position, pluck_force, pluck_softest, pluck_duration, release, velocity_curve, variation) =
            plucks;
        let (finger_force, finger_hardness, finger_mass, finger_hover, hand_damping) = fingers;
        let (bend_range, ignore_rpn, tremolo_arm, legato) = told;
        Touching {
            // The parameters are in mm and ms.
            pluck_position: 1e-3 * position,
            pluck_release: 1e-3 * release,
            pluck_force,
            pluck_softest,
            pluck_duration,
            velocity_curve,
            variation,
            take: 0,
            finger_force,
            finger_hardness,
            finger_mass,
            finger_hover,
            hand_damping,
            bend_range: bend_range.round(),
            ignore_rpn,
            tremolo_arm,
            legato,
            keyswitches: (keyswitches >= 0.0).then_some(keyswitches as u8),
            hand_position,
            capo: 0,
            hand_controllers: true,
        }
    })
}

/// Largest factor of a force that a note can have for itself.
const MOST: f32 = 100.0;
/// The most that a host can make a note's pluck harder by its volume.
const LOUDEST: f32 = 4.0;

/// What a note can have for itself.
fn any_expression(
    unit: impl Strategy<Value = f32> + Clone,
    turn: impl Strategy<Value = f32>,
) -> impl Strategy<Value = Expression> {
    let wild = prop_oneof![6 => 0.0..5.0_f32, 1 => Just(0.0), 1 => Just(MOST), 1 => prop::num::f32::ANY];
    prop_oneof![
        unit.clone().prop_map(Expression::Vibrato),
        unit.clone().prop_map(Expression::Pressure),
        unit.prop_map(Expression::Brightness),
        turn.prop_map(|semitones| Expression::Tuning(3.0 * semitones)),
        wild.clone().prop_map(Expression::PluckForce),
        wild.clone().prop_map(Expression::Swell),
        wild.clone().prop_map(Expression::Gain),
        wild.clone().prop_map(Expression::FingerForce),
        // m: beyond the ends of any string.
        wild.prop_map(|place| Expression::PluckPlace(place - 2.0)),
    ]
}

/// Any event: many controllers, and among notes many that are held over one another.
fn any_event() -> impl Strategy<Value = PlayerEvent> {
    // There are sixteen channels; others are ignored.
    let channel = prop_oneof![12 => 0..4_u8, 1 => prop::sample::select(vec![4, 15, 16, 255_u8])];
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

/// How far forces, speeds and times may go.
struct Limits {
    /// Of plucks, N.
    pluck: f64,
    /// Of throws, m/s.
    throw: f64,
    /// Of a finger on the string, N.
    press: f64,
    /// Of one that leaves it, N.
    lift: f64,
}

impl Limits {
    /// As far as hands that are set so can be asked to go.
    fn of(neck: &Neck, touching: &Touching, events: &[(u64, PlayerEvent)]) -> Self {
        let hands = touching.hands(&neck.setup.player, neck.strings[0].geometry.length);
        let fretting = &hands.fretting;
        let tightest = largest(neck.strings.iter().map(|string| string.geometry.highest_ratio));
        // Where a note is asked to be so many times as hard for itself: the most that any is.
        let asked = |of: fn(Expression) -> Option<f32>| {
            let expressions = events.iter().filter_map(|&(_, event)| match event {
                PlayerEvent::Note { expression, .. } | PlayerEvent::Notes { expression, .. } => {
                    of(expression)
                }
                _ => None,
            });
            largest(
                expressions.filter(|factor| factor.is_finite()).map(|factor| factor.min(MOST)).chain([1.0]),
            )
        };
        let moved = asked(|expression| match expression {
            Expression::PluckForce(factor) => Some(factor),
            _ => None,
        });
        let swollen = asked(|expression| match expression {
            Expression::Swell(factor) => Some(factor),
            _ => None,
        });
        let louder = asked(|expression| match expression {
            Expression::Gain(factor) => Some(factor.min(LOUDEST)),
            _ => None,
        });
        let pressed = asked(|expression| match expression {
            Expression::FingerForce(factor) => Some(factor),
            _ => None,
        });
        // Of the hardest pluck's force: variation makes a fifth of it more, and a strum 0.7 of that.
        let strength = moved * swollen * louder * (1.0 + 0.2 * touching.variation);
        let strummed = 1.7 * strength;
        Self {
            // Three times as hard in a pop; or 50 N by who points.
            pluck: largest([3.0 * hands.pluck_force * strummed, 50.0]),
            // The hardest tap, however hard a pluck would be: 2.7 m/s more than the softest.
            throw: 2.8,
            // At full pressure 2.5 times, and so many times that as a note has it for itself; on a string that is pulled so many
            // times more as that is tighter, if it would leave its fret otherwise. What rests, grazes or slaps presses with 2 N and
            // less on any string.
            press: largest([2.5 * pressed * fretting.force * tightest, 2.0]),
            // A finger, or the bar with its hand, is to move away with 0.5 m/s, or 0.3, in 1 ms, or 3, against the damping of a hand
            // that lets a string down (350 N s/m) or of one that is set to more.
            lift: largest([
                0.5 * largest([fretting.touch.hand_damping, 350.0]) + fretting.touch.mass * 0.5 / 0.001,
                0.3 * 45.0 + 0.75 * 0.3 / 0.003,
            ]),
        }
    }

    /// What of a gesture no hand would do. Written so that what is not a number is that, too.
    fn broken(&self, gesture: Gesture) -> Option<String> {
        let within = |value: f64, most: f64| (0.0..=most * (1.0 + 1e-9)).contains(&value);
        let possible = |touch: Touch| {
            touch.mass > 0.0
                && touch.stiffness > 0.0
                && within(touch.hand_damping, 1e5)
                && within(touch.damping, 1e5)
        };
        // Nothing takes longer than the slowest slide.
        let longest = 2.0;
        let kept = match gesture {
            Gesture::Pluck { force, duration, release, .. } => {
                within(force.abs(), self.pluck) && within(duration, longest) && within(release, longest)
            }
            Gesture::Place { touch, clearance, .. } => possible(touch) && within(clearance, 0.1),
            Gesture::Throw { touch, clearance, speed, .. } => {
                possible(touch) && within(clearance, 0.1) && within(speed, self.throw)
            }
            // One that eases off is pulled away as it will be lifted.
            Gesture::Press { force, duration, .. } => {
                let (pressed, pulled) = (within(force, self.press), within(-force, self.lift));
                (pressed || pulled) && within(duration, longest)
            }
            Gesture::Lift { force, duration, .. } => {
                force > 0.0 && within(force, self.lift) && within(duration, longest)
            }
            Gesture::Slide { duration, .. } => within(duration, longest),
            // A hand that is to be off the string takes nothing.
            Gesture::Still { loss, duration } => {
                (loss > 0.0 || duration == 0.0) && within(loss, 1e4) && within(duration, longest)
            }
            Gesture::Bend { tension_ratio, duration } => tension_ratio > 0.0 && within(duration, longest),
        };
        (!kept).then(|| format!("{gesture:?}"))
    }
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn nothing_hangs_and_blocks_do_not_matter(
        neck in 0..3_usize,
        input in any_input(),
        touching in any_touching(),
        steps in prop::collection::vec((prop_oneof![Just(0_u64), 0..9000_u64], any_event()), 1..100),
        block in 1..3000_u64,
    ) {
        let events = stopped_at_last(steps);

        let mut performance = player(neck, input, &touching);
        let whole = play(&mut performance, &events);
        for channel in 0..4 {
            prop_assert!((0..128).all(|key| !performance.sounds(channel, key)));
        }

        let blocks = play_in_blocks(&mut player(neck, input, &touching), &events, block);

        let count = NECKS[neck].strings.len();
        let limits = Limits::of(&NECKS[neck], &touching, &events);
        let mut left = vec![[false; FINGERS_PER_STRING]; count];
        // A finger whose force has yet to turn is still there, and may be wanted back.
        let mut until = vec![[0; FINGERS_PER_STRING]; count];
        for string in 0..count {
            let done = of_string(&whole, string);
            prop_assert_eq!(&done, &of_string(&blocks, string));
            let length = NECKS[neck].strings[string].geometry.length;
            for TimedGesture { time, gesture, .. } in done {
                prop_assert_eq!(limits.broken(gesture), None);
                let place = match gesture {
                    Gesture::Place { finger, position, .. } | Gesture::Throw { finger, position, .. } => {
                        left[string][finger] = true;
                        position
                    }
                    Gesture::Lift { finger, duration, .. } => {
                        left[string][finger] = false;
                        until[string][finger] = time + (duration * RATE).round() as u64;
                        0.5 * length
                    }
                    Gesture::Slide { position, .. } | Gesture::Pluck { position, .. } => position,
                    Gesture::Press { .. } | Gesture::Still { .. } | Gesture::Bend { .. } => 0.5 * length,
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
