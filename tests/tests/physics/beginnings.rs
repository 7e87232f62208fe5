//! The promise: what begins and ends between samples is right to the second order. A pluck gives the string what its push adds
//! up to, wherever samples fall; what is let go of moves from that moment on; a hand brakes a finger at any step as it would
//! without steps.

use low_action_dsp::curve::Curve;
use low_action_dsp::gesture::pluck_push;
use low_action_dsp::{Drive, Scene, Scratch, Simulation, State};
use std::f64::consts::PI;

/// Low E of an electric guitar without stiffness or losses.
fn string(sample_rate: f64, more: &str) -> Simulation {
    let text = format!(
        "sample_rate = {sample_rate:?}\nduration = 1.0\n[solver]\nstencil = \"wide\"\n\
         [[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n{more}"
    );
    Simulation::new(&Scene::from_toml(&text).expect("the scene is valid")).expect("it can be built")
}

/// The pushes of all samples add up to the push itself, ∫ (1 − cos πt/t_p)/2 dt = t_p/2 while it grows and as much of t_r while
/// it lets go, however short they are and wherever it begins. Each is known to a few units in its last place.
#[test]
fn a_pluck_gives_what_its_push_adds_up_to() {
    let times = [1e-9, 5e-6, 2e-5, 5e-4, 2e-3, 0.0371, 1.3];
    let pairs = || times.into_iter().flat_map(|one| [(one, 0.0), (0.0, one), (one, 3.0 * one), (one, 1e-4)]);
    for step in [1.0 / 44_100.0, 1.0 / 48_000.0, 1e-3] {
        for (duration, release) in pairs() {
            let whole = duration + release;
            for start in [0.0, 0.3, 0.5, 0.999].map(|part| part * step) {
                let count = (whole / step) as u64 + 3;
                let push = |n: u64| pluck_push(n as f64 * step - start, step, duration, release);
                let off = (0..count).map(push).sum::<f64>() * step / (0.5 * whole) - 1.0;
                // Each sample's part is a difference of times as large as the whole and a step, and known to their last digits.
                let allowed = 4.0 * f64::EPSILON * (1.0 + step / whole + whole / step);
                let case = format!("{duration} and {release} s from {start} s on in steps of {step} s");
                assert!(off.abs() < allowed, "{case}: {off:e}");
            }
        }
    }
    assert_eq!(pluck_push(0.0, 1e-5, 0.0, 0.0), 0.0);
    // One that lets go for years is at its strongest for long; in the step of its peak it has come to that half way, and before it
    // is a step of the rest of the push. Half a step more or less of the longest release that is seen from its end is known to a
    // part in 2²⁰.
    for step in [1e-7, 1.0 / 48_000.0, 1e-3] {
        for release in [0.9e9 * step, 4.2e9 * step, 4.3e9 * step, 1e6, 1e9, 1e11, 1e301, f64::MAX] {
            for (since, right) in [(0.0, 0.5), (step, 1.0), (100.25 * step, 1.0), (-step, 0.0)] {
                let push = pluck_push(since, step, 0.0, release);
                let case = format!("{since} s in steps of {step} s, for {release} s");
                assert!((push - right).abs() < 2e-6, "{case}: {push}");
            }
            if release < 1e300 {
                let middle = pluck_push(0.5 * release, step, 0.0, release);
                assert!((middle - 0.5).abs() < 2e-6, "{step} s, {release} s: {middle}");
                assert_eq!(pluck_push(1.5 * release, step, 0.0, release), 0.0);
            }
        }
    }
    // One that lasts for years is at its beginning for long.
    assert!(pluck_push(1.0, 1e-5, 1e9, 0.0) < 1e-17);
}

