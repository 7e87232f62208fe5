//! Beyond the paper: how fast the three stencils come to the exact solutions.

use std::f64::consts::PI;

use anyhow::Result;
use low_action_dsp::curve::Curve;
use low_action_dsp::scene::ListeningPoint;
use low_action_dsp::{Scene, Simulation, Stencil, StringParameters};
use low_action_figures::describe::significant;
use low_action_figures::{Axis, Layer, Panel, Sheet};
use xtask::stencils::STENCILS;

use super::Made;
use super::modes::partials;
use super::page::{Claim, Section};
use super::running::{Repository, listen};

const STRING: &str = "scenes/paper/figure_2.toml";
const BARRIER: &str = "scenes/paper/barrier.toml";

/// Orders in the grid spacing that the analysis promises for partials, of an ideal string and of a stiff one.
/// Stiffness leaves an error of κ²h²γ⁶/6 that only the wide stencil takes out, and then one of h⁴.
const IDEAL: [f64; 3] = [2.0, 4.0, 6.0];
const STIFF: [f64; 3] = [2.0, 2.0, 4.0];

/// How far an order may be from what is promised, as a part of it.
const WITHIN: f64 = 0.1;

/// Rates at which the stiff string is measured, Hz, and the number of the partial.
const RATES: [f64; 5] = [22_050.0, 44_100.0, 88_200.0, 176_400.0, 352_800.0];
const PARTIAL: usize = 20;

/// Spacings that a wave travels in a step on the grids of the ideal string: with 1 there is no error at all.
const COURANT: f64 = 0.8;

/// Grids on which the string over a board is measured.
const GRIDS: [usize; 5] = [50, 100, 200, 400, 800];

/// Points (size of the grid or rate, error).
type Errors = Vec<(f64, f64)>;

/// What was measured, of each stencil.
struct Measured {
    ideal: Vec<Errors>,
    stiff: Vec<Errors>,
    triangle: Vec<Errors>,
    arch: Vec<Errors>,
    /// Of the stiff string at 88.2 kHz, cents.
    at_88: Vec<f64>,
}

/// Draws it and measures the orders.
pub fn make(repository: &Repository) -> Result<Made> {
    let (string, barrier) = (repository.scene(STRING)?, repository.scene(BARRIER)?);
    let each = |errors: &dyn Fn(Stencil) -> Result<Errors>| -> Result<Vec<Errors>> {
        STENCILS.iter().map(|stencil| errors(stencil.0)).collect()
    };
    let measured = Measured {
        ideal: each(&|stencil| GRIDS.iter().map(|&intervals| ideal(&string, stencil, intervals)).collect())?,
        stiff: each(&|stencil| RATES.iter().map(|&rate| detuning(&string, stencil, rate)).collect())?,
        triangle: each(&|stencil| over_board(&barrier, stencil, Shape::Triangle))?,
        arch: each(&|stencil| over_board(&barrier, stencil, Shape::Arch))?,
        at_88: each(&|stencil| Ok(vec![detuning(&string, stencil, 88_200.0)?]))?
            .iter()
            .map(|e| e[0].1)
            .collect(),
    };
    let mut listened = barrier.clone();
    listened.duration = 0.5;
    listened.sample_rate = 32_969.0;
    listened.output.position = ListeningPoint::At(0.55);
    let sounds = vec![listen("beyond_convergence", &listened)?];
    Ok(Made { picture: draw(&measured)?, section: Some(section(&measured)), sounds })
}

/// |Error| of the partial of the paper's string, cents, with the intervals of its grid.
fn detuning(scene: &Scene, stencil: Stencil, rate: f64) -> Result<(f64, f64)> {
    let mut scene = Scene { sample_rate: rate, ..scene.clone() };
    scene.solver.stencil = stencil;
    scene.string[0].loss_0 = Some(0.0);
    scene.string[0].loss_1 = Some(0.0);
    let parameters = StringParameters::from_spec(&scene.string[0]);
    let number = PARTIAL as f64 * PI / parameters.length;
    let speed2 = parameters.tension / parameters.linear_density;
    let exact = (speed2 * number.powi(2) + parameters.kappa_squared() * number.powi(4)).sqrt() / (2.0 * PI);
    let found = partials(&scene, 0, &[PARTIAL], (0.05 * rate) as usize)?[0].frequency;
    let intervals = Simulation::new(&scene)?.string(0).model.grid.intervals;
    Ok((intervals as f64, (1200.0 * libm::log2(found / exact)).abs()))
}

