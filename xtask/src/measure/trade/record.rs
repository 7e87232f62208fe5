//! Runs a scene and keeps what is compared.

use std::collections::BTreeSet;
use std::time::Instant;

use anyhow::Result;
use low_action_dsp::{Scene, Simulation};

use super::scenes::PLUCK;

/// Sample rate at which everything is compared, Hz.
pub const COMMON: f64 = 48e3;
/// Windows over which contact impulses and levels are taken, s.
pub const WINDOW: f64 = 0.02;

/// What a run left behind.
#[derive(Debug, Clone)]
pub struct Record {
    /// Sample rate of the run, Hz.
    pub rate: f64,
    /// Force on the bridge at each sample of the run, N.
    pub bridge: Vec<f64>,
    /// Impulse of board and frets in each window, N s, string by string.
    pub impulses: Vec<f64>,
    /// When a fret or the board was first touched that was not touched when the pluck began, s.
    pub first_touch: f64,
    /// Deepest penetration of board or fret, m.
    pub penetration: f64,
    /// Energy booked to the solver, in sum, as a part of the largest energy.
    pub booked: f64,
    /// Most iterations in one sample of one string.
    pub iterations: u32,
    /// Samples of a string in which the secant fallback took over, as a part of those with contact.
    pub fallbacks: f64,
}

/// Runs a scene; with the ledger if its energy is asked for (it does not change the motion).
pub fn record(scene: &Scene, with_ledger: bool) -> Result<Record> {
    let mut simulation = Simulation::new(scene)?;
    if with_ledger {
        simulation.open_ledger();
    }
    let rate = scene.sample_rate;
    let windows = (scene.duration / WINDOW).ceil() as usize;
    let mut kept = Record {
        rate,
        bridge: Vec::with_capacity(simulation.samples() as usize),
        impulses: vec![0.0; windows * scene.string.len()],
        first_touch: f64::INFINITY,
        penetration: 0.0,
        booked: 0.0,
        iterations: 0,
        fallbacks: 0.0,
    };
    let mut touched = BTreeSet::new();
    let (mut contacts, mut fallbacks) = (0u64, 0u64);
    while simulation.steps() < simulation.samples() {
        // What a step leaves to be read holds for the sample it led from.
        let time = simulation.steps() as f64 / rate;
        if let Some(entry) = simulation.step() {
            kept.booked += entry.power_solver / rate;
        }
        kept.bridge.push(simulation.output());
        let window = ((time / WINDOW) as usize).min(windows - 1);
        for (index, string) in simulation.strings().iter().enumerate() {
            if string.convergence.active == 0 {
                continue;
            }
            let board = string.board_force();
            let window = index * windows + window;
            kept.impulses[window] += board / rate;
            let touches = (board > 0.0).then_some(usize::MAX).into_iter();
            let frets = string.fret_forces().filter(|(_, force)| *force > 0.0);
            for fret in touches.chain(frets.map(|(fret, force)| {
                kept.impulses[window] += force / rate;
                fret
            })) {
                if time <= PLUCK {
                    touched.insert((index, fret));
                } else if kept.first_touch > time && !touched.contains(&(index, fret)) {
                    kept.first_touch = time;
                }
            }
            kept.penetration = kept.penetration.max(string.penetration());
            kept.iterations = kept.iterations.max(string.convergence.iterations);
            contacts += 1;
            fallbacks += u64::from(string.convergence.fallbacks > 0);
        }
    }
    let largest: f64 = simulation.ledgers().iter().map(|ledger| ledger.largest).sum();
    kept.booked /= largest.max(f64::MIN_POSITIVE);
    kept.fallbacks = fallbacks as f64 / contacts.max(1) as f64;
    Ok(kept)
}

/// Nanoseconds per sample and string.
pub fn nanoseconds(scene: &Scene) -> Result<f64> {
    let mut simulation = Simulation::new(scene)?;
    let samples = simulation.samples();
    let (mut heard, started) = (0.0, Instant::now());
    for _ in 0..samples {
        simulation.step();
        heard += simulation.output();
    }
    std::hint::black_box(heard);
    Ok(1e9 * started.elapsed().as_secs_f64() / (samples * scene.string.len() as u64) as f64)
}
