//! Beyond the paper: how long two runs that begin almost alike stay together.

use anyhow::{Result, ensure};
use low_action_dsp::{Scene, Simulation};
use low_action_figures::course::BINS;
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Course, Layer, Panel, Sheet, Stroke};
use xtask::numbers::largest;

use super::Made;
use super::figure_2::{SCENE, plucked};
use super::page::{Claim, Section};
use super::running::{Repository, listen, shortened};

/// Plucks, N, whether the string loses energy, and their lines: one that swings free, that of the paper, a
/// hard one, and one that goes on buzzing.
const RUNS: [(&str, f64, bool, Stroke); 4] = [
    ("0.5 N", 0.5, true, Stroke::thin(colour::BLUE)),
    ("1 N", 1.0, true, Stroke::thin(colour::ORANGE)),
    ("2 N", 2.0, true, Stroke::thin(colour::VERMILION)),
    ("2 N, no losses", 2.0, false, Stroke::thin(colour::INK)),
];

/// Part by which the second pluck differs from the first.
const DIFFERENCE: f64 = 1e-14;

/// How many times as large as at first a difference is called divergence.
const GROWTH: f64 = 1e3;

/// Length of the runs, s: about twice what it takes without losses until nothing is in common. When that is, is itself an
/// accident of the last digits.
const DURATION: f64 = 1.0;

/// The scene with another force, with or without losses.
fn varied(scene: &Scene, force: f64, losses: bool) -> Scene {
    let mut scene = shortened(&plucked(scene, force), DURATION);
    if !losses {
        scene.string[0].loss_0 = Some(0.0);
        scene.string[0].loss_1 = Some(0.0);
    }
    scene
}

/// How two runs came apart.
struct Divergence {
    /// Largest difference anywhere on the string as a part of the largest displacement so far.
    course: Course,
    /// When contacts began, s.
    contact: Option<f64>,
    /// When the difference had grown by [`GROWTH`], and when it was 1 % of the displacement, s.
    begun: Option<f64>,
    apart: Option<f64>,
    /// The largest there was.
    largest: f64,
}

fn observe(scene: &Scene) -> Result<Divergence> {
    let mut other = scene.clone();
    other.pluck[0].force *= 1.0 + DIFFERENCE;
    let (mut one, mut other) = (Simulation::new(scene)?, Simulation::new(&other)?);
    let mut divergence = Divergence {
        course: Course::new(one.samples(), BINS),
        contact: None,
        begun: None,
        apart: None,
        largest: 0.0,
    };
    let mut highest = f64::MIN_POSITIVE;
    while one.steps() < one.samples() {
        one.step();
        other.step();
        let time = one.steps() as f64 / scene.sample_rate;
        let (a, b) = (one.string(0), other.string(0));
        let heights = a.state.displacement();
        highest = largest([highest, largest(heights.clone().map(f64::abs))]);
        let pairs = heights.zip(b.state.displacement());
        let part = largest(pairs.map(|(a, b)| (a - b).abs())) / highest;
        ensure!(part.is_finite(), "after {time} s two strings differ by {part} of the displacement");
        divergence.course.add(part);
        divergence.largest = divergence.largest.max(part);
        if a.convergence.active > 0 {
            divergence.contact.get_or_insert(time);
        }
        if part > GROWTH * DIFFERENCE {
            divergence.begun.get_or_insert(time);
        }
        if part > 0.01 {
            divergence.apart.get_or_insert(time);
        }
    }
    Ok(divergence)
}

/// Draws it and measures when the runs come apart.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = repository.scene(SCENE)?;
    let runs: Vec<_> =
        RUNS.iter().map(|run| observe(&varied(&scene, run.1, run.2))).collect::<Result<_>>()?;
    let mut panel = Panel::new(
        "Largest difference between the two runs, as a part of the largest displacement",
        Axis::linear("time, s", 0.0..DURATION),
        Axis::log("part", 1e-16..1.0).ticks(9),
    );
    for (run, (name, _, _, stroke)) in runs.iter().zip(RUNS) {
        let points = run.course.peaks(1.0, 1.0 / scene.sample_rate, 1.0);
        panel = panel.with(Layer::line(name, stroke, points));
    }
    let caption = format!(
        "{} The same with plucks of 0.5, 1 and 2 N, the last also without losses, each computed twice: the second time with a force larger by a part of \
         10⁻¹⁴.",
        describe(&scene)
    );
    let picture = Sheet::new("Two plucks that differ by 10⁻¹⁴", caption).row(1500, vec![panel]).draw()?;
    let sounds = vec![listen("beyond_chaos", &plucked(&scene, 2.0))?];
    Ok(Made { picture, section: Some(section(&runs)), sounds })
}

fn section(runs: &[Divergence]) -> Section {
    let time =
        |time: Option<f64>| time.map_or("never".into(), |time| format!("{} ms", significant(1e3 * time, 3)));
    let rows: Vec<_> = runs
        .iter()
        .zip(RUNS)
        .map(|(run, (name, ..))| {
            format!(
                "{name} | {} | {} | {} | {}",
                time(run.contact),
                time(run.begun),
                time(run.apart),
                significant(run.largest, 2)
            )
        })
        .collect();
    let [free, _, hard, endless] = runs else { return Section::new("Beyond: chaos") };
    let claims = vec![
        Claim::ours(
            "A string that touches nothing keeps what it was given",
            format!(
                "0.5 N: the difference is at most {}; anything below {} is taken as kept",
                significant(free.largest, 2),
                significant(GROWTH * DIFFERENCE, 1)
            ),
            free.largest < GROWTH * DIFFERENCE,
        ),
        Claim::ours(
            "A buzzing string forgets it: the difference grows a thousandfold",
            format!("2 N: after {}; the first contact comes after {}", time(hard.begun), time(hard.contact)),
            hard.begun.is_some(),
        ),
        Claim::ours(
            "Without losses it goes on until the two have nothing in common (1 % of the displacement)",
            format!("2 N: after {}", time(endless.apart)),
            endless.apart.is_some(),
        ),
    ];
    Section::new("Beyond: where chaos sets in")
        .text(&format!(
            "Scene: [`figure_2.toml`](../{SCENE}) with 0.5, 1 and 2 N, and with 2 N without losses, each beside a pluck that is stronger by a part of \
             10⁻¹⁴, about what rounding the force does. Every bounce off a fret turns a difference in place into one in \
             time and makes it larger.",
        ))
        .picture("Difference between two almost equal plucks over time, for three forces")
        .claims(claims)
        .table("pluck | first contact | difference 10⁻¹¹ | difference 1 % | largest", &rows)
        .text(
            "After that time a waveform of a buzzing string is one of many equally right ones: compare spectra, levels and \
             statistics, not samples. The moment is an accident as well: adding the same numbers in another order once moved that of the \
             last row from 393 to 513 ms. The same program gives the same bits on every run all the same.",
        )
}
