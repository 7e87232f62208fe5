//! Bodies under random scenes.

use low_action_dsp::{Scene, Simulation};
use toml::{Table, Value};

use super::draw::Draw;

/// The lightest and the heaviest that there may be, kg.
const LIGHTEST: f64 = 0.01;
const HEAVIEST: f64 = 1000.0;
/// How much heavier one is made at a time that is too light for the strings.
const HEAVIER: f64 = 4.0;
/// How often what is between too light and heavy enough is halved: to 2 %.
const HALVINGS: u32 = 6;

/// Puts a body under three scenes in ten, if it can bear the strings at all and is not too fast for their rate, and has three in
/// ten of these heard by it. Three in ten are hardly heavier than they must be. (Drawn after everything else, so that a trial of a
/// number is otherwise the one it was before there were any.)
pub fn under(draw: &mut Draw, scene: &mut Table) {
    if !draw.chance(0.3) {
        return;
    }
    let heard = draw.chance(0.3);
    let light = draw.chance(0.3);
    let mut mass = if light { LIGHTEST } else { draw.over(LIGHTEST, HEAVIEST) };
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
    let mut too_light = None;
    while !bears(&body, mass, scene) {
        if mass == HEAVIEST {
            return;
        }
        too_light = Some(mass);
        mass = (HEAVIER * mass).min(HEAVIEST);
    }
    if let (true, Some(mut too_light)) = (light, too_light) {
        for _ in 0..HALVINGS {
            let middle = (too_light * mass).sqrt();
            *if bears(&body, middle, scene) { &mut mass } else { &mut too_light } = middle;
        }
    }
    body.insert("mass".into(), mass.into());
    scene.insert("body".into(), body.into());
    if heard {
        let output = Table::from_iter([("position".into(), "air".into())]);
        scene.insert("output".into(), output.into());
    }
}

/// Whether a body of such a mass, kg, can bear the strings of a scene, and be had at its rate: the heavier, the slower it is.
fn bears(body: &Table, mass: f64, scene: &Table) -> bool {
    let mut bare = Table::new();
    for key in ["sample_rate", "duration", "solver", "string"] {
        bare.extend(scene.get(key).map(|value| (key.to_owned(), value.clone())));
    }
    let mut body = body.clone();
    body.insert("mass".into(), mass.into());
    bare.insert("body".into(), Value::Table(body));
    Scene::from_toml(&bare.to_string()).and_then(|scene| Simulation::new(&scene)).is_ok()
}
