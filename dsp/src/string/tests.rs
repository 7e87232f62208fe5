//! What a step keeps for those who ask.

use crate::curve::Curve;
use crate::drive::{Drive, Push};
use crate::gesture::Touch;
use crate::model::{Model, StringParameters};
use crate::scene::SolverSettings;
use crate::setup::Setup;
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

/// Of what stood in its room before, a step believes nothing that is no longer so: as fingers come, go, slide and take each other's
/// places, and the string strikes frets, used room gives the bits that new room gives in every step.
#[test]
fn used_room_is_as_good_as_new() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let length = setup.neck.scale_length;
    let barrier = setup.neck.barrier(&setup.neck.equal_places()).expect("its values are in range");
    let string = StringParameters { length, tension_limit: 80.0, tension_modulation: true, ..STRING };
    let model = Model::new(string, Some(&barrier), 2, SolverSettings::default(), 48e3);
    let model = model.expect("it can be built");
    let touch = setup.player.fretting.touch;
    let touches = [
        touch,
        Touch { stiffness: 0.1 * touch.stiffness, ..touch },
        Touch { exponent: 1.5, ..touch },
        Touch { mass: 2.0 * touch.mass, ..touch },
    ];
    let (mut state, mut scratch, mut drive) = (State::new(&model), Scratch::new(&model), Drive::new(&model));
    let mut other = state.clone();
    let (mut placed, mut active) = (0, 0);
    for step in 0..24_000 {
        drive.pushes.clear();
        if step % 1500 < 100 {
            drive.pushes.push(Push { reading: model.grid.reading(0.5), force: 1.5 });
        }
        if step % 241 == 0 {
            let (slot, position) = (step / 241 % 2, [0.12, 0.2, 0.27][step / 482 % 3]);
            if step % 7 == 0 {
                [&mut state, &mut other].into_iter().for_each(|state| state.remove_finger(slot));
            } else {
                for state in [&mut state, &mut other] {
                    let touch = touches[step / 723 % touches.len()];
                    state
                        .place_finger(&model, slot, touch, position, 1e-4, 0.0)
                        .expect("it is over the string");
                }
                placed += 1;
            }
            drive.hands[slot].position = position;
            drive.hands[slot].force = 6.0;
        }
        if step / 500 % 3 == 1 {
            drive.hands[0].position += 1e-5;
        }
        active += state.step(&model, &drive, &mut scratch).active;
        other.step(&model, &drive, &mut Scratch::new(&model));
        assert!(state.displacement().eq(other.displacement()), "step {step}");
    }
    // It is no test of nothing.
    println!("{placed} fingers placed, {active} contacts in all steps");
    assert!(placed > 80 && active > 20_000);
}
