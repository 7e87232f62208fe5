mod refusals;

use std::f64::consts::{PI, TAU};
use std::slice::from_mut;

use super::refusals::taken;
use super::*;
use crate::curve::Curve;
use crate::drive::Drive;
use crate::energy::Ledger;
use crate::model::StringParameters;
use crate::pickup::bridge_force;
use crate::scene::{Scene, SolverSettings, Stencil};
use crate::setup::Setup;
use crate::simulation::{SceneString, Simulation};
use crate::string::Scratch;

const GUITAR: Description = Description::GUITAR;

/// The low E of nylon, without losses of its own; with room for a body.
fn low_string(stencil: Stencil) -> Model {
    low_string_at(stencil, 48_000.0)
}

fn low_string_at(stencil: Stencil, rate: f64) -> Model {
    let string = StringParameters {
        length: 0.65,
        linear_density: 6.24e-3,
        tension: 71.6,
        tension_limit: 71.6 * 1.06 * room(true),
        youngs_modulus: 2.234e10,
        core_radius: 2.387e-4,
        loss_0: 0.0,
        loss_1: 0.0,
        tension_modulation: true,
    };
    let settings = SolverSettings { stencil, ..SolverSettings::default() };
    Model::new(string, None, 0, settings, rate).expect("it can be")
}

/// A string over a body, its ledger, and what moves with both.
struct Pair {
    model: Model,
    state: State,
    scratch: Scratch,
    drive: Drive,
    ledger: Ledger,
    body: Body,
    heard: Heard,
}

impl Pair {
    fn new(model: Model, description: &Description) -> Self {
        check(description, &[&model]).expect("it is heavy enough");
        let body = Body::new(description, &model);
        let state = State::new(&model);
        let (scratch, drive) = (Scratch::new(&model), Drive::new(&model));
        let ledger = Ledger::new(&model, &state, model.string.tension);
        Pair { model, state, scratch, drive, ledger, body, heard: Heard::default() }
    }

    /// One step, and what string and body hold together half a step before its end, J.
    fn step(&mut self) -> f64 {
        step(from_mut(self))
    }
}

/// One step of strings over one body, and what all hold together half a step before its end, J.
fn step(strings: &mut [Pair]) -> f64 {
    let lift = |strings: &[Pair]| strings.iter().map(|pair| pair.body.lift()).sum::<f64>();
    let before = lift(strings);
    let (mut energy, mut coupling) = (0.0, Vec::new());
    for Pair { model, state, scratch, drive, ledger, body, heard } in &mut *strings {
        let string_before = body.end.reading.of(&state.displacement);
        let (push, of_body) = body.step(model, state, drive.tension, before);
        *heard = of_body;
        drive.bridge = Some(push);
        state.step(model, drive, scratch);
        energy += ledger.record(model, state, scratch, drive).energies.total();
        coupling.push((body.end, [string_before, body.end.reading.of(&state.displacement)]));
    }
    let after = lift(strings);
    for (end, string) in coupling {
        energy += end.common(string, [before, after]);
    }
    // All that the strings have the modes do is one motion.
    let mut whole = strings[0].body.modes.clone();
    for Pair { body: Body { modes, .. }, .. } in &strings[1..] {
        let add = |to: &mut Vec<Row>, from: &[Row]| {
            to.iter_mut().flatten().zip(from.iter().flatten()).for_each(|(to, from)| *to += from);
        };
        add(&mut whole.place, &modes.place);
        add(&mut whole.motion, &modes.motion);
    }
    energy + whole.energy()
}

/// What a string loses at a bridge that gives way the body has, to the last digits, for every stencil; what rings in wood and air
/// is lost, and nothing is ever won.
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

