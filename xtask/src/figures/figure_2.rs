//! Figure 2: a string over a fretboard after a weak and a strong pluck.

use anyhow::{Context, Result, ensure};
use low_action_dsp::{Scene, Simulation};
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Ground, Layer, Panel, Profile, Sheet, Stroke};

use super::Made;
use super::page::{Claim, Section};
use super::running::{Repository, ground, listen, run, shortened};

/// The scene.
pub const SCENE: &str = "scenes/paper/figure_2.toml";

/// The part of the run after which contacts are no transients.
const TRANSIENT: f64 = 0.5;

/// Swings that are a smaller part of the first than this have decreased, and have not where they are a larger one than that.
const DECREASED: f64 = 0.95;
const KEPT: f64 = 0.99;

/// Moments shown, ms after the string is let go: a period of the scene's string, closer together where it hits.
const MOMENTS: [f64; 8] = [0.0, 2.0, 4.0, 5.0, 6.0, 7.0, 9.0, 12.0];

/// A time that is a whole number of steps may come out below it by less than that, s.
const ROUNDING: f64 = 1e-9;

/// What a run came to.
struct Outcome {
    profiles: Vec<Profile>,
    /// Lowest point of the string over the frets, mm.
    lowest: f64,
    /// Times of the first and the last contact, s after the release.
    touched: Option<(f64, f64)>,
    /// Frets that were hit, from 1, and the hardest blow, N.
    frets: Vec<usize>,
    hardest: f64,
    /// Highest |u| anywhere in each period, mm.
    swings: Vec<f64>,
}

/// The same scene with another force.
pub fn plucked(scene: &Scene, force: f64) -> Scene {
    let mut scene = scene.clone();
    scene.pluck[0].force = force;
    scene
}

/// The same scene without board and frets.
fn free(scene: &Scene) -> Scene {
    Scene { fretboard: None, ..scene.clone() }
}

/// When the pluck lets go, s.
fn release(scene: &Scene) -> f64 {
    scene.pluck.first().map_or(0.0, |pluck| pluck.start + pluck.duration)
}

/// Period of the string without stiffness, s.
fn period(scene: &Scene) -> f64 {
    let string = &scene.string[0];
    2.0 * string.length / (string.tension.at(0.0) / string.linear_density).sqrt()
}

fn observe(scene: &Scene) -> Result<Outcome> {
    let (release, period) = (release(scene), period(scene));
    let last_fret = ground(scene)?.crowns.last().map_or(scene.string[0].length, |crown| crown.0);
    let mut outcome = Outcome {
        profiles: Vec::new(),
        lowest: 0.0,
        touched: None,
        frets: Vec::new(),
        hardest: 0.0,
        swings: Vec::new(),
    };
    let step = 1.0 / scene.sample_rate;
    let mut look = |simulation: &Simulation| {
        let since = simulation.steps() as f64 * step - release + ROUNDING;
        let string = simulation.string(0);
        if MOMENTS.get(outcome.profiles.len()).is_some_and(|moment| since >= 1e-3 * moment) {
            outcome.profiles.push(Profile::of(string));
        }
        for (place, u) in string.places().zip(string.state.displacement()) {
            if place <= last_fret {
                outcome.lowest = outcome.lowest.min(1e3 * u);
            }
            if since >= 0.0 {
                let period = (since / period) as usize;
                outcome.swings.resize(outcome.swings.len().max(period + 1), 0.0);
                outcome.swings[period] = f64::max(outcome.swings[period], 1e3 * u.abs());
            }
        }
        // Forces act in the step that led here, at the time of the state it began with.
        let since = since - step;
        for (fret, force) in string.fret_forces().filter(|fret| fret.1 > 0.0) {
            let first = outcome.touched.map_or(since, |touched| touched.0);
            outcome.touched = Some((first, since));
            outcome.hardest = outcome.hardest.max(force);
            if !outcome.frets.contains(&(fret + 1)) {
                outcome.frets.push(fret + 1);
            }
        }
    };
    // What a string is let go in counts as well.
    look(&Simulation::new(scene)?);
    run(scene, |simulation, _| look(simulation))?;
    outcome.frets.sort_unstable();
    Ok(outcome)
}

