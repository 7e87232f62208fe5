//! A scene's body is an instrument's.

use super::*;
use crate::pickup::bridge_force;
use crate::scene::Scene;
use crate::simulation::{SceneString, Simulation};

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
