//! Figure 3: how deep the string sinks into the frets, and what it costs to keep it out.

use anyhow::{Context, Result};
use low_action_dsp::Scene;
use low_action_dsp::contact::ContactLaw;
use low_action_figures::axis::power_of_ten;
use low_action_figures::course::BINS;
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Course, Layer, Panel, Sheet, Stroke};
use xtask::numbers::largest;

use super::Made;
use super::figure_2::SCENE;
use super::page::{Claim, Section};
use super::running::{Repository, ground, listen, run, shortened};

/// Length of the runs, s: 8820 steps. The deepest contacts come in the first periods.
const DURATION: f64 = 0.1;

/// Exponents of ten of the stiffnesses tried.
const STIFFNESSES: std::ops::RangeInclusive<i32> = 9..=20;

/// Exponents of ten whose course in time is drawn, and with which lines.
const DRAWN: [(i32, Stroke); 4] = [
    (9, Stroke::thin(colour::ORANGE)),
    (12, Stroke::thin(colour::GREEN)),
    (15, Stroke::thin(colour::BLUE)),
    (20, Stroke::thin(colour::PURPLE)),
];

/// What the paper says the penetration stays under, m.
const SAID: f64 = 1e-9;

/// What a run came to.
struct Outcome {
    stiffness: f64,
    /// Deepest penetration in each step, and the bound that the energy sets, m.
    depth: Course,
    bound: Course,
    /// The largest part of the bound in its own step that a penetration came to.
    closest: f64,
    /// Newton iterations in steps with contact: sum, number of steps, most.
    iterations: (u64, u64, u32),
    /// What the law came to under this string: no steeper than the engine lets walls be.
    law: ContactLaw,
}

impl Outcome {
    fn mean_iterations(&self) -> f64 {
        self.iterations.0 as f64 / self.iterations.1.max(1) as f64
    }

    /// Whether a wall came to be as steep as the engine lets it, so that a straight line was measured and not the law.
    fn is_straight(&self) -> bool {
        self.law.stiffness() < self.stiffness || self.depth.largest() > self.law.knee()
    }
}

/// The scene with another contact law.
fn with_law(scene: &Scene, stiffness: f64, exponent: f64) -> Result<Scene> {
    let mut scene = shortened(scene, DURATION);
    let fretboard = scene.fretboard.as_mut().context("the scene needs a fretboard")?;
    fretboard.stiffness = stiffness;
    fretboard.exponent = exponent;
    Ok(scene)
}

fn observe(scene: &Scene, stiffness: f64, exponent: f64) -> Result<Outcome> {
    let scene = with_law(scene, stiffness, exponent)?;
    let samples = scene.samples();
    let (mut depth, mut bound) = (Course::new(samples, BINS), Course::new(samples, BINS));
    let (mut closest, mut iterations) = (0.0f64, (0, 0, 0));
    let walls = low_action_dsp::Simulation::new(&scene)?;
    let law = walls.string(0).model.contacts.first().context("there are frets")?.law;
    run(&scene, |simulation, entry| {
        let string = simulation.string(0);
        let deepest = string.penetration();
        depth.add(deepest);
        // Half of Φ at n + 1 is part of the energy at n + ½, so Kη^(α+1)/(α+1) ≤ 2𝔥.
        let energy = entry.energies.total().max(0.0);
        let most = libm::pow(2.0 * (exponent + 1.0) * energy / stiffness, 1.0 / (exponent + 1.0));
        bound.add(most);
        if deepest > 0.0 {
            closest = largest([closest, deepest / most]);
        }
        let convergence = &string.convergence;
        if convergence.active > 0 {
            let taken = convergence.iterations;
            iterations = (iterations.0 + u64::from(taken), iterations.1 + 1, iterations.2.max(taken));
        }
    })?;
    Ok(Outcome { stiffness, depth, bound, closest, iterations, law })
}

/// Draws it, and measures what the paper says about it.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = repository.scene(SCENE)?;
    let exponent = exponent(&scene)?;
    let outcomes: Vec<_> = STIFFNESSES
        .map(|power| observe(&scene, libm::exp10(f64::from(power)), exponent))
        .collect::<Result<_>>()?;
    let picture = draw(&scene, exponent, &outcomes)?;
    let mut soft = with_law(&scene, 1e9, exponent)?;
    soft.duration = scene.duration;
    let sounds = vec![listen("paper_figure_3_soft_frets", &soft)?];
    Ok(Made { picture, section: Some(section(&scene, &outcomes)?), sounds })
}

