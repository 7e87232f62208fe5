//! Instructions of the sample with most work, which callgrind counts.

use anyhow::{Context, Result};
use low_action_dsp::Simulation;

use super::Outcome;
use super::rival::Rival;
use super::scenes::SCENES;
use super::settings::{Law, all};
use crate::measure::features::{counted_part, instructions_of_parts};

/// Which sample: setting, scene, string and step.
type Place = (usize, usize, usize, u64);

/// Counts for each setting the worst sample of all scenes.
pub fn count(outcomes: &mut [Outcome]) -> Result<()> {
    for (index, setting) in all().iter().enumerate() {
        let own =
            outcomes.iter_mut().filter(|outcome| outcome.setting == *setting && outcome.kind().is_main());
        let Some(outcome) = own.max_by_key(|outcome| outcome.worst.map(|(size, ..)| size)) else { continue };
        if let Some((_, string, step)) = outcome.worst {
            outcome.instructions = Some(instructions((index, outcome.scene, string, step))?);
        }
    }
    Ok(())
}

/// Has callgrind count one sample, in a process of its own.
fn instructions((setting, scene, string, step): Place) -> Result<f64> {
    let program = std::env::current_exe().context("this program has no path")?;
    let sample = format!("{setting},{scene},{string},{step}");
    let parts = instructions_of_parts(&program, &["measure", "trade", "--sample", &sample])?;
    parts.first().copied().context("callgrind saw no sample")
}

/// Plays up to a sample, and the sample.
pub fn child(place: &str) -> Result<()> {
    let numbers: Vec<u64> = place.split(',').map(str::parse).collect::<Result<_, _>>()?;
    let &[setting, scene, string, step] = &numbers[..] else { anyhow::bail!("four numbers") };
    let setting = all().get(setting as usize).copied().context("no such setting")?;
    let scene = SCENES.get(scene as usize).context("no such scene")?.scenes(&setting)?;
    let scene = scene.get(string as usize).context("no such string")?;
    match setting.law {
        Law::Newton => {
            let mut simulation = Simulation::new(scene)?;
            (0..step).for_each(|_| {
                simulation.step();
            });
            counted_part(|| {
                simulation.step();
            });
        }
        Law::Quadratised => {
            let mut rival = Rival::new(scene)?;
            (0..step).for_each(|_| rival.step());
            counted_part(|| rival.step());
        }
    }
    Ok(())
}
