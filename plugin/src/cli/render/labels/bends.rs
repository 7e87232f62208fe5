//! What bends came to, a flat record for each.
//!
//! Hands know only nearly how far a tension raises a string that something stretches. Here it is found as the frequencies at its frets
//! are.

use std::collections::BTreeMap;

use low_action_dsp::Error;
use low_action_dsp::setup::tension_ratio;
use serde::Serialize;

use super::Clock;
use crate::cli::render::tuning::Tuned;
use crate::performance::{Annotation, Pull, TimedAnnotation};

/// A bend that goes for another goal.
#[derive(Debug, Serialize)]
pub(super) struct LabelledBend {
    /// From 1.
    string: usize,
    sample: u64,
    /// s.
    time: f64,
    /// At its end, over the fret of the note.
    semitones: f64,
    /// s.
    duration: f64,
}

/// The bends of all strings, in order of time, and of strings at once.
pub(super) fn bends(
    annotations: &[TimedAnnotation],
    tuned: &Tuned,
    clock: Clock,
) -> Result<Vec<LabelledBend>, Error> {
    let mut raised = Raised { tuned, found: BTreeMap::new() };
    let mut bends = Vec::new();
    for told in annotations.iter().filter(|told| clock.has(told.time)) {
        let Annotation::Bent { semitones, duration, pull } = told.annotation else { continue };
        bends.push(LabelledBend {
            string: told.string + 1,
            sample: told.time,
            time: clock.seconds(told.time),
            semitones: semitones - pull.semitones + raised.semitones(told.string, pull)?,
            duration,
        });
    }
    bends.sort_by_key(|bend| (bend.sample, bend.string));
    Ok(bends)
}

/// By how much pulling raises strings.
struct Raised<'a> {
    tuned: &'a Tuned<'a>,
    /// What strings sound at, Hz, by string, fret and [steps](STEPS) by which the tension alone would raise a flexible one.
    found: BTreeMap<(usize, usize, i32), f64>,
}

/// A vibrato has hundreds of goals a second: what a tension does is found at so many steps a semitone, and goes by straight lines
/// between them. A bend that goes as far as the grid bears comes to its end at once, and is 3 cents off there at most, but for all
/// `max_bend` of tenths.
const STEPS: f64 = 10.0;

impl Raised<'_> {
    /// Semitones by which a string sounds higher.
    fn semitones(&mut self, string: usize, Pull { ratio, fret, .. }: Pull) -> Result<f64, Error> {
        let alone = 6.0 * libm::log2(ratio);
        let (step, part) = ((STEPS * alone).floor(), STEPS * alone - (STEPS * alone).floor());
        let straight = self.frequency(string, fret, 0.0)?;
        let mut raised = |step| Ok(12.0 * libm::log2(self.frequency(string, fret, step)? / straight));
        let low = raised(step)?;
        Ok(if part > 0.0 { low + part * (raised(step + 1.0)? - low) } else { low })
    }

    fn frequency(&mut self, string: usize, fret: usize, step: f64) -> Result<f64, Error> {
        let key = (string, fret, step as i32);
        if let Some(&found) = self.found.get(&key) {
            return Ok(found);
        }
        let frequency = self.tuned.pulled(string, fret, tension_ratio(step / STEPS))?;
        self.found.insert(key, frequency);
        Ok(frequency)
    }
}
