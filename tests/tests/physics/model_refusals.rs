//! Promise: whoever builds a model without a scene is told, by name and value, of what no string, board, fret or finger can be;
//! nothing is compiled of it.

use low_action_dsp::contact::ContactLaw;
use low_action_dsp::curve::{CountOrList, Curve, OneOrEach};
use low_action_dsp::drive::Push;
use low_action_dsp::scene::FretPlacement;
use low_action_dsp::{
    Barrier, Drive, Ledger, Model, Scene, Scratch, Simulation, SolverSettings, State, StringParameters, Touch,
};

const RATE: f64 = 48_000.0;

const STRING: StringParameters = StringParameters {
    length: 0.65,
    linear_density: 5.25e-3,
    tension: 60.0,
    tension_limit: 70.0,
    youngs_modulus: 2e11,
    core_radius: 4.3e-4,
    loss_0: 1.0,
    loss_1: 1e-4,
    tension_modulation: true,
};

fn barrier() -> Barrier {
    Barrier {
        law: ContactLaw::new("fretboard", 1e10, 1.5).expect("it is a law"),
        damping: 0.3,
        board: Some(Curve::Points(vec![[0.0, -2e-3], [0.5, -2.5e-3]])),
        frets: vec![[0.04, -1e-3], [0.08, -1e-3]],
        placement: FretPlacement::Kinked,
        board_reference_spacing: Some(5e-3),
    }
}

#[track_caller]
fn assert_refused(built: Result<Model, low_action_dsp::Error>, words: &[&str]) {
    let said = built.map(|model| model.grid.intervals).expect_err("it is refused").to_string();
    assert!(!said.contains('\n'), "{said}");
    for word in words {
        assert!(said.contains(word), "`{word}` is not in `{said}`");
    }
}

#[test]
fn the_model_itself_is_accepted() {
    for barrier in [None, Some(barrier())] {
        let built = Model::new(STRING, barrier.as_ref(), 2, SolverSettings::default(), RATE);
        assert!(built.expect("it can be built").grid.intervals > 50);
    }
    // An ideal string, and one that is never bent beyond its own tension.
    let ideal =
        StringParameters { youngs_modulus: 0.0, core_radius: 0.0, loss_0: 0.0, loss_1: 0.0, ..STRING };
    assert!(Model::new(ideal, None, 0, SolverSettings::default(), RATE).is_ok());
}

#[test]
fn strings_that_cannot_be_are_refused() {
    let build = |string| Model::new(string, None, 0, SolverSettings::default(), RATE);
    for (wrong, shown) in [(-1.0, "-1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let refused = |name: &str, string| {
            assert_refused(
                build(string),
                &[&format!("{name} = {shown} is refused: it must be"), "and finite"],
            );
        };
        refused("length", StringParameters { length: wrong, ..STRING });
        refused("linear_density", StringParameters { linear_density: wrong, ..STRING });
        refused("tension", StringParameters { tension: wrong, ..STRING });
        refused("tension_limit", StringParameters { tension_limit: wrong, ..STRING });
        refused("youngs_modulus", StringParameters { youngs_modulus: wrong, ..STRING });
        refused("core_radius", StringParameters { core_radius: wrong, ..STRING });
        refused("loss_1", StringParameters { loss_1: wrong, ..STRING });
    }
    assert_refused(build(StringParameters { tension: 0.0, ..STRING }), &["tension = 0", "above 0 N"]);
    assert_refused(build(StringParameters { linear_density: 0.0, ..STRING }), &["above 0 kg/m"]);
}

