//! Figure 4: a finger taps the string, pins it against the board and flies off again.

use anyhow::{Context, Result};
use low_action_dsp::curve::Curve;
use low_action_dsp::{Scene, Simulation, StringParameters};
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Layer, Panel, Profile, Sheet, Stroke};

use super::Made;
use super::page::{Claim, Section};
use super::running::{Repository, ground, listen, run, shortened};

const SCENE: &str = "scenes/paper/figure_4.toml";

/// Time shown, ms, and moments at which the string is.
const SHOWN: f64 = 3.0;
const MOMENTS: [f64; 7] = [0.3, 0.7, 1.0, 1.28, 1.6, 2.0, 2.4];

/// Part of the string shown, m.
const PLACES: std::ops::Range<f64> = -0.003..0.155;

/// How a tap went.
#[derive(Default)]
pub struct Tap {
    profiles: Vec<Profile>,
    /// (time, ms; height, mm) of the finger, and of the string under it.
    finger: Vec<(f64, f64)>,
    string: Vec<(f64, f64)>,
    /// (time, ms; force, N) of the finger, the board and the first fret.
    forces: [Vec<(f64, f64)>; 3],
    /// First and last time of finger and string together, ms.
    touch: Option<(f64, f64)>,
    /// Time pinned between finger and board, ms, and in how many pieces.
    pub pinned: f64,
    pub pins: usize,
    /// Samples in which the finger touches the string, and those of them in which the string between the nut and the first
    /// fret is lowest within a grid spacing of it.
    touched: usize,
    beside: usize,
    /// Largest force of the finger, N.
    pub hardest: f64,
    /// Velocity of the finger at the end, m/s, up is positive.
    pub rebound: f64,
    /// Largest tension that stretching added, N.
    pub stretch: f64,
    /// Largest part of the shortest wave of the grid in the string once the finger has left, m.
    pub ripple: f64,
}

/// Runs a scene with one finger.
pub fn tap(scene: &Scene) -> Result<Tap> {
    let mut tap = Tap::default();
    let mut was_pinned = false;
    let step = 1.0 / scene.sample_rate;
    let place = scene.finger[0].position.at(0.0);
    let reading = Simulation::new(scene)?.string(0).model.grid.reading(place);
    let fret = ground(scene)?.crowns.first().context("there are frets")?.0;
    let simulation = run(scene, |simulation, entry| {
        let string = simulation.string(0);
        // State after the step, force in the step.
        let (time, before) = (simulation.steps() as f64 * step, (simulation.steps() as f64 - 1.0) * step);
        let Some(finger) = string.fingers().next() else { return };
        if time < 1e-3 * SHOWN {
            if MOMENTS.get(tap.profiles.len()).is_some_and(|moment| time >= 1e-3 * moment) {
                tap.profiles.push(Profile::of(string));
            }
            tap.finger.push((1e3 * time, 1e3 * finger.height));
            tap.string.push((1e3 * time, 1e3 * string.state.displacement_at(&reading)));
            let fret = string.fret_forces().filter(|fret| fret.0 == 0).map(|fret| fret.1).fold(0.0, f64::max);
            for (course, force) in tap.forces.iter_mut().zip([finger.force, string.board_force(), fret]) {
                course.push((1e3 * before, force));
            }
        }
        if finger.force > 0.0 {
            let first = tap.touch.map_or(1e3 * before, |touch| touch.0);
            tap.touch = Some((first, 1e3 * before));
            tap.hardest = tap.hardest.max(finger.force);
            let grid = &string.model.grid;
            let points = string.places().zip(string.state.displacement()).take_while(|point| point.0 < fret);
            let lowest = points.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |point| point.0);
            tap.touched += 1;
            tap.beside += usize::from((lowest - place).abs() < grid.spacing);
        }
        let spec = StringParameters::from_spec(&scene.string[0]);
        tap.stretch =
            tap.stretch.max((2.0 * spec.axial_stiffness() * entry.energies.tension / spec.length).sqrt());
        if finger.force == 0.0 && tap.touch.is_some() {
            tap.ripple = tap.ripple.max(ripple(&string.state.displacement().collect::<Vec<_>>()));
        }
        let is_pinned = finger.force > 0.0 && string.board_force() > 0.0;
        tap.pinned += if is_pinned { 1e3 * step } else { 0.0 };
        tap.pins += usize::from(is_pinned && !was_pinned);
        was_pinned = is_pinned;
    })?;
    let finger = simulation.string(0).state.fingers().iter().flatten().next().context("there is a finger")?;
    tap.rebound = finger.motion / step;
    Ok(tap)
}

