//! Bodies under random scenes.

use low_action_dsp::{Scene, Simulation};
use toml::{Table, Value};

use super::draw::Draw;

/// How often one is made heavier that is too light for the strings, and by what.
const TRIES: i32 = 8;
const HEAVIER: f64 = 4.0;
/// The heaviest that there may be, kg.
const HEAVIEST: f64 = 1000.0;

/// Puts a body under three scenes in ten, if it can bear the strings at all, and has three in ten of these heard by it. (Drawn after
/// everything else, so that a trial of a number is otherwise the one it was before there were any.)
pub fn under(draw: &mut Draw, scene: &mut Table) {
    if !draw.chance(0.3) {
        return;
    }
    let heard = draw.chance(0.3);
    let mut mass = draw.over(0.01, HEAVIEST);
    let mut body = Table::new();
    for (key, low, high) in [
        ("frequency", 30.0, 2000.0),
        ("area", 1e-4, 1.0),
        ("quality", 1.0, 200.0),
        ("spacing", 5.0, 1000.0),
        ("volume", 1e-4, 1.0),
        ("hole", 1e-5, 0.1),
    ] {
        body.insert(key.into(), draw.over(low, high).into());
    }
    for _ in 0..TRIES {
        body.insert("mass".into(), mass.into());
        if bears(&body, scene) {
            scene.insert("body".into(), body.into());
            if heard {
                let output = Table::from_iter([("position".into(), "air".into())]);
                scene.insert("output".into(), output.into());
            }
            return;
        }
        mass = (HEAVIER * mass).min(HEAVIEST);
    }
}

/// Whether a body can bear the strings of a scene.
fn bears(body: &Table, scene: &Table) -> bool {
    let mut bare = Table::new();
    for key in ["sample_rate", "duration", "solver", "string"] {
        bare.extend(scene.get(key).map(|value| (key.to_owned(), value.clone())));
    }
    bare.insert("body".into(), Value::Table(body.clone()));
    Scene::from_toml(&bare.to_string()).and_then(|scene| Simulation::new(&scene)).is_ok()
}
