//! What is heard of a string.

mod mix;

use crate::body::Heard;
use crate::field::Field;
use crate::filter::Biquad;
use crate::model::{ContactKind, Model};
use crate::setup::Pickup;
use crate::state::State;
use crate::string::Scratch;
pub(crate) use mix::PickupMix;

/// Transverse force of the string on the bridge at the sample n from which the last step led, N, up is
/// positive: −T ∂ₓu + EI ∂ₓₓₓu at x = L, with the tension raised by stretching. The bridge is `lift` m up.
///
/// The string goes on oddly beyond the bridge, so that its four last points give ∂ₓu up to an error of h⁸ and ∂ₓₓₓu to one of
/// h⁶. (One point would give ∂ₓu up to an error of h², which is 2 dB of treble at a third of the grid's own bandwidth.)
pub fn bridge_force(model: &Model, scratch: &Scratch, lift: f64) -> f64 {
    let h = model.grid.spacing;
    // After a step the scratch holds uⁿ. The shortest string has its nut for the fourth point.
    let line = |away: usize| lift * (1.0 - away as f64 / model.grid.intervals as f64);
    let point = |away: usize| scratch.displacement[model.grid.cell(model.grid.intervals - away)] - line(away);
    let [slope, bend] = end_shape([point(1), point(2), point(3), point(4)]);
    let tension = scratch.stiffness().tension + stretch_tension(model, scratch);
    let bending = model.string.linear_density * model.string.kappa_squared();
    (tension * slope / h - tension * lift / model.grid.length) + bending * bend / (h * h * h)
}

/// −h ∂ₓu and h³ ∂ₓₓₓu of a string at its end x = L, m, from the displacements h, 2h, 3h and 4h before it, m.
pub fn end_shape(near: [f64; 4]) -> [f64; 2] {
    [SLOPE, BEND].map(|[a, b, c, d]| (a * near[0] + b * near[1]) + (c * near[2] + d * near[3]))
}

/// h ∂ₓu of an odd function at 0 by its values at h, 2h, 3h and 4h.
const SLOPE: [f64; 4] = [1.6, -0.4, 8.0 / 105.0, -1.0 / 140.0];

/// −h³ ∂ₓₓₓu likewise.
const BEND: [f64; 4] = [61.0 / 15.0, -169.0 / 60.0, 0.6, -7.0 / 120.0];

/// What the slope of a flexible string at its end has of a force of 1 N upwards at the points h, 2h and 3h before it, N. The string
/// is bent there: −T ∂ₓu is more by 1 N beyond that point than before it, and what four points make of the end sees a part of that.
const BENT: [f64; 3] = [SLOPE[1] + 2.0 * SLOPE[2] + 3.0 * SLOPE[3], SLOPE[2] + 2.0 * SLOPE[3], SLOPE[3]];

/// Force of the string on what holds it up from the contact of index `from` on, N, up is positive, at the sample n from which
/// the last step led: the more a string wraps over a wide bridge the less of it is seen at its end.
fn wrapped(model: &Model, scratch: &Scratch, from: usize) -> f64 {
    let fixed = from..model.contacts.len();
    let pressed = scratch.active.iter().filter(|active| fixed.contains(&active.slot));
    let held = pressed.map(|active| {
        let bent = match model.contacts[active.slot].kind {
            ContactKind::Board { node } => BENT.get(model.grid.intervals - node - 1).copied().unwrap_or(0.0),
            ContactKind::Fret { .. } => 0.0,
        };
        (1.0 - bent) * active.force
    });
    held.fold(0.0, |sum, force| sum - force)
}

/// Tension added by stretching at n, EA/(2L)·∫(∂ₓu)² dx, N, as the step had it; 0 where the string has no tension modulation.
pub fn stretch_tension(model: &Model, scratch: &Scratch) -> f64 {
    model.string.stretch_tension(scratch.stretching(), model.grid.spacing)
}

/// What is heard of one string.
#[derive(Debug, Clone)]
pub(crate) struct Listener {
    ears: [Option<Ear>; 2],
}

