//! Figure 6: a finger under constant force slides across a fret.

use anyhow::{Context, Result, ensure};
use low_action_dsp::Scene;
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Ground, Layer, Panel, Profile, Sheet, Stroke};
use xtask::numbers::largest;

use super::Made;
use super::page::{Claim, Section};
use super::pitch;
use super::running::{Repository, ground, listen, run, shortened};

const SCENE: &str = "scenes/paper/figure_6.toml";

/// Moments shown, s: before the slide, while it crosses the fret, after it.
const MOMENTS: [f64; 6] = [0.48, 0.55, 0.575, 0.6, 0.65, 0.75];

/// Time after the pluck from which on the pitch is shown, s: what is compared with itself before is not yet a note.
const SETTLED: f64 = 0.1;

/// Part of the string shown, m.
const PLACES: std::ops::Range<f64> = 0.1..0.25;

/// The fret that is crossed, from 1.
const FRET: usize = 5;

/// What is taken as a semitone, cents more or less, and as a strong variation, times what there is elsewhere.
const SEMITONE: f64 = 20.0;
const STRONG: f64 = 3.0;

/// What is taken as shifted, m, and as the same shift on two grids, as a part of it.
const SHIFTED: f64 = 2e-4;
const ALIKE: f64 = 0.2;

/// A finger nearer to the crown than this is beside it, m.
const BESIDE: f64 = 0.004;

/// How the slide went.
#[derive(Default)]
struct Slide {
    profiles: Vec<Profile>,
    /// (time, s; place, m) of the finger, and of the lowest point of the string.
    finger: Vec<(f64, f64)>,
    lowest: Vec<(f64, f64)>,
    /// Least and largest force of the finger on the string once it is down, N.
    force: (f64, f64),
}

/// Place of the lowest point of a string, m, by a parabola through the lowest grid point and its neighbours.
fn lowest(profile: &[(f64, f64)]) -> f64 {
    let inner = 1..profile.len() - 1;
    let index = inner.min_by(|a, b| profile[*a].1.total_cmp(&profile[*b].1)).unwrap_or(1);
    let [(x, left), (_, middle), (next, right)] = [profile[index - 1], profile[index], profile[index + 1]];
    let spacing = 0.5 * (next - x);
    let curvature = left - 2.0 * middle + right;
    let shift = if curvature > 0.0 { 0.5 * (left - right) / curvature } else { 0.0 };
    profile[index].0 + shift * spacing
}

/// Draws it, and measures what the paper says about it.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = repository.scene(SCENE)?;
    let mut slide = Slide { force: (f64::INFINITY, 0.0), ..Slide::default() };
    run(&scene, |simulation, _| {
        let string = simulation.string(0);
        let time = simulation.steps() as f64 / scene.sample_rate;
        let Some(finger) = string.fingers().next() else { return };
        if time > 0.1 {
            slide.force = (slide.force.0.min(finger.force), slide.force.1.max(finger.force));
        }
        let is_due = MOMENTS.get(slide.profiles.len()).is_some_and(|moment| time >= *moment);
        if is_due || simulation.steps().is_multiple_of(100) {
            let profile = Profile::of(string);
            slide.finger.push((time, scene.finger[0].position.at(time)));
            slide.lowest.push((time, lowest(&profile.string)));
            if is_due {
                slide.profiles.push(profile);
            }
        }
    })?;
    let sound = listen("paper_figure_6", &scene)?;
    let pitches = pitch::course(&sound.samples, scene.sample_rate, 90.0..135.0);
    let ground = ground(&scene)?;
    ensure!(ground.crowns.len() >= FRET, "the scene must have {FRET} frets");
    let picture = draw(&scene, &ground, &slide, &pitches)?;
    let section = section(&scene, &ground, &slide, &pitches)?;
    Ok(Made { picture, section: Some(section), sounds: vec![sound] })
}