/// Neighbours that must alternate to be a ripple: a sharp bend alone has three.
const RIPPLES: usize = 8;

/// Largest amplitude of a wave that alternates from point to point: the mean of a sixteenth of the fourth difference over
/// neighbours that alternate in it.
fn ripple(heights: &[f64]) -> f64 {
    let fourth = |u: &[f64]| u[0] - 4.0 * u[1] + 6.0 * u[2] - 4.0 * u[3] + u[4];
    let parts: Vec<_> = heights.windows(5).map(|window| fourth(window) / 16.0).collect();
    let alternating =
        parts.windows(RIPPLES).filter(|part| part.windows(2).all(|pair| pair[0] * pair[1] < 0.0));
    let mean = |part: &[f64]| part.iter().map(|amplitude| amplitude.abs()).sum::<f64>() / RIPPLES as f64;
    alternating.map(mean).fold(0.0, f64::max)
}

/// Draws it, and measures what the paper says about it.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = repository.scene(SCENE)?;
    let tap = tap(&shortened(&scene, 0.02))?;
    let picture = draw(&scene, &tap)?;
    let sounds = vec![listen("paper_figure_4", &scene)?];
    Ok(Made { picture, section: Some(section(&scene, &tap)?), sounds })
}

fn draw(scene: &Scene, tap: &Tap) -> Result<String> {
    let ground = ground(scene)?;
    let mut profiles = Panel::new(
        "The string and the finger near the nut, from light to dark",
        Axis::linear("place, m from the nut", PLACES),
        Axis::linear("height, mm", -2.2..1.4).ticks(8),
    )
    .with(Layer::Ground(ground.clone()));
    let last = MOMENTS.len() - 1;
    for (index, (profile, moment)) in tap.profiles.iter().zip(MOMENTS).enumerate() {
        let strength = 0.3 + 0.7 * index as f64 / last as f64;
        let stroke = Stroke::new(colour::BLUE).faded(strength);
        let finger = Stroke::new(colour::GREEN).faded(strength);
        let name = format!("{moment} ms");
        profiles = profiles.with(Layer::line(name, stroke, profile.string.clone())).with(Layer::dots(
            if index == last { "finger" } else { "" },
            finger,
            profile.fingers.clone(),
        ));
    }
    let time = || Axis::linear("time, ms", 0.0..SHOWN);
    let crown = ground.crowns.first().map_or(0.0, |crown| crown.1);
    let board = ground.board.first().map_or(0.0, |point| point.1);
    let level = |height| vec![(0.0, height), (SHOWN, height)];
    let heights =
        Panel::new("Height at the finger’s place", time(), Axis::linear("height, mm", -2.2..2.2).ticks(6))
            .with(Layer::line("board", Stroke::new(colour::METAL), level(board)))
            .with(Layer::line("crowns", Stroke::new(colour::METAL).dashed(), level(crown)))
            .with(Layer::line("string", Stroke::new(colour::BLUE), tap.string.clone()))
            .with(Layer::line("finger", Stroke::new(colour::GREEN), tap.finger.clone()));
    let [finger, board, fret] = &tap.forces;
    let forces = Panel::new("Forces on the string", time(), Axis::linear("force, N", 0.0..1.1 * tap.hardest))
        .with(Layer::line("board", Stroke::thin(colour::ORANGE), board.clone()))
        .with(Layer::line("first fret", Stroke::thin(colour::VERMILION), fret.clone()))
        .with(Layer::line("finger", Stroke::thin(colour::GREEN), finger.clone()));
    Sheet::new("Figure 4: a finger taps the string", describe(scene))
        .row(1200, vec![profiles])
        .row(1200, vec![heights, forces])
        .draw()
}

