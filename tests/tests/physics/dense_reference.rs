//! The fast string equals a plain one built from full matrices, which itself keeps its energy balance.
//! (`dense_by_hand` checks the plain one against numbers worked on paper.)

use low_action_dsp::{Scene, Simulation};
use low_action_tests::dense::{Finger, Fret, Fretboard, Placement, Pluck, Reference, Setup, Stencil};
use low_action_tests::numbers;
use low_action_tests::plain_string::string_table;

/// The length of every run, in samples.
const SAMPLES: usize = 2000;

/// The whole instrument on a coarse grid: a low string over a board and twelve low frets, plucked hard enough
/// to buzz for the whole run, a finger coming down between frets 4 and 5 and pressing.
fn buzzing(stencil: Stencil) -> Setup {
    let length = 0.25;
    Setup {
        sample_rate: 36_000.0,
        stencil,
        length,
        linear_density: 5.25e-3,
        tension: vec![[0.0, 60.0]],
        youngs_modulus: 2e11,
        core_radius: 4.3e-4,
        loss_0: 1.38,
        loss_1: 1.25e-4,
        tension_modulation: true,
        stilling: vec![],
        shape: vec![],
        velocity: vec![],
        fretboard: Some(Fretboard {
            stiffness: 1e13,
            exponent: 2.3,
            damping: 0.3,
            board: Some(vec![[0.0, -2.015e-3], [0.13, -2.015e-3], [0.19, -0.9e-3], [length, -0.9e-3]]),
            board_reference_spacing: Some(0.005),
            frets: (1..=12)
                .map(|m| Fret { position: length * (1.0 - 2_f64.powf(-f64::from(m) / 12.0)), top: -2e-3 })
                .collect(),
            placement: Placement::Exact,
        }),
        plucks: vec![Pluck { start: 0.0, duration: 0.00147, release: 0.0, position: 0.21, force: -5.0 }],
        fingers: vec![Finger {
            mass: 5e-3,
            stiffness: 1e7,
            exponent: 2.3,
            damping: 2.0,
            hand_damping: 5.0,
            position: vec![[0.0, 0.058]],
            height: 0.8e-3,
            velocity: -0.4,
            force: vec![[0.0, 0.0], [0.005, 6.0], [0.03, 8.0], [0.05, 4.0]],
        }],
    }
}

/// The same with the finger sliding from fret 5 to fret 7 and back a little, while the string is retuned.
fn sliding(stencil: Stencil) -> Setup {
    let mut setup = buzzing(stencil);
    setup.fingers[0].position = vec![[0.0, 0.061], [0.01, 0.061], [0.03, 0.082], [0.05, 0.08]];
    setup.tension = vec![[0.0, 60.0], [0.01, 55.0], [0.04, 60.0]];
    setup
}

/// The same without any loss, in string, frets, finger or hand, at constant tension. The finger comes down gently and
/// presses lightly, or its bouncing would be so chaotic that rounding takes over before the end.
fn lossless(setup: Setup) -> Setup {
    let mut setup = setup.with_forces_scaled(0.3);
    (setup.loss_0, setup.loss_1) = (0.0, 0.0);
    setup.tension = vec![[0.0, 60.0]];
    setup.fretboard.as_mut().expect("there is one").damping = 0.0;
    let finger = &mut setup.fingers[0];
    (finger.damping, finger.hand_damping, finger.velocity) = (0.0, 0.0, -0.1);
    setup
}

/// A fretboard softer than steel, round whose frets the string bends within a cell of the grid: so soft that it is pressed in as
/// far as their knees and farther, and what strikes it loses by its damping and by the resistance alike. The string is thin:
/// bending would take all of the kink from a thick one.
fn kinked(setup: Setup) -> Setup {
    let mut setup = setup;
    let fretboard = setup.fretboard.as_mut().expect("there is one");
    (fretboard.placement, fretboard.stiffness) = (Placement::Kinked, 1e11);
    setup.core_radius = 0.6e-4;
    setup
}

/// The string is thrown up and plucked by flesh, which takes a while to let go, and then stilled by a hand laid along it, as
/// firmly for a moment as brings it to rest in a step.
fn stilled(setup: Setup) -> Setup {
    let mut setup = setup;
    setup.velocity = vec![[0.09, 0.0], [0.12, 0.4], [0.16, 0.1], [0.2, 0.0]];
    setup.plucks[0].release = 0.00083;
    let full = setup.sample_rate;
    setup.stilling = vec![
        [0.02, 0.0],
        [0.03, 100.0],
        [0.04, 10.0],
        [0.045, 10.0],
        [0.0451, full],
        [0.0452, full],
        [0.0453, 0.0],
    ];
    setup
}

