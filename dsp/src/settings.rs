//! How an instrument is computed: speed against accuracy.
//!
//! The lighter and tauter a string, the faster its waves and the wider the spacing of its grid: at 48 kHz
//! that of a guitar's high E is 11 mm, as wide as its highest frets are apart, and that of a bass's low E 4 mm.
//! What a string does at a fret is known no better than its grid tells places apart. So each string is
//! computed at the smallest multiple of the host's rate, in steps of a half, at which its grid is fine enough; a light
//! one needs more of them, and each costs it less. (Over a body all go on together, as often as the one that needs most.)

use std::ops::RangeInclusive;

use crate::digits::plain;
use crate::error::{Error, within};
use crate::intonation::flexible;
use crate::model::Model;
use crate::ratio::Ratio;
use crate::scene::{SolverSettings, Stencil};
use crate::setup::{Setup, SetupString};

/// How an instrument is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EngineSettings {
    /// Sample rate at which it is heard, Hz, 8e3 to 1e6.
    pub sample_rate: f64,
    /// The widest grid a string is asked to have, m, 1e-4 or more: one whose grid is wider at `sample_rate` is computed at a multiple
    /// of it, up to 400 kHz, and has what grid it gets there, wider or not. Over a wide bridge, or where fret 12 is more than 6 mm
    /// below the string, two thirds of this are asked for. Over a bare board it is moreover 3 mm and a ninetieth of the shortest
    /// length that sounds at most. Infinite sets no limit, be the board bare or not: every string is computed at `sample_rate` itself
    /// that is not too short for its grid there. Over a wide bridge four fifths of what that reaches are asked for in any case; a grid
    /// that comes out wider than all of it is refused, as the string would not touch it.
    pub widest_spacing: f64,
    /// Difference operator of the strings.
    pub stencil: Stencil,
    /// Newton iterations at most in a solution, 0 to 1000.
    pub max_iterations: usize,
    /// Largest error of a penetration at which the iteration may stop, m, 0 to 1e-3.
    pub tolerance: f64,
}

/// What the host's rate may be, Hz.
const RATES: RangeInclusive<f64> = 8e3..=1e6;

/// No string is computed at more than this rate, Hz, unless the host's is higher: the price of strings that
/// nobody would string up stays within bounds.
const HIGHEST_RATE: f64 = 400e3;

/// Strings bend round a fret on any grid. What else is hard, a wide bridge that they leave point by point or a bar (which lies on
/// strings out of the reach of fingers), asks for one so much finer.
const BETWEEN_FRETS: f64 = 2.0 / 3.0;

/// The widest grid over a wide bridge, as a part of how far that reaches: at least one point is over it, and a little more, as the
/// grid is found before the string is tuned.
const OF_A_BRIDGE: f64 = 0.8;

/// The widest grid over a bare board that fingers stop strings on, m, and as a part of the shortest length that sounds. Such a string ends
/// at a grid point, by up to half a spacing h beside where its pitch wants it: 600/ln 2 · h/l cents of a length l, 9.6 of ninety
/// spacings.
const ON_A_BARE_BOARD: f64 = 3e-3;
const OF_THE_SHORTEST: f64 = 1.0 / 90.0;

impl EngineSettings {
    /// What they mean for the solver.
    pub fn solver(&self) -> SolverSettings {
        SolverSettings {
            max_iterations: self.max_iterations,
            tolerance: self.tolerance,
            stencil: self.stencil,
        }
    }

    /// How many steps a string of a set-up takes in a sample: as few as its grid's spacing allows, or, where strings hear each other
    /// through a body, that of the string that needs most.
    pub fn ratio(&self, setup: &Setup, string: &SetupString) -> Ratio {
        if setup.body.is_none() {
            return self.own_ratio(setup, string);
        }
        let all = setup.string.iter().map(|string| self.own_ratio(setup, string));
        all.max().unwrap_or(Ratio::ONE)
    }

    /// That of a string by itself.
    fn own_ratio(&self, setup: &Setup, string: &SetupString) -> Ratio {
        let parameters = flexible(setup, string);
        let most = Ratio::of_halves((2.0 * HIGHEST_RATE / self.sample_rate.max(*RATES.start())) as usize);
        let widest = self.widest(setup);
        let fine = |ratio: &Ratio| {
            let time_step = 1.0 / (ratio.value() * self.sample_rate);
            // A string too short for its grid is one whose grid is too wide.
            Model::grid(&parameters, self.stencil, time_step).is_ok_and(|grid| grid.spacing <= widest)
        };
        (Ratio::ONE.halves()..most.halves()).map(Ratio::of_halves).find(fine).unwrap_or(most)
    }

    /// The widest grid that a string of a set-up may have, m.
    fn widest(&self, setup: &Setup) -> f64 {
        let part = if setup.is_touched_between_frets() { BETWEEN_FRETS } else { 1.0 };
        let over_bridge = setup.bridge.map_or(f64::INFINITY, |bridge| OF_A_BRIDGE * bridge.length);
        let widest = (self.widest_spacing * part).min(over_bridge);
        if !setup.neck.fretless || self.widest_spacing.is_infinite() {
            return widest;
        }
        let shortest = setup.neck.scale_length - setup.neck.equal_place(setup.neck.frets as f64);
        widest.min(ON_A_BARE_BOARD).min(OF_THE_SHORTEST * shortest)
    }

    /// Refuses values outside their range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        within("sample_rate", self.sample_rate, *RATES.start(), *RATES.end(), "Hz")?;
        if self.widest_spacing.is_nan() || self.widest_spacing < 1e-4 {
            let value = plain(self.widest_spacing);
            return Err(Error::range("widest_spacing", value, "it must be 1e-4 m or more"));
        }
        self.solver().check()
    }
}
