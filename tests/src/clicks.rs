//! Clicks: corners in a sound that stand alone. All lengths are samples at 48 kHz.

use crate::numbers::largest;

/// Samples in which corners are compared with those around: 5 ms.
const WINDOW: usize = 240;
/// How long clicks are looked for after a change: 100 ms.
const AFTER: usize = 20 * WINDOW;
/// How long a sound before the change shows what is usual: 50 ms.
const BEFORE: usize = 10 * WINDOW;

/// The sharpest corner: the largest second difference.
pub fn corner(sound: &[f32]) -> f64 {
    largest(sound.windows(3).map(|w| (w[2] - 2.0 * w[1] + w[0]).abs()))
}

/// What clicks within 100 ms of a change at a sample, if anything does: a corner more than twice as sharp as what is
/// usual. The sound must begin 50 ms before the change or earlier and go on for more than 100 ms after it.
pub fn click(sound: &[f32], change: usize) -> Option<String> {
    // What either sound does by itself in the 50 ms before, and from 100 ms after on.
    let usual = largest([corner(&sound[change - BEFORE..change]), corner(&sound[change + AFTER..])]);
    // A click stands alone. Frets that rise under a wide swing make it buzz, sharper than anything before, but
    // again and again: within 20 ms, beside the neighbours, which a click between two windows would share.
    let windows = (change - 10..).step_by(WINDOW).take(AFTER / WINDOW);
    // Two samples longer: a corner is made of three, and none is to fall between two windows.
    let corners: Vec<f64> = windows.map(|start| corner(&sound[start..start + WINDOW + 2])).collect();
    corners.iter().enumerate().find_map(|(at, &here)| {
        let near = corners.iter().enumerate().filter(|(other, _)| (2..=4).contains(&other.abs_diff(at)));
        let around = largest(near.map(|(_, &other)| other).chain([usual]));
        let time = at * WINDOW * 1000 / 48_000;
        // Written so that what is not a number is a click.
        let quiet = here <= 2.0 * around;
        (!quiet)
            .then(|| format!("a corner of {here:e} where {around:e} is usual, {time} ms after the change"))
    })
}

/// The smallest jump that is sure to be found at a change, wherever it falls: a corner of more than twice what is usual even
/// if what the sound does by itself there is taken off it.
pub fn smallest_jump(sound: &[f32], change: usize) -> f64 {
    let most = corner(&sound[change - BEFORE..]);
    3.0 * most * (1.0 + 1e-3)
}

/// A sound that jumps by so much at a sample and stays there.
pub fn with_jump(sound: &[f32], at: usize, jump: f64) -> Vec<f32> {
    let lift = |(n, sample): (usize, &f32)| if n < at { *sample } else { sample + jump as f32 };
    sound.iter().enumerate().map(lift).collect()
}