/// In how many samples board, frets and finger were in contact, and frets round which the string bends up to their knees and
/// beyond.
#[derive(Debug, Default)]
struct Touched {
    board: usize,
    frets: usize,
    finger: usize,
    before_knee: usize,
    beyond_knee: usize,
}

impl Touched {
    fn count(&mut self, string: &Reference) {
        let (frets, barriers) = (12, string.barriers.len());
        let any = |first, count| usize::from(string.forces.rows(first, count).amax() > 0.0);
        self.board += any(0, barriers - frets);
        self.frets += any(barriers - frets, frets);
        self.finger += any(barriers, 1);
        for fret in string.barriers.iter().filter(|fret| fret.resistance > 0.0) {
            let penetration = fret.height - string.spacing * fret.column.dot(&string.now);
            self.before_knee += usize::from(penetration > 0.0 && penetration < fret.law.knee);
            self.beyond_knee += usize::from(penetration > fret.law.knee);
        }
    }

    /// A run in which one of them hardly takes part checks little.
    fn assert_everything_was(&self, setup: &Setup) {
        let mut least = self.board.min(self.frets).min(self.finger);
        if setup.fretboard.as_ref().is_some_and(|board| board.placement == Placement::Kinked) {
            least = least.min(self.before_knee).min(self.beyond_knee);
        }
        assert!(least > SAMPLES / 100, "in {SAMPLES} samples only {self:?}");
    }
}

#[test]
fn the_reference_keeps_its_energy_balance() {
    for setup in [
        buzzing(Stencil::Paper),
        sliding(Stencil::Corrected),
        lossless(sliding(Stencil::Wide)),
        stilled(kinked(sliding(Stencil::Wide))),
    ] {
        let mut string = Reference::new(&setup);
        let (mut energy, mut largest, mut total) = (string.energy(), 0.0_f64, 0.0);
        let mut touched = Touched::default();
        for _ in 0..SAMPLES {
            string.step();
            let after = string.energy();
            largest = numbers::largest([largest, after]);
            let residual = after - energy + string.time_step * string.net_loss;
            total += residual;
            // Velocities from differences of positions carry a few digits less than the rest.
            assert!(residual.abs() <= 1e-13 * largest, "{residual:e} J of {largest:e} J unaccounted for");
            energy = after;
            touched.count(&string);
        }
        println!("residual {:e} of the largest energy; touched: {touched:?}", total / largest);
        assert!(total.abs() <= 1e-12 * largest, "{total:e} J of {largest:e} J unaccounted for in all");
        touched.assert_everything_was(&setup);
    }
}

/// The setup as a scene file for the fast string, solved to a tolerance. The frets must be those of equal
/// temperament, which the scene leaves to the fast string to place.
fn scene(setup: &Setup, tolerance: f64) -> Scene {
    let stencil = match setup.stencil {
        Stencil::Paper => "paper",
        Stencil::Corrected => "corrected",
        Stencil::Wide => "wide",
    };
    let velocity = match &setup.velocity[..] {
        [] => String::new(),
        velocity => format!("velocity = {velocity:?}"),
    };
    let (board, finger, pluck) = match (&setup.fretboard, &setup.fingers[..], &setup.plucks[..]) {
        (Some(board), [finger], [pluck]) => (board, finger, pluck),
        _ => panic!("the comparison is written for a board, one finger and one pluck"),
    };
    let placement = match board.placement {
        Placement::Exact => "exact",
        Placement::Nearest => "nearest",
        Placement::Kinked => "kinked",
    };
    let text = format!(
        "sample_rate = {:?}
        duration = 1.0
        [solver]
        max_iterations = 100
        tolerance = {tolerance:?}
        stencil = {stencil:?}
        {}
        tension_modulation = {:?}
        {velocity}
        [fretboard]
        stiffness = {:?}
        exponent = {:?}
        damping = {:?}
        board = {:?}
        board_reference_spacing = {:?}
        frets = {}
        fret_top = {:?}
        fret_placement = {placement:?}
        [[pluck]]
        start = {:?}
        duration = {:?}
        release = {:?}
        position = {:?}
        force = {:?}
        [[finger]]
        mass = {:?}
        stiffness = {:?}
        exponent = {:?}
        damping = {:?}
        hand_damping = {:?}
        position = {:?}
        height = {:?}
        velocity = {:?}
        force = {:?}",
        setup.sample_rate,
        string_table(
            [setup.length, setup.linear_density],
            &setup.tension,
            [setup.youngs_modulus, setup.core_radius],
            [setup.loss_0, setup.loss_1],
        ),
        setup.tension_modulation,
        board.stiffness,
        board.exponent,
        board.damping,
        board.board.as_ref().expect("the comparison has a board"),
        board.board_reference_spacing.expect("the comparison scales its board"),
        board.frets.len(),
        board.frets[0].top,
        pluck.start,
        pluck.duration,
        pluck.release,
        pluck.position,
        pluck.force,
        finger.mass,
        finger.stiffness,
        finger.exponent,
        finger.damping,
        finger.hand_damping,
        finger.position,
        finger.height,
        finger.velocity,
        finger.force,
    );
    Scene::from_toml(&text).expect("the scene is valid")
}

