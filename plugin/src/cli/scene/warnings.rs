//! What a scene says that is allowed and hardly meant: strings that begin inside something, and parts that do nothing.

use low_action_dsp::curve::Curve;
use low_action_dsp::digits::plain;
use low_action_dsp::scene::PluckSpec;
use low_action_dsp::{Account, Ledger, Scene, Simulation};

use super::{COARSE, Seen, named, open_part, rounding_part};

/// Contacts that begin with less energy than this, J, are not warned of: a pluck of 1 N that moves its place by 2 mm gives as much.
const NO_THROW: f64 = 1e-3;

/// Everything to warn of before a scene is computed, a line each.
pub(super) fn of(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut warnings = inside(simulation);
    warnings.extend(over_at_once(scene, simulation));
    warnings.extend(untouchable(scene, simulation));
    warnings.extend(unheard(scene));
    warnings.extend(motionless(scene));
    warnings
}

/// What to warn of afterwards: strings that were stretched farther than their grid has room for.
pub(super) fn overstretched(seen: &Seen) -> Option<String> {
    let [most, borne] = seen.stretched?;
    (most > borne).then(|| {
        format!(
            "stretching brings the tension to {most:.2} N, and the grid bears {borne:.2} N: pitch glides too little, and the \
             shortest waves ripple. A tension whose course reaches as high, be it after the end, makes room"
        )
    })
}

/// What to warn of afterwards: a balance of which rounding leaves little or nothing to be checked, of the string or body where it
/// leaves the least.
pub(super) fn coarse<'a>(strings: usize, accounts: impl Iterator<Item = &'a Account>) -> Option<String> {
    let parts =
        accounts.enumerate().map(|(index, account)| (index, rounding_part(account), open_part(account)));
    let (index, rounding, open) = parts.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (rounding.is_nan() || rounding > COARSE).then(|| {
        format!(
            "the energy balance of {} is checked only to {rounding:.1e} of its largest energy or of all that was \
             put in, and is open by {open:.1e}: forces or stretching are so large against what they move that rounding alone may \
             come to that",
            named(index, strings)
        )
    })
}

/// Strings that begin inside board, frets or fingers: these would throw them.
fn inside(simulation: &Simulation) -> Vec<String> {
    let thrown = (1..).zip(simulation.strings()).filter_map(|(number, string)| {
        let begun = Ledger::new(&string.model, &string.state, string.model.string.tension).energies();
        let own = begun.string + begun.tension;
        (begun.contact > own.max(NO_THROW)).then(|| {
            format!(
                "string[{number}] begins inside board, frets or fingers, which store {:.3e} J and throw it: it has {own:.3e} J \
                 itself",
                begun.contact
            )
        })
    });
    thrown.collect()
}

/// A scene that is over before its first sample.
fn over_at_once(scene: &Scene, simulation: &Simulation) -> Option<String> {
    let (duration, rate) = (plain(scene.duration), plain(scene.sample_rate));
    (simulation.samples() == 0)
        .then(|| format!("duration = {duration} s has no sample at {rate} Hz: nothing is computed"))
}

/// A fretboard without anything that a string could touch.
fn untouchable(scene: &Scene, simulation: &Simulation) -> Option<String> {
    let touches_nothing = simulation.strings().iter().all(|string| string.model.contacts.is_empty());
    (scene.fretboard.is_some() && touches_nothing)
        .then(|| "fretboard has neither board nor frets under any string: nothing is touched".to_owned())
}

/// Why a pluck is not heard, if it is not.
fn why_unheard(scene: &Scene, pluck: &PluckSpec) -> Option<String> {
    if pluck.force == 0.0 || pluck.duration + pluck.release == 0.0 {
        let (duration, force) = (plain(pluck.duration), plain(pluck.force));
        Some(format!("pushes nothing: force {force} N for {duration} s"))
    } else if pluck.start >= scene.duration {
        let (start, end) = (plain(pluck.start), plain(scene.duration));
        Some(format!("begins at {start} s, when the scene of {end} s is over"))
    } else {
        None
    }
}

/// Plucks that push nothing, and those that begin when all is over.
fn unheard(scene: &Scene) -> Vec<String> {
    let numbered = (1..).zip(&scene.pluck);
    numbered
        .filter_map(|(number, pluck)| Some(format!("pluck[{number}] {}", why_unheard(scene, pluck)?)))
        .collect()
}

/// A scene that stays as it is. (A string at rest is moved by no change of its tension, nor by a finger that only goes along above
/// it.)
fn motionless(scene: &Scene) -> Option<String> {
    let plucked = scene.pluck.iter().any(|pluck| why_unheard(scene, pluck).is_none());
    let is_any = |points: &Option<Vec<[f64; 2]>>| points.iter().flatten().any(|[_, value]| *value != 0.0);
    let begun = scene.string.iter().any(|string| is_any(&string.shape) || is_any(&string.velocity));
    let pressed = scene.finger.iter().any(|finger| {
        let forced = match &finger.force {
            Curve::Constant(force) => *force != 0.0,
            Curve::Points(course) => course.iter().any(|[_, force]| *force != 0.0),
            Curve::Parabola(_) => true,
        };
        forced || finger.velocity != 0.0 || finger.height < 0.0
    });
    (!plucked && !begun && !pressed).then(|| {
        "nothing sets it in motion: no pluck, no shape or velocity of a string, no finger that presses"
            .to_owned()
    })
}
