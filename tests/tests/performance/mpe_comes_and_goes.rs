//! The promise: channels may become notes of MPE and cease to be while notes sound. Pedals, wheels, pressure and vibrato of the
//! first channel act on the notes of others from then on, or no longer, and wheels reach as far as the specification has it until
//! they are told otherwise: all members equally far.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{InputMode, Performance, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, control, note, play, wheel};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// A registered parameter of a channel is set at a sample.
fn registered(at: u64, channel: u8, parameter: u8, value: u8) -> Vec<(u64, PlayerEvent)> {
    [(101, 0), (100, parameter), (6, value)]
        .map(|(number, value)| (at, control(channel, number, value)))
        .to_vec()
}

/// So many members are announced at a sample.
fn members(at: u64, count: u8) -> Vec<(u64, PlayerEvent)> {
    registered(at, 0, 6, count)
}

/// A member's wheel is said to reach so many semitones.
fn reach(at: u64, channel: u8, semitones: u8) -> Vec<(u64, PlayerEvent)> {
    registered(at, channel, 0, semitones)
}

fn up(channel: u8, key: u8) -> PlayerEvent {
    PlayerEvent::NoteOff { channel, key }
}

/// Takes events without waiting for what comes of them.
fn tell(player: &mut Performance, events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    let mut gestures = Vec::new();
    events.iter().for_each(|&(time, event)| player.event(time, event, &mut gestures));
    gestures
}

/// One way out of MPE, at a sample.
type Leaving = fn(&mut Performance, u64);

/// By the keyboard and by the player's choice.
const LEAVINGS: [Leaving; 2] = [
    |player, at| {
        tell(player, &members(at, 0));
    },
    |player, _| player.set_input(InputMode::Keyboard),
];

/// A player in MPE as it was announced.
fn announced() -> Performance {
    let mut player = GUITAR.player(EXACT);
    tell(&mut player, &members(0, 15));
    player
}

#[test]
fn notes_that_only_the_first_channel_keeps_end_when_it_speaks_for_itself_alone() {
    for (way, leave) in LEAVINGS.iter().enumerate() {
        for pedal in [64, 66] {
            let sounds = |own_pedal: bool, key_up: bool| {
                let mut player = announced();
                tell(&mut player, &[(0, note(1, 52)), (2400, control(0, pedal, 127))]);
                if own_pedal {
                    tell(&mut player, &[(2400, control(1, pedal, 127))]);
                }
                if key_up {
                    tell(&mut player, &[(4800, up(1, 52))]);
                }
                player.advance(9600, &mut Vec::new());
                assert!(player.sounds(1, 52), "a pedal is down: way {way}, CC {pedal}");
                leave(&mut player, 9600);
                player.advance(19_200, &mut Vec::new());
                player.sounds(1, 52)
            };
            assert!(!sounds(false, true), "way {way}, CC {pedal}");
            assert!(sounds(true, true), "its own pedal is down: way {way}, CC {pedal}");
            assert!(sounds(false, false), "its key is down: way {way}, CC {pedal}");
        }
    }
}

#[test]
fn a_key_that_is_down_comes_back_from_under_a_note_that_nothing_keeps_any_more() {
    for leave in LEAVINGS {
        let mut player = announced();
        player.touch(0, &Touching { legato: true, ..Touching::new(0.0, 2.0) }, &mut Vec::new());
        let pedal = [(0, control(0, 64, 127)), (0, note(1, 57)), (24_000, note(2, 59))];
        tell(&mut player, &pedal);
        tell(&mut player, &[(36_000, up(2, 59))]);
        player.advance(48_000, &mut Vec::new());
        assert!(player.sounds(2, 59));
        leave(&mut player, 48_000);
        player.advance(60_000, &mut Vec::new());
        assert!(!player.sounds(2, 59) && player.sounds(1, 57));
    }
}