/// A partial that moves as sin(nπx/L) sends T nπ/L to the bridge, which answers with Y: it dies away at 2 f₁ Z Re Y, and is off by
/// −f₁ Z Im Y/π, both to first order in Z|Y|, here below 1e-2.
#[test]
fn partials_die_away_and_move_as_the_admittance_says() {
    let description = Description { mass: 1.0, ..GUITAR };
    let model = low_string(Stencil::Wide);
    let (tension, density, length) = (model.string.tension, model.string.linear_density, model.string.length);
    let impedance = (tension * density).sqrt();
    let fundamental = (tension / density).sqrt() / (2.0 * length);
    for partial in [1, 2, 3, 5, 8] {
        let flexible = StringParameters { youngs_modulus: 0.0, tension_modulation: false, ..model.string };
        let model = Model::new(flexible, None, 0, model.settings, 48_000.0).expect("it can be");
        let mut pair = Pair::new(model, &description);
        let wave = PI * f64::from(partial) / length;
        let points = (0..=400).map(|i| length * f64::from(i) / 400.0);
        let shape = points.map(|x| [x, 1e-6 * libm::sin(wave * x)]).collect();
        pair.state.set_shape(&pair.model, &Curve::Points(shape));
        pair.state.let_go(&pair.model, &pair.drive);
        // The partial as it turns: its displacement and its velocity over 2πf.
        let frequency = fundamental * f64::from(partial);
        let mut turned = |samples: usize| {
            (0..samples).for_each(|_| _ = pair.step());
            let sum = |values: &mut dyn Iterator<Item = f64>| {
                values
                    .enumerate()
                    .map(|(i, u)| u * libm::sin(wave * (i + 1) as f64 * pair.model.grid.spacing))
                    .sum()
            };
            let (now, motion): (f64, f64) =
                (sum(&mut pair.state.displacement()), sum(&mut pair.state.motion()));
            let half = PI * frequency * pair.model.grid.time_step;
            // Half a step ago the displacement was u − d/2 over cos, the velocity d over 2 sin.
            [(now - 0.5 * motion) / libm::cos(half), 0.5 * motion / libm::sin(half)]
        };
        let (settle, samples) = (24_000, 96_000);
        let [a, b] = turned(settle);
        let [c, d] = turned(samples);
        let seconds = samples as f64 / 48_000.0;
        let decay = -0.5 * libm::log((c * c + d * d) / (a * a + b * b)) / seconds;
        let turn = libm::atan2(-d, c) - libm::atan2(-b, a) - TAU * frequency * seconds;
        let off = (turn - TAU * (turn / TAU).round()) / seconds / TAU;
        let omega = TAU * frequency;
        let (mut real, mut imaginary) = (0.0, 0.0);
        for mode in description.modes() {
            let own = TAU * mode.frequency;
            let (x, y) = (own * own - omega * omega, omega * own / mode.quality);
            let size = omega * mode.bridge * mode.bridge / (x * x + y * y);
            (real, imaginary) = (real + size * y, imaginary + size * x);
        }
        let (lost, moved) = (2.0 * fundamental * impedance * real, -fundamental * impedance * imaginary / PI);
        assert!((decay / lost - 1.0).abs() < 0.05, "partial {partial}: {decay} and not {lost} 1/s");
        assert!(
            (off - moved).abs() < 0.05 * moved.abs() + 0.002,
            "partial {partial}: {off} and not {moved} Hz"
        );
    }
}

