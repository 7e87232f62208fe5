//! What a step keeps for those who ask.

use crate::curve::Curve;
use crate::drive::Drive;
use crate::model::{Model, StringParameters};
use crate::scene::SolverSettings;
use crate::skyline::Sag;
use crate::state::State;
use crate::string::Scratch;

const STRING: StringParameters = StringParameters {
    length: 0.65,
    linear_density: 5.25e-3,
    tension: 60.0,
    tension_limit: 60.0,
    youngs_modulus: 2e11,
    core_radius: 1e-4,
    loss_0: 1.0,
    loss_1: 1e-5,
    tension_modulation: false,
};

/// What a string is taken to sag is no less than it does at any point, whether or not the sum of the squares of its second differences
/// is known: its second differences are those that it had a step before, and those of its motion.
#[test]
fn a_string_sags_no_more_than_it_is_taken_to() {
    for (tension_modulation, part) in
        [false, true].into_iter().flat_map(|on| [0.1, 0.5, 0.8].map(|p| (on, p)))
    {
        let string = StringParameters { tension_modulation, ..STRING };
        let mut model =
            Model::new(string, None, 0, SolverSettings::default(), 48e3).expect("it can be built");
        model.beside.sag = Sag::at(part);
        let Sag { bend, slope, motion } = model.beside.sag;
        let place = |node: usize| model.grid.place(node);
        let peak =
            |node: usize, height| [[place(node - 1), 0.0], [place(node), height], [place(node + 1), 0.0]];
        let zigzag =
            (0..=model.grid.intervals).map(|node| [place(node), if node % 2 == 0 { 1e-3 } else { -1e-3 }]);
        let shapes = [peak(1, 1e-3).to_vec(), peak(20, -1e-3).to_vec(), zigzag.collect()];
        for (index, shape) in shapes.into_iter().enumerate() {
            let (mut state, mut scratch) = (State::new(&model), Scratch::new(&model));
            state.set_shape(&model, &Curve::Points(shape));
            let true_sag = |state: &State| {
                let ends = || std::iter::once(0.0);
                let u: Vec<f64> = ends().chain(state.displacement()).chain(ends()).collect();
                let inner = 1..model.grid.intervals - 1;
                let straight = |node: usize| u[node] + part * (u[node + 1] - u[node]);
                let read = |node: usize| model.grid.reading((node as f64 + part) * model.grid.spacing);
                inner.map(|node| straight(node) - read(node).of(&state.displacement)).fold(0.0, f64::max)
            };
            for step in 0..30 {
                state.step(&model, &Drive::new(&model), &mut scratch);
                let (sag, true_sag) = (scratch.sag(&model), true_sag(&state));
                let case = format!(
                    "{tension_modulation}, {part}, shape {index}, step {step}: {sag} m, {true_sag} m"
                );
                assert!(sag >= true_sag - 1e-15, "{case}");
                // And no more than is needed to be sure. A single point, height 1, has differences 1 and −1, second ones 1, −2 and 1,
                // and by the limit of stability its first step is no more than these.
                let shape = if tension_modulation { bend * f64::sqrt(6.0) } else { slope * f64::sqrt(2.0) };
                let most = 1e-3 * (shape + motion * f64::sqrt(6.0));
                assert!(step > 0 || index == 2 || sag <= most, "{case}");
            }
        }
    }
}
