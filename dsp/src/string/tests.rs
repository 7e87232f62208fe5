//! What a step keeps for those who ask.

use crate::curve::Curve;
use crate::drive::Drive;
use crate::model::{Model, StringParameters};
use crate::scene::SolverSettings;
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

/// What a string is taken to sag is no less than it may, whether or not the sum of the squares of its second differences is known:
/// its second differences are those that it had a step before, and those of its motion.
#[test]
fn a_string_sags_no_more_than_it_is_taken_to() {
    for tension_modulation in [false, true] {
        let string = StringParameters { tension_modulation, ..STRING };
        let mut model =
            Model::new(string, None, 0, SolverSettings::default(), 48e3).expect("it can be built");
        model.beside.sag = 0.125;
        let place = |node: usize| model.grid.place(node);
        let peak =
            |node: usize, height| [[place(node - 1), 0.0], [place(node), height], [place(node + 1), 0.0]];
        let zigzag =
            (0..=model.grid.intervals).map(|node| [place(node), if node % 2 == 0 { 1e-3 } else { -1e-3 }]);
        let shapes = [peak(1, 1e-3).to_vec(), peak(20, -1e-3).to_vec(), zigzag.collect()];
        for (index, shape) in shapes.into_iter().enumerate() {
            let (mut state, mut scratch) = (State::new(&model), Scratch::new(&model));
            state.set_shape(&model, &Curve::Points(shape));
            let largest_bend = |state: &State| {
                let ends = || std::iter::once(0.0);
                let u: Vec<f64> = ends().chain(state.displacement()).chain(ends()).collect();
                u.windows(3).map(|u| ((u[2] - u[1]) - (u[1] - u[0])).abs()).fold(0.0, f64::max)
            };
            let bent = largest_bend(&state);
            for step in 0..30 {
                state.step(&model, &Drive::new(&model), &mut scratch);
                let (sag, true_sag) = (scratch.sag(&model), 0.125 * largest_bend(&state));
                let case = format!("{tension_modulation}, shape {index}, step {step}: {sag} m, {true_sag} m");
                assert!(sag >= true_sag * (1.0 - 1e-12), "{case}");
                // And no more than is needed to be sure. A single point, height 1, is bent by 2, its second differences are 1, −2 and
                // 1, which makes √6, and by the limit of stability its first step is no more than these: √6·√6.
                let most = 0.5 * (f64::sqrt(6.0) + 6.0) * bent;
                assert!(step > 0 || index == 2 || sag <= 0.125 * most, "{case}");
            }
        }
    }
}