/// One pickup over one string.
#[derive(Debug, Clone)]
struct Ear {
    source: Source,
    share: f64,
    coil: Biquad,
    block: Biquad,
    /// Whether what it hears first has been there for ever: the force of a string that is pressed is no thump.
    begins: bool,
}

#[derive(Debug, Clone)]
enum Source {
    /// Velocity averaged over the coil's field: points of the string, each with its weight, 1/s.
    Coil(Vec<(usize, f64)>),
    /// The force on the bridge: on its edge, and on the contacts from this index on.
    Bridge { from: usize },
    /// What the body sends out.
    Air,
}

/// Points at which the field of a coil is sampled, a Gauss–Legendre rule of five: exact for all that a
/// string can do within 2 cm.
pub(crate) const FIELD: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Below this nothing is music, and the force of a pressed string on the bridge has a constant part, Hz.
const LOWEST: f64 = 18.0;

impl Listener {
    /// The pickups of a set-up over one string; those that are not heard are left out.
    pub fn new(mix: &PickupMix, model: &Model, sample_rate: f64) -> Self {
        let from = model.contacts.partition_point(|contact| contact.place < mix.bridge);
        let ears = mix.parts.map(|(pickup, share)| {
            (share != 0.0).then(|| Ear::new(&pickup, from, share, model, sample_rate))
        });
        Listener { ears }
    }

    /// The signal after a step: volts of an arbitrary coil, newtons or pascals.
    #[inline]
    pub fn hear(&mut self, model: &Model, state: &State, scratch: &Scratch, heard: Heard) -> f64 {
        self.ears
            .iter_mut()
            .flatten()
            .map(|ear| ear.hear(model, state, scratch, heard))
            .fold(0.0, |a, b| a + b)
    }

    /// The signal of a string at rest, over a body that may ring.
    #[inline]
    pub fn hear_nothing(&mut self, heard: Heard) -> f64 {
        self.ears.iter_mut().flatten().map(|ear| ear.hear_nothing(heard)).fold(0.0, |a, b| a + b)
    }

    /// Whether nothing is left to be heard of the past.
    pub fn is_still(&mut self) -> bool {
        self.ears.iter_mut().flatten().all(Ear::is_still)
    }

    /// All that filter what is heard.
    #[cfg(test)]
    pub fn filters(&self) -> impl Iterator<Item = &Biquad> {
        self.ears.iter().flatten().flat_map(|ear| [&ear.coil, &ear.block])
    }

    /// Takes over what the filters of another listener remember, each from one that has heard the same.
    pub fn take_over(&mut self, old: &Listener) {
        for ear in self.ears.iter_mut().flatten() {
            let same =
                |old: &&Ear| std::mem::discriminant(&old.source) == std::mem::discriminant(&ear.source);
            match old.ears.iter().flatten().find(same) {
                Some(old) => {
                    ear.coil.take_over(&old.coil);
                    ear.block.take_over(&old.block);
                }
                None => ear.begins = true,
            }
        }
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        for ear in self.ears.iter_mut().flatten() {
            ear.coil.reset();
            ear.block.reset();
            ear.begins = false;
        }
    }
}

impl Ear {
    fn new(pickup: &Pickup, from: usize, share: f64, model: &Model, sample_rate: f64) -> Self {
        let block = Biquad::high_pass(LOWEST, sample_rate);
        match *pickup {
            Pickup::Microphone {} => {
                Ear { source: Source::Air, share, coil: Biquad::through(), block, begins: false }
            }
            Pickup::Bridge {} => {
                Ear { source: Source::Bridge { from }, share, coil: Biquad::through(), block, begins: false }
            }
            Pickup::Magnetic { position, aperture, resonance, quality } => {
                let end = model.grid.length;
                let middle = end - position;
                let mut sum = Field::new(&model.grid);
                for (offset, weight) in FIELD {
                    let place = (middle + 0.5 * aperture * offset).clamp(1e-6 * end, (1.0 - 1e-6) * end);
                    let share = 0.5 * weight / model.grid.time_step;
                    model.grid.reading(place).spread(&mut sum, share);
                }
                let cells = (1..model.grid.intervals).map(|node| model.grid.cell(node));
                let weights =
                    cells.map(|cell| (cell, sum[cell])).filter(|(_, weight)| *weight != 0.0).collect();
                let coil = Biquad::resonance(resonance, quality, sample_rate);
                Ear { source: Source::Coil(weights), share, coil, block, begins: false }
            }
        }
    }

