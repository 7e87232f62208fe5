//! How uneven the work is: what is solved, and instructions, sample by sample, of a chord that buzzes.

use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use low_action_dsp::{Convergence, Quality, Simulation};

use crate::measure::chord::fret;
use crate::measure::features::{counted_part, instructions_of_parts, instructions_of_run};
use crate::measure::trade::scenes::{Hand, PLUCK, Playing};
use crate::measure::trade::settings::quality;

/// What was counted over all samples, six strings together.
pub struct Work {
    /// In the worst sample.
    pub most: f64,
    /// In a sample on average.
    pub mean: f64,
}

impl Work {
    /// Of what was counted in each sample.
    fn of(counts: impl Iterator<Item = u32> + Clone) -> Self {
        let sum: u64 = counts.clone().map(u64::from).sum();
        Work { most: counts.max().unwrap_or(0).into(), mean: sum as f64 / SAMPLES as f64 }
    }
}

/// What the left hand does under the chord.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Hands {
    /// It stops each string behind the fret of the [chord](crate::measure::chord) that is timed.
    Fretted,
    /// Nothing: all strings are open.
    Open,
}

impl Hands {
    /// What it does on a string, the lowest being the first.
    fn on(self, string: usize) -> Hand {
        match self {
            Hands::Fretted => Hand::Stops(fret(string)),
            Hands::Open => Hand::Open,
        }
    }
}

/// Force of the plucks, N.
const FORCE: f64 = 3.0;

/// Hz, of the host.
const RATE: f64 = 48e3;

/// When the strings are plucked, in samples: all that is counted comes after.
const START: usize = (PLUCK * RATE) as usize;

/// Samples counted: half a second from the plucks on.
const SAMPLES: usize = 24_000;

/// Samples that look like the most work, of which instructions are counted one by one.
pub const SUSPECTS: usize = 48;

/// The strings of the default instrument over its neck as `live` computes them, plucked at once.
struct Chord {
    /// Each with the halves of a step that it takes in a sample.
    strings: Vec<(Simulation, usize)>,
    /// Samples that have been computed.
    now: usize,
}

