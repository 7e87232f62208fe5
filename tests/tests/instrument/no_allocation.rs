//! Promise: nothing is allocated once an instrument or a string is built, nor once it is cloned. The allocator of the
//! tests aborts the program when memory is asked for or given back inside `assert_no_alloc`.

// The allocator that keeps watch comes with the plugin.
use low_action as _;
use low_action_dsp::{
    Drive, Gesture, Instrument, Model, Quality, Scene, Scratch, Setup, State, StringParameters, TimedGesture,
    Touch,
};
use low_action_tests::numbers::largest;
use low_action_tests::stage::peak;
use low_action_tests::watch;
use nice_assert_no_alloc::assert_no_alloc;

#[test]
#[cfg_attr(not(debug_assertions), ignore = "in a release build nobody keeps watch over allocations")]
fn the_watch_is_kept() {
    watch::assert_it_is_kept(module_path!(), "the_watch_is_kept");
}

#[test]
fn playing_an_instrument() {
    for name in Setup::BUILTIN {
        let setup = Setup::builtin(name).expect("it is built in");
        let settings = Quality::Live.settings(48e3);
        let instrument = Instrument::new(&setup, &settings).expect("it can be built");
        play(name, &setup, instrument.clone());
        play(name, &setup, instrument);
    }
}

/// Every gesture on every string, over and over.
fn play(name: &str, setup: &Setup, mut instrument: Instrument) {
    let geometry: Vec<_> =
        (0..instrument.string_count()).map(|string| instrument.geometry(string).clone()).collect();
    let (mut left, mut right) = (vec![0.0; 512], vec![0.0; 512]);
    let touch = setup.player.fretting.touch;
    // How many gestures of each kind were taken, and how loud it was.
    let (mut taken, mut loudest) = ([0; 8], 0.0);
    assert_no_alloc(|| {
        for block in 0..100u64 {
            for (string, geometry) in geometry.iter().enumerate() {
                let finger = (block % 4) as usize;
                let position = geometry.finger_position(1 + (block as usize + string) % 12);
                let away = geometry.length - 0.1;
                let gestures = [
                    Gesture::Place { finger, touch, position, clearance: 1e-4 },
                    Gesture::Press { finger, force: 6.0, duration: 0.004 },
                    Gesture::Pluck { position: away, force: 2.0, duration: 0.001, release: 0.0 },
                    Gesture::Still { loss: 1000.0, duration: 0.001 },
                    Gesture::Slide { finger, position: position + 0.01, duration: 0.01 },
                    Gesture::Bend { tension_ratio: 1.1, duration: 0.01 },
                    Gesture::Lift { finger, force: 3.0, duration: 0.002 },
                    Gesture::Throw { finger: 4, touch, position: away, clearance: 1e-4, speed: 1.0 },
                ];
                for (index, gesture) in gestures.into_iter().enumerate() {
                    let time = instrument.now() + 80 * index as u64;
                    // A full queue leaves a gesture out, which is no concern here.
                    let scheduled = instrument.schedule(TimedGesture { time, string, gesture });
                    taken[index] += u32::from(scheduled.is_ok());
                }
            }
            instrument.process(&mut left, &mut right);
            loudest = largest([loudest, peak(&left)]);
        }
        instrument.reset();
    });
    assert!(taken.iter().all(|taken| *taken > 0), "{name}: {taken:?} gestures were taken");
    assert!(loudest > 1e-3 && loudest.is_finite(), "{name}: nothing was played");
}

/// Pads beyond what the string's rate can tell from rounding, which are left out.
#[test]
fn fingers_too_stiff_for_the_string() {
    let mut setup = Setup::builtin("electric").expect("it is built in");
    setup.string.truncate(1);
    let mut instrument =
        Instrument::new(&setup, &Quality::Live.settings(48e3)).expect("the set-up can be built");
    let touch = Touch { stiffness: 1e30, exponent: 2.0, ..setup.player.fretting.touch };
    assert!(instrument.model(0).finger_law(&touch).is_err(), "it is not too stiff");
    let (finger, position, clearance) = (0, 0.2, 1e-4);
    let (mut left, mut right) = (vec![0.0; 512], vec![0.0; 512]);
    assert_no_alloc(|| {
        for gesture in [
            Gesture::Place { finger, touch, position, clearance },
            Gesture::Throw { finger, touch, position, clearance, speed: 2.0 },
        ] {
            let time = instrument.now();
            assert!(instrument.schedule(TimedGesture { time, string: 0, gesture }).is_ok());
            instrument.process(&mut left, &mut right);
        }
    });
    assert!(instrument.state(0).fingers().iter().all(Option::is_none));
}