/// What the tension was last bent by, semitones.
fn bent(gestures: &[TimedGesture]) -> f64 {
    let mut ratios = gestures.iter().rev().filter_map(|g| match g.gesture {
        Gesture::Bend { tension_ratio, .. } => Some(tension_ratio),
        _ => None,
    });
    6.0 * ratios.next().unwrap_or(1.0).log2()
}

/// What is left after events of a note of channel 3 on an open string, bent by a part of a whole turn.
fn bent_after(told: &[&[(u64, PlayerEvent)]], turn: f32) -> f64 {
    let notes = [(4800, note(2, 40)), (9600, wheel(2, turn))];
    bent(&play(&mut GUITAR.player(EXACT), &[&told.concat()[..], &notes].concat()))
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-6, "{found} instead of {expected}");
}

#[test]
fn a_wheel_that_is_held_stands_for_what_it_does_in_mpe_from_the_announcement_on() {
    let held = [(0, note(2, 40)), (2400, wheel(2, 1.0 / 48.0))];
    let after = |told: &[(u64, PlayerEvent)]| {
        bent(&play(&mut GUITAR.player(EXACT), &[&held[..], told, &[(24_000, control(2, 7, 1))]].concat()))
    };
    assert_near(after(&[]), 2.0 / 48.0);
    assert_near(after(&members(9600, 15)), 1.0);
    assert_near(after(&[members(9600, 15), members(14_400, 0)].concat()), 2.0 / 48.0);
    // A reach that was announced for MPE goes when MPE is announced again.
    let narrow = [members(4800, 15), reach(4800, 5, 24)].concat();
    assert_near(after(&narrow), 0.5);
    assert_near(after(&[narrow, members(9600, 15)].concat()), 1.0);
}

#[test]
fn all_members_reach_equally_far_whatever_was_announced_first() {
    let part = 1.0 / 48.0;
    // What comes before the announcement of MPE is past, on whichever channel.
    for own in [1, 2] {
        assert_near(bent_after(&[&reach(0, own, 12), &members(0, 15)], part), 1.0);
        assert_near(bent_after(&[&members(0, 15), &reach(0, own, 12)], part), 0.25);
    }
    // That of the first channel, too.
    let by_first = |told: &[&[(u64, PlayerEvent)]]| bent_after(&[&told.concat(), &[(0, wheel(0, 0.5))]], 0.0);
    assert_near(by_first(&[&reach(0, 0, 1), &members(0, 15)]), 1.0);
    assert_near(by_first(&[&members(0, 15), &reach(0, 0, 1)]), 0.5);
    // Where the player has chosen MPE nobody may announce it, and what has been announced of one counts for all.
    let chosen = |told: &[(u64, PlayerEvent)], turned: u8| {
        let mut player = GUITAR.player(EXACT);
        player.set_input(InputMode::Keyboard);
        tell(&mut player, told);
        player.set_input(InputMode::Mpe);
        bent(&play(&mut player, &[(4800, note(turned, 40)), (9600, wheel(turned, part))]))
    };
    for turned in [1, 2] {
        assert_near(chosen(&[], turned), 1.0);
        assert_near(chosen(&reach(0, 1, 12), turned), 0.25);
    }
}

#[test]
fn the_first_channels_hand_swings_for_others_only_while_it_speaks_for_them() {
    for leave in LEAVINGS {
        let mut player = announced();
        tell(&mut player, &[(0, control(0, 1, 127)), (0, note(1, 52))]);
        let mut gestures = Vec::new();
        player.advance(24_000, &mut gestures);
        let swings = |gestures: &[TimedGesture]| {
            gestures
                .iter()
                .filter(|g| matches!(g.gesture, Gesture::Bend { .. } | Gesture::Slide { .. }))
                .count()
        };
        assert!(swings(&gestures) > 20);
        leave(&mut player, 24_000);
        // It comes to rest within half a swing.
        player.advance(48_000, &mut Vec::new());
        gestures.clear();
        player.advance(96_000, &mut gestures);
        assert_eq!(swings(&gestures), 0);
    }
}

