//! What the rival is held to: it plays the same string, and keeps its energy.

use low_action_dsp::scene::FretPlacement;
use low_action_dsp::{Quality, Scene, Simulation};

use super::Rival;
use crate::measure::trade::scenes::{Kind, SCENES};
use crate::measure::trade::settings::{BASE, Law, Setting, quality};
use crate::numbers::largest;

/// What is plucked hardest in the first scene of a kind.
fn scene(kind: Kind, setting: &Setting) -> Scene {
    let playing = SCENES.iter().find(|playing| playing.kind == kind).expect("there is one");
    playing.scenes(setting).expect("it can be computed").pop().expect("there is a string")
}

#[test]
fn a_string_that_touches_nothing_is_the_same_string() {
    let scene = &scene(Kind::Open, &quality(Quality::Live, 48e3));
    let (mut rival, mut simulation) = (Rival::new(scene).unwrap(), Simulation::new(scene).unwrap());
    let (mut apart, mut loudest) = (0.0, 0.0);
    for _ in 0..20_000 {
        rival.step();
        simulation.step();
        apart = largest([apart, (rival.output() - simulation.output()).abs()]);
        loudest = largest([loudest, simulation.output().abs()]);
    }
    assert!(loudest > 0.01 && apart < 1e-9 * loudest, "{apart:e} N apart of {loudest:e} N");
}

/// Products of neighbouring values in turn, summed.
fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What each value is above the one before it.
fn steps(values: &[f64]) -> Vec<f64> {
    values.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// The same of those, and nothing at both ends.
fn bends(values: &[f64]) -> Vec<f64> {
    [&[0.0], &steps(&steps(values))[..], &[0.0]].concat()
}

/// Energy between the last two samples, J: of string, stretching and contacts.
fn energy(rival: &Rival) -> f64 {
    let (string, grid) = (&rival.model.string, &rival.model.grid);
    let (h, k) = (grid.spacing, grid.time_step);
    let now = &rival.displacement;
    let before: Vec<f64> = now.iter().zip(&rival.motion).map(|(now, motion)| now - motion).collect();
    let slope = product(&steps(now), &steps(&before));
    let (bent, bent_before) = (bends(now), bends(&before));
    let moving = 0.5 * string.linear_density * h / (k * k) * product(&rival.motion, &rival.motion);
    let pulled = 0.5 * rival.stiffness.tension / h * slope;
    let stiff = rival.stiffness.kappa_squared / h.powi(3) * product(&bent, &bent_before)
        + rival.stiffness.kappa_6 / h.powi(5) * product(&steps(&bent), &steps(&bent_before));
    let stretched = string.axial_stiffness() / (8.0 * string.length) * (slope / h).powi(2);
    let contacts: f64 = rival.psi.iter().map(|psi| 0.5 * psi * psi).sum();
    moving + pulled + 0.5 * string.linear_density * stiff + stretched + contacts
}

#[test]
fn without_losses_it_keeps_its_energy() {
    // Kinked frets lose what the grid has no room for.
    let lossless = Setting { law: Law::Quadratised, frets: FretPlacement::Exact, damping: Some(0.0), ..BASE };
    let mut scene = scene(Kind::BuzzingLight, &lossless);
    (scene.string[0].loss_0, scene.string[0].loss_1) = (Some(0.0), Some(0.0));
    let mut rival = Rival::new(&scene).unwrap();
    let pluck = &scene.pluck[0];
    let end = (pluck.start + pluck.duration + pluck.release) * scene.sample_rate;
    (0..=end as usize + 1).for_each(|_| rival.step());
    let first = energy(&rival);
    let (mut off, mut stored, mut contacts) = (0.0, 0.0, 0);
    for _ in 0..8_000 {
        rival.step();
        off = largest([off, (energy(&rival) / first - 1.0).abs()]);
        stored = largest([stored, largest(rival.psi.iter().map(|psi| 0.5 * psi * psi)) / first]);
        contacts += u64::from(rival.active() > 0);
    }
    assert!(
        first > 1e-4 && stored > 1e-3 && contacts > 50,
        "{first:e} J, {stored:e} of it, {contacts} contacts"
    );
    assert!(off < 1e-11, "off by {off:e} of {first:e} J");
}
