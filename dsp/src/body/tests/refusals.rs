//! A body that cannot be is refused with the value that would do; one with that value is accepted.

use super::super::refusals::taken;
use super::*;
use crate::setup::Setup;

/// Why a body is refused under one string, behind the name and the value given.
fn refusal(description: &Description, model: &Model, name: &str) -> String {
    let error = check(description, &[model]).expect_err("it cannot be").to_string();
    let (before, why) = error.split_once(" is refused: ").expect("it says why");
    assert!(before.starts_with(name), "{error}");
    why.to_owned()
}

/// What the last number but for its unit is.
fn limit(why: &str) -> f64 {
    why.rsplit(' ').nth(1).and_then(|number| number.parse().ok()).expect("a number")
}

/// A mode is there below 0.4 of the rate: at 4 kHz, below 1600 Hz. The soundboard on the air is a little higher than by itself.
#[test]
fn a_body_that_is_too_fast_for_the_rate_is_refused() {
    let heavy = Description { mass: 10.0, ..GUITAR };
    let fast = Description { frequency: 2000.0, ..heavy };
    let slow = low_string_at(Stencil::Wide, 4_000.0);
    let why = refusal(&fast, &slow, "body.frequency = 2000");
    let said = "at 4000 Hz a body's two lowest modes must lie below 1600 Hz: it must lie between 30 and ";
    let most = limit(&why);
    assert!(why.starts_with(said) && (1590.0..1600.0).contains(&most), "{why}");
    let at = |frequency: f64| Description { frequency, ..heavy };
    assert_eq!(check(&at(most), &[&slow]), Ok(()));
    assert!(check(&at(1.001 * most), &[&slow]).is_err());
    // So both modes are there, and at a higher rate they are anyway.
    let bridge = |modes: &Modes| modes.coefficients[0].bridge;
    assert!(bridge(&Modes::new(&at(most), slow.grid.time_step))[..2].iter().all(|phi| *phi != 0.0));
    assert_eq!(check(&fast, &[&low_string(Stencil::Wide)]), Ok(()));
    // As stiff as this the air alone is too fast.
    let tight = Description { area: 1.0, volume: 1e-4, ..fast };
    let why = refusal(&tight, &slow, "body.frequency = 2000");
    assert!(
        why.contains(", and by the air in the box one is at ") && why.contains(" Hz even with 30 Hz: "),
        "{why}"
    );
    for mended in [Description { volume: 0.1, ..tight }, Description { area: 0.02, ..tight }] {
        assert_eq!(check(&Description { frequency: 30.0, ..mended }, &[&slow]), Ok(()));
    }
}

/// What is said to be heavy enough is, up to the heaviest that there may be; beyond, other things are named that help.
#[test]
fn no_mass_is_asked_for_that_is_refused() {
    let string = |density: f64| {
        let model = low_string_at(Stencil::Wide, 8_000.0);
        // As fast a wave on any.
        let [tension, tension_limit] =
            [model.string.tension, model.string.tension_limit].map(|force| force * density / 6.24e-3);
        let string = StringParameters { linear_density: density, tension, tension_limit, ..model.string };
        Model::new(string, None, 0, model.settings, 8_000.0).expect("it can be")
    };
    let light = Description { mass: 0.01, spacing: 5.0, ..GUITAR };
    let mut densest: f64 = 0.0;
    for density in (0..60).map(|power| 1e-3 * 1.25_f64.powi(power)) {
        let model = string(density);
        let Err(error) = check(&light, &[&model]) else { continue };
        let error = error.to_string();
        if error.starts_with("body.mass = 0.01 is refused: it must be at least ") {
            let least = limit(&error);
            assert!(least <= 1000.0, "{error}");
            assert_eq!(check(&Description { mass: least, ..light }, &[&model]), Ok(()));
            densest = density;
        }
    }
    let model = string(1.25 * densest);
    for mass in [0.01, 1000.0] {
        let why = refusal(&Description { mass, ..light }, &model, "body.mass");
        assert!(why.starts_with("no mass up to 1000 kg will do: linear_density, "), "{why}");
    }
    println!("from {densest} kg/m on none will do");
    let heavy = Description { mass: 1000.0, ..light };
    assert_eq!(check(&Description { spacing: 10.0, ..heavy }, &[&model]), Ok(()));
    assert_eq!(check(&heavy, &[&string(densest)]), Ok(()));
}

/// Bodies that come with the program take a part of the room that grids of all their strings leave for them.
#[test]
fn guitars_leave_room() {
    let mut most: f64 = 0.0;
    for setup in Setup::SHIPPED.into_iter().filter_map(Setup::shipped) {
        let Some(description) = &setup.body else { continue };
        for rate in [22_050.0, 48_000.0, 96_000.0] {
            let model = |spec| {
                let string = crate::intonation::flexible(&setup, spec);
                let settings = SolverSettings { stencil: Stencil::Wide, ..SolverSettings::default() };
                Model::new(string, None, 0, settings, rate).expect("it can be")
            };
            let models: Vec<_> = setup.string.iter().map(model).collect();
            most = most.max(taken(description, &models.iter().collect::<Vec<_>>()));
        }
    }
    println!("they take {most} of it");
    assert!(most > 0.0 && most < 0.25, "they take {most} of it");
}
