//! What is asleep cannot be touched, and what is close is known as it is.

use super::WAKING;
use crate::drive::{Drive, Push};
use crate::gesture::Touch;
use crate::model::{Model, StringParameters};
use crate::scene::SolverSettings;
use crate::setup::Setup;
use crate::state::State;
use crate::string::Scratch;

/// A low E over the neck of the electric guitar.
fn low_e() -> (Model, Touch) {
    let setup = Setup::builtin("electric").expect("it is built in");
    let string = StringParameters {
        length: setup.neck.scale_length,
        linear_density: 6.8e-3,
        tension: 78.0,
        tension_limit: 100.0,
        youngs_modulus: 2e11,
        core_radius: 2e-4,
        loss_0: 1.0,
        loss_1: 1e-4,
        tension_modulation: true,
    };
    let barrier = setup.neck.barrier(&setup.neck.equal_places()).expect("its values are in range");
    let model = Model::new(string, Some(&barrier), 1, SolverSettings::default(), 48e3);
    (model.expect("it can be built"), setup.player.fretting.touch)
}

/// A drive in which a finger presses from the 6000th step on and slides from the 9000th, the string is plucked ever harder, and
/// board and frets rise and sink again for a while.
fn drive_at(step: usize, model: &Model, drive: &mut Drive) {
    drive.pushes.clear();
    if step % 3000 < 150 {
        let force = 0.5 * (1 + step / 3000) as f64;
        drive.pushes.push(Push { reading: model.grid.reading(0.5), force });
    }
    drive.hands[0].force = 8.0;
    drive.hands[0].position = 0.12 + 1e-5 * step.saturating_sub(9000).min(3000) as f64;
    drive.heights.clear();
    if (15_000..18_000).contains(&step) {
        let lift = 2e-4 * (0.01 * (step - 15_000) as f64).sin().powi(2);
        drive.heights.extend(model.contacts.iter().map(|contact| contact.height + lift));
    }
}

#[test]
fn what_is_asleep_cannot_be_touched() {
    let (model, touch) = low_e();
    let (mut state, mut scratch, mut drive) = (State::new(&model), Scratch::new(&model), Drive::new(&model));
    let displacements = |state: &State| -> Vec<f64> {
        model.contacts.iter().map(|contact| contact.reading.of(&state.displacement)).collect()
    };
    let (mut sleeping, mut close_ones, mut woken, mut repeats) = (0, 0, 0, 0);
    let mut slept = vec![false; model.contacts.len()];
    for step in 0..20_000 {
        drive_at(step, &model, &mut drive);
        if step == 6000 {
            state.place_finger(&model, 0, touch, 0.12, 1e-3, 0.0).expect("it is over the string");
        }
        let past = displacements(&state);
        let heights = state.heights.clone();
        repeats += state.step(&model, &drive, &mut scratch).repeats;
        let now = displacements(&state);
        let motion = (state.squares / model.grid.unknowns() as f64).sqrt();
        assert!(state.close.is_sorted_by(|a, b| a.index < b.index), "step {step}");
        for index in 0..model.contacts.len() {
            let over = now[index] - state.heights[index];
            let close = state.close.iter().find(|close| close.index as usize == index);
            assert!(close.is_some() != state.asleep[index].is_some(), "step {step}, {index}");
            let Some(close) = close else {
                // (But for rounding.)
                assert!(over > WAKING * motion * (1.0 - 1e-9), "step {step}, {index}: {over} m");
                sleeping += 1;
                slept[index] = true;
                continue;
            };
            assert_eq!(close.displacement, now[index], "step {step}, {index}");
            assert_eq!(close.now.depth.penetration, -over, "step {step}, {index}");
            assert_eq!(close.before.penetration, heights[index] - past[index], "step {step}, {index}");
            close_ones += 1;
            woken += usize::from(std::mem::take(&mut slept[index]));
        }
    }
    // It is no test of nothing.
    println!("{sleeping} asleep, {close_ones} close, {woken} of them woken, {repeats} steps repeated");
    assert!(sleeping > close_ones && close_ones > 20_000 && woken > 1000 && repeats > 0);
}
