//! Bodies that cannot be are refused by what must be otherwise, and one that is as said can be.

use super::*;

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
