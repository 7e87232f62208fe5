//! Promise: whatever is legal is drawn. Every gesture there is, every part of a drive, every key of a scene. The patterns below
//! name all of them, so that what is new does not compile until it is drawn, too, or said to be another way to write what is.

use std::collections::BTreeSet;

use low_action_dsp::curve::{CountOrList, Curve, OneOrEach};
use low_action_dsp::scene::{
    BoardSpec, FingerSpec, FretPlacement, FretboardSpec, ListeningPoint, OutputSpec, PluckSpec, StringSpec,
};
use low_action_dsp::{Drive, Gesture, Scene, Setup, Simulation, SolverSettings};

use super::bodies;
use super::draw::Draw;
use super::playing::gesture;
use super::scenes::scene;
use super::stream::{Acting, Stream};

/// Far more than any of these needs to be drawn: the rarest is in one of thirty.
const TRIES: u64 = 1000;

/// Fails unless all of these have been drawn, and nothing else.
fn assert_drawn(drawn: &BTreeSet<&str>, all: &[&str]) {
    let all: BTreeSet<&str> = all.iter().copied().collect();
    assert_eq!(drawn, &all, "what is drawn, and what is legal");
}

#[test]
fn every_gesture_is_drawn() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut drawn = BTreeSet::new();
    for number in 0..TRIES {
        drawn.insert(match gesture(&mut Draw::new(1, number), &setup, 0.65) {
            Gesture::Pluck { release: 0.0, .. } => "pluck",
            Gesture::Pluck { .. } => "pluck that lets go softly",
            Gesture::Place { .. } => "place",
            Gesture::Throw { .. } => "throw",
            Gesture::Press { .. } => "press",
            Gesture::Slide { .. } => "slide",
            Gesture::Lift { .. } => "lift",
            Gesture::Still { duration: 0.0, .. } => "still for no time",
            Gesture::Still { .. } => "still",
            Gesture::Bend { .. } => "bend",
        });
    }
    let all = [
        "pluck",
        "pluck that lets go softly",
        "place",
        "throw",
        "press",
        "slide",
        "lift",
        "still for no time",
        "still",
        "bend",
    ];
    assert_drawn(&drawn, &all);
}

#[test]
fn every_part_of_a_drive_is_drawn() {
    let text = "sample_rate = 48000.0\nduration = 1.0\n[[string]]\nlength = 0.65\nlinear_density = 0.005\n\
                tension = [[0.0, 60.0], [0.5, 70.0]]\n[fretboard]\nstiffness = 1e9\nexponent = 2.0\nfrets = 3\n\
                fret_top = -1e-3\n[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\nposition = 0.3\nheight = 1e-3\n";
    let scene = Scene::from_toml(text).expect("it is legal");
    let mut drawn = BTreeSet::new();
    for number in 0..TRIES {
        let stream = Stream::random(&mut Draw::new(1, number), 1e-3);
        let mut simulation = Simulation::new(&scene).expect("it is legal");
        let mut acting = Acting::new(&stream, 0, simulation.string(0));
        let most_loss = 1.0 / simulation.string(0).model.grid.time_step;
        for _ in 0..4 {
            simulation.step_under(|_, string| {
                let of_the_scene = string.drive.clone();
                acting.act(string);
                // (What a bridge does is the body's own.)
                let Drive { tension, loss, pushes, bridge: _, hands, heights } = &string.drive;
                assert!((0.0..=most_loss).contains(loss), "{loss} 1/s is not legal");
                let places = |hands: &[low_action_dsp::drive::Hand]| hands[0].position;
                let changes = [
                    (*tension != of_the_scene.tension, "tension"),
                    (*loss > 0.0, "loss"),
                    (*loss == most_loss, "all the loss there may be"),
                    (!pushes.is_empty(), "pushes"),
                    (hands[0].force != 0.0, "forces of hands"),
                    (places(hands) != places(&of_the_scene.hands), "places of hands"),
                    (!heights.is_empty(), "heights"),
                ];
                drawn.extend(changes.iter().filter(|(is, _)| *is).map(|(_, name)| name));
            });
        }
    }
    let all = [
        "tension",
        "loss",
        "all the loss there may be",
        "pushes",
        "forces of hands",
        "places of hands",
        "heights",
    ];
    assert_drawn(&drawn, &all);
}

