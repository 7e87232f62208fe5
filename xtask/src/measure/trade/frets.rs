//! What frets between grid points cost: kinked, as instruments have them, and exact, on grids of several spacings.

use low_action_dsp::scene::FretPlacement;

use super::Outcome;
use super::errors::Ringing;
use super::scenes::{Kind, Playing, SCENES};
use super::settings::{Axis, Setting, settings};
use super::table::{head, shown};

/// Buzz of each string of `electric`, then pitch and decay of its light strings stopped high on the neck; a column for
/// each placement and spacing.
pub fn tables(outcomes: &[Outcome]) -> String {
    let columns = settings(Axis::Frets);
    let lossy: Vec<Setting> = columns.iter().copied().filter(|one| one.damping.is_none()).collect();
    let buzz = rows(Kind::EachBuzzing, &columns, outcomes, |playing, cells| {
        let cells = cells.map(|one| shown(one.and_then(Outcome::impulses)));
        format!("| {}, % | {} |\n", playing.string().unwrap_or_default(), joined(cells))
    });
    let stopped = rows(Kind::High, &lossy, outcomes, |playing, cells| {
        let found: Vec<_> = cells.collect();
        let of = |text: fn(&Ringing) -> String| {
            let ringing = found.iter().map(|one| one.and_then(|one| one.errors.ringing));
            joined(ringing.map(|one| one.as_ref().map_or_else(|| shown(None), text)))
        };
        let pitch = of(|one| shown(Some(one.pitch)));
        let decay = of(|one| {
            let [found, reference] = one.t60;
            match format!("{:+.0}", 100.0 * (found / reference - 1.0)) {
                zero if zero.ends_with("+0") || zero.ends_with("-0") => "0".into(),
                percent => percent.replace('-', "−"),
            }
        });
        format!("| {}, cents off | {pitch} |\n| {}, T60, % | {decay} |\n", playing.name, playing.name)
    });
    let names = |columns: &[Setting]| head(columns.iter().map(|setting| setting.name(Axis::Frets)));
    format!(
        "Buzz:\n\n{}{buzz}\nStopped high on the neck, each against the reference:\n\n{}{stopped}",
        names(&columns),
        names(&lossy)
    )
}

/// A row of each scene of a kind, of what was found there under each of the settings.
fn rows<'a>(
    kind: Kind,
    columns: &'a [Setting],
    outcomes: &'a [Outcome],
    row: impl Fn(&Playing, &mut dyn Iterator<Item = Option<&'a Outcome>>) -> String,
) -> String {
    let scenes = SCENES.iter().enumerate().filter(|(_, playing)| playing.kind == kind);
    scenes
        .map(|(index, playing)| {
            let found =
                |setting: &Setting| outcomes.iter().find(|one| one.scene == index && one.setting == *setting);
            row(playing, &mut columns.iter().map(found))
        })
        .collect()
}

fn joined(cells: impl Iterator<Item = String>) -> String {
    cells.collect::<Vec<_>>().join(" | ")
}

/// How files write a placement.
pub fn placement_name(placement: FretPlacement) -> &'static str {
    match placement {
        FretPlacement::Exact => "exact",
        FretPlacement::Nearest => "nearest",
        FretPlacement::Kinked => "kinked",
    }
}