/// Draws it, and measures what the paper says about it.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = repository.scene(SCENE)?;
    let (weak, strong) = (observe(&plucked(&scene, 0.5))?, observe(&plucked(&scene, 1.0))?);
    ensure!(strong.profiles.len() == MOMENTS.len(), "the scene must last beyond the moments shown");
    let ground = ground(&scene)?;
    let sound = |name, force| listen(name, &plucked(&scene, force));
    let sounds = vec![sound("paper_figure_2_weak", 0.5)?, sound("paper_figure_2_strong", 1.0)?];
    let section = section(&scene, &weak, &strong)?;
    Ok(Made { picture: draw(&scene, &ground, &weak, &strong)?, section: Some(section), sounds })
}

fn draw(scene: &Scene, ground: &Ground, weak: &Outcome, strong: &Outcome) -> Result<String> {
    let caption = format!("{} The weaker pluck is the same with 0.5 N.", describe(scene));
    let mut sheet = Sheet::new("Figure 2: a string over frets, plucked with 0.5 N and with 1 N", caption);
    let rows = MOMENTS.len() / 2;
    for row in 0..rows {
        let lowest = row + 1 == rows;
        // Time runs down the columns.
        let panels = [row, row + rows].map(|index| {
            let across = Axis::linear("place, m from the nut", -0.01..0.66);
            let title = format!("{} ms after the release", MOMENTS[index]);
            let names = if row == 0 { ["0.5 N", "1 N"] } else { ["", ""] };
            Panel::new(
                title,
                if lowest { across } else { across.bare() },
                Axis::linear("height, mm", -2.2..2.2).ticks(5),
            )
            .with(Layer::Ground(ground.clone()))
            .with(Layer::line(names[0], Stroke::new(colour::INK), weak.profiles[index].string.clone()))
            .with(Layer::line(
                names[1],
                Stroke::new(colour::VERMILION),
                strong.profiles[index].string.clone(),
            ))
        });
        sheet = sheet.row(if lowest { 776 } else { 640 }, panels.into());
    }
    sheet.draw()
}

