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

/// How often what is subtracted is timed.
const TRIES: usize = 3;

/// Part of a core that a string of a scene takes in real time.
pub fn load(playing: &Playing, setting: &Setting) -> Result<f64> {
    let (mut taken, mut played) = (0.0, 0.0);
    for scene in playing.scenes(setting)? {
        taken += match setting.law {
            Law::Newton => seconds_by_newton(&scene)?,
            // Its string is stepped by plain loops: what is compared is what contacts cost over the same string.
            Law::Quadratised => {
                let bare = Scene { fretboard: None, finger: Vec::new(), ..scene.clone() };
                // A difference of times wants each at its best.
                let best = |seconds: fn(&Scene) -> Result<f64>, scene: &Scene| {
                    let tries = (0..TRIES).map(|_| seconds(scene)).collect::<Result<Vec<f64>>>()?;
                    Ok::<f64, anyhow::Error>(tries.into_iter().fold(f64::INFINITY, f64::min))
                };
                best(seconds_by_rival, &scene)? - best(seconds_by_rival, &bare)?
                    + best(seconds_by_newton, &bare)?
            }
        };
        played += scene.duration;
    }
    Ok(taken / played)
}

fn seconds_by_newton(scene: &Scene) -> Result<f64> {
    let mut simulation = Simulation::new(scene)?;
    let (mut heard, started) = (0.0, Instant::now());
    for _ in 0..simulation.samples() {
        simulation.step();
        heard += simulation.output();
    }
    std::hint::black_box(heard);
    Ok(started.elapsed().as_secs_f64())
}

fn seconds_by_rival(scene: &Scene) -> Result<f64> {
    let mut rival = Rival::new(scene)?;
    let (mut heard, started) = (0.0, Instant::now());
    for _ in 0..rival.samples() {
        rival.step();
        heard += rival.output();
    }
    std::hint::black_box(heard);
    Ok(started.elapsed().as_secs_f64())
}
