//! Scenes that are absurd but legal, as the text of scene files.

use low_action_dsp::model::stiffest;
use low_action_dsp::{Model, Stencil, StringParameters};
use toml::{Table, Value};

use super::beginnings::{self, point};
use super::draw::Draw;

/// The most products of a grid point and a sample in a scene.
pub const MOST_POINT_SAMPLES: f64 = 1e6;

/// The fastest slide, m/s.
pub const FASTEST_SLIDE: f64 = 50.0;

/// Caps of the solver that are tried, none more often than the rest.
pub const CAPS: [usize; 9] = [0, 0, 1, 2, 3, 5, 8, 20, 50];

/// Exponents that have their own code, and some that have not.
const EXPONENTS: [f64; 8] = [1.0, 1.5, 2.0, 2.3, 2.5, 3.0, 4.0, 5.0];

/// One string with what decides about its contacts.
struct Drawn {
    table: Table,
    length: f64,
    spacing: f64,
    intervals: usize,
    mobility: f64,
}

/// A scene.
pub fn scene(draw: &mut Draw) -> Table {
    let rate = draw.over(8e3, 768e3);
    let stencil = draw.one_of(&Stencil::ALL);
    let count = if draw.chance(0.1) { 2 } else { 1 };
    let strings: Vec<_> = (0..count).map(|_| string(draw, rate, stencil)).collect();
    let points: usize = strings.iter().map(|string| string.intervals).sum();
    // How far things are apart in this scene.
    let reach = draw.over(1e-6, 0.1);
    // Mostly short, so that there can be many; one in ten may be long.
    let most = if draw.chance(0.1) { MOST_POINT_SAMPLES } else { 0.1 * MOST_POINT_SAMPLES };
    let budget = draw.over(3e3, most);
    let samples = (budget / points as f64).clamp(2.0, 20e3).floor();
    let duration = samples / rate;

    let mut solver = Table::new();
    solver.insert("max_iterations".into(), Value::Integer(draw.one_of(&CAPS) as i64));
    solver.insert("tolerance".into(), draw.over_or_nothing(0.1, 1e-18, 1e-6).into());
    solver.insert("stencil".into(), stencil.name().into());
    let mut scene = Table::new();
    scene.insert("sample_rate".into(), rate.into());
    scene.insert("duration".into(), duration.into());
    scene.insert("solver".into(), solver.into());

    let least = strings.iter().map(|string| string.length).fold(f64::INFINITY, f64::min);
    let fretboard = draw.chance(0.9).then(|| fretboard(draw, &strings, least, reach));
    let mut fingers = Vec::new();
    let mut plucks = Vec::new();
    for (index, string) in strings.iter().enumerate() {
        let frets = fretboard.as_ref().and_then(|board| board.get("frets")).and_then(Value::as_array);
        let places: Vec<f64> = frets.into_iter().flatten().filter_map(Value::as_float).collect();
        let number = index as i64 + 1;
        let count = if draw.chance(0.03) { draw.whole(5, 30) } else { draw.whole(0, 3) };
        for _ in 0..count {
            fingers.push(finger(draw, string, number, rate, duration, reach, &places));
        }
        for _ in 0..draw.whole(0, 2) {
            plucks.push(pluck(draw, string, number, rate, duration));
        }
    }
    let list = |tables: Vec<Table>| Value::Array(tables.into_iter().map(Value::Table).collect());
    let strings = strings.into_iter().map(|string| shaped(draw, string, reach, duration)).collect();
    scene.insert("string".into(), list(strings));
    if let Some(fretboard) = fretboard {
        scene.insert("fretboard".into(), fretboard.into());
    }
    if !plucks.is_empty() {
        scene.insert("pluck".into(), list(plucks));
    }
    if !fingers.is_empty() {
        scene.insert("finger".into(), list(fingers));
    }
    if draw.chance(0.3) {
        let mut output = Table::new();
        output.insert("position".into(), (least * draw.between(0.001, 0.999)).into());
        scene.insert("output".into(), output.into());
    }
    scene
}

