//! Figure 5: where the energy of a tap goes when nothing is lost, and how well it is kept.

use anyhow::{Context, Result};
use low_action_dsp::curve::{Curve, OneOrEach};
use low_action_dsp::finger::Finger;
use low_action_dsp::{Scene, State};
use low_action_figures::describe::{describe, significant};
use low_action_figures::style::colour;
use low_action_figures::{Axis, Layer, Panel, Sheet, Stroke};
use xtask::numbers::largest;

use super::Made;
use super::figure_4::tap;
use super::page::{Claim, Section};
use super::running::{Repository, listen, run, shortened};

/// The scene.
pub const SCENE: &str = "scenes/paper/figure_5.toml";

/// Time shown of the partition, ms.
const SHOWN: f64 = 5.0;

/// What is taken as identical, as a part of the speed, and as fully, as a part of the energy.
const IDENTICAL: f64 = 0.01;
const FULLY: f64 = 0.99;

/// Parts of the energy that count as transferred: to the string, to its stretching, to the collision.
const TRANSFERRED: [f64; 3] = [0.1, 0.01, 1e-4];

/// Energies in the paper's partition, in the order of its caption, with their lines.
const PARTS: [(&str, Stroke); 5] = [
    ("string, linear", Stroke::new(colour::VERMILION)),
    ("stretching", Stroke::new(colour::BLUE)),
    ("string and fretboard", Stroke::new(colour::PURPLE)),
    ("finger", Stroke::new(colour::GREEN)),
    ("all", Stroke::new(colour::INK)),
];

/// Where the energy went.
#[derive(Default)]
struct Partition {
    /// (time, ms; energy, mJ) of each part.
    parts: [Vec<(f64, f64)>; 5],
    /// Largest part of all energy that each had, and when, ms.
    peaks: [(f64, f64); 5],
    /// ε over time, and the largest |ε|, at first until the finger has left, then in all.
    variation: Vec<(f64, f64)>,
    largest: (f64, f64),
    /// (time, ms; energy, µJ) of the fretboard.
    fretboard: Vec<(f64, f64)>,
    /// Times at which the string met the fretboard, ms.
    contacts: Vec<f64>,
    /// First and last time of the finger on the string, ms.
    met: f64,
    left: f64,
    /// Part of the energy that the finger has at the end.
    returned: f64,
}

/// Energy in the pads at one moment, J. The ledger gives all contacts together; the paper counts the pad to
/// the finger.
fn pads(state: &State) -> f64 {
    let energy = |finger: &Finger| {
        let penetration = state.displacement_at(&finger.reading) - finger.height;
        finger.law.energy(penetration)
    };
    state.fingers().iter().flatten().map(energy).sum()
}

fn observe(scene: &Scene) -> Result<Partition> {
    let mut partition = Partition::default();
    let (mut pads_before, mut first, mut was_in_contact) = (0.0, None, false);
    run(scene, |simulation, entry| {
        let string = simulation.string(0);
        let time = 1e3 * (simulation.steps() as f64 - 0.5) / scene.sample_rate;
        let pads_now = pads(&string.state);
        let pad = 0.5 * (pads_before + pads_now);
        pads_before = pads_now;
        let energies = &entry.energies;
        let total = energies.total();
        let fretboard = energies.contact - pad;
        let parts = [energies.string, energies.tension, fretboard, energies.finger + pad, total];
        for (index, part) in parts.iter().enumerate() {
            if time < SHOWN {
                partition.parts[index].push((time, 1e3 * part));
            }
            if part / total > partition.peaks[index].0 {
                partition.peaks[index] = (part / total, time);
            }
        }
        if time < SHOWN {
            partition.fretboard.push((time, 1e6 * fretboard));
        }
        let variation = total / *first.get_or_insert(total) - 1.0;
        partition.variation.push((time, variation));
        if string.fingers().any(|finger| finger.force > 0.0) {
            partition.met = if partition.left == 0.0 { time } else { partition.met };
            partition.left = time;
            partition.largest.0 = largest([partition.largest.1, variation.abs()]);
        }
        partition.largest.1 = largest([partition.largest.1, variation.abs()]);
        let in_contact = string.fret_forces().any(|fret| fret.1 > 0.0) || string.board_force() > 0.0;
        if in_contact && !was_in_contact {
            partition.contacts.push(time);
        }
        was_in_contact = in_contact;
        partition.returned = parts[3] / total;
    })?;
    Ok(partition)
}