/// A push that lets go as slowly as it grows is the same from either end, and strongest in the middle.
#[test]
fn a_pluck_lets_go_as_it_grows() {
    let (step, time) = (1.0 / 48_000.0, 2e-3);
    let at = |since: f64| pluck_push(since, step, time, time);
    for part in 0..100 {
        let away = time * f64::from(part) / 100.0;
        // Places in time of 2 ms are known to 4e-19 s, of the 1/1570 s in which a push changes by its whole.
        assert!((at(time - away) - at(time + away)).abs() < 1e-14, "{away} s from the middle");
        assert!(at(time + away) <= at(time), "{away} s from the middle");
    }
    // The mean over a step of what is 1 − (πt/2t_p)² at its top.
    let top = 1.0 - (PI * step / time).powi(2) / 48.0;
    assert!((at(time) - top).abs() < 1e-8, "{}", at(time));
}

/// The momentum of the string at the end of a push, from a scene: its force times half its duration.
#[test]
fn a_plucked_string_has_the_momentum_of_the_pluck() {
    for (rate, start) in [(44_100.0, 0.001), (48_000.0, 0.009), (48_000.0, 0.011), (96_000.0, 0.001_003)] {
        let duration = 5e-4;
        let pluck =
            format!("[[pluck]]\nposition = 0.3\nforce = 1.0\nstart = {start:?}\nduration = {duration:?}\n");
        let mut simulation = string(rate, &pluck);
        // No wave is at an end within 2 ms of the push.
        for _ in 0..((start + duration) * rate) as usize + 2 {
            simulation.step();
        }
        let model = &simulation.string(0).model;
        let moving: f64 = simulation.string(0).state.motion().sum();
        let momentum = model.string.linear_density * model.grid.spacing / model.grid.time_step * moving;
        let off = momentum / (0.5 * duration) - 1.0;
        assert!(off.abs() < 1e-12, "{rate} Hz, from {start} s on: off by {off:e}");
    }
}

/// A shape that is let go of has its velocity at no time but a moment later: a partial goes as the cosine of the frequency that
/// the grid gives it. Half a sample early it would be off by ωk/2, which is a sixteenth here.
#[test]
fn what_is_let_go_of_moves_from_then_on() {
    let mode = 3.0 * PI / 0.65;
    let flat = string(12_000.0, "");
    let places: Vec<f64> = flat.string(0).places().collect();
    let shape = |x: f64| 1e-3 * (mode * x).sin();
    let inner = places.iter().map(|&x| [x, shape(x)]);
    let points: Vec<_> = [[0.0, 0.0]].into_iter().chain(inner).chain([[0.65, 0.0]]).collect();
    let mut simulation = string(12_000.0, &format!("shape = {points:?}\n"));
    let amplitude = |simulation: &Simulation| {
        let u = simulation.string(0).state.displacement();
        u.zip(&places).map(|(u, &x)| u * (mode * x).sin()).sum::<f64>()
    };
    let first = amplitude(&simulation);
    simulation.step();
    // The scheme's own frequency: u⁺ + u⁻ = 2cos(ωk)u, and u⁻ = u⁺ for what has no velocity.
    let turn = (amplitude(&simulation) / first).acos();
    assert!(turn > 0.1, "{turn}");
    for n in 2..2_000 {
        simulation.step();
        let found = amplitude(&simulation) / first;
        let expected = (f64::from(n) * turn).cos();
        // The frequency is as good as an arc cosine near its end tells.
        assert!((found - expected).abs() < 1e-10, "{found} after {n} samples, not {expected}");
    }
}

/// The same of a string that is set by itself, beside the one of a scene.
#[test]
fn a_string_without_a_scene_is_let_go_of_likewise() {
    let points = vec![[0.0, 0.0], [0.2, 1e-3], [0.65, 0.0]];
    let mut simulation = string(12_000.0, &format!("shape = {points:?}\n"));
    let model = simulation.string(0).model.clone();
    let (mut state, mut scratch, drive) = (State::new(&model), Scratch::new(&model), Drive::new(&model));
    state.set_shape(&model, &Curve::Points(points));
    state.let_go(&model, &drive);
    for n in 1..1_000 {
        simulation.step();
        state.step(&model, &drive, &mut scratch);
        assert!(state.displacement().eq(simulation.string(0).state.displacement()), "after {n} samples");
    }
}