/// Bodies that come with the program take a part of the room that grids of all their strings leave for them.
#[test]
fn guitars_leave_room() {
    let names = Setup::BUILTIN.into_iter().chain(Setup::PRESETS);
    let mut most: f64 = 0.0;
    for setup in names.filter_map(Setup::shipped) {
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

/// What a piezo hears does not depend on the rate: the force is that of a string whose end has moved, not of one whose end is where it
/// was. (Compared in what is low enough for both grids, by its mean square under a low-pass of 2 kHz.)
#[test]
fn the_force_on_a_bridge_that_gives_way_is_known() {
    let force = |rate: f64| {
        let mut pair = Pair::new(low_string_at(Stencil::Wide, rate), &Description { mass: 0.05, ..GUITAR });
        let bump = (0..=40).map(|i| [0.2 + 0.005 * f64::from(i), 1e-4 * libm::sin(PI * f64::from(i) / 40.0)]);
        let shape = std::iter::once([0.0, 0.0]).chain(bump).chain([[0.65, 0.0]]).collect();
        pair.state.set_shape(&pair.model, &Curve::Points(shape));
        pair.state.let_go(&pair.model, &pair.drive);
        let (mut low, mut sum) = (0.0, 0.0);
        for _ in 0..(0.3 * rate) as usize {
            pair.step();
            let heard = bridge_force(&pair.model, &pair.scratch, pair.heard.lift);
            low += (heard - low) * (1.0 - libm::exp(-TAU * 2000.0 / rate));
            sum += low * low;
        }
        (sum / (0.3 * rate)).sqrt()
    };
    let [coarse, fine] = [48_000.0, 192_000.0].map(force);
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} and {fine} N");
}

/// A body that comes under a string that is pressed begins where the string holds it, however light it is.
#[test]
fn a_body_begins_where_the_string_holds_it() {
    for mass in [0.2, 0.012] {
        let description = Description { frequency: 30.0, mass, spacing: 1000.0, ..GUITAR };
        let mut pair = Pair::new(low_string(Stencil::Wide), &description);
        let push = Push { reading: pair.model.grid.reading(0.5), force: -1.0 };
        pair.drive.loss = 300.0;
        for _ in 0..48_000 {
            pair.drive.pushes.push(push);
            pair.state.step(&pair.model, &pair.drive, &mut pair.scratch);
            pair.drive.pushes.clear();
        }
        let tension = pair.drive.tension;
        pair.body.take_over(None, &pair.model, tension);
        let end = pair.body.end;
        pair.body.rest_under(end.force(&pair.state, 0.0) / (1.0 + pair.body.gives() * end.back));
        let begins = pair.body.lift();
        let mut farthest: f64 = 0.0;
        for _ in 0..48_000 {
            pair.drive.pushes.push(push);
            pair.step();
            pair.drive.pushes.clear();
            farthest = farthest.min(pair.body.lift());
        }
        let rests = pair.body.lift();
        assert!(begins < 0.0 && begins > rests, "{mass} kg: it begins at {begins} and rests at {rests} m");
        assert!(farthest > 2.0 * rests, "{mass} kg: it swings to {farthest} and rests at {rests} m");
    }
}

/// Every lane of a body that rings, beside each other and to itself, never holds a number that processors are slow with.
#[test]
fn a_body_that_fades_is_forgotten() {
    let mut pair = Pair::new(low_string(Stencil::Wide), &GUITAR);
    pair.state.set_shape(&pair.model, &Curve::Points(vec![[0.0, 0.0], [0.5, 3e-3], [0.65, 0.0]]));
    (0..4_800).for_each(|_| _ = pair.step());
    assert!(!pair.body.is_still());
    let mut steps = 0;
    while !pair.body.is_still() {
        pair.body.ring(pair.body.lift());
        steps += 1;
        let numbers = pair.body.modes.place.iter().chain(&pair.body.modes.motion).flatten();
        assert!(numbers.into_iter().all(|number| !number.is_subnormal()));
        assert!(steps < 96_000, "it comes to rest");
    }
    assert!(steps > 4_800, "it rings");
    assert_eq!(pair.body.ring(0.0), Heard::default());
}

/// A scene of so many strings like that of [`low_string`], the first of them plucked, over a body.
fn scene(count: usize, position: &str) -> Simulation {
    let string = "[[string]]\nlength = 0.65\nlinear_density = 6.24e-3\ntension = 71.6\nyoungs_modulus = 2.234e10\n\
                  core_radius = 2.387e-4\ntension_modulation = true\n";
    let Description { frequency, mass, area, quality, spacing, volume, hole } = GUITAR;
    let text = format!(
        "sample_rate = 48000\nduration = 1.0\n{}[body]\nfrequency = {frequency}\nmass = {mass}\narea = {area}\n\
         quality = {quality}\nspacing = {spacing}\nvolume = {volume}\nhole = {hole}\n\
         [[pluck]]\nduration = 0.002\nposition = 0.5\nforce = 1.0\n[output]\nposition = \"{position}\"\n",
        string.repeat(count)
    );
    Simulation::new(&Scene::from_toml(&text).expect("it is legal")).expect("it can be built")
}

/// Over a scene's body a string moves as over one of an instrument, and the same is heard, at the bridge and in the air, to the
/// bit; and several do but for rounding, though there each has a bank of modes to itself.
#[test]
fn strings_of_a_scene_and_of_an_instrument_hear_the_same_body() {
    // (Last digits of displacements are a k² larger part of accelerations, which is what sounds.)
    for (count, apart) in [(1, 0.0), (3, 1e-10)] {
        let [mut of_air, mut of_bridge] = ["air", "bridge"].map(|position| scene(count, position));
        let new = |string: &SceneString| Pair::new(string.model.clone(), &GUITAR);
        let mut strings: Vec<Pair> = of_air.strings().iter().map(new).collect();
        let mut loudest = [0.0; 2];
        for _ in 0..24_000 {
            of_bridge.step();
            of_air.step_under(|index, string| {
                strings[index].drive.pushes.clear();
                strings[index].drive.pushes.extend_from_slice(&string.drive.pushes);
            });
            step(&mut strings);
            let force = |pair: &Pair| bridge_force(&pair.model, &pair.scratch, pair.heard.lift);
            let heard = [
                (of_air.output(), strings.iter().map(|pair| pair.heard.pressure).sum::<f64>()),
                (of_bridge.output(), strings.iter().map(force).sum::<f64>()),
            ];
            for (most, (found, expected)) in loudest.iter_mut().zip(heard) {
                *most = expected.abs().max(*most);
                assert!((found - expected).abs() <= apart * *most, "{count}: {found} and not {expected}");
            }
            for (string, pair) in of_air.strings().iter().zip(&strings) {
                let both = string.state.displacement().zip(pair.state.displacement());
                for (found, expected) in both {
                    assert!(
                        (found - expected).abs() <= apart * 1e-3,
                        "{count}: {found} and not {expected} m"
                    );
                }
            }
        }
        assert!(loudest[0] > 0.01 && loudest[1] > 0.1, "{loudest:?}");
    }
}
