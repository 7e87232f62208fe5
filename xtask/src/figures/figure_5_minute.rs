//! Figure 5 for a minute: how well energy is kept, and what limits it.

use anyhow::Result;
use low_action_dsp::Scene;
use low_action_figures::course::BINS;
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Course, Layer, Panel, Sheet, Stroke};

use super::Made;
use super::figure_5::SCENE;
use super::page::{Claim, Section};
use super::running::{Repository, run, shortened};
use super::sound::Sound;

/// Length of the long run, s.
const MINUTE: f64 = 60.0;

/// Tolerance of the finer of the two long runs, m.
const FINER: f64 = 1e-17;

/// How the energy of a long run varied, as a part of what there was at first.
struct Minute {
    /// All of it, the part from inexact contact forces, and the part from rounding.
    courses: [Course; 3],
    /// When contacts pushed, s, each sample by itself, and the largest force of one, N.
    contacts: Vec<f64>,
    hardest: f64,
    /// What is heard of the last [`HEARD`] seconds.
    sound: Vec<f64>,
}

/// Length of the sound, s.
const HEARD: f64 = 3.0;

impl Minute {
    fn observe(scene: &Scene) -> Result<Minute> {
        let samples = (scene.duration * scene.sample_rate) as u64;
        let mut courses = [0, 1, 2].map(|_| Course::new(samples, BINS));
        let (mut first, mut solver, mut rounding) = (None, 0.0, 0.0);
        let (mut contacts, mut hardest, mut sound) = (Vec::new(), 0.0f64, Vec::new());
        let heard = samples - (HEARD * scene.sample_rate) as u64;
        run(scene, |simulation, entry| {
            let total = entry.energies.total();
            let first = *first.get_or_insert(total);
            solver -= entry.power_solver / scene.sample_rate;
            // What the first step leaves open is not in the change since.
            rounding += if simulation.steps() > 1 { entry.residual } else { 0.0 };
            let parts = [total / first - 1.0, solver / first, rounding / first];
            courses.iter_mut().zip(parts).for_each(|(course, part)| course.add(part));
            if simulation.steps() > heard {
                sound.push(simulation.output());
            }
            let string = simulation.string(0);
            let force = string.scratch.forces().map(|(_, force)| force).fold(0.0, f64::max);
            hardest = hardest.max(force);
            if force > 0.0 {
                contacts.push(simulation.steps() as f64 / scene.sample_rate);
            }
        })?;
        Ok(Minute { courses, contacts, hardest, sound })
    }

    /// When a part of all samples with contact is over, s.
    fn over(&self, part: f64) -> f64 {
        let place = (part * self.contacts.len() as f64) as usize;
        self.contacts.get(place.saturating_sub(1)).copied().unwrap_or(0.0)
    }

    /// The largest variation of each course.
    fn largest(&self) -> [f64; 3] {
        self.courses.each_ref().map(|course| course.largest().abs().max(course.smallest().abs()))
    }
}

/// Draws it, and measures how well energy is kept.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = shortened(&repository.scene(SCENE)?, MINUTE);
    let mut finer = scene.clone();
    finer.solver.tolerance = FINER;
    let observe = |scene: &Scene, which: &str| {
        eprintln!("a minute, {which}");
        Minute::observe(scene)
    };
    let (minute, finer) = (observe(&scene, "1 of 2")?, observe(&finer, "2 of 2")?);
    let picture = draw(&scene, &minute, &finer)?;
    let samples = (MINUTE * scene.sample_rate) as u64;
    let ([all, solver, rounding], [all_finer, ..]) = (minute.largest(), finer.largest());
    let first = 0.5 * scene.finger[0].mass * scene.finger[0].velocity.powi(2);
    let claims = vec![
        Claim::ours(
            "Energy is conserved to 10⁻¹² over a minute",
            format!("to {} over {samples} samples", significant(all, 2)),
            all <= 1e-12,
        ),
        Claim::ours(
            format!("The same with a tolerance of {} m", significant(FINER, 1)),
            format!("to {}", significant(all_finer, 2)),
            all_finer <= 1e-12,
        ),
    ];
    let limit = if solver > rounding { "inexact contact forces" } else { "rounding" };
    let section = Section::new("Figure 5 for a minute")
        .text(&format!(
            "The same scene for {MINUTE} s. The string, which loses nothing, touches something in {} % of the samples: nine \
             tenths of these are over after {} s, the last after {} s.",
            significant(100.0 * minute.contacts.len() as f64 / samples as f64, 2),
            significant(minute.over(0.9), 3),
            significant(minute.over(1.0), 3)
        ))
        .picture("Variation of the energy over a minute and its two sources, and the variation with a finer tolerance")
        .claims(claims)
        .text(&format!(
            "**What limits it**: {limit}. Inexact contact forces account for at most {} of the change, rounding in string, \
             contacts and ledger for at most {}. The solver may stop when a penetration is known to its tolerance, {} m; \
             times the largest force, {} N, that is {} of the energy in one sample. But what the errors of all forces do \
             together is held to 10⁻¹⁵ of the energy besides.",
            significant(solver, 2),
            significant(rounding, 2),
            significant(scene.solver.tolerance, 1),
            significant(minute.hardest, 2),
            significant(scene.solver.tolerance * minute.hardest / first, 2)
        ));
    let name = "paper_figure_5_minute".to_owned();
    let sounds = vec![Sound { name, rate: scene.sample_rate as u32, samples: minute.sound }];
    Ok(Made { picture, section: Some(section), sounds })
}

fn draw(scene: &Scene, minute: &Minute, finer: &Minute) -> Result<String> {
    let names = ["all of it", "from inexact contact forces", "from rounding"];
    let strokes = [Stroke::thin(colour::INK), Stroke::new(colour::VERMILION), Stroke::new(colour::BLUE)];
    let extent = 1.2e13 * minute.largest().into_iter().chain(finer.largest()).fold(0.0, f64::max);
    let mut panel = Panel::new(
        "Variation of all energy H, (H − H₀)/H₀",
        Axis::linear("time, s", 0.0..MINUTE),
        Axis::linear("variation, 10⁻¹³", -extent..extent),
    );
    let points = |course: &Course| course.points(0.5, 1.0 / scene.sample_rate, 1e13);
    for ((course, name), stroke) in minute.courses.iter().zip(names).zip(strokes) {
        panel = panel.with(Layer::line(name, stroke, points(course)));
    }
    let name = format!("all of it, tolerance {} m", significant(FINER, 1));
    panel = panel.with(Layer::line(name, Stroke::new(colour::GREEN), points(&finer.courses[0])));
    let caption = format!(
        "{} Tolerance {} m but for one line.",
        describe(scene),
        significant(scene.solver.tolerance, 1)
    );
    Sheet::new("Figure 5 for a minute: what limits the conservation of energy", caption)
        .row(1400, vec![panel])
        .draw()
}
