//! Where fingers press to stop a fret.

/// How far behind the crown of its fret, towards the nut, a finger presses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Behind {
    /// The part of the fret's own space.
    pub part: f64,
    /// The least distance, m, where the space has room for it: half of what a fingertip covers.
    pub nearest: f64,
}

/// The part of a fret's space beyond which a finger does not draw back only to be far enough from the crown: a little
/// past the middle (chosen, not measured), or it would lie on the fret before.
const ROOM: f64 = 0.65;

impl Behind {
    /// The distance, m, in a fret's space of this length, m.
    pub fn distance(&self, space: f64) -> f64 {
        (self.part * space).max(self.nearest.min(ROOM * space))
    }
}

/// Where a finger presses to stop the fret of index `fret`, 0 for the first, m from the nut.
///
/// # Panics
/// When there is no such fret.
pub fn finger_place(frets: &[f64], fret: usize, behind: Behind) -> f64 {
    let below = if fret == 0 { 0.0 } else { frets[fret - 1] };
    frets[fret] - behind.distance(frets[fret] - below)
}

/// Where a finger presses to stop a fret (1 for the first), m from the nut: one beyond the last as the last. The open string's,
/// and any where there are no frets, is the nut itself, 0.
pub fn finger_position(frets: &[f64], fret: usize, behind: Behind) -> f64 {
    match fret.min(frets.len()).checked_sub(1) {
        Some(index) => finger_place(frets, index, behind),
        None => 0.0,
    }
}
