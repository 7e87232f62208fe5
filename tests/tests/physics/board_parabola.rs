//! Promise: a board of three heights is the parabola through them under each string, exact at every point of whatever grid.

use low_action_dsp::model::ContactKind;
use low_action_dsp::simulation::SceneString;
use low_action_dsp::{Scene, Simulation};

const HEIGHTS: [f64; 3] = [-1e-3, -1.5e-3, -1.8e-3];
const LENGTHS: [f64; 2] = [0.65, 0.58];

/// Two strings that are plucked down onto a board, the second shorter.
fn over(board: &str, rate: f64, stencil: &str) -> Simulation {
    let strings = LENGTHS.map(|length| {
        format!("[[string]]\nlength = {length:?}\nlinear_density = 5.25e-3\ntension = 60.0\nloss_0 = 1.0\n")
    });
    let plucks = [1, 2].map(|string| {
        format!("[[pluck]]\nstring = {string}\nduration = 1e-3\nposition = 0.4\nforce = -4.0\n")
    });
    let text = format!(
        "sample_rate = {rate:?}\nduration = 1.0\n[solver]\nstencil = \"{stencil}\"\n{}\
         [fretboard]\nstiffness = 1e10\nexponent = 2.0\nboard = {board}\n{}",
        strings.concat(),
        plucks.concat()
    );
    Simulation::new(&Scene::from_toml(&text).expect("the scene is valid")).expect("the scene can be built")
}

fn through([nut, middle, bridge]: [f64; 3]) -> String {
    format!("{{ nut = {nut:?}, middle = {middle:?}, bridge = {bridge:?} }}")
}

/// Places, m, and heights, m, of the board under a string; there is one under each of its points.
fn heights(string: &SceneString) -> Vec<[f64; 2]> {
    let contacts = &string.model.contacts;
    assert!(contacts.iter().all(|contact| matches!(contact.kind, ContactKind::Board { .. })));
    assert_eq!(contacts.len(), string.model.grid.intervals - 1);
    contacts.iter().map(|contact| [contact.place, contact.height]).collect()
}

/// What is heard of so many samples, which must be of strings that hit the board.
fn heard(mut simulation: Simulation) -> Vec<u64> {
    let mut hit = [false; LENGTHS.len()];
    let heard = (0..4000).map(|_| {
        simulation.step();
        for (hit, string) in hit.iter_mut().zip(simulation.strings()) {
            *hit |= string.board_force() > 0.0;
        }
        simulation.output().to_bits()
    });
    let heard = heard.collect();
    assert_eq!(hit, [true; LENGTHS.len()], "every string hits the board");
    heard
}

#[test]
fn it_is_the_parabola_through_its_heights() {
    for (rate, stencil) in [(16e3, "wide"), (44.1e3, "paper"), (192e3, "corrected")] {
        let simulation = over(&through(HEIGHTS), rate, stencil);
        for (string, length) in simulation.strings().iter().zip(LENGTHS) {
            for [place, height] in heights(string) {
                // By Lagrange: each height times the parabola that is 1 there and 0 at the other two.
                let part = place / length;
                let weights =
                    [(1.0 - part) * (1.0 - 2.0 * part), 4.0 * part * (1.0 - part), part * (2.0 * part - 1.0)];
                let expected: f64 = weights.iter().zip(HEIGHTS).map(|(weight, height)| weight * height).sum();
                // A few roundings of 2 mm.
                assert!(
                    (height - expected).abs() < 2e-18,
                    "{rate} Hz: {height:e} at {place} m, not {expected:e}"
                );
            }
        }
    }
}

#[test]
fn it_sounds_to_the_last_bit_like_its_heights_listed_point_by_point() {
    for rate in [22.05e3, 96e3] {
        let simulation = over(&through(HEIGHTS), rate, "paper");
        // A list stands under all strings alike, and the parabola under each its own: one at a time.
        for (index, string) in simulation.strings().iter().enumerate() {
            let listed = heights(string);
            let of_string = |board: &str| {
                let mut simulation = over(board, rate, "paper");
                let heard = (0..4000).map(|_| {
                    simulation.step();
                    let string = simulation.string(index);
                    (
                        string.state.displacement_at(&string.model.grid.reading(0.3)).to_bits(),
                        string.board_force().to_bits(),
                    )
                });
                heard.collect::<Vec<_>>()
            };
            let (three, all) = (of_string(&through(HEIGHTS)), of_string(&format!("{listed:?}")));
            assert!(three.iter().any(|(_, force)| *force != 0), "string {index} hits the board");
            assert!(three == all, "{rate} Hz, string {index}");
        }
    }
}

#[test]
fn three_equal_heights_are_one_and_three_on_a_line_the_line() {
    let bits = |board: &str| heard(over(board, 44.1e3, "paper"));
    assert!(bits(&through([-1.1e-3; 3])) == bits("-0.0011"));
    // (Numbers that halve without a rest; the list is of the longer string.)
    let line = [-0.0009765625, -0.00146484375, -0.001953125];
    let alone = |board: &str| heights(over(board, 44.1e3, "paper").string(0));
    assert_eq!(alone(&through(line)), alone("[[0.0, -0.0009765625], [0.65, -0.001953125]]"));
}

#[test]
fn it_may_touch_the_strings_at_rest_and_be_a_table_of_its_own() {
    // −(√−nut − √−bridge)²/4 of −1 and −4 mm, and 10 nm lower: it all but touches a third of the way.
    let simulation = over(&through([-1e-3, -2.5001e-4, -4e-3]), 44.1e3, "paper");
    let highest =
        heights(simulation.string(0)).into_iter().fold([0.0, -1.0], |a, b| if a[1] < b[1] { b } else { a });
    assert!((highest[0] / LENGTHS[0] - 1.0 / 3.0).abs() < 0.01 && highest[1].abs() < 1e-6, "{highest:?}");
    let inline = over(&through(HEIGHTS), 44.1e3, "paper");
    let text = format!(
        "sample_rate = 44100\nduration = 1\n[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60\n\
         [fretboard]\nstiffness = 1e10\nexponent = 2\n[fretboard.board]\nnut = {}\nmiddle = {}\nbridge = {}\n",
        HEIGHTS[0], HEIGHTS[1], HEIGHTS[2]
    );
    let apart = Simulation::new(&Scene::from_toml(&text).unwrap()).unwrap();
    assert_eq!(heights(apart.string(0)), heights(inline.string(0)));
}