fn draw(scene: &Scene, ground: &Ground, slide: &Slide, pitches: &[(f64, f64)]) -> Result<String> {
    let mut profiles = Panel::new(
        "The string around the fret, from light to dark, and the finger that presses it",
        Axis::linear("place, m from the nut", PLACES),
        Axis::linear("height, mm", -1.85..-0.4).ticks(8),
    )
    .with(Layer::Ground(ground.clone()));
    for (index, (profile, moment)) in slide.profiles.iter().zip(MOMENTS).enumerate() {
        let strength = 0.25 + 0.75 * index as f64 / (MOMENTS.len() - 1) as f64;
        let name = format!("{moment} s");
        profiles = profiles
            .with(Layer::line(name, Stroke::new(colour::BLUE).faded(strength), profile.string.clone()))
            .with(Layer::dots("", Stroke::new(colour::GREEN).faded(strength), profile.fingers.clone()));
    }
    let during = Axis::linear("time, s", 0.4..0.9);
    let pluck = scene.pluck.first().context("the scene needs a pluck")?;
    let sounding = Axis::linear("time, s", pluck.start + SETTLED..scene.duration);
    let crown = ground.crowns[FRET - 1].0;
    let places = Panel::new("Where the finger is, and the lowest point of the string", during, {
        Axis::linear("place, m from the nut", 0.145..0.195).ticks(6)
    })
    .with(Layer::line("fret", Stroke::new(colour::METAL).dashed(), vec![(0.4, crown), (0.9, crown)]))
    .with(Layer::line("lowest point", Stroke::thin(colour::BLUE), slide.lowest.clone()))
    .with(Layer::line("finger", Stroke::new(colour::GREEN), slide.finger.clone()));
    let pitch = Panel::new(
        format!("Pitch, from {SETTLED} s after the pluck on"),
        sounding,
        Axis::linear("fundamental, Hz", 110.0..122.0).ticks(8),
    )
    .with(Layer::line("", Stroke::new(colour::VERMILION), pitches.to_vec()));
    Sheet::new("Figure 6: a finger slides across the fifth fret", describe(scene))
        .row(1200, vec![profiles])
        .row(1100, vec![places, pitch])
        .draw()
}