/// A finger that its hand pushes falls as ½(F/M)t² from where it is, and one that it brakes loses exp(−Rt/M) of its velocity,
/// whatever the step; a steady push moves it at F/R.
#[test]
fn a_hand_brakes_and_pushes_a_finger_as_without_steps() {
    let finger = |velocity: f64, force: f64, damping: f64| {
        let text = format!(
            "[[finger]]\nmass = 0.01\nstiffness = 1e5\nexponent = 2.3\nposition = 0.3\nheight = 0.05\n\
             velocity = {velocity:?}\nforce = {force:?}\nhand_damping = {damping:?}\n"
        );
        string(10_000.0, &text)
    };
    let height =
        |simulation: &Simulation| simulation.string(0).fingers().next().expect("there is a finger").height;
    let mut falling = finger(0.5, 2.0, 0.0);
    for n in 1..100 {
        falling.step();
        let t = f64::from(n) * 1e-4;
        let expected = 0.05 + 0.5 * t - 0.5 * (2.0 / 0.01) * t * t;
        assert!((height(&falling) - expected).abs() < 1e-14, "at {t} s");
    }
    // From slightly to far beyond R = 2M/k, where the trapezoidal rule would have it turn round in each step.
    for damping in [0.1, 10.0, 200.0, 1e3, 1e5] {
        let mut braked = finger(1.0, 0.0, damping);
        let (mut before, mut motion) = (height(&braked), None::<f64>);
        for _ in 0..5 {
            braked.step();
            let moved = height(&braked) - before;
            before = height(&braked);
            if let Some(last) = motion {
                let left: f64 = f64::exp(-damping * 1e-4 / 0.01);
                // Heights of 5 cm are rounded to 1e-17 m.
                assert!((moved - left * last).abs() < 2e-17, "{damping} N s/m: {moved} m after {last} m");
            }
            assert!(moved >= 0.0, "{damping} N s/m: it turned round");
            motion = Some(moved);
        }
    }
    let mut pushed = finger(0.0, 1.0, 100.0);
    (0..200).for_each(|_| _ = pushed.step());
    let from = height(&pushed);
    (0..100).for_each(|_| _ = pushed.step());
    let velocity = (height(&pushed) - from) / 1e-2;
    assert!((velocity + 0.01).abs() < 1e-12, "{velocity} m/s and not −F/R");
}

/// A board or frets beside a string that is thrown off them had it inside, a sample before; that must not throw it once more,
/// at any rate and however near they are. What the string begins with is ½ρ∫v², here of a triangle: ρLv²/6.
#[test]
fn a_string_that_is_thrown_off_the_board_has_its_own_energy_alone() {
    let (density, length, velocity) = (5.25e-3, 0.65, 10.0);
    let expected = density * length * velocity * velocity / 6.0;
    for rate in [22_050, 44_100, 176_400] {
        for height in [0.0, -5e-5, -1e-4, -3e-4, -1e-3] {
            let text = format!(
                "sample_rate = {rate}\nduration = 0.01\n[[string]]\nlength = {length}\nlinear_density = {density}\n\
                 tension = 60.0\nvelocity = [[0, 0], [0.3, {velocity}], [{length}, 0]]\n[fretboard]\nstiffness = 1e15\n\
                 exponent = 2.3\nboard = {height:e}\n"
            );
            let scene = Scene::from_toml(&text).expect("the scene is valid");
            let mut simulation = Simulation::new(&scene).expect("it can be built");
            simulation.open_ledger();
            for _ in 0..scene.samples() {
                simulation.step();
            }
            let ledger = &simulation.ledgers()[0];
            // The grid's triangle has its tip cut off: the square of the spacing, a part of 0.004 at most.
            assert!(
                (ledger.initial / expected - 1.0).abs() < 0.02,
                "{rate} Hz, {height}: {:e}",
                ledger.initial
            );
            assert!(ledger.largest < 1.02 * expected, "{rate} Hz, {height}: {:e}", ledger.largest);
            assert!(ledger.worst_residual < 1e-12, "{rate} Hz, {height}: {:e}", ledger.worst_residual);
        }
    }
}