fn section(scene: &Scene, tap: &Tap) -> Result<Section> {
    let (first, last) = tap.touch.context("the finger meets the string")?;
    let claims = vec![
        Claim::new(
            "The finger is “rebounding from the string”",
            format!(
                "touches it from {} to {} ms with at most {} N, leaves at {} m/s",
                significant(first, 3),
                significant(last, 3),
                significant(tap.hardest, 3),
                significant(tap.rebound, 3)
            ),
            tap.rebound > 0.0,
        ),
        Claim::new(
            "“accompanied by an intermediate pinning action against the fretboard itself”",
            format!("pinned for {} ms in {} pieces", significant(tap.pinned, 3), tap.pins),
            tap.pins > 0,
        ),
    ];
    // Other readings of what the paper leaves open.
    let mut rows = Vec::new();
    let board = |scene: &Scene, height: f64| {
        let mut scene = shortened(scene, 0.02);
        if let Some(fretboard) = &mut scene.fretboard {
            fretboard.board = Some(Curve::Constant(height).into());
        }
        scene
    };
    // Grids are made for the largest tension of the course, which comes when all is over.
    let mut roomy = shortened(scene, 0.02);
    let tension = scene.string[0].tension.at(0.0);
    roomy.string[0].tension = Curve::Points(vec![[0.0, tension], [1.0, tension], [1.1, 1.5 * tension]]);
    let mut from_bridge = shortened(scene, 0.02);
    let length = scene.string[0].length;
    let place = scene.finger[0].position.at(0.0);
    from_bridge.finger[0].position = Curve::Constant(length - place);
    let variations = [
        ("as drawn", shortened(scene, 0.02)),
        ("0.012 m from the bridge", from_bridge),
        ("board at −1.5 mm", board(scene, -1.5e-3)),
        ("board at −2.2 mm", board(scene, -2.2e-3)),
        ("grid with room for 90 N", roomy),
    ];
    for (name, scene) in &variations {
        let tap = self::tap(scene)?;
        rows.push(format!(
            "{name} | {} | {} | {} | {}",
            significant(tap.pinned, 3),
            significant(tap.hardest, 3),
            significant(tap.rebound, 3),
            significant(1e6 * tap.ripple, 2)
        ));
    }
    Ok(Section::new("Figure 4: a finger tap")
        .text(&format!(
            "Scene: [`figure_4.toml`](../{SCENE}). The finger comes from {} mm above the string, {place} m from the nut: \
             the paper says “from the end of the string”, and a fretting hand is at the nut. While \
             they touch, waves run along the string: between nut and first fret it is lowest within a grid spacing of the \
             finger in {} samples of {}.",
            significant(1e3 * scene.finger[0].height, 3),
            tap.beside,
            tap.touched,
        ))
        .picture("Profiles of the string near the nut with the finger, heights over time, and forces over time")
        .claims(claims)
        .text("What the open choices do:")
        .table("set-up | pinned, ms | finger at most, N | rebound, m/s | ripple, µm", &rows)
        .text(&format!(
            "**A limit of the paper’s grid.** Its spacing is the smallest that is stable at the tension at rest, {tension} N, \
             and the tap stretches the string by up to {} N more. The energy stays bounded all the same, but the shortest \
             wave of the grid grows into a ripple from point to point, which can be seen in the figure and is given \
             above. Little of it is left when the grid has room for the stretch, as that of every instrument here has \
             ([physics.md](physics.md#5-three-stencils)): let `tension` be a course that rises after the scene is over. The \
             figures on this page keep to the paper.",
            significant(tap.stretch, 2)
        )))
}

#[cfg(test)]
mod tests {
    use super::ripple;

    #[test]
    fn a_ripple_alternates_over_many_points() {
        let wave = |n: usize| if n.is_multiple_of(2) { 1e-5 } else { -1e-5 };
        let wavy: Vec<_> = (0..40).map(|n| 1e-3 * (0.1 * n as f64).sin() + wave(n)).collect();
        assert!((ripple(&wavy) - 1e-5).abs() < 1e-7, "{}", ripple(&wavy));
        let bent: Vec<_> = (0..40).map(|n| 1e-3 * (f64::from(n) - 20.0).abs()).collect();
        assert_eq!(ripple(&bent), 0.0);
    }
}
