//! Promise: frets act where `fret_placement` says: each at its own place, or on the grid point nearest to it.

use low_action_dsp::{Scene, Simulation};

const LENGTH: f64 = 0.65;

/// A string over frets at these places, m from the nut.
fn over_frets(frets: &[f64], placement: &str) -> Simulation {
    let text = format!(
        "sample_rate = 48000.0\nduration = 1.0\n[[string]]\nlength = {LENGTH}\nlinear_density = 4e-4\ntension = 72.0\n\
         [fretboard]\nstiffness = 1e10\nexponent = 1.5\nfrets = {frets:?}\nfret_top = -1e-3\n\
         fret_placement = \"{placement}\"\n"
    );
    build(&text)
}

fn build(text: &str) -> Simulation {
    Simulation::new(&Scene::from_toml(text).expect("the scene is valid")).expect("the scene can be built")
}

/// Spacing of its grid, m.
fn spacing() -> f64 {
    over_frets(&[0.1], "exact").string(0).model.grid.spacing
}

/// Places of the contacts in spacings, and how many grid points each reads.
fn contacts(cells: &[f64], placement: &str) -> Vec<(f64, usize)> {
    let h = spacing();
    let simulation = over_frets(&cells.iter().map(|cell| cell * h).collect::<Vec<_>>(), placement);
    let model = &simulation.string(0).model;
    let points = |weights: [f64; 4]| weights.iter().filter(|weight| **weight != 0.0).count();
    model.contacts.iter().map(|contact| (contact.place / h, points(contact.reading.weights))).collect()
}

fn assert_at(cells: &[f64], placement: &str, expected: &[(f64, usize)]) {
    let found = contacts(cells, placement);
    assert_eq!(found.len(), expected.len(), "{placement}: {found:?}");
    for (found, expected) in found.iter().zip(expected) {
        // Places are quotients and products of lengths: a few roundings.
        assert!((found.0 - expected.0).abs() < 1e-12 * expected.0, "{placement}: {found:?}");
        assert_eq!(found.1, expected.1, "{placement}: grid points of {found:?}");
    }
}

#[test]
fn exact_frets_are_read_between_four_points_and_kinked_ones_between_two() {
    assert_at(&[12.3, 40.8], "exact", &[(12.3, 4), (40.8, 4)]);
    assert_at(&[12.3, 40.8], "kinked", &[(12.3, 2), (40.8, 2)]);
}

#[test]
fn nearest_frets_are_on_grid_points() {
    assert_at(&[12.3, 40.8], "nearest", &[(12.0, 1), (41.0, 1)]);
    // Never on an end of the string; two that come to one point are one.
    assert_at(&[0.2, 20.1, 20.4], "nearest", &[(1.0, 1), (20.0, 1)]);
}

/// Fret 12 stands half way between two grid points wherever the number of intervals is odd.
#[test]
fn frets_half_way_between_grid_points_are_moved_away_from_the_nut() {
    let mut odd = 0;
    for step in 0..200 {
        let tension = 40.0 + 0.25 * f64::from(step);
        let text = format!(
            "sample_rate = 48000.0\nduration = 1.0\n[[string]]\nlength = {LENGTH}\nlinear_density = 4e-4\n\
             tension = {tension:?}\n[fretboard]\nstiffness = 1e10\nexponent = 1.5\nfrets = 12\nfret_top = -1e-3\n\
             fret_placement = \"nearest\"\n"
        );
        let simulation = build(&text);
        let model = &simulation.string(0).model;
        let twelfth = model.contacts.last().expect("it has frets");
        let node = (twelfth.place / model.grid.spacing).round() as usize;
        assert_eq!(node, model.grid.intervals.div_ceil(2), "{tension} N, {} intervals", model.grid.intervals);
        odd += model.grid.intervals % 2;
    }
    assert!(odd > 0, "no number of intervals was odd");
}