/// A pad that one rate can tell from rounding and another cannot is taken away by a hand-over.
#[test]
fn fingers_too_stiff_for_what_takes_over() {
    let mut setup = Setup::builtin("electric").expect("it is built in");
    setup.string.truncate(1);
    let build =
        |quality: Quality| Instrument::new(&setup, &quality.settings(48e3)).expect("the set-up can be built");
    let (mut fine, coarse) = (build(Quality::Studio), Box::new(build(Quality::Live)));
    let stiffness = (0..3000).map(|step| 1e3 * 1.02f64.powi(step));
    let mut pads =
        stiffness.map(|stiffness| Touch { stiffness, exponent: 2.0, ..setup.player.fretting.touch });
    let between =
        |touch: &Touch| fine.model(0).finger_law(touch).is_ok() && coarse.model(0).finger_law(touch).is_err();
    let touch = pads.find(between).expect("the finer rate bears more");
    let gesture = Gesture::Place { finger: 0, touch, position: 0.2, clearance: 1e-4 };
    fine.schedule(TimedGesture { time: 0, string: 0, gesture }).expect("there is room");
    let (mut left, mut right) = (vec![0.0; 512], vec![0.0; 512]);
    fine.process(&mut left, &mut right);
    assert!(fine.state(0).fingers()[0].is_some());
    let taken = assert_no_alloc(|| fine.hand_over(coarse).is_ok());
    assert!(taken && fine.state(0).fingers()[0].is_none());
}

const SAMPLE_RATE: f64 = 96e3;
const LENGTH: f64 = 0.65;

/// Of a string of some shape, stiff or not, over a fretboard.
fn scene(youngs_modulus: f64, shape: &str, fretboard: &str) -> Scene {
    let text = format!(
        "sample_rate = {SAMPLE_RATE}\nduration = 1.0\n[[string]]\nlength = {LENGTH}\nlinear_density = 5.25e-3\n\
         tension = 60.0\nyoungs_modulus = {youngs_modulus:?}\ncore_radius = 4.3e-4\ntension_modulation = true\n\
         shape = {shape}\n[fretboard]\nstiffness = 1e13\nexponent = 2.3\nboard = -1e-5\n{fretboard}"
    );
    Scene::from_toml(&text).expect("the scene is valid")
}

/// Steps the string of a scene, and a clone of it; returns how many contacts the least of both had at once.
fn step(scene: &Scene) -> Option<u32> {
    let fretboard = scene.fretboard.as_ref().expect("there is one");
    let barrier = low_action_dsp::Barrier::from_spec(fretboard, LENGTH).expect("it is valid");
    let string = StringParameters::from_spec(&scene.string[0]);
    let model = Model::new(string, Some(&barrier), 0, scene.solver, SAMPLE_RATE).expect("it can be built");
    let mut state = State::new(&model);
    let shape = scene.string[0].shape.clone().expect("there is one");
    state.set_shape(&model, &low_action_dsp::curve::Curve::Points(shape));
    let scratch = Scratch::new(&model);
    let drive = Drive::new(&model);
    let clones = (state.clone(), scratch.clone(), drive.clone());
    let most = [clones, (state, scratch, drive)].map(|(mut state, mut scratch, drive)| {
        assert_no_alloc(|| (0..2000).map(|_| state.step(&model, &drive, &mut scratch).active).max())
    });
    most.into_iter().min().flatten()
}

#[test]
fn hundreds_of_coupled_contacts() {
    // A string dropped on a board of frets closer than the grid: large blocks, and blocks apart.
    for frets in ["", "frets = [0.1, 0.1005, 0.101, 0.1015, 0.102, 0.1025, 0.103, 0.3]\nfret_top = -1e-5\n"] {
        let most = step(&scene(2e11, "[[0.0, 0.0], [0.1, -0.001], [0.5, -0.001], [0.65, 0.0]]", frets));
        assert!(most.is_some_and(|most| most > 50), "{most:?} contacts at once");
    }
}

/// A kinked fret in the last spacing, which is solved for before points of the board that stand before it.
#[test]
fn a_kinked_fret_beside_the_bridge() {
    let shape = "[[0.0, 0.0], [0.001, -0.001], [0.649, -0.001], [0.65, 0.0]]";
    let bare = scene(0.0, shape, "");
    let string = StringParameters::from_spec(&bare.string[0]);
    let grid = Model::grid(&string, bare.solver.stencil, 1.0 / SAMPLE_RATE).expect("there is room for one");
    for part in [0.2, 0.4, 0.6] {
        let place = LENGTH - part * grid.spacing;
        let fret = format!("frets = [{place}]\nfret_top = -1e-5\nfret_placement = \"kinked\"\n");
        let most = step(&scene(0.0, shape, &fret));
        assert!(most.is_some_and(|most| most as usize == grid.intervals), "{most:?} contacts at once");
    }
}
