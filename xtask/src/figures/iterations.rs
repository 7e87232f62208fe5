//! The paper's closing remarks: whether the iteration converges, and how few iterations do.

use anyhow::Result;
use low_action_dsp::Scene;
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Layer, Panel, Sheet, Stroke};

use super::Made;
use super::page::{Claim, Section};
use super::running::{Repository, listen, run, shortened};

/// The scenes, with what they are called, their length, s, and their lines.
const SCENES: [(&str, &str, f64, Stroke); 3] = [
    ("pluck", "scenes/paper/figure_2.toml", 0.1, Stroke::new(colour::ORANGE)),
    ("tap", "scenes/paper/figure_4.toml", 0.1, Stroke::new(colour::GREEN)),
    ("slide", "scenes/paper/figure_6.toml", 1.2, Stroke::new(colour::BLUE)),
];

/// Caps on the iterations tried; the last is the paper's.
const CAPS: [usize; 10] = [0, 1, 2, 3, 4, 6, 8, 10, 20, 50];

/// A tolerance that would do for audio, m.
const COARSE: f64 = 1e-9;

/// What a run came to.
struct Run {
    cap: usize,
    /// Newton iterations on average in a step with contact, and at most.
    mean: f64,
    most: u32,
    /// Steps with contact, and those in which the fallback took over.
    contacts: u64,
    fallbacks: u64,
    /// Those of them in which the iteration had not reached its cap.
    refused: u64,
    /// Energy that inexact solutions took, as a part of the largest.
    taken: f64,
}

fn observe(scene: &Scene, cap: usize) -> Result<Run> {
    let mut scene = scene.clone();
    scene.solver.max_iterations = cap;
    let mut outcome = Run { cap, mean: 0.0, most: 0, contacts: 0, fallbacks: 0, refused: 0, taken: 0.0 };
    let mut iterations = 0;
    let simulation = run(&scene, |simulation, entry| {
        let convergence = &simulation.string(0).convergence;
        outcome.taken += entry.power_solver / scene.sample_rate;
        outcome.contacts += u64::from(convergence.active > 0);
        iterations += u64::from(convergence.iterations);
        outcome.most = outcome.most.max(convergence.iterations);
        if convergence.fallbacks > 0 {
            outcome.fallbacks += 1;
            outcome.refused += u64::from((convergence.iterations as usize) < cap);
        }
    })?;
    outcome.taken /= simulation.ledgers()[0].largest;
    outcome.mean = iterations as f64 / outcome.contacts.max(1) as f64;
    Ok(outcome)
}

/// Draws it, and measures what the paper says about it.
pub fn make(repository: &Repository) -> Result<Made> {
    let scenes: Vec<_> = SCENES.iter().map(|(_, path, ..)| repository.scene(path)).collect::<Result<_>>()?;
    let (mut runs, mut coarse) = (Vec::new(), Vec::new());
    for (scene, (_, _, duration, _)) in scenes.iter().zip(SCENES) {
        let mut scene = shortened(scene, duration);
        runs.push(CAPS.iter().map(|cap| observe(&scene, *cap)).collect::<Result<Vec<_>>>()?);
        scene.solver.tolerance = COARSE;
        coarse.push(observe(&scene, CAPS[CAPS.len() - 1])?.mean);
    }
    let mut capped = scenes[2].clone();
    capped.solver.max_iterations = 4;
    let sounds = vec![listen("paper_iterations_cap_4", &capped)?];
    Ok(Made { picture: draw(&scenes, &runs)?, section: Some(section(&scenes, &runs, &coarse)), sounds })
}

fn draw(scenes: &[Scene], runs: &[Vec<Run>]) -> Result<String> {
    // One place for each cap: they are not evenly apart.
    let caps = || Axis::linear("cap on the iterations", -0.3..CAPS.len() as f64 - 0.7).named(names());
    let mut fallback =
        Panel::new("Steps with contact that take the fallback", caps(), Axis::linear("part, %", 0.0..104.0));
    let mut taken = Panel::new(
        "Energy lost to inexact contact forces",
        caps(),
        Axis::log("part of the largest energy", 1e-16..1.0).ticks(9),
    );
    for (runs, (name, _, _, stroke)) in runs.iter().zip(SCENES) {
        let points = |of: &dyn Fn(&Run) -> f64| -> Vec<(f64, f64)> {
            runs.iter().enumerate().map(|(place, run)| (place as f64, of(run))).collect()
        };
        let part = points(&|run| 100.0 * run.fallbacks as f64 / run.contacts.max(1) as f64);
        fallback = fallback.with(Layer::line(name, stroke, part.clone())).with(Layer::dots("", stroke, part));
        let part = points(&|run| run.taken.abs());
        taken = taken.with(Layer::line(name, stroke, part.clone())).with(Layer::dots("", stroke, part));
    }
    let caption = format!(
        "The scenes of Figures 2 ({} N, {} s), 4 ({} s) and 6 with other caps. Of the last: {}",
        significant(scenes[0].pluck[0].force, 3),
        SCENES[0].2,
        SCENES[1].2,
        describe(&scenes[2])
    );
    Sheet::new("What iterations buy", caption).row(1300, vec![fallback, taken]).draw()
}

