//! What a string that is tuned and fretted sounds at, however hard it is pressed and however far it is pulled.

use std::f64::consts::TAU;

use super::mode::open_frequency;
use super::{Bench, Intonated, MOST_STEPS};
use crate::error::Error;
use crate::scene::Stencil;
use crate::setup::{Setup, SetupString, frequency};

/// A frequency looked for so near to what is found, as a part of it, makes no difference that is heard.
const NEAR_ENOUGH: f64 = 0.01;

/// What is done to a string at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressed {
    /// What a finger behind a fret presses with, N.
    pub force: f64,
    /// How far the string is pulled, as a multiple of its own tension.
    pub tension_ratio: f64,
}

/// A string of a set-up on its grid.
pub struct Sounding<'a> {
    bench: Bench<'a>,
    string: &'a SetupString,
    placed: &'a Intonated,
}

impl<'a> Sounding<'a> {
    /// A string as it has been tuned and fretted at a sample rate, Hz.
    pub fn new(
        setup: &'a Setup,
        string: &'a SetupString,
        placed: &'a Intonated,
        stencil: Stencil,
        sample_rate: f64,
    ) -> Self {
        Self { bench: Bench::new(setup, stencil, sample_rate), string, placed }
    }

    /// The frequency, Hz, at which it sounds where a finger stops a fret, 1 for the first; 0 is the open string.
    ///
    /// # Errors
    /// As [`intonate`](super::intonate).
    ///
    /// # Panics
    /// When there is no such fret.
    pub fn frequency(&self, fret: usize, pressed: Pressed) -> Result<f64, Error> {
        let Self { ref bench, string, placed: Intonated { string: tuned, frets } } = *self;
        let Pressed { force, tension_ratio } = pressed;
        let own = bench.model(tuned, frets)?;
        // (On the grid that it has at its own tension.)
        let mut model = own.clone();
        model.string.tension *= tension_ratio;
        let Some(index) = fret.checked_sub(1) else {
            return Ok(open_frequency(&model, 1) / TAU);
        };
        let straight = bench.rest(&own, frets, index, force, None);
        let mut rest = bench.rest(&model, frets, index, force, Some(straight.displacement));
        // What stretching adds beyond what the grid bears goes into a ripple that nobody hears (`docs/physics.md`, section 5).
        rest.tension = rest.tension.min(model.tension_borne(model.string.tension));
        // As its tension has it at first, and then nearer: a finger gives way by how fast it is shaken.
        let written = frequency(string.pitch + bench.setup.tuning + fret as f64);
        let mut angular = TAU * written * (rest.tension / straight.tension).sqrt();
        for _ in 0..MOST_STEPS {
            let near = angular;
            angular = bench.sound(&model, &rest, frets, index, force, near)?;
            if (angular / near - 1.0).abs() < NEAR_ENOUGH {
                break;
            }
        }
        Ok(angular / TAU)
    }
}
