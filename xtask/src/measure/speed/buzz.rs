//! How uneven the work is: iterations and instructions, sample by sample, of a chord that buzzes.

use anyhow::{Context, Result, ensure};
use low_action_dsp::{Convergence, Quality, Simulation};

use crate::measure::features::{counted_part, instructions_of_parts, instructions_of_run};
use crate::measure::trade::scenes::{PLUCK, Playing};
use crate::measure::trade::settings::quality;

/// What was counted over all samples, six strings together.
pub struct Work {
    /// In the worst sample.
    pub most: f64,
    /// In a sample on average.
    pub mean: f64,
}

/// Hz, of the host.
const RATE: f64 = 48e3;

/// When the strings are plucked, in samples: all that is counted comes after.
const START: usize = (PLUCK * RATE) as usize;

/// Samples counted: half a second from the plucks on.
const SAMPLES: usize = 24_000;

/// Samples that look like the most work, of which instructions are counted one by one.
pub const SUSPECTS: usize = 48;

/// The strings of the default instrument over its neck as `live` computes them, plucked with 3 N.
struct Chord {
    /// Each with the halves of a step that it takes in a sample.
    strings: Vec<(Simulation, usize)>,
    /// Samples that have been computed.
    now: usize,
}

impl Chord {
    fn new() -> Result<Chord> {
        let scenes = Playing::plucked_at_once("electric", 3.0)?.scenes(&quality(Quality::Live, RATE))?;
        let string = |scene| {
            let simulation = Simulation::new(scene)?;
            Ok((simulation, (2.0 * scene.sample_rate / RATE).round() as usize))
        };
        let mut chord = Chord { strings: scenes.iter().map(string).collect::<Result<_>>()?, now: 0 };
        (0..START).for_each(|_| chord.step(|_| ()));
        Ok(chord)
    }

    /// Takes the steps of a sample, as an instrument shares them out: of two samples that share one the first has it.
    fn step(&mut self, mut see: impl FnMut(&Convergence)) {
        for (string, halves) in &mut self.strings {
            let steps_before = |sample: usize| (*halves * sample).div_ceil(2);
            for _ in steps_before(self.now)..steps_before(self.now + 1) {
                string.step();
                see(&string.string(0).convergence);
            }
        }
        self.now += 1;
    }
}

/// Plays the chord for so many samples, for whoever counts what that takes: that of each named one by itself.
pub fn play(samples: usize, counted: &[usize]) -> Result<()> {
    let mut chord = Chord::new()?;
    for sample in 0..samples {
        if counted.contains(&sample) {
            counted_part(|| chord.step(|_| ()));
        } else {
            chord.step(|_| ());
        }
    }
    Ok(())
}

/// Iterations in each sample, and how much work its contacts look like.
fn count() -> Result<Vec<(u32, u32)>> {
    let mut chord = Chord::new()?;
    let counts = (0..SAMPLES).map(|_| {
        let (mut iterations, mut looks) = (0, 0);
        chord.step(|done| {
            iterations += done.iterations;
            looks += weight(done);
        });
        (iterations, looks)
    });
    Ok(counts.collect())
}

/// How much work a solution looks like: every iteration, and about as often what is there without any, has a matrix with a
/// row and a column for each contact.
fn weight(done: &Convergence) -> u32 {
    (done.iterations + done.fallbacks + done.repeats + 1) * done.active * done.active
}

/// The samples that look like the most work, in the order in which they come.
fn suspects(counts: &[(u32, u32)]) -> Vec<usize> {
    let mut samples: Vec<usize> = (0..counts.len()).collect();
    samples.sort_by_key(|&sample| std::cmp::Reverse(counts[sample].1));
    samples.truncate(SUSPECTS);
    samples.sort_unstable();
    samples
}

/// Counts iterations.
pub fn iterations() -> Result<Work> {
    let counts = count()?;
    let sum: u64 = counts.iter().map(|(iterations, _)| u64::from(*iterations)).sum();
    let most = counts.iter().map(|(iterations, _)| *iterations).max().unwrap_or(0);
    Ok(Work { most: f64::from(most), mean: sum as f64 / SAMPLES as f64 })
}

/// Counts instructions: on average what a run takes more for having all samples, and those of the suspects one by one.
pub fn instructions() -> Result<Work> {
    let program = std::env::current_exe().context("this program has no path")?;
    let (all, none) = (SAMPLES.to_string(), 0.to_string());
    let run = |samples: &str| instructions_of_run(&program, &["measure", "speed", "--play-buzz", samples]);
    let mean = (run(&all)? - run(&none)?) / SAMPLES as f64;
    let suspects: Vec<String> = suspects(&count()?).iter().map(usize::to_string).collect();
    let one_by_one = ["measure", "speed", "--play-buzz", &all, "--counted", &suspects.join(",")];
    let parts = instructions_of_parts(&program, &one_by_one)?;
    ensure!(parts.len() == SUSPECTS, "callgrind saw {} of {SUSPECTS} samples", parts.len());
    Ok(Work { most: parts.into_iter().fold(0.0, f64::max), mean })
}

#[cfg(test)]
mod tests {
    use low_action_dsp::scene::FretPlacement;

    use super::*;

    #[test]
    fn the_chord_is_what_live_plays() {
        let live = quality(Quality::Live, RATE);
        let playing = Playing::plucked_at_once("electric", 3.0).expect("it is built in");
        let scenes = playing.scenes(&live).expect("they can be computed");
        assert_eq!(scenes.len(), 6);
        for scene in &scenes {
            let fretboard = scene.fretboard.as_ref().expect("there is a neck");
            assert_eq!(fretboard.fret_placement, FretPlacement::Kinked);
            assert_eq!(scene.solver, live.solver());
            // There is room for bends.
            assert!(scene.string[0].tension.largest() > 1.01 * scene.string[0].tension.at(0.0));
            assert!(scene.duration >= PLUCK + SAMPLES as f64 / RATE);
        }
        let chord = Chord::new().expect("it can be computed");
        // Six and a half steps a sample, as the page says.
        assert_eq!(chord.strings.iter().map(|(_, halves)| halves).sum::<usize>(), 13);
        for (string, halves) in &chord.strings {
            assert_eq!(string.steps() as usize, (halves * START).div_ceil(2));
        }
    }

    #[test]
    fn suspects_are_those_with_most_contacts_and_iterations() {
        let done = |iterations, active| Convergence { iterations, active, ..Convergence::default() };
        assert!(weight(&done(4, 9)) > weight(&done(20, 3)));
        assert!(weight(&done(4, 9)) > weight(&done(3, 9)));
        let mut counts = vec![(0, 0); 2 * SUSPECTS];
        (0..SUSPECTS).for_each(|place| counts[2 * place] = (0, 1 + place as u32));
        assert_eq!(suspects(&counts), (0..SUSPECTS).map(|place| 2 * place).collect::<Vec<_>>());
    }
}