    #[inline]
    fn hear(&mut self, model: &Model, state: &State, scratch: &Scratch, heard: Heard) -> f64 {
        let signal = match &self.source {
            Source::Bridge { from } => {
                bridge_force(model, scratch, heard.lift) + wrapped(model, scratch, *from)
            }
            Source::Air => heard.pressure,
            Source::Coil(weights) => weights.iter().map(|&(cell, weight)| state.motion[cell] * weight).sum(),
        };
        let signal = self.coil.next(signal);
        if self.begins {
            self.block.settle(signal);
            self.begins = false;
        }
        self.share * self.block.next(signal)
    }

    #[inline]
    fn hear_nothing(&mut self, heard: Heard) -> f64 {
        self.begins = false;
        let signal = match self.source {
            Source::Air => heard.pressure,
            Source::Bridge { .. } => heard.straight,
            Source::Coil(_) => 0.0,
        };
        if signal == 0.0 && self.is_still() {
            return 0.0;
        }
        self.share * self.block.next(self.coil.next(signal))
    }

    fn is_still(&mut self) -> bool {
        self.coil.is_still() && self.block.is_still()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::{Drive, Push};
    use crate::model::StringParameters;
    use crate::scene::SolverSettings;
    use crate::setup::Setup;

    /// A string at rest is pulled down by 1 N over a wide bridge, on which it comes to lie. However many points that are, the
    /// bridge has T times the slope before them. Flexible, so that its shape at rest is of straight pieces.
    #[test]
    fn a_wide_bridge_bears_the_slope_before_it() {
        let setup = Setup::shipped("sitar").expect("it comes with the program");
        let spec = &setup.string[4];
        let string = StringParameters {
            youngs_modulus: 0.0,
            loss_0: 200.0,
            loss_1: 0.0,
            tension_modulation: false,
            ..crate::intonation::flexible(&setup, spec)
        };
        let barrier = setup.barrier(&[]).expect("it has one");
        for rate in [48_000.0, 96_000.0, 192_000.0] {
            let model =
                Model::new(string, Some(&barrier), 0, SolverSettings::default(), rate).expect("it can be");
            let (mut state, mut scratch, mut drive) =
                (State::new(&model), Scratch::new(&model), Drive::new(&model));
            drive.pushes.push(Push { reading: model.grid.reading(0.3), force: -1.0 });
            (0..(0.3 * rate) as usize).for_each(|_| _ = state.step(&model, &drive, &mut scratch));
            let bridge = setup.neck.scale_length - 0.04;
            let from = model.contacts.partition_point(|contact| contact.place < bridge);
            let (end, wrapped) = (bridge_force(&model, &scratch, 0.0), wrapped(&model, &scratch, from));
            let places = (0.45 / model.grid.spacing) as usize;
            let [here, next] = [places, places + 1].map(|node| scratch.displacement[model.grid.cell(node)]);
            let slope = -string.tension * (next - here) / model.grid.spacing;
            // Nine tenths of the force and more are the bridge's: 0.906 at 48 kHz, where the end sees the most of what bends it close by.
            assert!(wrapped < 0.9 * slope && slope < -0.4, "it lies on the bridge: {wrapped} of {slope} N");
            // Straight pieces leave nothing out, and after 60 times 1/σ₀ nothing moves. The solver stops at penetrations of 1e-15 m,
            // T/h times which are some 1e-11 N at each point.
            assert!(
                (end + wrapped - slope).abs() < 1e-10,
                "{rate} Hz: {end} and {wrapped}, {slope} N before it"
            );
        }
    }
}
