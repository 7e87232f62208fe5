//! One step of one string: predict without contacts, solve the contacts, advance.

use crate::active::ActiveSet;
use crate::drive::{Drive, Push};
use crate::field::Field;
use crate::finger::FingerBefore;
use crate::instructions::{Instructions, Pass, Vectors};
use crate::kernel::{Advance, Kernel, Moved, Prediction, Shape, Stretching, Weights};
use crate::model::{Coasting, Model, Stiffness};
use crate::roomy::Roomy;
use crate::solver::{Convergence, Solver};
use crate::state::State;

/// Room to step one string, and what the last step did, for whoever measures it. It goes with one state: before it steps another,
/// it is to be [reset](Scratch::reset).
#[derive(Debug, Clone)]
pub struct Scratch {
    pub(crate) instructions: Instructions,
    pub(crate) kernel: Kernel,
    stiffness: Stiffness,
    /// What a hand laid along the string added to its loss in the last step, 1/s, and how the string goes on by itself so.
    loss: f64,
    pub(crate) coasting: Coasting,
    weights: Weights,
    /// How the string was bent where the last step led from.
    shape: Shape,
    string_energy: f64,
    /// (δuⁿ)ᵀδ(uⁿ⁺¹ + uⁿ⁻¹)/2, m².
    pub(crate) stretching: f64,
    /// dᵀd of the motion to n + 1, m².
    squares: f64,
    /// The motion to n + 1: without contacts and tension modulation, then with contacts, then dⁿ⁺¹ itself; after the step dⁿ.
    pub(crate) motion: Field,
    /// uⁿ⁺¹ in the step, uⁿ after it.
    pub(crate) displacement: Field,
    pub(crate) solver: Solver,
    /// The contacts active in the last step, with their forces.
    pub(crate) active: ActiveSet,
    /// Where in [`State::close`] those stand that are near but not yet active.
    pub(crate) near: Roomy<usize>,
    /// The step in which each contact was last solved for, one more than its index.
    pub(crate) held: Vec<u64>,
    /// Sum of the sizes of all forces that led to those found, N.
    pub(crate) tried: f64,
    /// What the last step has overwritten of the fingers.
    pub(crate) fingers: Vec<Option<FingerBefore>>,
    /// Energy of the fingers' motion before it, J.
    pub(crate) finger_energy: f64,
}

impl Scratch {
    /// Room for every contact and finger of the model.
    pub fn new(model: &Model) -> Scratch {
        let contacts = model.contacts.len() + model.finger_slots;
        let grid = || Field::new(&model.grid);
        let stiffness = model.stiffness(model.string.tension);
        Scratch {
            instructions: Instructions::best(),
            kernel: Kernel::new(model),
            weights: Weights::new(model, &stiffness, &model.coasting),
            loss: 0.0,
            coasting: model.coasting,
            stiffness,
            shape: Shape::default(),
            string_energy: 0.0,
            stretching: 0.0,
            squares: 0.0,
            motion: grid(),
            displacement: grid(),
            solver: Solver::with_capacity(&model.spans(), model.finger_slots),
            active: ActiveSet::with_capacity(contacts),
            near: Roomy::with_capacity(model.contacts.len()),
            held: vec![0; model.contacts.len()],
            tried: 0.0,
            fingers: vec![None; model.finger_slots],
            finger_energy: 0.0,
        }
    }

    /// From now on the string is stepped with the instructions that a processor without wide vectors (AVX2) has. The result is the
    /// same bits; this is for measuring how much faster wide vectors are.
    pub fn leave_vectors(&mut self) {
        self.instructions = Instructions::narrow();
    }

    /// Back to the state of new room, without allocating. What is not set here a step writes before it reads it:
    /// `squares`, `tried` and `finger_energy` whenever they are asked for, stiffness, loss and what follows from
    /// them where the drive has others than the step before.
    pub fn reset(&mut self) {
        let Self {
            instructions: _,
            kernel: _,
            // The next step makes them anew where its drive has another tension or loss; they stay true of each other.
            stiffness: _,
            loss: _,
            coasting: _,
            weights: _,
            shape,
            string_energy,
            stretching,
            // Every step writes it before anything reads it.
            squares: _,
            motion,
            displacement,
            solver,
            active,
            // A step that may touch something finds anew what it reads of these, and no other reads them.
            near: _,
            held,
            tried: _,
            fingers,
            finger_energy: _,
        } = self;
        active.forget();
        solver.aside.forget();
        held.fill(0);
        *shape = Shape::default();
        *string_energy = 0.0;
        *stretching = 0.0;
        fingers.fill(None);
        motion.fill(0.0);
        displacement.fill(0.0);
    }

