//! Runs a scene and keeps what is compared.

use std::collections::BTreeSet;
use std::time::Instant;

use anyhow::{Result, ensure};
use low_action_dsp::{Scene, Simulation};

use super::filter::LowPass;
use super::rival::Rival;
use super::scenes::{PLUCK, Playing};
use super::settings::{Law, Setting};

/// Sample rate at which everything is compared, Hz.
pub const COMMON: f64 = 48e3;
/// Windows over which contact impulses and levels are taken, s.
pub const WINDOW: f64 = 0.02;

/// What a run left behind.
#[derive(Debug, Clone, Default)]
pub struct Record {
    /// Rates, Hz, and at each of their samples the force on the bridge of all strings at that rate, N.
    pub bridge: Vec<(f64, Vec<f64>)>,
    /// Impulse of board and frets in each window, N s, string by string.
    pub impulses: Vec<f64>,
    /// When a fret or the board was first touched that was not touched when the pluck began, s.
    pub first_touch: f64,
    /// Deepest penetration of board or fret, m.
    pub penetration: f64,
    /// Strongest pull of a contact, which should only push, N.
    pub pull: f64,
    /// Energy booked to the solver, in sum, and the sum of the strings' largest energies, J; none where no equation is solved.
    pub booked: Option<[f64; 2]>,
    /// Most iterations in one sample of one string.
    pub iterations: u32,
    /// Samples of a string with contact, and those of them in which the secant fallback took over.
    pub contacts: [u64; 2],
    /// The sample with most work, by iterations times contacts: that number, string and step.
    pub worst: Option<(u32, usize, u64)>,
}

/// What one step of one string did.
#[derive(Debug, Clone, Copy, Default)]
struct Work {
    iterations: u32,
    active: u32,
    fallback: bool,
}

/// What is seen of one string as it is stepped.
struct Watch<'a> {
    record: &'a mut Record,
    string: usize,
    rate: f64,
    touched: BTreeSet<usize>,
}

impl<'a> Watch<'a> {
    fn new(record: &'a mut Record, string: usize, scene: &Scene) -> Self {
        let rate = scene.sample_rate;
        record.bridge.push((rate, Vec::with_capacity((scene.duration * rate) as usize + 1)));
        let windows = (scene.duration / WINDOW).ceil() as usize;
        record.impulses.resize((string + 1) * windows, 0.0);
        if string == 0 {
            record.first_touch = f64::INFINITY;
        }
        Watch { record, string, rate, touched: BTreeSet::new() }
    }

    /// Takes in a step. What a step leaves to be read holds for the sample it led from.
    fn see(&mut self, step: u64, heard: f64, board: f64, frets: &[(usize, f64)], depth: f64, work: Work) {
        let (kept, time) = (&mut *self.record, step as f64 / self.rate);
        kept.bridge[self.string].1.push(heard);
        if work.active == 0 {
            return;
        }
        let windows = kept.impulses.len() / (self.string + 1);
        let window = self.string * windows + ((time / WINDOW) as usize).min(windows - 1);
        for (fret, force) in frets.iter().copied().chain([(usize::MAX, board)]) {
            kept.impulses[window] += force / self.rate;
            kept.pull = kept.pull.max(-force);
            if force <= 0.0 {
                continue;
            }
            if time <= PLUCK {
                self.touched.insert(fret);
            } else if kept.first_touch > time && !self.touched.contains(&fret) {
                kept.first_touch = time;
            }
        }
        kept.penetration = kept.penetration.max(depth);
        kept.iterations = kept.iterations.max(work.iterations);
        kept.contacts[0] += 1;
        kept.contacts[1] += u64::from(work.fallback);
        let size = work.iterations.max(1) * work.active;
        if kept.worst.is_none_or(|(most, ..)| size > most) {
            kept.worst = Some((size, self.string, step));
        }
    }
}

/// Runs a scene under a setting; with the ledger if its energy is asked for (it does not change the motion).
///
/// # Errors
/// When the scene is refused, or a force or an energy of it is not finite.
pub fn record(playing: &Playing, setting: &Setting, with_ledger: bool) -> Result<Record> {
    let mut record = Record::default();
    for (string, scene) in playing.scenes(setting)?.iter().enumerate() {
        match setting.law {
            Law::Newton => {
                let booked = by_newton(scene, &mut Watch::new(&mut record, string, scene), with_ledger)?;
                let sums = record.booked.get_or_insert_default();
                sums.iter_mut().zip(booked).for_each(|(sum, booked)| *sum += booked);
            }
            Law::Quadratised => {
                let mut rival = Rival::new(scene)?;
                let mut watch = Watch::new(&mut record, string, scene);
                for step in 0..rival.samples() {
                    rival.step();
                    let work = Work { iterations: 0, active: rival.active(), fallback: false };
                    let frets = rival.fret_forces();
                    watch.see(step, rival.output(), rival.board_force(), &frets, rival.penetration(), work);
                }
            }
        }
    }
    record.add_up();
    let forces = record.bridge.iter().flat_map(|(_, forces)| forces);
    let mut kept = forces.chain(&record.impulses).chain(record.booked.iter().flatten());
    ensure!(kept.all(|value| value.is_finite()), "not finite under {setting:?}");
    Ok(record)
}

