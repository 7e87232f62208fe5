//! What a step keeps for those who ask.

use crate::curve::Curve;
use crate::drive::Drive;
use crate::model::{Model, StringParameters};
use crate::scene::SolverSettings;
use crate::skyline::SAG;
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

/// The margin is no less than the string hangs through between two points, whether or not the sum of the squares of its second
/// differences is known, and where it is not, of a single bent point no more.
#[test]
fn the_margin_has_room_for_what_hangs_between_points() {
    for tension_modulation in [false, true] {
        let string = StringParameters { tension_modulation, ..STRING };
        let model = Model::new(string, None, 0, SolverSettings::default(), 48e3).expect("it can be built");
        let place = |node: usize| model.grid.place(node);
        let peak =
            |node: usize, height| [[place(node - 1), 0.0], [place(node), height], [place(node + 1), 0.0]];
        let zigzag =
            (0..=model.grid.intervals).map(|node| [place(node), if node % 2 == 0 { 1e-3 } else { -1e-3 }]);
        let shapes = [peak(1, 1e-3).to_vec(), peak(20, -1e-3).to_vec(), zigzag.collect()];
        for (index, shape) in shapes.into_iter().enumerate() {
            let (mut state, mut scratch) = (State::new(&model), Scratch::new(&model));
            state.set_shape(&model, &Curve::Points(shape));
            let ends = || std::iter::once(0.0);
            let u: Vec<f64> = ends().chain(state.displacement()).chain(ends()).collect();
            let bends = u.windows(3).map(|u| ((u[2] - u[1]) - (u[1] - u[0])).abs());
            let sag = SAG * bends.fold(0.0, f64::max);
            state.step(&model, &Drive::new(&model), &mut scratch);
            let margin = scratch.margin(&model, 0.0, 0.0);
            let case = format!("{tension_modulation}, shape {index}: {margin} m, {sag} m");
            assert!(margin >= sag * (1.0 - 1e-12), "{case}");
            assert!(tension_modulation || index == 2 || margin <= sag * (1.0 + 1e-12), "{case}");
            // And for what is near, and what moves.
            assert!((scratch.margin(&model, 0.1, 0.2) - margin - 0.1 - 4.0 * SAG * 0.2).abs() < 1e-15);
        }
    }
}
