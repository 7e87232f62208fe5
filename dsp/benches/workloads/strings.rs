//! Single strings: a low E of the default instrument, alone or over its neck.

use std::hint::black_box;

use low_action_dsp::drive::Push;
use low_action_dsp::neck::Neck;
use low_action_dsp::{
    Barrier, Drive, Model, Quality, Scratch, Setup, SolverSettings, State, Stencil, StringParameters,
};

use super::SAMPLES;
use super::instruments::lowest_alone;

/// A string under way.
#[derive(Clone)]
pub struct OneString {
    /// Its coefficients.
    pub model: Model,
    state: State,
    scratch: Scratch,
    drive: Drive,
}

/// The lowest string as its instrument tunes it.
fn low_e() -> StringParameters {
    lowest_alone().model(0).string
}

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
        let frets = setup.neck.equal_places();
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
        let live = Quality::Live.settings(rate);
        let settings =
            SolverSettings { stencil, max_iterations: live.max_iterations, tolerance: live.tolerance };
        let model = Model::new(low_e(), barrier, fingers, settings, rate).expect("it can be built");
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

    /// Where its moving points are, m.
    pub fn displacement(&self) -> Vec<f64> {
        self.state.displacement().collect()
    }

    /// How far they moved in the last step, m.
    pub fn motion(&self) -> Vec<f64> {
        self.state.motion().collect()
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
    let half = 0.5 * neck.scale_length;
    let frets: Vec<f64> = (1..=count).map(|fret| half * fret as f64 / count as f64).collect();
    let mut barrier = neck.barrier(&frets).expect("its values are in range");
    barrier.board = None;
    for fret in &mut barrier.frets {
        fret[1] = -0.02;
    }
    let mut string = OneString::new(48e3, Stencil::Wide, Some(&barrier), 0);
    string.pluck(0.5);
    string
}