    /// How much lower than the straight line between the points beside it the string may lie at a contact after a step, m: bent as it
    /// was at n, and by its motion from there.
    #[inline(always)]
    pub(crate) fn sag(&self, model: &Model) -> f64 {
        let sag = &model.beside.sag;
        if sag.bend == 0.0 {
            return 0.0;
        }
        let shape = if model.coasting.stretch > 0.0 {
            sag.bend * self.shape.curvature.sqrt()
        } else {
            sag.slope * self.shape.steepness.sqrt()
        };
        shape + sag.motion * self.squares.sqrt()
    }

    /// ψ, by which dⁿ⁺¹ = w − ψ v, w with the forces of contacts in it: the tension that stretching adds, in the units of the step.
    #[inline(always)]
    pub(crate) fn pull(&self, stretching: f64) -> f64 {
        -2.0 * self.coasting.stretch * stretching
    }

    /// The stiffness of the last step.
    pub fn stiffness(&self) -> &Stiffness {
        &self.stiffness
    }

    /// How far the string was stretched around the sample the last step led from, m²: the sum of squared differences
    /// between neighbours, by (δuⁿ)ᵀδ(uⁿ⁺¹ + uⁿ⁻¹)/2. 0 without tension modulation.
    pub fn stretching(&self) -> f64 {
        // (A step of a string that does not pull itself tight leaves there what plucks and contacts do.)
        if self.coasting.stretch > 0.0 { self.stretching } else { 0.0 }
    }

    /// Energy of the string as a linear one without bending at the sample the last step led from, J:
    /// what the step knew anyway.
    pub fn string_energy(&self) -> f64 {
        self.string_energy
    }

    /// Force of each active contact in the last step, N, by index: the model's contacts, then fingers.
    pub fn forces(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.active.iter().map(|active| (active.slot, active.force))
    }
}

/// A step, to be compiled for each instruction set.
struct Step<'a> {
    state: &'a mut State,
    model: &'a Model,
    drive: &'a Drive,
    scratch: &'a mut Scratch,
}

impl Pass for Step<'_> {
    type Output = Convergence;

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) -> Convergence {
        self.state.step_by(simd, self.model, self.drive, self.scratch)
    }
}

impl State {
    /// Advances the string by one step under a drive.
    ///
    /// Never allocates, never fails: the energy cannot exceed what was put in, whatever the numbers, as long as what acts is
    /// finite and the tension not above the model's `tension_limit`, for which its grid is made. (From a push that is no number
    /// on, nothing of the string is one.)
    ///
    /// # Panics
    /// When the state, the drive or its readings, or the scratch are not made for this model: heights must be as many as its
    /// contacts, or none, and of hands none may lack that has a finger.
    pub fn step(&mut self, model: &Model, drive: &Drive, scratch: &mut Scratch) -> Convergence {
        scratch.instructions.run(Step { state: self, model, drive, scratch })
    }

    /// The tension, N, at which the next step will be taken under a drive.
    #[inline]
    pub(crate) fn tension_under(&self, drive: &Drive, scratch: &Scratch) -> f64 {
        if self.lets_hands_rest(scratch) { scratch.stiffness.tension } else { drive.tension }
    }

    /// Whether there is so much energy that hands neither slide nor bend.
    #[inline(always)]
    fn lets_hands_rest(&self, scratch: &Scratch) -> bool {
        self.energy_scale.max(scratch.string_energy) > MOST_ENERGY
    }

