//! What the damping of frets does to buzz: on a grid as it is played, and at the rate of the reference.

use super::Outcome;
use super::scenes::{Kind, SCENES};
use super::settings::{Axis, Setting, settings};
use super::table::{head, shown};

/// Buzz of each string of `electric`, a column for each damping.
pub fn table(outcomes: &[Outcome]) -> String {
    let columns = settings(Axis::Loss);
    let mut text = head(columns.iter().map(|setting| setting.name(Axis::Loss)));
    for (index, playing) in SCENES.iter().enumerate().filter(|(_, one)| one.kind == Kind::EachBuzzing) {
        let cells = columns.iter().map(|setting| shown(buzz(setting, index, outcomes)));
        let name = playing.string().unwrap_or_default();
        text += &format!("| {name}, % | {} |\n", cells.collect::<Vec<_>>().join(" | "));
    }
    text
}

/// How far the impulses on frets and board are off in a scene, %.
fn buzz(setting: &Setting, scene: usize, outcomes: &[Outcome]) -> Option<f64> {
    outcomes.iter().find(|one| one.scene == scene && one.setting == *setting)?.impulses()
}