/// The same without stiffness, on a grid of so many intervals.
fn ideal(scene: &Scene, stencil: Stencil, intervals: usize) -> Result<(f64, f64)> {
    let mut scene = scene.clone();
    let spec = &mut scene.string[0];
    spec.youngs_modulus = 0.0;
    let tension = spec.tension.at(0.0);
    // Grids are made for the largest tension of the course, which comes when all is over.
    let limit = tension / (COURANT * COURANT);
    spec.tension = Curve::Points(vec![[0.0, tension], [1.0, tension], [2.0, limit]]);
    let rate = (limit / spec.linear_density).sqrt() * (intervals as f64 + 0.5) / spec.length;
    detuning(&scene, stencil, rate)
}

/// What the string over the board is let go from.
#[derive(Clone, Copy, PartialEq)]
enum Shape {
    /// A triangle above a board at −d.
    Triangle,
    /// An arch of a sine over a board at 0: the free motion, folded up.
    Arch,
}

/// Over two periods, the root of the mean square difference from the exact solution, % of the height A.
fn over_board(scene: &Scene, stencil: Stencil, shape: Shape) -> Result<Errors> {
    let height = 3e-3;
    let depth = if shape == Shape::Triangle { 1e-3 } else { 0.0 };
    let spec = &scene.string[0];
    let length = spec.length;
    let speed = (spec.tension.at(0.0) / spec.linear_density).sqrt();
    let period = length / speed * (1.0 + depth / height);
    let exact = |x: f64, t: f64| match shape {
        Shape::Triangle => {
            let since_turn = (t % period).min(period - t % period);
            let top = height * (1.0 - 2.0 * speed * since_turn / length);
            let start = height * (1.0 - (2.0 * x / length - 1.0).abs());
            if top >= 0.0 { start.min(top) } else { top.max(-start) }
        }
        Shape::Arch => height * (libm::sin(PI * x / length) * libm::cos(PI * speed * t / length)).abs(),
    };
    let mut errors = Vec::new();
    for intervals in GRIDS {
        let mut scene = scene.clone();
        scene.solver.stencil = stencil;
        scene.sample_rate = speed * (intervals as f64 + 0.5) / length;
        if let Some(fretboard) = &mut scene.fretboard {
            fretboard.board = Some(Curve::Constant(-depth).into());
        }
        scene.string[0].shape = None;
        let places: Vec<f64> = Simulation::new(&scene)?.string(0).places().collect();
        let inner = places.iter().map(|&x| [x, exact(x, 0.0)]);
        scene.string[0].shape = Some([[0.0, 0.0]].into_iter().chain(inner).chain([[length, 0.0]]).collect());
        let mut simulation = Simulation::new(&scene)?;
        let (mut sum, mut count) = (0.0, 0.0);
        for n in 0..(2.0 * period * scene.sample_rate) as usize {
            let time = n as f64 / scene.sample_rate;
            for (&x, u) in places.iter().zip(simulation.string(0).state.displacement()) {
                sum += ((u - exact(x, time)) / height).powi(2);
                count += 1.0;
            }
            simulation.step();
        }
        errors.push((places.len() as f64 + 1.0, 100.0 * f64::sqrt(sum / count)));
    }
    Ok(errors)
}

/// The power with which an error falls from the first to the last point, by least squares in logarithms.
fn order(errors: &Errors) -> f64 {
    let points: Vec<_> = errors.iter().map(|&(size, error)| (libm::log2(size), libm::log2(error))).collect();
    let count = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / count, sum.1 + p.1 / count));
    let along = points.iter().map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum::<f64>();
    let across = points.iter().map(|p| (p.0 - mean.0).powi(2)).sum::<f64>();
    -along / across
}

