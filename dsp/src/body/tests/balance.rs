//! The body receives what strings lose at the bridge: nothing is won between them, and nothing blows up.

use super::*;
use crate::curve::Curve;

/// The body receives what a string loses at the bridge, to the last digits, for every stencil; what rings in wood and air is lost, and
/// nothing is ever won.
#[test]
fn nothing_is_lost_between_string_and_body() {
    for stencil in [Stencil::Paper, Stencil::Corrected, Stencil::Wide] {
        let keeping = Description { quality: 1e15, ..GUITAR };
        for (description, keeps) in [(keeping, true), (GUITAR, false)] {
            let mut pair = Pair::new(low_string(stencil), &description);
            let shape = Curve::Points(vec![[0.0, 0.0], [0.5, 3e-3], [0.65, 0.0]]);
            pair.state.set_shape(&pair.model, &shape);
            let first = pair.step();
            let (mut least, mut most, mut last) = (first, first, first);
            for _ in 0..48_000 {
                let energy = pair.step();
                assert!(keeps || energy <= last * (1.0 + 1e-12), "it grew: {last} to {energy} J");
                (least, most, last) = (least.min(energy), most.max(energy), energy);
            }
            // 1e-14 is found: of 48,000 steps each rounds by some 1e-16 of what there is, to either side, and their root is 200.
            let lost = (most - least) / first;
            assert!(if keeps { lost < 1e-13 } else { last < 0.8 * first }, "{stencil:?}: {lost}");
        }
    }
}

/// Five strings over one body, one of which is plucked: what it loses the body and the others have. Those of its pitch take much, and
/// no energy is won or lost between them.
#[test]
fn nothing_is_lost_between_strings_over_a_body() {
    let keeping = Description { quality: 1e15, ..GUITAR };
    let model = low_string(Stencil::Wide);
    // An octave and a fifth above, a tritone above, and in unison.
    let tuned = |ratio: f64| {
        let string = StringParameters {
            tension: model.string.tension * ratio * ratio,
            tension_limit: model.string.tension_limit * ratio * ratio,
            ..model.string
        };
        Model::new(string, None, 0, model.settings, 48_000.0).expect("it can be")
    };
    let mut strings = [1.0, 1.5, 2.0, libm::sqrt(2.0), 1.0].map(|ratio| Pair::new(tuned(ratio), &keeping));
    check(&keeping, &strings.each_ref().map(|pair| &pair.model)).expect("it is heavy enough");
    strings[0].state.set_shape(&model, &Curve::Points(vec![[0.0, 0.0], [0.5, 3e-3], [0.65, 0.0]]));
    let first = step(&mut strings);
    let (mut least, mut most) = (first, first);
    for _ in 0..48_000 {
        let energy = step(&mut strings);
        (least, most) = (least.min(energy), most.max(energy));
    }
    let held = strings.each_ref().map(|pair| pair.ledger.energies().total() / first);
    assert!((most - least) / first < 1e-13, "{least} to {most} J");
    assert!(held[4] > 0.05, "a string in unison has {} of it", held[4]);
    assert!(held[3] < held[1] && held[3] < held[2], "strings in tune hear more than another: {held:?}");
}

/// As light a body as there may be, under a string or three as taut as may be: the refusal names its mass, a body of that mass is
/// taken, and what all hold together stays, to 1e-9, through 20,000 steps in which anything that grows would be seen.
#[test]
fn the_lightest_body_that_is_accepted_is_stable() {
    let cases = [(1, 48_000.0, 5.0), (1, 48_000.0, 300.0), (1, 22_050.0, 20.0), (3, 48_000.0, 5.0)];
    for stencil in [Stencil::Paper, Stencil::Corrected, Stencil::Wide] {
        for (count, rate, spacing) in cases {
            let model = low_string_at(stencil, rate);
            let keeping = Description { quality: 1e15, spacing, mass: 1e-4, ..GUITAR };
            let under = vec![&model; count];
            let error = check(&keeping, &under).expect_err("it is too light").to_string();
            let least: f64 = error.rsplit(' ').nth(1).and_then(|mass| mass.parse().ok()).expect("a mass");
            let description = Description { mass: least, ..keeping };
            check(&description, &under).expect("it is heavy enough");
            let mut strings = vec![Pair::new(model.clone(), &description)];
            for number in 1..count {
                // Each with a motion of its own.
                let mut other = Pair::new(model.clone(), &description);
                let top = [0.65 - 0.2 * number as f64, -1e-3];
                other.state.set_shape(&model, &Curve::Points(vec![[0.0, 0.0], top, [0.65, 0.0]]));
                strings.push(other);
            }
            let shape = Curve::Points(vec![[0.0, 0.0], [0.6, 3e-3], [0.65, 0.0]]);
            strings[0].state.set_shape(&model, &shape);
            strings.iter_mut().for_each(|pair| pair.drive.tension = most_tension(&model, true));
            step(&mut strings);
            let first = step(&mut strings);
            let last = (0..20_000).map(|_| step(&mut strings)).last().expect("many");
            assert!(
                (last / first - 1.0).abs() < 1e-9,
                "{stencil:?}, {count} over {least} kg: {first} and {last} J"
            );
        }
    }
}