impl Chord {
    fn new(hands: Hands) -> Result<Chord> {
        let playing = Playing::plucked_at_once("electric", FORCE, |string| hands.on(string))?;
        let scenes = playing.scenes(&quality(Quality::Live, RATE))?;
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
pub fn play(hands: Hands, samples: usize, counted: &[usize]) -> Result<()> {
    let mut chord = Chord::new(hands)?;
    for sample in 0..samples {
        if counted.contains(&sample) {
            counted_part(|| chord.step(|_| ()));
        } else {
            chord.step(|_| ());
        }
    }
    Ok(())
}

/// What is seen of a sample.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    /// Linear systems solved for contacts.
    systems: u32,
    /// Those after the first of each step.
    iterations: u32,
    /// How much work its contacts look like.
    weight: u32,
}

/// Looks at each sample.
fn look(hands: Hands) -> Result<Vec<Seen>> {
    let mut chord = Chord::new(hands)?;
    let samples = (0..SAMPLES).map(|_| {
        let mut seen = Seen::default();
        chord.step(|done| {
            seen.systems += systems(done);
            seen.iterations += done.iterations;
            seen.weight += weight(done);
        });
        seen
    });
    Ok(samples.collect())
}

/// Linear systems that a solution took: the one from which it starts, which is a step of Newton's from penetrations that go on as
/// they went, anew for each contact that was missed, every iteration, and every attempt of the fallback.
fn systems(done: &Convergence) -> u32 {
    if done.active == 0 { 0 } else { 1 + done.repeats + done.iterations + done.fallbacks }
}

/// How much work a solution looks like: each of its systems has a matrix with a row and a column for each contact.
fn weight(done: &Convergence) -> u32 {
    systems(done) * done.active * done.active
}

/// The samples that look like the most work, in the order in which they come.
fn suspects(weights: &[u32]) -> Vec<usize> {
    let mut samples: Vec<usize> = (0..weights.len()).collect();
    samples.sort_by_key(|&sample| std::cmp::Reverse(weights[sample]));
    samples.truncate(SUSPECTS);
    samples.sort_unstable();
    samples
}

/// Counts linear systems, and those of them that are iterations.
pub fn solved(hands: Hands) -> Result<[Work; 2]> {
    let seen = look(hands)?;
    Ok([Work::of(seen.iter().map(|seen| seen.systems)), Work::of(seen.iter().map(|seen| seen.iterations))])
}

/// Counts instructions: on average what a run takes more for having all samples, and those of the suspects one by one.
pub fn instructions(hands: Hands) -> Result<Work> {
    let program = std::env::current_exe().context("this program has no path")?;
    let name = hands.to_possible_value().context("every hand has a name")?;
    let (all, none) = (SAMPLES.to_string(), 0.to_string());
    let playing = |samples| ["measure", "speed", "--hands", name.get_name(), "--play-buzz", samples];
    let run = |samples| instructions_of_run(&program, &playing(samples));
    let mean = (run(&all)? - run(&none)?) / SAMPLES as f64;
    let weights: Vec<u32> = look(hands)?.iter().map(|seen| seen.weight).collect();
    let suspects: Vec<String> = suspects(&weights).iter().map(usize::to_string).collect();
    let counted = ["--counted", &suspects.join(",")];
    let parts = instructions_of_parts(&program, &[&playing(&all)[..], &counted].concat())?;
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
        for hands in [Hands::Fretted, Hands::Open] {
            let playing = Playing::plucked_at_once("electric", FORCE, |string| hands.on(string));
            let scenes = playing.and_then(|playing| playing.scenes(&live)).expect("they can be computed");
            assert_eq!(scenes.len(), 6);
            for scene in &scenes {
                let fretboard = scene.fretboard.as_ref().expect("there is a neck");
                assert_eq!(fretboard.fret_placement, FretPlacement::Kinked);
                assert_eq!(scene.solver, live.solver());
                // There is room for bends.
                assert!(scene.string[0].tension.largest() > 1.01 * scene.string[0].tension.at(0.0));
                assert!(scene.duration >= PLUCK + SAMPLES as f64 / RATE);
                assert_eq!(scene.finger.len(), usize::from(matches!(hands, Hands::Fretted)));
            }
            // The lowest string is the first, and is stopped nearest to the nut.
            let densities = scenes.iter().map(|scene| scene.string[0].linear_density);
            assert!(densities.is_sorted_by(|before, after| before > after));
            if let [first, second, ..] = &scenes[..]
                && let ([low], [high]) = (&first.finger[..], &second.finger[..])
            {
                assert!(low.position.at(0.0) < high.position.at(0.0));
            }
            let chord = Chord::new(hands).expect("it can be computed");
            // Six and a half steps a sample, as the page says.
            assert_eq!(chord.strings.iter().map(|(_, halves)| halves).sum::<usize>(), 13);
            for (string, halves) in &chord.strings {
                assert_eq!(string.steps() as usize, (halves * START).div_ceil(2));
            }
        }
    }

    #[test]
    fn every_system_counts_and_the_first_is_no_iteration() {
        let done = Convergence { iterations: 4, active: 9, repeats: 1, fallbacks: 2 };
        assert_eq!(systems(&done), 8);
        assert_eq!(systems(&Convergence { iterations: 0, repeats: 0, fallbacks: 0, ..done }), 1);
        assert_eq!(systems(&Convergence::default()), 0);
        let work = Work::of([3, 0, 9].into_iter());
        assert_eq!((work.most, work.mean), (9.0, 12.0 / SAMPLES as f64));
    }

    #[test]
    fn suspects_are_those_with_most_contacts_and_iterations() {
        let done = |iterations, active| Convergence { iterations, active, ..Convergence::default() };
        assert!(weight(&done(4, 9)) > weight(&done(20, 3)));
        assert!(weight(&done(4, 9)) > weight(&done(3, 9)));
        let mut weights = vec![0; 2 * SUSPECTS];
        (0..SUSPECTS).for_each(|place| weights[2 * place] = 1 + place as u32);
        assert_eq!(suspects(&weights), (0..SUSPECTS).map(|place| 2 * place).collect::<Vec<_>>());
    }
}