/// Runs one string; returns the energy booked to the solver and the largest energy, J.
fn by_newton(scene: &Scene, watch: &mut Watch<'_>, with_ledger: bool) -> Result<[f64; 2]> {
    let mut simulation = Simulation::new(scene)?;
    if with_ledger {
        simulation.open_ledger();
    }
    let mut booked = 0.0;
    while simulation.steps() < simulation.samples() {
        let step = simulation.steps();
        if let Some(entry) = simulation.step() {
            booked += entry.power_solver / scene.sample_rate;
        }
        let string = simulation.string(0);
        let done = string.convergence;
        let work = Work { iterations: done.iterations, active: done.active, fallback: done.fallbacks > 0 };
        let (mut frets, mut board, mut depth) = (Vec::new(), 0.0, 0.0);
        if done.active > 0 {
            frets.extend(string.fret_forces());
            board = string.board_force();
            depth = string.penetration();
        }
        watch.see(step, simulation.output(), board, &frets, depth, work);
    }
    Ok([booked, simulation.ledgers().iter().map(|ledger| ledger.largest).sum()])
}

impl Record {
    /// Adds up the forces of strings of the same rate.
    fn add_up(&mut self) {
        let mut sums: Vec<(f64, Vec<f64>)> = Vec::new();
        for (rate, signal) in self.bridge.drain(..) {
            match sums.iter_mut().find(|(known, _)| *known == rate) {
                Some((_, sum)) => sum.iter_mut().zip(signal).for_each(|(sum, value)| *sum += value),
                None => sums.push((rate, signal)),
            }
        }
        self.bridge = sums;
    }

    /// Samples at the common rate of all strings together.
    pub fn heard(&self, filter: &LowPass, from: f64, to: f64, delay: f64) -> Vec<f64> {
        let mut sum = Vec::new();
        for (rate, signal) in &self.bridge {
            let one = filter.run(signal, *rate, from, to, delay);
            sum.resize(one.len(), 0.0);
            sum.iter_mut().zip(one).for_each(|(sum, one)| *sum += one);
        }
        sum
    }
}

/// A piece of a scene that is timed by itself, s.
const PIECE: f64 = 0.01;

/// The times that the pieces of some scenes have taken, s, each the fastest so far: so whatever else a machine does for a while
/// counts only where it did that whenever the piece was timed.
#[derive(Debug, Default)]
pub struct Times {
    scenes: Vec<f64>,
    /// Of the rival's string with nothing to touch, which is subtracted, and of ours, which is put in its place.
    bare: [Vec<f64>; 2],
}

/// Part of a core that a string of a scene takes in real time, by times that are taken once more.
pub fn load(playing: &Playing, setting: &Setting, times: &mut Times) -> Result<f64> {
    let mut taken = Times::default();
    let mut played = 0.0;
    for scene in playing.scenes(setting)? {
        match setting.law {
            Law::Newton => time_newton(&scene, &mut taken.scenes)?,
            // Its string is stepped by plain loops: what is compared is what contacts cost over the same string.
            Law::Quadratised => {
                let bare = Scene { fretboard: None, finger: Vec::new(), ..scene.clone() };
                time_rival(&scene, &mut taken.scenes)?;
                time_rival(&bare, &mut taken.bare[0])?;
                time_newton(&bare, &mut taken.bare[1])?;
            }
        }
        played += scene.duration;
    }
    let [theirs, ours] = &mut times.bare;
    let [new_theirs, new_ours] = taken.bare;
    let seconds =
        fastest(&mut times.scenes, taken.scenes) - fastest(theirs, new_theirs) + fastest(ours, new_ours);
    Ok(seconds / played)
}

/// Keeps the faster time of each piece; returns what all take, s.
fn fastest(known: &mut Vec<f64>, taken: Vec<f64>) -> f64 {
    if known.is_empty() {
        *known = taken;
    } else {
        known.iter_mut().zip(taken).for_each(|(known, taken)| *known = known.min(taken));
    }
    known.iter().sum()
}

fn time_newton(scene: &Scene, times: &mut Vec<f64>) -> Result<()> {
    let mut simulation = Simulation::new(scene)?;
    time_pieces(simulation.samples(), scene.duration, times, || {
        simulation.step();
        simulation.output()
    });
    Ok(())
}

fn time_rival(scene: &Scene, times: &mut Vec<f64>) -> Result<()> {
    let mut rival = Rival::new(scene)?;
    time_pieces(rival.samples(), scene.duration, times, || {
        rival.step();
        rival.output()
    });
    Ok(())
}

/// Times so many samples, which last so long, piece by piece.
fn time_pieces(samples: u64, duration: f64, times: &mut Vec<f64>, mut sample: impl FnMut() -> f64) {
    let piece = ((PIECE / duration * samples as f64) as u64).max(1);
    let mut left = samples;
    while left > 0 {
        let count = left.min(piece);
        let started = Instant::now();
        let heard: f64 = (0..count).map(|_| sample()).sum();
        std::hint::black_box(heard);
        times.push(started.elapsed().as_secs_f64());
        left -= count;
    }
}