    #[inline(always)]
    fn step_by<V: Vectors>(
        &mut self,
        simd: V,
        model: &Model,
        drive: &Drive,
        scratch: &mut Scratch,
    ) -> Convergence {
        // What is known of the energy before anything is computed.
        let resting = self.lets_hands_rest(scratch);
        let bends = drive.tension != scratch.stiffness.tension && !resting;
        if bends || drive.loss != scratch.loss {
            if bends {
                scratch.stiffness = model.stiffness(drive.tension);
            }
            scratch.loss = drive.loss;
            scratch.coasting = model.coasting_under(drive.loss);
            scratch.weights = Weights::new(model, &scratch.stiffness, &scratch.coasting);
        }
        let convergence = if model.contacts.is_empty() && self.no_finger_from == 0 {
            // Nothing of the last contact may be left in the record.
            scratch.active.clear();
            scratch.fingers.fill(None);
            scratch.tried = 0.0;
            let predicted = self.predict(simd, drive, scratch);
            self.advance::<V, false>(simd, self.would_stretch(&predicted), scratch);
            Convergence::default()
        } else {
            let predicted = self.predict(simd, drive, scratch);
            // (None of this waits for the prediction, nor the prediction for it. So much of it that is at hand fills the time
            // in which the prediction's sums are waited for.)
            self.hold(model, drive, resting, scratch);
            self.contact_step(simd, model, drive, predicted, scratch)
        };
        std::mem::swap(&mut self.displacement, &mut scratch.displacement);
        std::mem::swap(&mut self.motion, &mut scratch.motion);
        self.squares = scratch.squares;
        self.stretched = 2.0 * scratch.stretching - self.stretched;
        self.steps += 1;
        convergence
    }

    /// The motion to n + 1 without contacts and stretching, and what stretching depends on.
    #[inline(always)]
    pub(crate) fn predict<V: Vectors>(
        &mut self,
        simd: V,
        drive: &Drive,
        scratch: &mut Scratch,
    ) -> Stretching {
        let Coasting { mobility, stretch, .. } = scratch.coasting;
        let Scratch { kernel, weights, motion, shape, .. } = &mut *scratch;
        let from = (&self.displacement, &self.motion);
        let to = (&mut self.curvature, motion);
        let mut predicted = kernel.predict(simd, Prediction { weights, stretch, from, to, shape });
        let steepness = if stretch > 0.0 { self.stretched } else { scratch.shape.steepness };
        scratch.string_energy = scratch.weights.energy(self.squares, steepness);
        for push in &drive.pushes {
            self.spread(push, mobility, &mut predicted, scratch);
        }
        if let Some(push) = &drive.bridge {
            self.spread_apart(push, mobility, &mut predicted, scratch);
        }
        predicted
    }

    /// What the push of a bridge does to the prediction: by itself, so that strings without one do not pay for it.
    #[inline(never)]
    fn spread_apart(&self, push: &Push, mobility: f64, predicted: &mut Stretching, scratch: &mut Scratch) {
        self.spread(push, mobility, predicted, scratch);
    }

    /// What a push does to the prediction.
    #[inline(always)]
    fn spread(&self, push: &Push, mobility: f64, predicted: &mut Stretching, scratch: &mut Scratch) {
        let motion = mobility * push.force;
        push.reading.spread(&mut scratch.motion, motion);
        predicted.along += motion * push.reading.of(&self.curvature);
    }

    /// (δuⁿ)ᵀδ(uⁿ⁺¹ + uⁿ⁻¹)/2, m², of a prediction, the forces of contacts in it.
    #[inline(always)]
    pub(crate) fn would_stretch(&self, predicted: &Stretching) -> f64 {
        0.5 * predicted.yielding * (self.stretched - predicted.along)
    }

    /// The motion to n + 1 from the prediction; `OVER` the skyline if anything may be touched.
    #[inline(always)]
    pub(crate) fn advance<V: Vectors, const OVER: bool>(
        &self,
        simd: V,
        stretching: f64,
        scratch: &mut Scratch,
    ) -> Moved {
        scratch.stretching = stretching;
        let pull = scratch.pull(stretching);
        let Scratch { kernel, motion, displacement, .. } = scratch;
        let from = (&self.curvature, &self.displacement);
        let pass = Advance { pull, motion, from, to: displacement, skyline: &self.skyline };
        let moved = kernel.advance::<V, OVER>(simd, pass);
        scratch.squares = moved.squares;
        moved
    }
}

/// Above this energy, J, hands neither slide nor bend nor move a board: each of these multiplies what there is,
/// and if it were repeated for ever would reach infinity.
const MOST_ENERGY: f64 = 1e30;

#[cfg(test)]
mod tests;