fn section(scene: &Scene, ground: &Ground, slide: &Slide, pitches: &[(f64, f64)]) -> Result<Section> {
    let mean = |from: f64, to: f64| {
        let inside: Vec<_> = pitches.iter().filter(|(t, _)| (from..to).contains(t)).map(|p| p.1).collect();
        inside.iter().sum::<f64>() / inside.len().max(1) as f64
    };
    let (before, after) = (mean(0.35, 0.48), mean(0.8, 1.1));
    let cents = |ratio: f64| 1200.0 * libm::log2(ratio);
    let rise = cents(after / before);
    let open = open_pitch(scene);
    let sharp = |pitch: f64, fret: f64| cents(pitch / open) - 100.0 * fret;
    // The slope beside the fret just after the finger has crossed it.
    let profile = slide.profiles.get(4).context("the slide lasts to the fifth moment")?;
    let crown = ground.crowns[FRET - 1].0;
    let turns = turns(&profile.string);
    let at_fret = turns.iter().filter(|(x, _)| (x - crown).abs() < 0.006).map(|turn| turn.1.abs());
    let at_fret = at_fret.fold(0.0, f64::max);
    let finger = profile.fingers[0].0;
    let elsewhere = turns.iter().filter(|(x, _)| {
        let clear = |place: f64| (x - place).abs() > 0.02;
        clear(finger) && ground.crowns.iter().all(|crown| clear(crown.0)) || *x > 0.35
    });
    let elsewhere = elsewhere.map(|turn| turn.1.abs()).fold(0.0, f64::max);
    // While it slides; beside the crown the string is lowest on one side of it or the other.
    let sliding =
        || slide.finger.iter().zip(&slide.lowest).filter(|((time, _), _)| (0.5..0.75).contains(time));
    let is_beside = |place: f64| (place - crown).abs() <= BESIDE;
    let most_offset = |beside: bool| {
        let those = sliding().filter(|((_, place), _)| is_beside(*place) == beside);
        largest(those.map(|((_, finger), (_, lowest))| 1e3 * (finger - lowest).abs()))
    };
    // Grid points lie farther apart than the minimum is shifted, so that a finer grid has to agree.
    let at_rest = shift_at_rest(scene, scene.sample_rate)?;
    let at_rest_finely = shift_at_rest(scene, 4.0 * scene.sample_rate)?;
    let claims = vec![
        Claim::new(
            "The finger “slides across a single fret, effecting a pitch change”",
            format!(
                "from {} to {} Hz, {} cents; equal temperament says 100, and {SEMITONE} more or less is taken as that",
                significant(before, 4),
                significant(after, 4),
                significant(rise, 3)
            ),
            (rise - 100.0).abs() < SEMITONE,
        ),
        Claim::ours(
            "Under that force the finger stays on the string",
            format!(
                "force on the string between {} and {} N",
                significant(slide.force.0, 2),
                significant(slide.force.1, 2)
            ),
            slide.force.0 > 0.0,
        ),
        Claim::new(
            "“due to the finite string stiffness, the slope of the string exhibits a strong variation at the fret \
             location”",
            format!(
                "with the finger {} mm past the fret the slope changes by {} within a grid spacing of the fret, by at \
                 most {} away from frets and finger; over {STRONG} times as much is taken as strong",
                significant(1e3 * (finger - crown), 2),
                significant(at_fret, 2),
                significant(elsewhere, 2)
            ),
            at_fret > STRONG * elsewhere,
        ),
        Claim::new(
            "“the minimum may occur at a location slightly shifted from that of the finger”",
            format!(
                "with the finger at rest behind fret 5 by {} mm, at four times the rate by {} mm (over {} mm and within \
                 {} % of each other counts); during the slide by at most {} mm, and {} mm within {} mm of the crown",
                significant(1e3 * at_rest, 2),
                significant(1e3 * at_rest_finely, 2),
                1e3 * SHIFTED,
                100.0 * ALIKE,
                significant(most_offset(false), 2),
                significant(most_offset(true), 2),
                1e3 * BESIDE
            ),
            at_rest > SHIFTED && (at_rest / at_rest_finely - 1.0).abs() < ALIKE,
        ),
    ];
    Ok(Section::new("Figure 6: time-varying finger position")
        .text(&format!(
            "Scene: [`figure_6.toml`](../{SCENE}). The paper’s finger has no damping of any kind; laid on the string and \
             loaded slowly, in 50 ms, it stays there, but dances.",
        ))
        .picture("Profiles of the string around the fret, the places of finger and lowest point, and the pitch over time")
        .claims(claims)
        .text(&format!(
            "Stopped notes are sharp, as on a guitar whose saddle has not been set: pressing stretches the string. Over \
             the {} Hz of the open string the note is {} cents sharp behind fret 5 and {} behind fret 6.",
            significant(open, 4),
            significant(sharp(before, 5.0), 2),
            significant(sharp(after, 6.0), 2)
        )))
}

/// Fundamental of the stiff string between its ends, Hz.
fn open_pitch(scene: &Scene) -> f64 {
    let string = low_action_dsp::StringParameters::from_spec(&scene.string[0]);
    let wave_number = std::f64::consts::PI / string.length;
    let squared = string.tension / string.linear_density + string.kappa_squared() * wave_number * wave_number;
    wave_number * squared.sqrt() / (2.0 * std::f64::consts::PI)
}

/// How far the lowest point of the string is from the finger that rests behind the fret, m: with a hand that
/// damps, and nothing plucked.
fn shift_at_rest(scene: &Scene, sample_rate: f64) -> Result<f64> {
    let mut scene = Scene { sample_rate, pluck: Vec::new(), ..shortened(scene, 0.3) };
    scene.finger[0].hand_damping = 8.0;
    let simulation = run(&scene, |_, _| {})?;
    let profile = Profile::of(simulation.string(0));
    Ok((profile.fingers[0].0 - lowest(&profile.string)).abs())
}

/// How much the slope changes at each inner point, (m, –).
fn turns(profile: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let slope = |a: (f64, f64), b: (f64, f64)| 1e-3 * (b.1 - a.1) / (b.0 - a.0);
    profile.windows(3).map(|p| (p[1].0, slope(p[1], p[2]) - slope(p[0], p[1]))).collect()
}