/// The exponent of the scene's frets.
fn exponent(scene: &Scene) -> Result<f64> {
    Ok(scene.fretboard.as_ref().context("the scene needs a fretboard")?.exponent)
}

fn draw(scene: &Scene, exponent: f64, outcomes: &[Outcome]) -> Result<String> {
    let step = 1e3 / scene.sample_rate;
    let time = || Axis::linear("time, ms", 0.0..1e3 * DURATION);
    let mut courses = Panel::new(
        "Deepest penetration in each step; dashed: the bound by energy",
        time(),
        Axis::log("penetration, m", 1e-10..1e-3).ticks(8),
    );
    for (power, stroke) in DRAWN {
        let Some(outcome) = outcomes.get((power - STIFFNESSES.start()) as usize) else { continue };
        let name = format!("K = {}", power_of_ten(power));
        courses = courses
            .with(Layer::line(name, stroke, outcome.depth.peaks(1.0, step, 1.0)))
            .with(Layer::line("", stroke.dashed(), outcome.bound.peaks(1.0, step, 1.0)));
    }
    let said = Stroke::new(colour::VERMILION).dashed();
    courses = courses.with(Layer::line("the paper’s limit", said, vec![(0.0, SAID), (1e3 * DURATION, SAID)]));
    let stiffness =
        || Axis::log(format!("stiffness K, N/m^{}", significant(exponent, 3)), 4e8..2.5e20).ticks(12);
    let points = |of: &dyn Fn(&Outcome) -> f64| outcomes.iter().map(|o| (o.stiffness, of(o))).collect();
    let depth = |outcome: &Outcome| outcome.depth.largest();
    let deepest =
        Panel::new("Deepest of all", stiffness(), Axis::log("penetration, m", 1e-10..1e-3).ticks(8))
            .with(Layer::line("bound", Stroke::new(colour::BLUE).dashed(), points(&|o| o.bound.largest())))
            .with(Layer::line("measured", Stroke::new(colour::BLUE), points(&depth)))
            .with(Layer::dots("", Stroke::new(colour::BLUE), points(&depth)))
            .with(Layer::line("the paper’s limit", said, vec![(4e8, SAID), (2.5e20, SAID)]));
    let most = |outcome: &Outcome| f64::from(outcome.iterations.2);
    let cost = Panel::new(
        "Newton iterations in a step with contact",
        stiffness(),
        Axis::linear("iterations", 0.0..24.0),
    )
    .with(Layer::line("most", Stroke::new(colour::PURPLE), points(&most)))
    .with(Layer::dots("", Stroke::new(colour::PURPLE), points(&most)))
    .with(Layer::line("on average", Stroke::new(colour::GREEN), points(&Outcome::mean_iterations)))
    .with(Layer::dots("", Stroke::new(colour::GREEN), points(&Outcome::mean_iterations)));
    let caption = format!(
        "{} But K of the fretboard is as marked. The first {} ms, tolerance {} m. The energy bound on a penetration is (2(α+1)H/K)^(1/(α+1)), H the energy of all.",
        describe(scene),
        1e3 * DURATION,
        significant(scene.solver.tolerance, 3)
    );
    Sheet::new("Figure 3: penetration into the frets, for stiffer and stiffer frets", caption)
        .row(1200, vec![courses])
        .row(1000, vec![deepest, cost])
        .draw()
}

