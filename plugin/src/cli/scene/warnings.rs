//! What a scene says that is allowed and hardly meant: strings that begin inside something, and parts that do nothing.

use low_action_dsp::curve::Curve;
use low_action_dsp::digits::plain;
use low_action_dsp::scene::PluckSpec;
use low_action_dsp::{Account, Barrier, Ledger, Model, Scene, Simulation, State};

use super::check::{COARSE, named, open_part, rounding_part};
use super::seen::Seen;

/// Contacts that begin with less energy than this, J, are not warned of: a pluck of 1 N that moves its place by 2 mm gives as much.
const NO_THROW: f64 = 1e-3;

/// Everything to warn of before a scene is computed, a line each.
pub(super) fn of(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut warnings = inside(scene, simulation);
    warnings.extend(over_at_once(scene, simulation));
    warnings.extend(untouchable(scene, simulation));
    warnings.extend(sunk(scene));
    warnings.extend(without_core(scene));
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
fn inside(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let strings = (1..).zip(simulation.strings());
    let thrown = strings.filter_map(|(number, string)| {
        let [contacts, own] = energies_at_first(scene, number, &string.model)?;
        (contacts > own.max(NO_THROW)).then(|| {
            format!(
                "string[{number}] begins inside board, frets or fingers, which store {contacts:.3e} J and throw it: it has \
                 {own:.3e} J itself"
            )
        })
    });
    thrown.collect()
}

/// What the contacts of a string, counted from 1, and the string itself have at time 0, J. (A ledger is of the time half a sample
/// earlier, and of what is thrown meanwhile: so the string stands still in its shape here, and its velocity is counted by itself.)
fn energies_at_first(scene: &Scene, number: usize, model: &Model) -> Option<[f64; 2]> {
    let spec = scene.string.get(number - 1)?;
    let mut state = State::new(model);
    if let Some(velocity) = &spec.velocity {
        state.set_velocity(model, &Curve::Points(velocity.clone()));
    }
    let speeds = state.motion().map(|motion| motion / model.grid.time_step);
    let moving = 0.5
        * model.string.linear_density
        * model.grid.spacing
        * speeds.map(|speed| speed * speed).sum::<f64>();
    state.set_shape(model, &Curve::Points(spec.shape.clone().unwrap_or_else(|| vec![[0.0, 0.0]])));
    for (slot, finger) in scene.finger.iter().filter(|finger| finger.string == number).enumerate() {
        let place = finger.position.at(0.0);
        state.place_finger(model, slot, finger.touch(), place, finger.height, 0.0).ok()?;
    }
    let still = Ledger::new(model, &state, model.string.tension).energies();
    Some([still.contact, still.string + still.tension + moving])
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

/// Frets whose crowns lie below the board: the string meets the board beside them first.
fn sunk(scene: &Scene) -> Option<String> {
    let fretboard = scene.fretboard.as_ref()?;
    let below = (1..).zip(&scene.string).find_map(|(number, string)| {
        let Barrier { board, frets, .. } = Barrier::from_spec(fretboard, string.length).ok()?;
        let board = board?;
        let is_under = |place: f64| match &board {
            Curve::Constant(_) | Curve::Parabola(_) => true,
            Curve::Points(profile) => {
                profile.first().is_some_and(|first| first[0] <= place)
                    && profile.last().is_some_and(|last| place <= last[0])
            }
        };
        let sunk = |[place, top]: &[f64; 2]| is_under(*place) && *top < board.at(*place);
        let first = frets.iter().position(sunk)?;
        let [place, top] = frets[first];
        Some((number, first + 1, [top, board.at(place)], frets.iter().filter(|fret| sunk(fret)).count()))
    });
    let (number, fret, heights, count) = below?;
    let [top, board] = heights.map(plain);
    let others = if count > 1 { format!(", and {} more are", count - 1) } else { String::new() };
    Some(format!(
        "fretboard.fret_top = {top} m is below the board, {board} m, at fret {fret} of string[{number}]{others}: the string meets \
         the board first"
    ))
}

/// Strings that are said to be stiff, or to be stretched, and have no core by which they could be.
fn without_core(scene: &Scene) -> Vec<String> {
    let told = (1..).zip(&scene.string).filter_map(|(number, string)| {
        let (modulus, radius) = (string.youngs_modulus, string.core_radius);
        let told = match (modulus > 0.0, radius > 0.0) {
            (true, true) => return None,
            (true, false) => format!("youngs_modulus = {} does nothing without core_radius", plain(modulus)),
            (false, true) => format!("core_radius = {} does nothing without youngs_modulus", plain(radius)),
            (false, false) if string.tension_modulation => {
                "tension_modulation = true does nothing without youngs_modulus and core_radius".to_owned()
            }
            (false, false) => return None,
        };
        let stretched =
            if string.tension_modulation { ": stretching does not raise the tension" } else { "" };
        Some(format!("string[{number}].{told}{stretched}"))
    });
    told.collect()
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