fn names() -> Vec<String> {
    CAPS.iter().map(usize::to_string).collect()
}

fn section(scenes: &[Scene], runs: &[Vec<Run>], coarse: &[f64]) -> Section {
    let full = || runs.iter().filter_map(|runs| runs.last());
    let most = full().map(|run| run.most).max().unwrap_or(0);
    let (fallbacks, contacts) = full().fold((0, 0), |sum, run| (sum.0 + run.fallbacks, sum.1 + run.contacts));
    let refused: u64 = full().map(|run| run.refused).sum();
    let listed = |of: &dyn Fn(&Run) -> String, cap: usize| {
        let each = runs.iter().filter_map(|runs| runs.iter().find(|run| run.cap == cap));
        each.map(of).collect::<Vec<_>>().join(", ")
    };
    let at_20 = runs.iter().filter_map(|runs| runs.iter().find(|run| run.cap == 20));
    let mut fine: Vec<_> = scenes.iter().map(|scene| significant(scene.solver.tolerance, 1)).collect();
    fine.dedup();
    let same = at_20.zip(full()).all(|(one, other)| one.taken == other.taken);
    let claims = vec![
        Claim::ours(
            "Every step is solved to the tolerance within the paper’s 50 iterations",
            format!(
                "{contacts} steps with contact in pluck, tap and slide took at most {most}; {fallbacks} of them the fallback"
            ),
            fallbacks == 0 && most < 50,
        ),
        Claim::new(
            "“50 iterations have been employed, for results to machine accuracy, though this can be significantly \
             reduced”",
            format!(
                "{} on average, at most {most}; a cap of 20 gives {} as 50",
                listed(&|run| significant(run.mean, 2), 50),
                if same { "the same" } else { "not the same" }
            ),
            same,
        ),
    ];
    let mut section = Section::new("Closing remarks: iterations")
        .text(
            "The paper leaves open whether each step has one solution and whether Newton’s method finds it. For the scheme \
             as built here both are proved in [solver.md](solver.md): the changes of penetration are the minimum of a \
             strongly convex function, the forces follow from them, and the step is searched along the line. What is left to \
             measure is how soon. Scenes: those of Figures 2, 4 and 6.",
        )
        .picture("Part of the steps that take the fallback, and energy lost to inexact forces, over the cap on iterations")
        .claims(claims)
        .text(&format!(
            "Below what a step needs, the secant fallback keeps the result passive, but it costs energy: with a cap of 8 \
             pluck, tap and slide lose {} % of their largest energy to it, with 4 {} %. A tolerance of {} m instead \
             of {} m takes {} iterations on average instead of {}.",
            listed(&|run| significant(100.0 * run.taken, 2), 8),
            listed(&|run| significant(100.0 * run.taken, 2), 4),
            significant(COARSE, 1),
            fine.join(", "),
            coarse.iter().map(|mean| significant(*mean, 2)).collect::<Vec<_>>().join(", "),
            listed(&|run| significant(run.mean, 2), 50)
        ));
    if refused > 0 {
        section = section.text(&format!(
            "**Why a step that has converged takes the fallback** ({refused} of them at a cap of 50): what inexact \
             solutions have put in is kept in an account, and refused where it would pass 10⁻¹² of the largest energy. In \
             the slide nothing that the finger or its pad could lose pays it back, and after a tenth of a second of \
             constant contact a converged solution meets an account that is full. The secant that replaces it for one step \
             takes {} % of the largest energy. **Nearest set-up at which the statement holds**: a pad or a hand with some \
             loss, as in [`ledger.toml`](../scenes/paper/ledger.toml), or pluck and tap.",
            listed(&|run| significant(100.0 * run.taken.max(0.0), 2), 50)
        ));
    }
    section
}