/// Where a step leaves nothing of a motion, its loss would be infinite and the balance no number.
#[test]
fn losses_are_refused_of_which_no_double_could_tell() {
    for rate in [1e3, RATE, 1e7] {
        let build = |loss_0| {
            let string = StringParameters { loss_0, ..STRING };
            Model::new(string, None, 0, SolverSettings::default(), rate)
        };
        for (wrong, shown) in
            [(-1.0, "-1"), (1.001e12, "1.001e12"), (1e21, "1e21"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")]
        {
            let words = format!("loss_0 = {shown} is refused: it must lie between 0 and 1e12 1/s");
            assert_refused(build(wrong), &[&words]);
        }
        // The largest that is accepted is realised, and its balance closes.
        let model = build(1e12).expect("it can be built");
        assert!((model.string.loss_0 / 1e12 - 1.0).abs() < 1e-7, "{rate} Hz: {} 1/s", model.string.loss_0);
        let (mut state, mut scratch) = (State::new(&model), Scratch::new(&model));
        let mut drive = Drive::new(&model);
        drive.pushes.push(Push { reading: model.grid.reading(0.3), force: 10.0 });
        let mut ledger = Ledger::new(&model, &state, model.string.tension);
        for _ in 0..100 {
            state.step(&model, &drive, &mut scratch);
            ledger.record(&model, &state, &scratch, &drive);
        }
        assert!(ledger.put_in > 0.0, "{rate} Hz: {} J", ledger.put_in);
        assert!(ledger.residual_sum.abs() <= 1e-12 * ledger.put_in, "{rate} Hz: {} J", ledger.residual_sum);
    }
}

/// Of a program: gestures and scenes never come so far.
#[test]
fn fingers_that_cannot_be_are_refused() {
    const FINGER: Touch =
        Touch { mass: 5e-3, stiffness: 1e7, exponent: 2.0, damping: 1.0, hand_damping: 5.0 };
    let model = Model::new(STRING, None, 2, SolverSettings::default(), RATE).expect("it can be built");
    let place = |touch, [position, height, velocity]: [f64; 3]| {
        let mut state = State::new(&model);
        let placed = state.place_finger(&model, 1, touch, position, height, velocity);
        assert_eq!(placed.is_ok(), state.fingers()[1].is_some());
        placed.map_err(|error| error.to_string())
    };
    let there = [0.3, 1e-3, -1.0];
    assert_eq!(place(FINGER, there), Ok(()));
    let refused = |placed: Result<(), String>, words: &str| {
        let said = placed.expect_err("it is refused");
        assert!(said.starts_with(words) && !said.contains('\n'), "`{words}` does not begin `{said}`");
    };
    for (wrong, shown) in [(-1.0, "-1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        for (name, touch) in [
            ("mass", Touch { mass: wrong, ..FINGER }),
            ("stiffness", Touch { stiffness: wrong, ..FINGER }),
            ("exponent", Touch { exponent: wrong, ..FINGER }),
            ("damping", Touch { damping: wrong, ..FINGER }),
            ("hand_damping", Touch { hand_damping: wrong, ..FINGER }),
        ] {
            refused(
                place(touch, there),
                &format!("finger.{name} = {shown} is refused: it must lie between "),
            );
        }
    }
    refused(
        place(FINGER, [0.3, -1e160, -1.0]),
        "finger.height = -1e160 is refused: it must lie between -1e30 and 1e30 m",
    );
    refused(
        place(Touch { mass: 0.0, ..FINGER }, there),
        "finger.mass = 0 is refused: it must lie between 1e-7 and 1000 kg",
    );
    for (wrong, shown) in [(-1e4, "-10000"), (1e4, "10000"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        for (begins, name, range) in [
            ([wrong, 1e-3, -1.0], "position", "it must lie on the string, above 0 and below 0.65 m"),
            ([0.3, wrong, -1.0], "height", "it must lie between -1e30 and 1e30 m"),
            ([0.3, 1e-3, wrong], "velocity", "it must lie between -1000 and 1000 m/s"),
        ] {
            // Over a string that swings far it may be anywhere.
            if name == "height" && wrong.is_finite() {
                assert_eq!(place(FINGER, begins), Ok(()));
            } else {
                refused(place(FINGER, begins), &format!("finger.{name} = {shown} is refused: {range}"));
            }
        }
    }
}

#[test]
fn rates_and_solvers_that_cannot_be_are_refused() {
    for rate in [0.0, -RATE, 999.0, 2e7, f64::NAN, f64::INFINITY] {
        let built = Model::new(STRING, None, 0, SolverSettings::default(), rate);
        assert_refused(built, &["sample_rate", "between 1000 and 1e7 Hz"]);
    }
    let endless = SolverSettings { max_iterations: 1_000_000, ..SolverSettings::default() };
    assert_refused(Model::new(STRING, None, 0, endless, RATE), &["solver.max_iterations = 1e6", "1000"]);
    let vague = SolverSettings { tolerance: f64::NAN, ..SolverSettings::default() };
    assert_refused(Model::new(STRING, None, 0, vague, RATE), &["solver.tolerance = NaN", "0.001 m"]);
}

#[test]
fn more_fingers_than_there_is_memory_for_are_refused() {
    for slots in [101, usize::MAX] {
        let built = Model::new(STRING, None, slots, SolverSettings::default(), RATE);
        assert_refused(built, &["finger_slots = ", "between 0 and 100"]);
    }
}

/// Descriptions that no file can hold, but a program.
#[test]
fn fretboards_that_cannot_be_are_refused() {
    let text = "sample_rate = 48000\nduration = 0.01\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\ntension = 60.0\n\
                [fretboard]\nstiffness = 1e10\nexponent = 1.5\nfrets = 3\nfret_top = -1e-3\n";
    let scene = Scene::from_toml(text).expect("it is a scene");
    let board = scene.fretboard.clone().expect("it has a board");
    for (frets, fret_top, words) in [
        (CountOrList::Count(641), OneOrEach::One(-1e-3), ["fretboard.frets = 641", "between 0 and 640"]),
        (CountOrList::Count(usize::MAX), OneOrEach::One(-1e-3), ["fretboard.frets = ", "between 0 and 640"]),
        (
            CountOrList::List(vec![0.1; 1001]),
            OneOrEach::One(-1e-3),
            ["number of fretboard.frets = 1001", "1000"],
        ),
        (CountOrList::Count(3), OneOrEach::Each(Vec::new()), ["fretboard.fret_top", "the 3 frets"]),
    ] {
        let mut board = board.clone();
        (board.frets, board.fret_top) = (frets, Some(fret_top));
        let refused = [
            Barrier::from_spec(&board, 0.65).map(|_| ()),
            Simulation::new(&Scene { fretboard: Some(board.clone()), ..scene.clone() }).map(|_| ()),
        ];
        for said in refused.map(|built| built.expect_err("it is refused").to_string()) {
            assert!(words.iter().all(|word| said.contains(word)), "{said}");
        }
    }
}

#[test]
fn boards_and_frets_that_cannot_be_are_refused() {
    let build = |barrier: Barrier| Model::new(STRING, Some(&barrier), 0, SolverSettings::default(), RATE);
    let points = |points: &[[f64; 2]]| Some(Curve::Points(points.to_vec()));
    assert_refused(build(Barrier { damping: -0.3, ..barrier() }), &["fretboard.damping = -0.3", "s/m"]);
    assert_refused(build(Barrier { board: points(&[]), ..barrier() }), &["fretboard.board", "at least one"]);
    assert_refused(
        build(Barrier { board: points(&[[0.3, -1e-3], [0.2, -1e-3]]), ..barrier() }),
        &["place of point 2 of fretboard.board = 0.2", "above"],
    );
    assert_refused(
        build(Barrier { board: Some(Curve::Constant(f64::NAN)), ..barrier() }),
        &["fretboard.board = NaN", "between -10 and 10 m"],
    );
    assert_refused(
        build(Barrier { frets: vec![[0.04, -1e-3], [0.08, f64::NAN]], ..barrier() }),
        &["fretboard.fret_top[2] = NaN", "between -10 and 10 m"],
    );
    assert_refused(
        build(Barrier { frets: vec![[0.66, -1e-3]], ..barrier() }),
        &["fretboard.frets[1] = 0.66", "below 0.65 m"],
    );
    assert_refused(
        build(Barrier { board_reference_spacing: Some(0.0), ..barrier() }),
        &["fretboard.board_reference_spacing = 0", "1e-6"],
    );
    for (wrong, shown) in [(f64::NAN, "NaN"), (-1e10, "-1e10"), (0.0, "0"), (f64::INFINITY, "inf")] {
        let law = barrier().law.with_stiffness(wrong);
        let words = format!("fretboard.stiffness = {shown} is refused: it must lie between 0.001 and 1e30");
        assert_refused(build(Barrier { law, ..barrier() }), &[&words]);
    }
}

/// As many as a scene may have; and so crowded that how each answers each would fill the memory, no more than there is room for.
#[test]
fn more_frets_than_there_is_memory_for_are_refused() {
    // At 10 MHz a string without stiffness has tens of thousands of points.
    let string = StringParameters { youngs_modulus: 0.0, loss_1: 0.0, ..STRING };
    let build = |frets: usize, fingers, board| {
        let frets = (0..frets).map(|i| [0.3 + 1e-9 * i as f64, -1e-3]).collect();
        let barrier = Barrier { frets, board, placement: FretPlacement::Exact, ..barrier() };
        Model::new(string, Some(&barrier), fingers, SolverSettings::default(), 1e7)
    };
    assert_refused(build(100_000, 0, None), &["number of fretboard.frets = 100000", "between 0 and 1000"]);
    assert!(build(1000, 0, None).is_ok());
    // Each of a hundred fingers may join all frets, where these are crowded, to what the others touch of the board.
    let board = Some(Curve::Constant(-2e-3));
    assert_refused(
        build(1000, 100, board.clone()),
        &[
            "number of fretboard.frets = 1000",
            "share grid points are too many",
            "1e8 numbers, with 100 fingers",
        ],
    );
    assert!(build(10, 100, board).is_ok());
}

/// From as high or low as a finger may be put it throws the string wherever it may, and what there is stays a number: whatever pulls
/// it back, and however hard the pad.
#[test]
fn fingers_as_far_as_may_be_leave_numbers() {
    let model =
        Model::new(STRING, Some(&barrier()), 1, SolverSettings::default(), RATE).expect("it can be built");
    for height in [-1e30, -1e9, -1e3, 1e30] {
        for stiffness in [1e3, 1e9] {
            let touch = Touch { mass: 5e-3, stiffness, exponent: 1.5, damping: 1.0, hand_damping: 5.0 };
            let (mut state, mut scratch) = (State::new(&model), Scratch::new(&model));
            state.place_finger(&model, 0, touch, 0.3, height, 0.0).expect("it may be there");
            let mut drive = Drive::new(&model);
            drive.hands[0].position = 0.3;
            for step in 0..200 {
                state.step(&model, &drive, &mut scratch);
                assert!(
                    state.displacement().chain(state.motion()).all(f64::is_finite),
                    "{height} m, {stiffness} N/m^1.5: step {step}"
                );
            }
        }
    }
}

/// A drive that lacks the hand of a finger is of another model. (It would hold that finger still for ever.)
#[test]
#[should_panic]
fn a_drive_without_a_hand_for_each_finger_is_not_taken() {
    let model = Model::new(STRING, None, 2, SolverSettings::default(), RATE).expect("it can be built");
    let touch = Touch { mass: 5e-3, stiffness: 1e7, exponent: 2.0, damping: 1.0, hand_damping: 5.0 };
    let (mut state, mut scratch) = (State::new(&model), Scratch::new(&model));
    state.place_finger(&model, 1, touch, 0.3, 1e-3, 0.0).expect("it may be there");
    let mut drive = Drive::new(&model);
    drive.hands.truncate(1);
    state.step(&model, &drive, &mut scratch);
}

/// A brake that is nothing beside the mass, be it less than any normal number, leaves a finger as free as none.
#[test]
fn a_brake_of_next_to_nothing_brakes_nothing() {
    let model = Model::new(STRING, None, 1, SolverSettings::default(), RATE).expect("it can be built");
    let height_after = |hand_damping| {
        let touch = Touch { mass: 1000.0, stiffness: 1e7, exponent: 2.0, damping: 1.0, hand_damping };
        let (mut state, mut scratch) = (State::new(&model), Scratch::new(&model));
        state.place_finger(&model, 0, touch, 0.3, 1e-3, -1.0).expect("it may be there");
        let mut drive = Drive::new(&model);
        drive.hands[0].position = 0.3;
        for _ in 0..100 {
            state.step(&model, &drive, &mut scratch);
        }
        state.fingers()[0].map(|finger| finger.height)
    };
    let free = height_after(0.0);
    assert!(free.is_some_and(|height| height.abs() < 1.0), "{free:?}");
    for loss in [5e-324, 1e-318, 1e-310, 1e-305, 1e-300] {
        assert_eq!(height_after(loss), free, "{loss:e} kg/s");
    }
}
