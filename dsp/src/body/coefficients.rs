//! What stays the same of a body's modes, side by side.

use std::f64::consts::{PI, TAU};

use crate::field::{LANES, Row};
use crate::setup::Mode;

/// Coefficients of modes side by side; where there is none they are 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Coefficients {
    /// What is left of the motion, (1 − ε)/(1 + ε) with ε = tanh(ωk/2Q).
    pub kept: Row,
    /// What the spring adds to it, (2 − 2√(1 − ε²) cos θ)/(1 + ε), θ the turn in a step, k√(ω² − (ω/2Q)²): together they have the mode
    /// ring and die away as it would without steps. (Found so that nothing cancels, however slow the mode is.)
    pub spring: Row,
    /// What 1 N on the bridge adds to it, k²φ/(1 + ε).
    pub force: Row,
    /// φ, 1/√kg.
    pub bridge: Row,
    /// Sound pressure for a change of the motion, Pa/(m√kg).
    pub pressure: Row,
    /// What the spring has of 1 kg, 1/s².
    pub own: Row,
}

/// Modes from this part of the rate up are left out.
const HIGHEST: f64 = 0.4;

/// Below how many Hz there are modes at a time step, s.
pub(super) fn fastest(time_step: f64) -> f64 {
    HIGHEST / time_step
}

/// Whether there is a mode of a frequency, Hz, at a time step, s.
pub(super) fn is_slow(frequency: f64, time_step: f64) -> bool {
    frequency * time_step < HIGHEST
}

impl Coefficients {
    /// Those of so many modes, in rows, at a time step, s.
    pub fn of(modes: Vec<Mode>, time_step: f64) -> Vec<Coefficients> {
        let slow: Vec<_> = modes.into_iter().filter(|mode| is_slow(mode.frequency, time_step)).collect();
        let row = |modes: &[Mode]| {
            let mut row = Coefficients::default();
            for (lane, mode) in modes.iter().enumerate() {
                row.set(lane, mode, time_step);
            }
            row
        };
        slow.chunks(LANES).map(row).collect()
    }

    fn set(&mut self, lane: usize, mode: &Mode, time_step: f64) {
        let lossy = libm::tanh(PI * mode.frequency * time_step / mode.quality);
        let half = 0.5 / mode.quality;
        let turn = TAU * mode.frequency * time_step * (1.0 - half * half).sqrt();
        let (shrinks, sine) = ((1.0 - lossy * lossy).sqrt(), libm::sin(0.5 * turn));
        let square = 2.0 * lossy * lossy / (1.0 + shrinks) + 4.0 * shrinks * sine * sine;
        let (k2, lost) = (time_step * time_step, 1.0 / (1.0 + lossy));
        self.kept[lane] = (1.0 - lossy) * lost;
        self.spring[lane] = square * lost;
        self.force[lane] = k2 * mode.bridge * lost;
        self.bridge[lane] = mode.bridge;
        self.pressure[lane] = mode.pressure / k2;
        self.own[lane] = square / k2;
    }

    /// Σφ²·f(own) over the modes of several rows.
    pub fn sum(rows: &[Coefficients], of_own: impl Fn(f64) -> f64) -> f64 {
        let all = rows.iter().flat_map(|row| row.bridge.into_iter().zip(row.own));
        // (Of a lane without a mode nothing is asked: its spring is none.)
        all.filter(|(_, own)| *own > 0.0).map(|(phi, own)| phi * phi * of_own(own)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// z = exp(−x ± iθ) solves z² − (1 + kept − spring) z + kept = 0, so that spring is (1 − e⁻ˣ)² + 4e⁻ˣ sin²(θ/2): to the last
    /// digits also of a mode that needs a second for what takes 1e-7 s.
    #[test]
    fn modes_ring_as_they_would_without_steps() {
        for rate in [4_000.0, 48_000.0, 1e7] {
            for quality in [1.0, 20.0, 200.0] {
                for frequency in [0.2, 1.0, 30.0, 170.0, 1_500.0] {
                    let mode = Mode { frequency, quality, bridge: 1.0, pressure: 1.0 };
                    let row = Coefficients::of(vec![mode], 1.0 / rate)[0];
                    let step = TAU * frequency / rate;
                    let (fades, turns) =
                        (0.5 * step / quality, step * (1.0 - 0.25 / (quality * quality)).sqrt());
                    let sine = libm::sin(0.5 * turns);
                    let expected = libm::expm1(-fades).powi(2) + 4.0 * libm::exp(-fades) * sine * sine;
                    let off = row.spring[0] / expected - 1.0;
                    assert!(
                        off.abs() < 16.0 * f64::EPSILON,
                        "{frequency} Hz of {quality} at {rate} Hz: {off:e}"
                    );
                    let off = row.kept[0] / libm::exp(-2.0 * fades) - 1.0;
                    assert!(
                        off.abs() < 16.0 * f64::EPSILON,
                        "{frequency} Hz of {quality} at {rate} Hz: {off:e}"
                    );
                    // Between steps it is pulled back by ω², but for what steps take of high ones, (ωk)²/12 and at the lowest Q
                    // twice that.
                    let off = row.own[0] / (TAU * frequency).powi(2) - 1.0;
                    let most = step * step / 4.0 + 16.0 * f64::EPSILON;
                    assert!(off.abs() < most, "{frequency} Hz of {quality} at {rate} Hz: {off:e}");
                }
            }
        }
    }
}