#[test]
fn only_as_many_are_members_as_were_announced() {
    // Channels 2 to 6 are; the seventh has its own wheel, and no other channel's pedal, wheel or hands.
    let told =
        [members(0, 5), vec![(0, control(0, 64, 127)), (0, wheel(0, 0.5)), (0, control(0, 22, 3))]].concat();
    for (channel, is_member) in [(1, true), (5, true), (6, false), (15, false)] {
        let mut player = GUITAR.player(EXACT);
        let played =
            [(4800, note(channel, 40)), (9600, wheel(channel, 1.0 / 48.0)), (14_400, up(channel, 40))];
        let gestures = play(&mut player, &[&told[..], &played].concat());
        assert_near(bent(&gestures), if is_member { 2.0 } else { 2.0 / 48.0 });
        assert_eq!(player.sounds(channel, 40), is_member, "channel {channel}");
        let rests = |g: &&TimedGesture| matches!(g.gesture, Gesture::Pluck { force, .. } if force < 0.0);
        assert_eq!(gestures.iter().any(|g| rests(&g)), is_member, "channel {channel}: a rest stroke");
    }
    // Where the player has chosen MPE, and where another number is announced.
    let mut player = GUITAR.player(EXACT);
    player.set_input(InputMode::Mpe);
    let bent_so = |player: &mut Performance, at: u64| {
        bent(&play(player, &[(at, note(9, 40)), (at + 10, wheel(9, 0.0)), (at + 4800, wheel(9, 1.0 / 48.0))]))
    };
    assert_near(bent_so(&mut player, 0), 1.0);
    tell(&mut player, &members(400_000, 5));
    assert_near(bent_so(&mut player, 400_000), 2.0 / 48.0);
    tell(&mut player, &members(800_000, 9));
    assert_near(bent_so(&mut player, 800_000), 1.0);
    // Those of an upper zone belong to the first channel, too, and take nothing away from what it has announced.
    let upper = registered(0, 15, 6, 7);
    for told in [[members(0, 5), upper.clone()].concat(), [upper.clone(), members(0, 5)].concat()] {
        for (channel, semitones) in [(5, 1.0), (6, 2.0 / 48.0), (8, 1.0), (14, 1.0), (15, 2.0 / 48.0)] {
            let mut player = GUITAR.player(EXACT);
            let played = [(4800, note(channel, 40)), (9600, wheel(channel, 1.0 / 48.0))];
            assert_near(bent(&play(&mut player, &[&told[..], &played].concat())), semitones);
        }
    }
    assert_near(bent_after(&[&members(0, 5), &reach(0, 3, 24), &upper], 1.0 / 48.0), 0.5);
}

#[test]
fn notes_of_channels_that_are_members_no_more_are_their_own_while_others_stay() {
    let mut player = announced();
    tell(&mut player, &[(0, note(1, 52)), (0, note(9, 64)), (2400, control(0, 64, 127))]);
    tell(&mut player, &[(4800, up(1, 52)), (4800, up(9, 64))]);
    player.advance(9600, &mut Vec::new());
    assert!(player.sounds(1, 52) && player.sounds(9, 64));
    tell(&mut player, &members(9600, 5));
    player.advance(19_200, &mut Vec::new());
    assert!(player.sounds(1, 52) && !player.sounds(9, 64));
}

/// A melody goes on over channels of MPE, and not to one that is none.
#[test]
fn an_ordinary_channel_takes_over_from_no_member() {
    let plucks = |channel: u8| {
        let told = [members(0, 5), vec![(0, control(0, 68, 127)), (0, control(channel, 68, 127))]].concat();
        let melody = [(0, note(1, 57)), (24_000, note(channel, 59))];
        let gestures = play(&mut GUITAR.player(EXACT), &[&told[..], &melody].concat());
        gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. })).count()
    };
    assert_eq!([2, 5, 6].map(plucks), [1, 1, 2]);
}
