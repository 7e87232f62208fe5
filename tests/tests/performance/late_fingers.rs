//! The promise: fingers that sound a note by themselves are late as hands are, never early, by no more than is said and each by
//! something else; and whatever comes meanwhile comes after them.

use std::sync::LazyLock;

use low_action::engine::EngineOptions;
use low_action::performance::{PlayerEvent, Style};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE, any_left, control, play, wheel};
use low_action_tests::stage::{off, on};

static NECKS: LazyLock<[Neck; 2]> = LazyLock::new(|| ["electric", "bass"].map(Neck::of));

/// Samples in so many ms.
fn ms(time: f64) -> u64 {
    (0.001 * time * RATE).round() as u64
}

/// A key held, and another struck over it for half of so many samples each time.
fn trill(held: u8, other: u8, apart: u64, turns: u64) -> Vec<(u64, PlayerEvent)> {
    let mut events = vec![(0, control(0, 68, 127)), (0, on(held, 80))];
    for turn in 1..=turns {
        events.extend([(turn * apart, on(other, 80)), (turn * apart + apart / 2, off(other))]);
    }
    events
}

/// When fingers strike the string, and when they pull it.
fn struck_and_pulled(gestures: &[TimedGesture]) -> [Vec<u64>; 2] {
    let times =
        |is: fn(&Gesture) -> bool| gestures.iter().filter(|g| is(&g.gesture)).map(|g| g.time).collect();
    let mut pulled: Vec<u64> = times(|gesture| matches!(gesture, Gesture::Pluck { .. }));
    // The first is the stroke that all begins with.
    pulled.remove(0);
    [times(|gesture| matches!(gesture, Gesture::Throw { .. })), pulled]
}

#[test]
fn a_finger_is_late_by_up_to_12_ms_at_full_variation_and_3_at_the_usual_one() {
    const TURNS: u64 = 40;
    for (neck, held) in NECKS.iter().zip([57, 33]) {
        let apart = ms(200.0);
        for (variation, most) in [(0.0, 0.0), (EngineOptions::VARIATION, 3.0), (1.0, 12.0)] {
            let mut player = neck.player(Style { variation, ..EXACT });
            let [struck, pulled] =
                struck_and_pulled(&play(&mut player, &trill(held, held + 2, apart, TURNS)));
            for (times, begin) in [(struck, apart), (pulled, apart + apart / 2)] {
                assert_eq!(times.len(), TURNS as usize);
                let asked = (0..).map(|turn| begin + turn * apart);
                let late: Vec<u64> = times.iter().zip(asked).map(|(time, asked)| time - asked).collect();
                assert!(late.iter().all(|&late| late <= ms(most)), "variation {variation}: {late:?}");
                // Of 40 by chance, some fall into the first and the last tenth, but for one time in 30.
                let [first, last] = [late.iter().min(), late.iter().max()].map(|late| late.copied());
                assert!(
                    first <= Some(ms(0.1 * most)) && last >= Some(ms(0.9 * most)),
                    "variation {variation}: {late:?}"
                );
            }
        }
    }
}

#[test]
fn what_comes_before_a_late_finger_has_come_waits_for_it() {
    for neck in NECKS.iter() {
        for apart in [0.5, 1.0, 2.0, 5.0, 9.0] {
            for seed in 0..20 {
                let at = |step: u64| ms(200.0) + ms(apart * step as f64);
                let held = if neck.setup.string.len() > 4 { 57 } else { 38 };
                let events = [
                    (0, control(0, 68, 127)),
                    (0, on(held, 80)),
                    (at(0), on(held + 2, 80)),
                    (at(1), wheel(0, 0.5)),
                    (at(2), off(held + 2)),
                    (at(3), control(0, 20, 60)),
                    (at(4), on(held + 3, 80)),
                    (at(5), control(0, 68, 0)),
                    (at(6), on(held + 1, 90)),
                    (at(7), off(held)),
                    (at(8), off(held + 3)),
                    (at(9), off(held + 1)),
                ];
                let mut player = neck.player(Style { variation: 1.0, seed, ..EXACT });
                let gestures = play(&mut player, &events);
                for string in 0..neck.strings.len() {
                    // (A stroke may be handed over a millisecond ahead.)
                    let of_fingers = gestures
                        .iter()
                        .filter(|g| g.string == string && !matches!(g.gesture, Gesture::Pluck { .. }));
                    let times: Vec<u64> = of_fingers.map(|g| g.time).collect();
                    assert!(times.is_sorted(), "{apart} ms apart, seed {seed}, string {string}: {times:?}");
                }
                assert!(!any_left(&gestures), "{apart} ms apart, seed {seed}");
            }
        }
    }
}