/// A string of 2 cm to 20 m at 0.1 N to 10 kN. Its density and bending stiffness are chosen from the share
/// of the grid's stability they take up, so that grids from the coarsest on all occur.
fn string(draw: &mut Draw, rate: f64, stencil: Stencil) -> Drawn {
    loop {
        let length = draw.over(0.02, 20.0);
        let tension = draw.over(0.1, 1e4);
        let intervals = draw.over(4.1, 1500.0);
        let (h, k) = (length / intervals, 1.0 / rate);
        let bent = if draw.chance(0.2) { draw.between(1.0, 4.0) } else { 1.0 };
        // Shares of tension, stiffness and loss; mostly of tension, as strings are.
        let share = [
            draw.over(1e-4, 1.0),
            draw.over_or_nothing(0.3, 1e-8, 1.0),
            draw.over_or_nothing(0.5, 1e-6, 0.3),
        ];
        let sum: f64 = share.iter().sum();
        let [waves, bending, losing] = share.map(|share| share / sum.max(1.0));
        let density = tension * bent * k * k / (waves * h * h);
        let kappa_squared = bending * h * h * h * h / (4.0 * k * k);
        let core_radius = draw.over(1e-5, 1e-2);
        let moment = std::f64::consts::FRAC_PI_4 * libm::pow(core_radius, 4.0);
        let youngs_modulus = kappa_squared * density / moment;
        let loss_1 = losing * h * h / (4.0 * k);
        if !(1e-7..=1e2).contains(&density) || youngs_modulus > 1e13 || loss_1 > 1e2 {
            continue;
        }
        let loss_0 = draw.over_or_nothing(0.4, 1e-3, 1e4);
        let tension_modulation = draw.chance(0.6);
        let parameters = StringParameters {
            length,
            linear_density: density,
            tension,
            tension_limit: tension * bent,
            youngs_modulus,
            core_radius,
            loss_0,
            loss_1,
            tension_modulation,
        };
        // One that has no grid is drawn all the same: the scene is then refused, and counted.
        let grid = Model::grid(&parameters, stencil, k).ok();
        let (intervals, spacing) = grid.map_or((4, h), |grid| (grid.intervals, grid.spacing));
        let mut table = Table::new();
        table.insert("length".into(), length.into());
        table.insert("linear_density".into(), density.into());
        let tension = if bent > 1.0 {
            // Up to the limit and down again; the times follow when the scene's length is known.
            Value::Array(vec![
                tension.into(),
                (tension * bent).into(),
                (tension * draw.between(0.2, bent)).into(),
            ])
        } else {
            tension.into()
        };
        table.insert("tension".into(), tension);
        table.insert("youngs_modulus".into(), youngs_modulus.into());
        table.insert("core_radius".into(), core_radius.into());
        table.insert("loss_0".into(), loss_0.into());
        table.insert("loss_1".into(), loss_1.into());
        table.insert("tension_modulation".into(), tension_modulation.into());
        return Drawn {
            table,
            length,
            spacing,
            intervals,
            mobility: k * k / (density * spacing * (1.0 + loss_0 * k)),
        };
    }
}

/// The string's table with the course of its tension in time and, often, a shape it is released from, or a velocity.
fn shaped(draw: &mut Draw, string: Drawn, reach: f64, duration: f64) -> Table {
    let Drawn { mut table, length, .. } = string;
    if let Some(Value::Array(tensions)) = table.get("tension") {
        let middle = duration * draw.between(0.01, 0.9);
        let times = [0.0, middle, middle + duration * draw.over(1e-6, 1.0)];
        let course = times
            .iter()
            .zip(tensions)
            .map(|(&time, tension)| Value::Array(vec![time.into(), tension.clone()]));
        let course = course.collect();
        table.insert("tension".into(), Value::Array(course));
    }
    if draw.chance(0.6) {
        table.insert("shape".into(), beginnings::shape(draw, length, reach));
    }
    if draw.chance(0.3) {
        table.insert("velocity".into(), beginnings::velocity(draw, length));
    }
    table
}

