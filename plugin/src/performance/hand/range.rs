//! What a string can give.

use std::f64::consts::TAU;

use crate::performance::technique::{DEAF, HIGHEST_HARMONIC, NEAR_ENOUGH};

/// The notes a string can give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    /// Pitch of the open string, MIDI note number.
    pub open_pitch: f64,
    /// Number of frets.
    pub frets: usize,
    /// Where a coil hears the string, as a part of its length from the saddle.
    pub coil: Option<f64>,
}

impl Range {
    /// The fret (0: open) that sounds a key, if there is one.
    pub(crate) fn fret(&self, key: f64) -> Option<usize> {
        let fret = (key - self.open_pitch).round();
        (0.0..=self.frets as f64).contains(&fret).then_some(fret as usize)
    }

    /// The fret to stop, and the partial of what sounds then, that give a harmonic of a pitch: a natural one
    /// of the open string (or over a capo) if there is one, or else the octave over a stopped note.
    pub(crate) fn harmonic(&self, pitch: f64, capo: usize) -> Option<(usize, u32)> {
        let over = pitch - self.open_pitch - capo as f64;
        let natural = |order: &u32| (over - 12.0 * libm::log2(f64::from(*order))).abs() < NEAR_ENOUGH;
        let natural = (2..=HIGHEST_HARMONIC).find(natural).map(|order| (capo, order));
        natural.or_else(|| Some((self.fret(pitch - 12.0).filter(|&fret| fret >= capo)?, 2)))
    }

    /// Whether a partial of what sounds over a fret is hardly heard because the coil lies under its node.
    pub(super) fn is_deaf_to(&self, fret: usize, order: u32) -> bool {
        let wavelengths = |coil: f64| 0.5 * f64::from(order) * coil * libm::exp2(fret as f64 / 12.0);
        self.coil.is_some_and(|coil| libm::sin(TAU * wavelengths(coil)).abs() < DEAF)
    }
}

/// A pitch and its octaves, nearest first.
pub(crate) fn octaves(pitch: f64) -> impl Iterator<Item = f64> {
    (0..=10).flat_map(move |octave| [pitch + 12.0 * f64::from(octave), pitch - 12.0 * f64::from(octave)])
}
