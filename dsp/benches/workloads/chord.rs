//! The chord that is timed wherever a whole instrument is: the strings of the default one, each stopped behind its third to
//! fifth fret and plucked.
//!
//! The benchmarks have this file as a module, and so has `cargo xtask measure`, so that `speed`, `trade` and `features` time the
//! same.

use low_action_dsp::{Gesture, Instrument, QueueFull, Setup, TimedGesture};

/// The default instrument with so many of its strings from the lowest on.
pub fn lowest_strings(count: usize) -> Setup {
    let mut setup = Setup::builtin("electric").expect("it is built in");
    setup.string.reverse();
    setup.string.truncate(count);
    setup
}

/// The fret behind which the chord stops a string.
pub fn fret(string: usize) -> usize {
    3 + string % 3
}

/// Puts a finger behind a fret of a string, 1 or above; for 0 the string stays open.
///
/// # Errors
/// When too many gestures wait.
pub fn stop(instrument: &mut Instrument, setup: &Setup, string: usize, fret: usize) -> Result<(), QueueFull> {
    if fret == 0 {
        return Ok(());
    }
    let fretting = &setup.player.fretting;
    let position = instrument.geometry(string).finger_position(fret);
    for gesture in [
        Gesture::Place { finger: 0, touch: fretting.touch, position, clearance: fretting.hover },
        Gesture::Press { finger: 0, force: fretting.force, duration: fretting.landing },
    ] {
        instrument.schedule(TimedGesture { time: 0, string, gesture })?;
    }
    Ok(())
}

/// Plucks a string where the set-up's player does, with six tenths of the loudest note's force.
///
/// # Errors
/// When too many gestures wait.
pub fn pluck(instrument: &mut Instrument, setup: &Setup, string: usize) -> Result<(), QueueFull> {
    let player = &setup.player;
    let gesture = Gesture::Pluck {
        position: instrument.geometry(string).length - player.pluck_position,
        force: 0.6 * player.pluck_force,
        duration: player.pluck_duration,
        release: 0.0,
    };
    instrument.schedule(TimedGesture { time: 0, string, gesture })
}