/// A contact stiffness up to the bound of conditioning, often at it.
fn stiffness(draw: &mut Draw, exponent: f64, mobility: f64) -> f64 {
    // The bound as computed here and when the scene is built may differ in the last digits.
    let highest = 0.999 * stiffest(exponent, mobility).min(1e30);
    if draw.chance(0.2) { highest } else { (highest * draw.over(1e-16, 1.0)).max(1e-3) }
}

fn exponent(draw: &mut Draw) -> f64 {
    if draw.chance(0.7) { draw.one_of(&EXPONENTS) } else { draw.between(1.0, 5.0) }
}

/// Damping of a fretboard, s/m: absent, none, that of real ones, or anything up to the most there may be.
pub fn damping(draw: &mut Draw) -> Option<f64> {
    match draw.whole(0, 7) {
        0 | 1 => None,
        2 => Some(0.0),
        3 | 4 => Some(draw.over(0.01, 1.0)),
        5 | 6 => Some(draw.over(1e-6, 1e5)),
        _ => Some(1e5),
    }
}

/// Board and frets: none, a few, or hundreds; on the grid, between its points, closer than they are.
fn fretboard(draw: &mut Draw, strings: &[Drawn], length: f64, reach: f64) -> Table {
    let mut table = Table::new();
    let exponent = exponent(draw);
    let mobility = strings.iter().map(|string| string.mobility).fold(0.0, f64::max);
    let spacing = strings.iter().map(|string| string.spacing).fold(0.0, f64::max);
    let shared_out = draw.chance(0.3).then(|| draw.over(1e-4, 0.1));
    // Board points of a grid wider than the reference are the stiffer for it.
    let harder = shared_out.map_or(1.0, |reference| (spacing / reference).max(1.0));
    table.insert("stiffness".into(), (stiffness(draw, exponent, mobility) / harder).max(1e-3).into());
    table.insert("exponent".into(), exponent.into());
    if let Some(damping) = damping(draw) {
        table.insert("damping".into(), damping.into());
    }
    if let Some(reference) = shared_out {
        table.insert("board_reference_spacing".into(), reference.into());
    }
    let depth = draw.over_or_nothing(0.1, 0.01 * reach, reach);
    match draw.whole(0, 3) {
        0 => {}
        1 => {
            table.insert("board".into(), (-depth).into());
        }
        _ => {
            let ends = [draw.between(0.0, 0.5), draw.between(0.5, 1.0)].map(|part| part * length);
            let heights = [draw.between(0.0, 2.0), draw.between(0.0, 2.0)].map(|part| -part * depth);
            let profile = vec![point(ends[0], heights[0]), point(ends[1] + 1e-6, heights[1])];
            table.insert("board".into(), Value::Array(profile));
        }
    }
    let count = match draw.whole(0, 4) {
        0 => 0,
        1..=3 => draw.whole(1, 24),
        _ => draw.whole(25, 300),
    };
    if count > 0 {
        let middle = draw.between(0.01, 0.99) * length;
        let width = match draw.whole(0, 3) {
            0 => length,
            1 => 10.0 * spacing,
            2 => spacing,
            _ => draw.over(1e-9, 1.0) * spacing,
        };
        let on_grid = draw.chance(0.2);
        let places: Vec<Value> = (0..count)
            .map(|_| {
                let place =
                    (middle + width * draw.between(-0.5, 0.5)).clamp(1e-6 * length, (1.0 - 1e-6) * length);
                let node = (place / spacing).round() * spacing;
                if on_grid && node > 0.0 && node < length { node.into() } else { place.into() }
            })
            .collect();
        let top = depth * draw.between(0.0, 1.0);
        let tops = if draw.chance(0.5) {
            Value::Array((0..count).map(|_| (-top * draw.between(0.5, 1.0)).into()).collect())
        } else {
            (-top).into()
        };
        let frets = if draw.chance(0.15) { Value::Integer(count as i64) } else { Value::Array(places) };
        table.insert("frets".into(), frets);
        table.insert("fret_top".into(), tops);
        table.insert("fret_placement".into(), draw.one_of(&["exact", "kinked", "nearest"]).into());
    }
    table
}