#[test]
fn every_key_of_a_scene_is_drawn() {
    let mut drawn = BTreeSet::new();
    for number in 0..TRIES {
        let mut draw = Draw::new(1, number);
        let mut table = scene(&mut draw);
        bodies::under(&mut draw, &mut table);
        let text = table.to_string();
        see_scene(&Scene::from_toml(&text).expect("it is legal"), &mut drawn);
    }
    let all = [
        "board along the string",
        "board at a height",
        "board shared out",
        "body",
        "body under two strings",
        "course of a finger",
        "course of a force",
        "course of tension",
        "damped board",
        "damped finger",
        "damped hand",
        "exact frets",
        "finger",
        "finger on the second string",
        "fretboard",
        "frets by a count",
        "frets by their places",
        "heard at a point",
        "heard at the bridge",
        "heard in the air",
        "kinked frets",
        "loss",
        "loss of high frequencies",
        "nearest frets",
        "one height of frets",
        "heights of frets",
        "paper",
        "corrected",
        "wide",
        "pluck",
        "pluck later on",
        "pluck that lets go softly",
        "pluck on the second string",
        "shape",
        "stiff string",
        "tension modulation",
        "tolerance of nothing",
        "velocity",
    ];
    assert_drawn(&drawn, &all);
}

/// What a scene has.
fn see_scene(scene: &Scene, drawn: &mut BTreeSet<&'static str>) {
    // Rates and durations are in all of them.
    let Scene { sample_rate: _, duration: _, solver, string, fretboard, body, pluck, finger, output } = scene;
    let SolverSettings { max_iterations: _, tolerance, stencil } = solver;
    drawn.insert(stencil.name());
    let OutputSpec { position } = output;
    drawn.insert(match position {
        ListeningPoint::Bridge => "heard at the bridge",
        ListeningPoint::At(_) => "heard at a point",
        ListeningPoint::Air => "heard in the air",
    });
    let mut see = |is: bool, name| {
        if is {
            drawn.insert(name);
        }
    };
    see(*tolerance == 0.0, "tolerance of nothing");
    see(body.is_some(), "body");
    see(body.is_some() && string.len() == 2, "body under two strings");
    for StringSpec {
        length: _,
        linear_density: _,
        tension,
        youngs_modulus,
        core_radius: _,
        loss_0,
        loss_1,
        // Only another way to give the two above.
        t60: _,
        tension_modulation,
        shape,
        velocity,
    } in string
    {
        see(matches!(tension, Curve::Points(_)), "course of tension");
        see(*youngs_modulus > 0.0, "stiff string");
        see(loss_0.is_some_and(|loss| loss > 0.0), "loss");
        see(loss_1.is_some_and(|loss| loss > 0.0), "loss of high frequencies");
        see(*tension_modulation, "tension modulation");
        see(shape.is_some(), "shape");
        see(velocity.is_some(), "velocity");
    }
    for PluckSpec { string, start, duration: _, release, position: _, force: _ } in pluck {
        see(true, "pluck");
        see(*string == 2, "pluck on the second string");
        see(*start > 0.0, "pluck later on");
        see(*release > 0.0, "pluck that lets go softly");
    }
    for finger in finger {
        let FingerSpec {
            string,
            mass: _,
            stiffness: _,
            exponent: _,
            damping,
            hand_damping,
            position,
            height: _,
            velocity: _,
            force,
        } = finger;
        see(true, "finger");
        see(*string == 2, "finger on the second string");
        see(*damping > 0.0, "damped finger");
        see(*hand_damping > 0.0, "damped hand");
        see(matches!(position, Curve::Points(_)), "course of a finger");
        see(matches!(force, Curve::Points(_)), "course of a force");
    }
    if let Some(fretboard) = fretboard {
        see_fretboard(fretboard, see);
    }
}

fn see_fretboard(fretboard: &FretboardSpec, mut see: impl FnMut(bool, &'static str)) {
    let FretboardSpec {
        stiffness: _,
        exponent: _,
        damping,
        board,
        frets,
        fret_top,
        fret_placement,
        board_reference_spacing,
    } = fretboard;
    see(true, "fretboard");
    see(*damping > 0.0, "damped board");
    match board {
        // Through three heights it is but other heights of the points that are there in any case.
        None | Some(BoardSpec::Parabola(_) | BoardSpec::Profile(Curve::Parabola(_))) => {}
        Some(BoardSpec::Profile(Curve::Constant(_))) => see(true, "board at a height"),
        Some(BoardSpec::Profile(Curve::Points(_))) => see(true, "board along the string"),
    }
    see(board_reference_spacing.is_some(), "board shared out");
    see(matches!(frets, CountOrList::Count(1..)), "frets by a count");
    see(matches!(frets, CountOrList::List(places) if !places.is_empty()), "frets by their places");
    see(matches!(fret_top, Some(OneOrEach::One(_))), "one height of frets");
    see(matches!(fret_top, Some(OneOrEach::Each(_))), "heights of frets");
    if fret_top.is_some() {
        let name = match fret_placement {
            FretPlacement::Exact => "exact frets",
            FretPlacement::Nearest => "nearest frets",
            FretPlacement::Kinked => "kinked frets",
        };
        see(true, name);
    }
}
