//! The promise: whatever hands have done on a string, in whatever order, a plain note after it sounds at its own pitch. No
//! finger, capo or hand that was there stops it, dampens it or bends it.

use std::cell::RefCell;

use low_action::performance::PlayerEvent;
use low_action_tests::cases::cases;
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, cc, decibels, hertz, off, on, peak};
use proptest::prelude::*;

const RATE: f64 = 48_000.0;
/// Set-up, string, its open key.
const STRINGS: [(&str, usize, u8); 4] =
    [("electric", 2, 55), ("classical", 4, 45), ("bass", 2, 33), ("fretless-bass", 2, 33)];
/// Farthest a note may be from its key, cents: a string alone is within 2 of it over the frets, pulls of fingers included,
/// and the rest of a bend that is still being let go of within 3.
const IN_TUNE: f64 = 5.0;
/// Quietest peak of such a note, dB; alone they are at -26 to -9.
const HEARD: f64 = -40.0;

/// What a hand is told to do.
#[derive(Debug, Clone, Copy)]
enum Told {
    /// A key goes down: so many frets up, velocity.
    Down(u8, u8),
    /// The last one that went down goes up.
    Up,
    /// A controller, its value.
    Control(u8, u8),
    /// The wheel turns.
    Wheel(f32),
    /// The keys are pressed.
    Press(f32),
}

fn anything() -> impl Strategy<Value = (Told, f64)> {
    let told = prop_oneof![
        6 => (0..17_u8, 20..128_u8).prop_map(|(fret, velocity)| Told::Down(fret, velocity)),
        3 => Just(Told::Up),
        1 => (0..8_u8).prop_map(|stroke| Told::Control(22, stroke)),
        1 => (0..4_u8).prop_map(|left| Told::Control(23, left)),
        1 => (0..6_u8).prop_map(|fret| Told::Control(26, fret)),
        1 => any::<bool>().prop_map(|slides| Told::Control(65, 127 * u8::from(slides))),
        1 => any::<bool>().prop_map(|connects| Told::Control(68, 127 * u8::from(connects))),
        1 => (prop::sample::select(vec![1, 5, 20, 25, 64]), prop_oneof![Just(0), 0..128_u8])
            .prop_map(|(number, value)| Told::Control(number, value)),
        1 => (-1.0_f32..=1.0).prop_map(Told::Wheel),
        1 => (0.0_f32..=1.0).prop_map(Told::Press),
    ];
    // Hands need the time between two keys that a chord does not have: two keys at once are for two strings.
    (told, prop::sample::select(vec![0.001, 0.003, 0.01, 0.04, 0.12, 0.3]))
}

/// What a player hears of it, and when it is over, s: every key and controller as before.
fn events(told: &[(Told, f64)], open: u8) -> (Vec<(f64, PlayerEvent)>, f64) {
    let (mut events, mut down, mut time) = (Vec::new(), Vec::new(), 0.0);
    for &(told, wait) in told {
        let event = match told {
            Told::Down(fret, velocity) => {
                down.push(open + fret);
                Some(on(open + fret, velocity))
            }
            Told::Up => down.pop().map(off),
            Told::Control(number, value) => Some(cc(number, value)),
            Told::Wheel(value) => Some(PlayerEvent::PitchBend { channel: 0, value }),
            Told::Press(pressure) => Some(PlayerEvent::ChannelPressure { channel: 0, pressure }),
        };
        events.extend(event.map(|event| (time, event)));
        time += wait;
    }
    events.extend(down.into_iter().map(|key| (time, off(key))));
    // A capo belongs to no channel, and no reset of one takes it off.
    events.extend([
        (time, cc(121, 0)),
        (time, cc(26, 0)),
        (time, PlayerEvent::PitchBend { channel: 0, value: 0.0 }),
    ]);
    (events, time)
}

thread_local! {
    static STAGES: RefCell<Vec<Stage>> =
        RefCell::new(STRINGS.map(|(setup, string, _)| Stage::alone(setup, string)).into());
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn a_plain_note_sounds_at_its_pitch(
        string in 0..STRINGS.len(),
        told in prop::collection::vec(anything(), 1..16),
        rest in 0.002..1.5_f64,
        fret in 0..13_u8,
    ) {
        let (setup, _, open) = STRINGS[string];
        let (mut events, over) = events(&told, open);
        let start = over + rest;
        events.push((start, on(open + fret, 80)));
        let sound = STAGES.with_borrow_mut(|stages| stages[string].play(&events, start + 0.6).strings[0].clone());
        let heard = &sound[((start + 0.15) * RATE) as usize..];
        let pitch = hertz(f64::from(open + fret));
        let off = cents(frequency_near(heard, RATE, pitch), pitch);
        prop_assert!(off.abs() < IN_TUNE, "{setup}, fret {fret}: {off} cents");
        let loud = decibels(peak(heard));
        prop_assert!(loud > HEARD, "{setup}, fret {fret}: {loud} dB");
    }
}