fn section(scene: &Scene, weak: &Outcome, strong: &Outcome) -> Result<Section> {
    let crown = ground(scene)?.crowns.first().context("the scene needs frets")?.1;
    // What the frets do to the profile: against the same pluck over no fretboard.
    let distortion = distortion(scene)?;
    // What stiffness alone does to the swings: no frets, losses or stretching.
    let mut ideal = shortened(&free(scene), 0.3);
    ideal.string[0].loss_0 = Some(0.0);
    ideal.string[0].loss_1 = Some(0.0);
    ideal.string[0].tension_modulation = false;
    let stiff = observe(&ideal)?.swings;
    ideal.string[0].youngs_modulus = 0.0;
    let limp = observe(&ideal)?.swings;
    // The same, let go from rest in the triangle in which the force would hold the string.
    let (place, force) = (scene.pluck[0].position, scene.pluck[0].force);
    let length = ideal.string[0].length;
    let apex = force * place * (length - place) / (ideal.string[0].tension.at(0.0) * length);
    let mut pulled = Scene { pluck: Vec::new(), ..ideal.clone() };
    pulled.string[0].shape = Some(vec![[0.0, 0.0], [place, apex], [length, 0.0]]);
    pulled.string[0].youngs_modulus = scene.string[0].youngs_modulus;
    let pulled = observe(&pulled)?.swings;
    let fall = |swings: &[f64]| swings[10..20].iter().copied().fold(0.0, f64::max) / swings[0];
    let (weak_reach, strong_reach) = (lowest_over_frets(scene, 0.5)?, lowest_over_frets(scene, 1.0)?);
    let frets = strong.frets.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    let (first, last) = strong.touched.unwrap_or((f64::NAN, f64::NAN));
    let claims = vec![
        Claim::new(
            "“In one case, the string vibration is free from collision”",
            format!(
                "0.5 N: {}; lowest {} mm over the frets",
                if weak.touched.is_none() { "no contact" } else { "it touches them" },
                significant(weak.lowest, 3)
            ),
            weak.touched.is_none(),
        ),
        Claim::new(
            "“in the other, it is sufficient to allow for rebounding against the frets”",
            format!(
                "1 N: first contact {} ms after the release, hardest blow {} N, frets {frets}",
                significant(1e3 * first, 3),
                significant(strong.hardest, 3)
            ),
            strong.touched.is_some(),
        ),
        Claim::new(
            "“greatly distorting the profile of the string subsequently”",
            format!(
                "in the third period after the release the profile differs by {} % (rms) from the same pluck over no \
                 fretboard; anything over 10 % is taken as great",
                significant(100.0 * distortion, 2)
            ),
            distortion > 0.1,
        ),
        Claim::new(
            "“under normal lossy conditions … the collision with the fretboard will lead to transients”",
            format!(
                "the last contact comes {} s after the release, of {} s; up to {} s is taken as transient",
                significant(last, 3),
                scene.duration,
                significant(TRANSIENT * scene.duration, 3)
            ),
            last < TRANSIENT * scene.duration,
        ),
        Claim::new(
            "“stiffness effects in the string lead to dispersion, also decreasing the maximum string displacement after \
             the initial pluck”",
            format!(
                "without losses, stretching and frets the largest swing of periods 11 to 20 is {} % of the first with \
                 stiffness, {} % without; less than {} % with it and more than {} % without would be a decrease",
                significant(100.0 * fall(&stiff), 3),
                significant(100.0 * fall(&limp), 3),
                100.0 * DECREASED,
                100.0 * KEPT
            ),
            fall(&stiff) < DECREASED && fall(&limp) > KEPT,
        ),
    ];
    Ok(Section::new("Figure 2: free vibration")
        .text(&format!(
            "Scene: [`figure_2.toml`](../{SCENE}), and the same with `force = 0.5`. The pluck pushes up for {} ms. Over \
             no fretboard the string would swing down to {} mm and {} mm over the frets, so crowns anywhere between \
             show what the paper shows; here they are at {} mm.",
            1e3 * scene.pluck[0].duration,
            significant(weak_reach, 3),
            significant(strong_reach, 3),
            significant(crown, 3),
        ))
        .picture("Eight moments of a string after a weak and a strong pluck; the strong one is caught by the frets")
        .claims(claims)
        .text(&format!(
            "**Nearest set-up at which dispersion lowers the swing**: a string let go from rest. In the triangle in which \
             {} N would hold it, all partials start at their largest, so nothing later can be higher under the pluck; \
             periods 11 to 20 reach {} % of the first. A pluck of {} ms lets go of a moving string, whose partials \
             dispersion may also bring together.",
            significant(force, 3),
            significant(100.0 * fall(&pulled), 3),
            1e3 * scene.pluck[0].duration,
        )))
}

/// Lowest point over the frets were there none, mm.
fn lowest_over_frets(scene: &Scene, force: f64) -> Result<f64> {
    let mut lower = shortened(&plucked(scene, force), 0.05);
    // A fretboard out of reach keeps the places of the frets.
    if let Some(fretboard) = &mut lower.fretboard {
        fretboard.board = None;
        fretboard.fret_top = Some(low_action_dsp::curve::OneOrEach::One(-0.1));
    }
    Ok(observe(&lower)?.lowest)
}

/// Root of the mean square difference that the frets make to the profiles of the third period, as a part of
/// the root of the mean square without them.
fn distortion(scene: &Scene) -> Result<f64> {
    let (release, period) = (release(scene), period(scene));
    let window = |scene: &Scene| {
        let mut heights = Vec::new();
        run(&shortened(scene, release + 3.0 * period), |simulation, _| {
            if simulation.steps() as f64 / scene.sample_rate > release + 2.0 * period {
                heights.extend(simulation.string(0).state.displacement());
            }
        })?;
        Ok::<_, anyhow::Error>(heights)
    };
    let (with, without) = (window(scene)?, window(&free(scene))?);
    let square = |sum: f64, number: f64| sum + number * number;
    let difference = with.iter().zip(&without).map(|(a, b)| a - b).fold(0.0, square);
    Ok((difference / without.iter().copied().fold(0.0, square)).sqrt())
}
