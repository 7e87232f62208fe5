use std::slice::from_mut;

use super::{RUN, Voice};
use crate::gesture::Gesture;
use crate::quality::Quality;
use crate::setup::{Pickup, Setup};
use crate::together;

/// Samples of 20 s.
const LENGTH: usize = 20 * 48_000;

/// What stays on a string that has been plucked.
#[derive(Debug, Clone, Copy)]
enum Hold {
    /// Two soft parts of a hand, at these parts of the length from the saddle, with so many times the damper's force.
    Pads([f64; 2], f64),
    /// A hand along the whole string: nothing presses, and it comes to rest to the last bit.
    Hand,
}

/// As a palm lies, and the fingers of a muted note.
const HOLDS: [Hold; 3] = [Hold::Pads([0.09, 0.054], 0.735), Hold::Pads([0.6, 0.48], 1.0), Hold::Hand];

/// A string of a set-up that is plucked and held.
fn held(setup: &Setup, hold: Hold) -> Voice {
    let mut voice = Voice::new(setup, 2, &Quality::Live.settings(48e3)).expect("it comes with the program");
    voice.wake(true);
    let (damper, length) = (&setup.player.damper, voice.geometry.length);
    match hold {
        Hold::Pads(places, times) => {
            for (finger, place) in places.into_iter().enumerate() {
                let position = length * (1.0 - place);
                voice.begin(Gesture::Place { finger, touch: damper.touch, position, clearance: 0.0 });
                voice.begin(Gesture::Press { finger, force: times * damper.force, duration: 0.001 });
            }
        }
        Hold::Hand => voice.begin(Gesture::Still { loss: 200.0, duration: 60.0 }),
    }
    let position = length - setup.player.pluck_position;
    voice.begin(Gesture::Pluck { position, force: 1.0, duration: 0.002, release: 0.0 });
    voice
}

/// A string that is held is awake for as long, and what pickups remember of it fades: to zeros, whatever the pieces in which it is
/// computed.
#[test]
fn filters_of_a_string_that_is_held_never_hold_subnormal_numbers() {
    // With a coil beside each other pickup: the force on the bridge, a microphone, and the force on one that gives way.
    for (name, piezo, hold) in [("electric", false), ("classical", false), ("classical", true)]
        .into_iter()
        .flat_map(|(name, piezo)| HOLDS.map(|hold| (name, piezo, hold)))
    {
        let mut setup = Setup { blend: 0.3, ..Setup::shipped(name).expect("it comes with the program") };
        if piezo {
            setup.pickup = Pickup::Bridge {};
        }
        let [mut whole, mut single] = [0, 1].map(|_| held(&setup, hold));
        for block in 0..LENGTH / RUN {
            together::run(from_mut(&mut whole), RUN);
            for sample in 0..RUN {
                together::run(from_mut(&mut single), 1);
                let seconds = (block * RUN + sample) as f64 / 48e3;
                let found = single.listener.filters().find(|filter| filter.holds_subnormal());
                assert!(found.is_none(), "{name}, {hold:?}, after {seconds} s: {found:?}");
                let same = whole.run[sample].to_bits() == single.run[0].to_bits();
                assert!(same, "{name}, {hold:?}: other bits in pieces of one sample after {seconds} s");
            }
        }
        assert!(!whole.asleep && !single.asleep, "{name}, {hold:?}: it was to be held");
    }
}