/// The largest of some heights, above or below.
fn size(heights: impl Iterator<Item = f64>) -> f64 {
    numbers::largest(heights.map(f64::abs))
}

/// Runs the plain string, the plain string with every force 1e-14 larger, and the fast string at two
/// tolerances of its solver. Contacts are chaotic, so what counts is how far rounding alone drives the answer:
/// at each sample the fast string may differ by a number of times the largest response of the plain one
/// so far, 100 at a tolerance of 1e-17 m, and 20 at a tolerance of 0, where it iterates to the last digit.
#[track_caller]
fn assert_equal_to_the_reference(setup: &Setup) {
    let mut plain = Reference::new(setup);
    let mut nudged = Reference::new(&setup.with_forces_scaled(1.0 + 1e-14));
    plain.let_go();
    nudged.let_go();
    let mut fast = [(1e-17, 100.0), (0.0, 20.0)].map(|(tolerance, limit)| {
        let simulation = Simulation::new(&scene(setup, tolerance)).expect("the scene can be built");
        (simulation, limit, 0.0_f64)
    });
    let mut touched = Touched::default();
    let (mut largest, mut response) = (0.0_f64, 0.0_f64);
    for sample in 1..=SAMPLES {
        let stilling = plain.stilling();
        plain.step();
        nudged.step();
        touched.count(&plain);
        largest = numbers::largest([largest, size(plain.now.iter().copied())]);
        response = numbers::largest([response, size((&nudged.now - &plain.now).iter().copied())]);
        // Positions themselves are rounded to this, whatever the forces; and a push that has hardly begun to a digit of its
        // largest, of which each sample's moves the string by so much for ever.
        let pushed: f64 = setup.plucks.iter().map(|pluck| pluck.force.abs()).sum::<f64>() * sample as f64;
        let mobility = plain.time_step.powi(2) / (setup.linear_density * plain.spacing);
        let floor = 4.0 * f64::EPSILON * (largest + mobility * pushed);
        for (simulation, limit, worst) in &mut fast {
            simulation.step_under(|_, string| string.drive.loss = stilling);
            let string = simulation.string(0).state.displacement();
            assert_eq!(string.clone().count(), plain.now.len(), "the two grids differ");
            let error = size(string.zip(&plain.now).map(|(a, b)| a - b));
            assert!(
                error <= floor + *limit * response,
                "sample {sample}: {error:e} m apart where a 1e-14 change of force makes {response:e} m"
            );
            if response > 0.0 {
                *worst = numbers::largest([*worst, (error - floor) / response]);
            }
        }
    }
    println!(
        "{:.1} and {:.1} responses apart at most; last response {response:e} m of {largest:e} m; {touched:?}",
        fast[0].2, fast[1].2
    );
    touched.assert_everything_was(setup);
    assert!(100.0 * response < 0.01 * largest, "{response:e} m: too chaotic for the end to mean anything");
}

#[test]
fn paper_stencil_equals_the_reference() {
    assert_equal_to_the_reference(&buzzing(Stencil::Paper));
    assert_equal_to_the_reference(&sliding(Stencil::Paper));
    assert_equal_to_the_reference(&lossless(sliding(Stencil::Paper)));
    assert_equal_to_the_reference(&stilled(kinked(sliding(Stencil::Paper))));
}

#[test]
fn corrected_stencil_equals_the_reference() {
    assert_equal_to_the_reference(&buzzing(Stencil::Corrected));
    assert_equal_to_the_reference(&sliding(Stencil::Corrected));
    assert_equal_to_the_reference(&lossless(sliding(Stencil::Corrected)));
    assert_equal_to_the_reference(&stilled(kinked(sliding(Stencil::Corrected))));
}

#[test]
fn wide_stencil_equals_the_reference() {
    assert_equal_to_the_reference(&buzzing(Stencil::Wide));
    assert_equal_to_the_reference(&sliding(Stencil::Wide));
    assert_equal_to_the_reference(&lossless(sliding(Stencil::Wide)));
    assert_equal_to_the_reference(&stilled(kinked(sliding(Stencil::Wide))));
}

/// Frets on the grid points next to their places, as in the paper.
#[test]
fn nearest_frets_equal_the_reference() {
    let mut setup = buzzing(Stencil::Paper);
    setup.fretboard.as_mut().expect("there is one").placement = Placement::Nearest;
    assert_equal_to_the_reference(&setup);
}