fn section(scene: &Scene, outcomes: &[Outcome]) -> Result<Section> {
    let said = outcomes.iter().find(|o| o.stiffness == 1e15).context("the paper's K is among those tried")?;
    let depths: Vec<_> = outcomes.iter().map(|outcome| outcome.depth.largest()).collect();
    let closest = largest(outcomes.iter().map(|outcome| outcome.closest));
    let (first, last) =
        (outcomes.first().context("there are some")?, outcomes.last().context("there are some")?);
    let less = depths.windows(2).all(|pair| pair[1] < pair[0]);
    let claims = vec![
        Claim::new(
            "The penetration for the pluck of Figure 2 “takes on values under 10⁻⁹ m” at K = 10¹⁵",
            format!("{} m", significant(said.depth.largest(), 3)),
            said.depth.largest() < SAID,
        ),
        Claim::new(
            "“the larger [K] is, the less the penetration”",
            format!(
                "from {} m at K = 10⁹ to {} m at 10²⁰, {} at every step",
                significant(first.depth.largest(), 3),
                significant(last.depth.largest(), 3),
                if less { "less" } else { "not less" }
            ),
            less,
        ),
        Claim::new(
            "“with the side effect that the number of iterations required in Newton’s method tends to increase”",
            format!(
                "on average from {} to {}, at most from {} to {}",
                significant(first.mean_iterations(), 2),
                significant(last.mean_iterations(), 3),
                first.iterations.2,
                last.iterations.2
            ),
            last.mean_iterations() > first.mean_iterations(),
        ),
        Claim::ours(
            "No penetration exceeds the energy bound of its step",
            format!(
                "at K = 10¹⁵ at most {} of it, at any K at most {}",
                significant(said.closest, 2),
                significant(closest, 2)
            ),
            closest <= 1.0,
        ),
        Claim::ours(
            "The paper’s 50 iterations are enough at every K shown",
            format!("at most {}", outcomes.iter().map(|o| o.iterations.2).max().unwrap_or(0)),
            outcomes.iter().all(|o| o.iterations.2 < 50),
        ),
    ];
    let grid = low_action_dsp::Simulation::new(scene)?.string(0).model.grid;
    let mass = scene.string[0].linear_density * grid.spacing;
    let depth_of_crowns = -ground(scene)?.crowns.first().context("the scene needs frets")?.1;
    // Of the energy, K η^(α+1)/(α+1).
    let exponent = exponent(scene)?;
    let power = exponent + 1.0;
    let [alpha, beyond] = [exponent, power].map(|number| significant(number, 3));
    let (linear, faster) =
        (observe(scene, 1e15, 1.0)?, Scene { sample_rate: 4.0 * scene.sample_rate, ..scene.clone() });
    let finer = observe(&faster, 1e15, 1.0)?;
    let steepest = linear.law.stiffness();
    let table: Vec<_> = [exponent, 2.0, 1.5, 1.3, 1.0]
        .into_iter()
        .map(|exponent| row(scene, exponent))
        .collect::<Result<_>>()?;
    Ok(Section::new("Figure 3: spurious penetration")
        .text(&format!(
            "Scene: [`figure_2.toml`](../{SCENE}) with `stiffness` from 1e9 to 1e20, the first {} s.",
            DURATION
        ))
        .picture("Penetration over time for four stiffnesses, the deepest over stiffness, and iterations over stiffness")
        .claims(claims)
        .text(&format!(
            "What is measured is {} % of the {} mm between string and crowns, and nothing that could be seen or heard. \
             But **10⁻⁹ m it cannot be**: a grid point of the string, mass ρh = {} mg, that comes at 1 m/s and is \
             stopped by a spring of K = 10¹⁵ and α = {alpha} sinks in until ½ρhv² = Kη^{beyond}/{beyond}, which is at η = {} m.",
            significant(1e5 * said.depth.largest() / depth_of_crowns, 1),
            significant(depth_of_crowns, 3),
            significant(1e6 * mass, 2),
            significant(libm::pow(0.5 * mass * power / said.stiffness, 1.0 / power), 2)
        ))
        .text(&format!(
            "**Nearest set-up at which it holds.** No wall of the engine grows steeper than doubles can tell \
             ([solver.md](solver.md#how-stiff-is-allowed)), which on this string is {} N/m, whatever its exponent and K. Into the \
             steepest the string sinks by {} m, at four times the rate, where walls may be steeper, by {} m: there it {}. \
             (With α = 1 the depth goes as 1/√K. Without that limit K = 10¹⁵ would come to {} m at the paper’s rate.) For each \
             exponent, the deepest penetration at K = 10¹⁵ and at the largest power of ten with which the law is nowhere so \
             steep as that:",
            significant(steepest, 2),
            significant(linear.depth.largest(), 3),
            significant(finer.depth.largest(), 3),
            if finer.depth.largest() < SAID { "holds" } else { "fails as well" },
            significant(linear.depth.largest() * (steepest / linear.stiffness).sqrt(), 2)
        ))
        .table("exponent α | at K = 10¹⁵, m | largest K | there, m", &table))
}

/// A row of the table: an exponent, the depth at the paper's K, the largest power of ten that is not a straight line, and the
/// depth there.
fn row(scene: &Scene, exponent: f64) -> Result<String> {
    let depth = |run: &Outcome| significant(run.depth.largest(), 3);
    let said = observe(scene, 1e15, exponent)?;
    // (What is too stiff for this rate is refused.)
    let largest = (9..30)
        .rev()
        .filter_map(|power| observe(scene, libm::exp10(f64::from(power)), exponent).ok())
        .find(|run| !run.is_straight())
        .context("soft walls are not that steep")?;
    let at_said = if said.is_straight() { "steeper than that".to_owned() } else { depth(&said) };
    Ok(format!("{exponent} | {at_said} | {} | {}", significant(largest.stiffness, 1), depth(&largest)))
}