/// Draws it, and measures what the paper says about it.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = repository.scene(SCENE)?;
    let partition = observe(&scene)?;
    let sounds = vec![listen("paper_figure_5", &shortened(&scene, 2.0))?];
    let picture = draw(&scene, &partition)?;
    Ok(Made { picture, section: Some(section(&scene, &partition)?), sounds })
}

fn draw(scene: &Scene, partition: &Partition) -> Result<String> {
    let most = partition.parts[4].iter().map(|point| point.1).fold(0.0, f64::max);
    let time = Axis::linear("time, ms", 0.0..SHOWN);
    let mut parts = Panel::new("Where the energy is", time, Axis::linear("energy, mJ", 0.0..1.1 * most));
    for (points, (name, stroke)) in partition.parts.iter().zip(PARTS) {
        parts = parts.with(Layer::line(name, stroke, points.clone()));
    }
    let time = Axis::linear("time, ms", 0.0..1e3 * scene.duration);
    let variation = partition.variation.iter().map(|&(time, part)| (time, 1e14 * part)).collect();
    let extent = 1.2e14 * partition.largest.1;
    let variation = Panel::new(
        "Variation of all energy H, (H − H₀)/H₀",
        time,
        Axis::linear("variation, 10⁻¹⁴", -extent..extent),
    )
    .with(Layer::line("", Stroke::thin(colour::INK), variation));
    let zoom = 0.8..partition.left + 0.3;
    let most = partition.fretboard.iter().map(|point| point.1).fold(0.0, f64::max);
    let fretboard = Panel::new(
        "Energy between string and fretboard, enlarged: contact and recontact",
        Axis::linear("time, ms", zoom).ticks(10),
        Axis::linear("energy, µJ", 0.0..1.1 * most),
    )
    .with(Layer::line("", Stroke::thin(colour::PURPLE), partition.fretboard.clone()));
    Sheet::new("Figure 5: the energy of a tap without losses", describe(scene))
        .row(1400, vec![parts, variation])
        .row(800, vec![fretboard])
        .draw()
}

