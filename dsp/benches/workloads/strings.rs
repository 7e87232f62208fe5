//! Single strings: a low E of the default instrument, alone or over its neck.

use std::hint::black_box;

use low_action_dsp::drive::Push;
use low_action_dsp::neck::Neck;
use low_action_dsp::{
    Barrier, Drive, Model, Scratch, Setup, SolverSettings, State, Stencil, StringParameters,
};

use super::SAMPLES;

/// A string under way.
#[derive(Clone)]
pub struct OneString {
    /// Its coefficients.
    pub model: Model,
    state: State,
    scratch: Scratch,
    drive: Drive,
}

const LOW_E: StringParameters = StringParameters {
    length: 0.6477,
    linear_density: 6.8246e-3,
    tension: 77.8,
    tension_limit: 110.0,
    youngs_modulus: 2.07e11,
    core_radius: 2.286e-4,
    loss_0: 0.285,
    loss_1: 5.38e-4,
    tension_modulation: true,
};

impl OneString {
    /// Plucked and ringing, with nothing to touch.
    pub fn free(rate: f64, stencil: Stencil) -> Self {
        let mut string = Self::new(rate, stencil, None, 0);
        string.pluck(0.5);
        string
    }

    /// Stopped by a finger behind the fifth fret, plucked and ringing: a finger and two frets in contact.
    pub fn fretted(rate: f64) -> Self {
        let setup = Setup::builtin("electric").expect("it is built in");
        let frets: Vec<f64> =
            (1..=22).map(|fret| LOW_E.length * (1.0 - 0.5f64.powf(f64::from(fret) / 12.0))).collect();
        let barrier = setup.neck.barrier(&frets).expect("its values are in range");
        let mut string = Self::new(rate, Stencil::Wide, Some(&barrier), 1);
        let fretting = setup.player.fretting;
        let place = 0.6 * frets[4] + 0.4 * frets[3];
        string
            .state
            .place_finger(&string.model, 0, fretting.touch, place, 1e-4, 0.0)
            .expect("the neck is long enough");
        string.drive.hands[0].position = place;
        string.drive.hands[0].force = fretting.force;
        string.steps((0.2 * rate) as usize);
        string.pluck(0.52);
        string
    }

    fn new(rate: f64, stencil: Stencil, barrier: Option<&Barrier>, fingers: usize) -> Self {
        let settings = SolverSettings { stencil, max_iterations: 20, tolerance: 1e-9 };
        let model = Model::new(LOW_E, barrier, fingers, settings, rate).expect("it can be built");
        let (state, scratch, drive) = (State::new(&model), Scratch::new(&model), Drive::new(&model));
        OneString { model, state, scratch, drive }
    }

    /// A push of 3 ms, and as long until the first waves are everywhere.
    fn pluck(&mut self, place: f64) {
        self.drive.pushes.push(Push { reading: self.model.grid.reading(place), force: 0.4 });
        self.steps((0.003 / self.model.grid.time_step) as usize);
        self.drive.pushes.clear();
        self.steps((0.05 / self.model.grid.time_step) as usize);
    }

    fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.state.step(&self.model, &self.drive, &mut self.scratch);
        }
    }

    /// [`SAMPLES`] samples.
    pub fn run(&mut self) -> f64 {
        self.steps(SAMPLES);
        black_box(self.state.displacement().sum())
    }

    /// The same by instructions that any processor has.
    pub fn without_vectors(mut self) -> Self {
        self.scratch.leave_vectors();
        self
    }
}

/// A free string over so many frets that it never reaches.
pub fn over_frets(count: usize) -> OneString {
    let setup = Setup::builtin("electric").expect("it is built in");
    let neck = Neck { fret_height: 1e-3, ..setup.neck };
    let frets: Vec<f64> = (1..=count).map(|fret| 0.5 * LOW_E.length * fret as f64 / count as f64).collect();
    let mut barrier = neck.barrier(&frets).expect("its values are in range");
    barrier.board = None;
    for fret in &mut barrier.frets {
        fret[1] = -0.02;
    }
    let mut string = OneString::new(48e3, Stencil::Wide, Some(&barrier), 0);
    string.pluck(0.5);
    string
}
