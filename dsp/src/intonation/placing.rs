//! Where frets stand, and where fingers stop the string on a bare board, so that each note is in tune.

use super::{Bench, MOST_STEPS, PITCH_TOLERANCE};
use crate::error::Error;
use crate::model::StringParameters;

impl Bench<'_> {
    /// Moves the frets, lowest first, until each stops the string at its pitch.
    pub(super) fn place_frets(
        &self,
        string: &StringParameters,
        open: f64,
        frets: &mut [f64],
    ) -> Result<(), Error> {
        let (mut rest, mut shift) = (None, 0.0);
        for fret in 0..frets.len() {
            let mut sharpness = |place: f64, frets: &mut [f64]| {
                frets[fret] = place;
                self.sharpness(string, open, frets, fret, &mut rest)
            };
            // The secant method, started where the fret before leads to, with the ideal string's law:
            // pitch goes with 1/(L − x). On a grid too coarse for the fret the best place is kept.
            let (low, high) = self.limits(frets, fret);
            let mut place = (frets[fret] + shift).clamp(low, high);
            let mut off = sharpness(place, frets)?;
            let mut slope = 1.0 / (string.length - place);
            let mut best = (place, off);
            for _ in 0..MOST_STEPS {
                let next = (place - off / slope).clamp(low, high);
                if off.abs() < PITCH_TOLERANCE || next == place {
                    break;
                }
                let next_off = sharpness(next, frets)?;
                let secant = (next_off - off) / (next - place);
                if secant > 0.0 {
                    slope = secant;
                }
                (place, off) = (next, next_off);
                if off.abs() < best.1.abs() {
                    best = (place, off);
                }
            }
            frets[fret] = best.0;
            shift = best.0 - self.neck.equal_place((fret + 1) as f64);
            rest = None;
        }
        Ok(())
    }

    /// Finds where fingers stop the string on a bare board, lowest first: half way between two points of the grid, and of all such
    /// places where each pitch is met best.
    ///
    /// The string ends at a grid point, however far before it the finger presses. From half way the finger presses both of its
    /// neighbours on the board alike and lifts those beyond, a sixteenth of its force each: there is one end, however the string
    /// swings. Near a grid point one more lies on the board with hardly any force. Pitch goes smoothly from one end to the next there,
    /// and might be met to the last digit, but only at rest: swinging the string leaves that point, the sooner the louder.
    pub(super) fn place_fingers(
        &self,
        string: &StringParameters,
        open: f64,
        frets: &mut [f64],
    ) -> Result<(), Error> {
        let spacing = self.model(string, frets)?.grid.spacing;
        let (mut rest, mut shift) = (None, 0.0);
        for fret in 0..frets.len() {
            let (low, high) = self.limits(frets, fret);
            let middle = |cell: f64| ((cell + 0.5) * spacing).clamp(low, high);
            let mut sharpness = |place: f64, frets: &mut [f64]| {
                frets[fret] = place;
                self.sharpness(string, open, frets, fret, &mut rest)
            };
            // Started where the one before leads to. Pitch rises towards the bridge: cell by cell there, or back, until it is passed.
            let mut cell = ((frets[fret] + shift) / spacing).floor();
            let mut place = middle(cell);
            let mut best = (place, sharpness(place, frets)?);
            let onwards = if best.1 < 0.0 { 1.0 } else { -1.0 };
            loop {
                cell += onwards;
                let before = std::mem::replace(&mut place, middle(cell));
                if place == before {
                    break;
                }
                let off = sharpness(place, frets)?;
                if off.abs() < best.1.abs() {
                    best = (place, off);
                }
                if off * onwards >= 0.0 {
                    break;
                }
            }
            frets[fret] = best.0;
            shift = best.0 - self.neck.equal_place((fret + 1) as f64);
            rest = None;
        }
        Ok(())
    }

    /// How much too sharp the string sounds at a fret, as a part of its pitch there, where the open one has `open`, Hz. It goes on from
    /// the shape at rest that was found last, and leaves that it has found.
    fn sharpness(
        &self,
        string: &StringParameters,
        open: f64,
        frets: &[f64],
        fret: usize,
        rest: &mut Option<Vec<f64>>,
    ) -> Result<f64, Error> {
        let target = open * libm::exp2((fret + 1) as f64 / 12.0);
        let (pitch, shape) = self.stopped(string, frets, fret, target, rest.take())?;
        *rest = Some(shape);
        Ok(pitch / target - 1.0)
    }

    /// How far a fret may move: less than to where its neighbours would be, and not past the one below.
    fn limits(&self, frets: &[f64], fret: usize) -> (f64, f64) {
        let number = (fret + 1) as f64;
        let (here, low) = (self.neck.equal_place(number), self.neck.equal_place(number - 0.9));
        let below = if fret == 0 { 0.0 } else { frets[fret - 1] };
        (low.max(below + 0.1 * (here - low)), self.neck.equal_place(number + 0.9))
    }
}