/// Where on a string: anywhere, on a fret, close to an end.
fn place(draw: &mut Draw, string: &Drawn, frets: &[f64]) -> f64 {
    let anywhere = draw.between(0.001, 0.999) * string.length;
    let at = match draw.whole(0, 5) {
        0 | 1 if !frets.is_empty() => draw.one_of(frets),
        2 => draw.one_of(&[0.5, 0.25, 0.75]) * string.length,
        3 => draw.over(1e-9, 0.1) * string.length,
        _ => anywhere,
    };
    if at > 0.0 && at < string.length { at } else { anywhere }
}

/// A finger from a grain of sand to a sledgehammer.
fn finger(
    draw: &mut Draw,
    string: &Drawn,
    number: i64,
    rate: f64,
    duration: f64,
    reach: f64,
    frets: &[f64],
) -> Table {
    let k = 1.0 / rate;
    let mass = draw.over(1e-6, 10.0);
    let hand_damping = draw.over_or_nothing(0.5, 1e-3, 1e3);
    let exponent = exponent(draw);
    let mobility = string.mobility + k * k / (mass + 0.5 * hand_damping * k);
    let mut table = Table::new();
    table.insert("string".into(), number.into());
    table.insert("mass".into(), mass.into());
    table.insert("stiffness".into(), stiffness(draw, exponent, mobility).into());
    table.insert("exponent".into(), exponent.into());
    table.insert("damping".into(), draw.over_or_nothing(0.4, 1e-3, 1e4).into());
    table.insert("hand_damping".into(), hand_damping.into());
    table.insert("height".into(), (reach * draw.between(-0.3, 1.0)).into());
    table.insert("velocity".into(), draw.either_way(1e-3, 100.0).into());
    let force = draw.either_way(1e-3, 1e4);
    let force = if draw.chance(0.5) {
        let end = duration * draw.between(0.01, 1.0);
        Value::Array(vec![point(0.0, force * draw.between(-1.0, 1.0)), point(end, force)])
    } else {
        force.into()
    };
    table.insert("force".into(), force);
    let start = place(draw, string, frets);
    let position = if draw.chance(0.3) {
        let mut points = vec![point(0.0, start)];
        let (mut time, mut at) = (0.0, start);
        for _ in 0..draw.whole(1, 4) {
            let last = duration * draw.over(1e-4, 0.5);
            let speed = draw.either_way(1e-3, FASTEST_SLIDE);
            let end = (at + speed * last).clamp(1e-6 * string.length, (1.0 - 1e-6) * string.length);
            time += last;
            at = end;
            points.push(point(time, at));
        }
        Value::Array(points)
    } else {
        start.into()
    };
    table.insert("position".into(), position);
    table
}

fn pluck(draw: &mut Draw, string: &Drawn, number: i64, rate: f64, duration: f64) -> Table {
    let mut table = Table::new();
    table.insert("string".into(), number.into());
    table.insert("start".into(), (duration * draw.between(0.0, 0.5)).into());
    table.insert("duration".into(), draw.over(0.1 / rate, duration.max(1.0 / rate)).into());
    table.insert("position".into(), place(draw, string, &[]).into());
    // From what barely moves the string to what throws it across the room.
    let force = draw.either_way(1e-3, 1e4).clamp(-1e4, 1e4);
    table.insert("force".into(), force.into());
    table.insert("release".into(), draw.over_or_nothing(0.5, 0.1 / rate, duration.max(1.0 / rate)).into());
    table
}