fn section(scene: &Scene, partition: &Partition) -> Result<Section> {
    let speed = scene.finger[0].velocity.abs();
    let tap = tap(&shortened(scene, 0.02))?;
    let percent = |part: f64| format!("{} %", significant(100.0 * part, 3));
    let [string, stretching, fretboard, ..] = partition.peaks;
    let first_contact = partition.contacts.first().copied().context("the string meets the fretboard")?;
    let while_tapped = partition.contacts.iter().filter(|time| **time <= partition.left).count();
    let claims = vec![
        Claim::new(
            "“the finger energy is transferred first to the linear and nonlinear energy components of the string”",
            format!(
                "from {} ms on; at most {} at {} ms and {} at {} ms",
                significant(partition.met, 2),
                percent(string.0),
                significant(string.1, 3),
                percent(stretching.0),
                significant(stretching.1, 3)
            ),
            string.0 > TRANSFERRED[0] && stretching.0 > TRANSFERRED[1] && first_contact > partition.met,
        ),
        Claim::new(
            "“then to the stored energy of the collision, when the string is in contact with the fretboard”",
            format!(
                "from {} ms on; at most {} at {} ms",
                significant(first_contact, 3),
                percent(fretboard.0),
                significant(fretboard.1, 3)
            ),
            fretboard.0 > TRANSFERRED[2],
        ),
        Claim::new(
            "The energy goes “finally fully back to the finger”",
            format!("{} come back; the string keeps the rest and rings on", percent(partition.returned)),
            comes_back(partition.returned),
        ),
        Claim::new(
            "The finger “rebounds with a speed identical to its initial speed”",
            format!("{} m/s of {speed} m/s", significant(tap.rebound, 4)),
            is_identical(tap.rebound, speed),
        ),
        Claim::new(
            "“contact/recontact phenomena visible in the energy of the string/fretboard collision”",
            format!("{while_tapped} contacts with frets or board while the finger is on the string"),
            while_tapped > 1,
        ),
        Claim::new(
            "“Energy is conserved to roughly 14 places” (taken as 10⁻¹³)",
            format!(
                "to {} until the finger has left at {} ms, to {} over {} ms",
                significant(partition.largest.0, 2),
                significant(partition.left, 3),
                significant(partition.largest.1, 2),
                1e3 * scene.duration
            ),
            partition.largest.1 <= 1e-13,
        ),
    ];
    let mut rows = Vec::new();
    // Set-ups in which both statements about the rebound hold, without and with pinning.
    let mut both = [Vec::new(), Vec::new()];
    for (name, scene) in nearer(scene) {
        let tap = self::tap(&scene)?;
        let share = observe(&scene)?.returned;
        if comes_back(share) && is_identical(tap.rebound, speed) {
            both[usize::from(tap.pinned > 0.0)].push(name);
        }
        let (pinned, rebound) = (significant(tap.pinned, 3), significant(tap.rebound, 4));
        rows.push(format!("{name} | {pinned} | {rebound} | {}", percent(share)));
    }
    Ok(Section::new("Figure 5: energy partition")
        .text(&format!(
            "Scene: [`figure_5.toml`](../{SCENE}), the tap of Figure 4 without losses. As in the paper, the energy of the \
             pad is counted to the finger. “Identical” is taken as within {} of the speed, “fully” as {} of the \
             energy; as transferred counts over {} of it in the string, over {} in its stretching, over {} in the collision.",
            percent(IDENTICAL),
            percent(FULLY),
            percent(TRANSFERRED[0]),
            percent(TRANSFERRED[1]),
            percent(TRANSFERRED[2])
        ))
        .picture("Energies of string, stretching, fretboard and finger over time, and how little their sum varies")
        .claims(claims)
        .text(
            "**Why not all of it comes back.** While the finger pushes the string down, waves run off along it, and in a \
             string without losses they do not come to rest: it rings on with what the finger does not have. The string \
             gives everything back only where it follows the finger slowly beside its own waves, or where hardly any of \
             it has to move. **Nearest set-ups** on the way there:",
        )
        .table("set-up | pinned, ms | rebound, m/s | finger’s share of the energy at the end", &rows)
        .text(&format!(
            "So for the paper’s string both statements hold {} without pinning, and {} with it.",
            where_both_hold(&both[0]),
            where_both_hold(&both[1])
        )))
}

/// In which of some set-ups they do, in words.
fn where_both_hold(names: &[&str]) -> String {
    if names.is_empty() { "nowhere".to_owned() } else { format!("at {}", names.join("; ")) }
}

/// Whether all energy is with the finger again.
fn comes_back(returned: f64) -> bool {
    returned > FULLY
}

/// Whether a finger leaves as fast as it came.
fn is_identical(rebound: f64, speed: f64) -> bool {
    (rebound - speed).abs() < IDENTICAL * speed
}

/// Set-ups that come nearer and nearer to an elastic rebound.
fn nearer(scene: &Scene) -> Vec<(&'static str, Scene)> {
    let scene = shortened(scene, 0.05);
    let changed = |mass: f64, pad: f64, height: Option<f64>| {
        let mut scene = scene.clone();
        scene.finger[0].mass = mass;
        scene.finger[0].stiffness = pad;
        if let (Some(fretboard), Some(height)) = (&mut scene.fretboard, height) {
            fretboard.board = Some(Curve::Constant(height).into());
            fretboard.fret_top = Some(OneOrEach::One(height));
        }
        scene
    };
    vec![
        ("the paper’s: 5 g, K_f = 10¹⁰", scene.clone()),
        ("finger of 50 g", changed(0.05, 1e10, None)),
        ("board and crowns at −0.05 mm", changed(5e-3, 1e10, Some(-0.05e-3))),
        ("K_f = 10⁵", changed(5e-3, 1e5, None)),
        ("K_f = 10⁶, finger of 50 g", changed(0.05, 1e6, None)),
        ("K_f = 10⁸, board and crowns at −0.05 mm", changed(5e-3, 1e8, Some(-0.05e-3))),
    ]
}