fn draw(measured: &Measured) -> Result<String> {
    let intervals = || Axis::log("intervals of the grid", 30.0..1e3).ticks(3);
    let cents = |title: &str| Panel::new(title, intervals(), Axis::log("error, cents", 1e-8..1e3).ticks(12));
    let mut ideal = cents(&format!("Partial {PARTIAL}, ideal string"));
    let mut stiff = cents(&format!("Partial {PARTIAL}, the paper’s string"));
    let mut board = Panel::new(
        "An ideal string bouncing on a flat board",
        intervals(),
        Axis::log("error, % of the height (rms)", 1e-1..1e1).ticks(3),
    );
    for (index, (stencil, stroke)) in STENCILS.into_iter().enumerate() {
        let name = stencil.name();
        let add = |panel: Panel, errors: &Errors| {
            panel.with(Layer::line(name, stroke, errors.clone())).with(Layer::dots(
                "",
                stroke,
                errors.clone(),
            ))
        };
        ideal = add(ideal, &measured.ideal[index]);
        stiff = add(stiff, &measured.stiff[index]);
        // One over the other where they agree: narrower in front.
        let stroke = stroke.wide(24 - 8 * index as u32);
        board = board
            .with(Layer::line(format!("{name}, triangle"), stroke, measured.triangle[index].clone()))
            .with(Layer::line(format!("{name}, arch"), stroke.dashed(), measured.arch[index].clone()));
    }
    let caption = format!(
        "Above: strings of 0.65 m, 5.25 g/m and 60 N without losses, let go in the shape of the partial; left without \
         stiffness, a wave travelling {COURANT} spacings in a step; right with E = 200 GPa and r = 0.43 mm, at 22.05 to \
         352.8 kHz. Below: no stiffness, losses or stretching, over a board of 10⁹ N/m a point; a triangle of 3 mm over a \
         board 1 mm below the string, and an arch of 3 mm over a board at its rest position, against the exact \
         solutions over two periods. Lines of the three stencils lie on each other."
    );
    Sheet::new("Convergence on exact solutions", caption)
        .row(1300, vec![ideal, stiff])
        .row(1100, vec![board])
        .draw()
}

fn section(measured: &Measured) -> Section {
    let mut claims = Vec::new();
    let mut rows = Vec::new();
    for (index, (stencil, _)) in STENCILS.into_iter().enumerate() {
        let name = stencil.name();
        let orders = [order(&measured.ideal[index]), order(&measured.stiff[index])];
        let promised = [IDEAL[index], STIFF[index]];
        claims.push(Claim::ours(
            format!(
                "`{name}`: partials converge with order {} without stiffness, {} with",
                promised[0], promised[1]
            ),
            format!(
                "orders {} and {}; the paper’s string at 88.2 kHz is off by {} cents",
                significant(orders[0], 3),
                significant(orders[1], 3),
                significant(measured.at_88[index], 2)
            ),
            orders.iter().zip(promised).all(|(found, promised)| (found - promised).abs() < WITHIN * promised),
        ));
        let errors = |errors: &Errors| {
            errors.iter().map(|point| significant(point.1, 3)).collect::<Vec<_>>().join(" | ")
        };
        rows.push(format!("`{name}`, triangle | {}", errors(&measured.triangle[index])));
        rows.push(format!("`{name}`, arch | {}", errors(&measured.arch[index])));
    }
    let orders: Vec<_> = measured.triangle.iter().chain(&measured.arch).map(order).collect();
    let (least, most) = orders.iter().fold((f64::MAX, 0.0), |(a, b), &o| (f64::min(a, o), f64::max(b, o)));
    claims.push(Claim::ours(
        "Over a board all three converge with order 1",
        format!("orders {} to {}", significant(least, 3), significant(most, 3)),
        least > 1.0 - WITHIN && most < 1.0 + WITHIN,
    ));
    Section::new("Beyond: convergence on exact solutions")
        .text(&format!(
            "Scenes: the string of [`figure_2.toml`](../{STRING}) alone, and [`barrier.toml`](../{BARRIER}). A scheme \
             that conserves energy need not be accurate; where there are exact solutions the error can be measured. \
             Orders are powers of the grid spacing; within {} % of what is promised they are taken as that. The better stencils ([physics.md](physics.md#5-three-stencils)) make \
             partials right, not bounces: one takes up to two samples longer than no time with any of them. (A stiff string’s \
             spacing goes with the root of the time step, so twice the rate is far from half the spacing.)",
            100.0 * WITHIN
        ))
        .picture("Error of a partial for an ideal and a stiff string, and of a bouncing string, over the grid, for three stencils")
        .claims(claims)
        .text("Error over the board, % of the height (rms over two periods), for grids of so many intervals:")
        .table("| 50 | 100 | 200 | 400 | 800", &rows)
}
