//! The promise: notes of one channel that begin at one sample are one chord, whatever else is said or let go of at that sample,
//! and in whatever order: none is connected with another of them, a strum goes over all of them, and what changes notes that
//! sound changes those that have begun then.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::TimedGesture;
use low_action_tests::hands::{EXACT, Neck, control, play, plucks, wheel};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
const LEGATO: (u64, PlayerEvent) = (0, told(68));
const SLOWEST_STRUM: (u64, PlayerEvent) = (0, told(21));

const fn told(number: u8) -> PlayerEvent {
    PlayerEvent::Controller { channel: 0, number, value: 1.0 }
}

fn played(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    GUITAR.told(InputMode::Keyboard, &Touching::new(0.0, 2.0), events)
}

/// Events of one sample, some time after what else is told.
fn at_once(told: &[(u64, PlayerEvent)], events: &[PlayerEvent]) -> Vec<TimedGesture> {
    let events = events.iter().map(|&event| (24_000, event));
    played(&told.iter().copied().chain(events).collect::<Vec<_>>())
}

/// What says what is so already.
fn idle() -> [PlayerEvent; 12] {
    let pressure = PlayerEvent::ChannelPressure { channel: 0, pressure: 0.0 };
    let controllers = [(1, 0), (7, 100), (11, 127), (20, 0), (22, 0), (64, 0), (66, 0), (74, 64), (100, 127)];
    let [a, b, c, d, e, f, g, h, i] = controllers.map(|(number, value)| cc(number, value));
    [a, b, c, d, e, f, g, h, i, pressure, wheel(0, 0.0), off(99)]
}

#[test]
fn no_note_of_a_chord_takes_over_from_another() {
    for told in [&[LEGATO][..], &[LEGATO, (0, cc(65, 127))]] {
        let chord = at_once(told, &[on(48, 90), on(52, 90)]);
        assert_eq!(plucks(&chord).len(), 2);
        for between in idle() {
            let found = at_once(told, &[on(48, 90), between, on(52, 90)]);
            assert_eq!(plucks(&found), plucks(&chord), "{between:?}");
        }
        // Nor where the chord has to be placed before: this pedal keeps what has begun.
        let kept = plucks(&at_once(told, &[on(48, 90), cc(66, 127), on(52, 90)]));
        assert!(kept.len() == 2 && kept[0].1 != kept[1].1, "{kept:?}");
    }
}

/// As most files have it: each key goes up where the next one goes down.
#[test]
fn a_chord_after_another_is_the_same_in_any_order() {
    let held = [40, 47, 52].map(|key| (0, on(key, 90)));
    let told: Vec<_> = [LEGATO, SLOWEST_STRUM].into_iter().chain(held).collect();
    for next in [[42, 49, 54], [40, 47, 52]] {
        let [first, second, third] = next.map(|key| on(key, 90));
        let [one, two, three] = [40, 47, 52].map(off);
        let sorted = at_once(&told, &[first, second, third, one, two, three]);
        let struck: Vec<_> = plucks(&sorted).into_iter().filter(|pluck| pluck.0 >= 24_000).collect();
        assert_eq!(struck.len(), 3, "{next:?}");
        for mixed in [
            [first, one, second, two, third, three],
            [first, second, one, two, third, three],
            [first, three, second, two, third, one],
            [one, two, three, first, second, third],
            [three, first, one, second, two, third],
        ] {
            assert_eq!(plucks(&at_once(&told, &mixed)), plucks(&sorted), "{next:?}");
        }
        let mut player = GUITAR.player(EXACT);
        let mixed = [first, one, second, two, third, three].map(|event| (24_000, event));
        let end = next.map(|key| (48_000, off(key)));
        play(&mut player, &[&told[..], &mixed, &end].concat());
        assert!((0..128).all(|key| !player.sounds(0, key)), "{next:?}: each ends with its key");
    }
}

/// What ends where the next note begins goes over to it by a hammer or a pull, in either order: on one channel, on the channels of
/// strings, and in MPE.
#[test]
fn notes_that_abut_are_connected_in_any_order() {
    let channels: [(InputMode, [u8; 2]); 3] = [
        (InputMode::Keyboard, [0, 0]),
        (InputMode::Strings { first: 0, from_last: false }, [2, 2]),
        (InputMode::Mpe, [1, 2]),
    ];
    for (input, [one, other]) in channels {
        for (from, to) in [(57, 59), (61, 60), (57, 55)] {
            let [begins, next] = [(one, from), (other, to)].map(|(channel, key)| PlayerEvent::NoteOn {
                channel,
                key,
                velocity: 0.7,
            });
            let [over, last] =
                [(one, from), (other, to)].map(|(channel, key)| PlayerEvent::NoteOff { channel, key });
            let play = |told: &[u8], middle: &[PlayerEvent]| {
                let told = told
                    .iter()
                    .flat_map(|&number| [one, other].map(|channel| (0, control(channel, number, 127))));
                let middle = middle.iter().map(|&event| (24_000, event));
                let events = [(0, begins)].into_iter().chain(middle).chain([(48_000, last)]);
                GUITAR.told(input, &Touching::new(0.0, 2.0), &told.chain(events).collect::<Vec<_>>())
            };
            let anew = plucks(&play(&[], &[over, next]));
            for legato in [&[68][..], &[65]] {
                let found = play(legato, &[over, next]);
                assert_eq!(found, play(legato, &[next, over]), "{input:?}, {from} to {to}");
                assert_ne!(plucks(&found), anew, "{input:?}, {from} to {to}");
                // As where the first key stays down, until the hand goes back to it.
                let mut held = plucks(&play(legato, &[next]));
                held.retain(|pluck| pluck.0 < 48_000);
                assert_eq!(plucks(&found), held, "{input:?}, {from} to {to}");
                // Between them the wheel goes back, or the next note is pressed.
                let pressed = PlayerEvent::ChannelPressure { channel: other, pressure: 0.0 };
                for between in [wheel(other, 0.0), pressed, control(other, 11, 127)] {
                    assert_eq!(play(legato, &[over, between, next]), found, "{between:?}");
                }
            }
            // A key that has gone up where no pedal connects has.
            let off = [one, other].map(|channel| control(channel, 68, 0));
            assert_eq!(plucks(&play(&[68], &[over, off[0], off[1], next])), anew);
        }
    }
}

#[test]
fn what_its_channel_says_meanwhile_does_not_tear_a_strum_apart() {
    let [a, b, c, d] = [40, 47, 52, 56].map(|key| on(key, 90));
    let then = [57, 60].map(|key| (48_000, on(key, 90)));
    // The stroke turns once for each chord.
    let told: Vec<_> = [SLOWEST_STRUM, (0, cc(22, 2))].to_vec();
    let chord = |between: &[PlayerEvent]| {
        let events = [&[a, b][..], between, &[c, d]].concat();
        let events = events.into_iter().filter(|&event| event != cc(22, 0)).map(|event| (24_000, event));
        plucks(&played(&told.iter().copied().chain(events).chain(then).collect::<Vec<_>>()))
    };
    let whole = chord(&[]);
    assert_eq!(whole.len(), 6);
    for between in idle().into_iter().filter(|&event| event != cc(66, 0)) {
        assert_eq!(chord(&[between]), whole, "{between:?}");
    }
}

#[test]
fn what_changes_notes_that_sound_changes_those_that_have_begun_at_its_sample() {
    let pressed = PlayerEvent::ChannelPressure { channel: 0, pressure: 1.0 };
    let [low, high] = [on(41, 90), on(65, 90)];
    let plain = at_once(&[], &[low, high]);
    for said in [cc(1, 127), cc(20, 100), cc(25, 64), pressed, wheel(0, 1.0)] {
        let before = at_once(&[], &[said, low, high]);
        assert_ne!(before, plain, "{said:?}");
        assert_eq!(at_once(&[], &[low, said, high]), before, "{said:?}");
        assert_eq!(at_once(&[], &[low, high, said]), before, "{said:?}");
    }
}

#[test]
fn what_says_how_notes_are_plucked_counts_for_those_after_it() {
    let force = |events: &[PlayerEvent]| {
        let [low, high] = plucks(&at_once(&[], events))[..] else { panic!("two notes") };
        [low.2, high.2]
    };
    let [low, high] = [on(41, 90), on(65, 90)];
    let plain = force(&[low, high]);
    for (said, part) in [(cc(22, 5), 3.0), (cc(11, 64), 64.0 / 127.0)] {
        let found = force(&[low, said, high]);
        assert_eq!(found[0], plain[0], "{said:?}");
        assert!((found[1] / plain[1] / part - 1.0).abs() < 1e-6, "{said:?}: {found:?}, {plain:?}");
    }
}

/// A pedal that goes down after a key is up keeps nothing of it.
#[test]
fn a_pedal_comes_before_or_after_the_keys_of_its_sample() {
    let ends = |events: &[PlayerEvent]| {
        let mut player = GUITAR.player(EXACT);
        let events = events.iter().map(|&event| (24_000, event));
        let held = [LEGATO, (0, on(52, 90))];
        let next = [(48_000, off(54))];
        play(&mut player, &held.into_iter().chain(events).chain(next).collect::<Vec<_>>());
        !player.sounds(0, 52)
    };
    let [pedal, key, up] = [cc(64, 127), on(54, 90), off(52)];
    assert!(ends(&[key, up]));
    let order: [&[PlayerEvent]; 2] = [&[key, up, pedal, cc(64, 0)], &[pedal, key, up, cc(64, 0)]];
    assert!(order.into_iter().all(ends));
}
