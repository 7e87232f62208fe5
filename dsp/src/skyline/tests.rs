//! What the skyline promises of the contacts under it.

use super::*;
use crate::contact::ContactLaw;
use crate::grid::Reading;
use crate::model::ContactKind;

/// Numbers from −1 to 1 that look random (the constants of Knuth's MMIX generator).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Contacts anywhere, on grid points and within the first and last spacing too, read by curves and by straight lines, in
/// order of place.
fn contacts(grid: &Grid, seed: &mut u64) -> Vec<Contact> {
    let mut contacts: Vec<_> = (0..30)
        .map(|index| {
            let place = 0.5 * (1.0 + random(seed));
            let node = ((place * grid.intervals as f64) as usize).clamp(1, grid.intervals - 1);
            let reading = match index % 3 {
                0 => Reading::at_node(grid, node),
                1 => grid.reading(place),
                _ => grid.straight_reading(place),
            };
            let law = ContactLaw::known(1e10, 1.5);
            let kind = ContactKind::Fret { index };
            Contact { place, reading, law, damping: 0.0, radiation: 0.0, height: 0.5 * random(seed), kind }
        })
        .collect();
    contacts.sort_by(|a, b| a.place.total_cmp(&b.place));
    contacts
}

/// A grid of few points or more, contacts over it and their heights.
fn neck(run: usize, seed: &mut u64) -> (Grid, Vec<Contact>, Vec<f64>, Beside) {
    let grid = Grid::new(1.0, 4 + run % 40, 1e-5);
    let contacts = contacts(&grid, seed);
    let heights = contacts.iter().map(|contact| contact.height).collect();
    let beside = Beside::new(&grid, &contacts);
    (grid, contacts, heights, beside)
}

/// From smooth to as rough as can be.
fn string(grid: &Grid, seed: &mut u64) -> Field {
    let roughness = 0.5 * (1.0 + random(seed));
    let mut u = Field::new(grid);
    for node in 1..grid.intervals {
        let smooth = (6.0 * grid.place(node)).sin();
        u[grid.cell(node)] = (1.0 - roughness) * smooth + roughness * random(seed);
    }
    u
}

/// Over whatever string contacts fell asleep, another one is over each of them by no less than its points beside it are over the
/// skyline, but for what it sags. And those that share a point share the skyline there.
#[test]
fn what_is_over_the_skyline_is_over_what_sleeps_under_it() {
    let mut seed = 1;
    let mut over = 0;
    for run in 0..3000 {
        let (grid, contacts, heights, beside) = neck(run, &mut seed);
        let fell_asleep = string(&grid, &mut seed);
        let asleep: Vec<_> = (0..contacts.len())
            .map(|index| {
                let sleeps = beside.may_sleep(index) && random(&mut seed) > 0.0;
                sleeps.then(|| beside.line(index, &fell_asleep).rise)
            })
            .collect();
        let mut skyline = Field::new(&grid);
        beside.draw_all(&heights, &asleep, &mut skyline);
        let mut u = string(&grid, &mut seed);
        // Somewhere between that string and this one.
        let part = 0.5 * (1.0 + random(&mut seed));
        u.iter_mut().zip(&*fell_asleep).for_each(|(u, other)| *u = part * *u + (1.0 - part) * other);
        let point = |node: usize| u[grid.cell(node)];
        let slope = |node: usize| point(node + 1) - point(node);
        let slopes: f64 = (0..grid.intervals).map(|node| slope(node).powi(2)).sum();
        let bends: f64 = (1..grid.intervals).map(|node| (slope(node) - slope(node - 1)).powi(2)).sum();
        // (As a motion from a straight line, too.)
        let points: f64 = (1..grid.intervals).map(|node| point(node).powi(2)).sum();
        let Sag { bend, slope, motion } = beside.sag;
        let sag = (bend * bends.sqrt()).min(slope * slopes.sqrt()).min(motion * points.sqrt());
        for (index, contact) in contacts.iter().enumerate().filter(|(index, _)| asleep[*index].is_some()) {
            let clear = beside.cells(index).map(|cell| u[cell] - skyline[cell]);
            let sags = if contact.reading.is_curved() { sag } else { 0.0 };
            let promised = clear[0].min(clear[1]) - sags;
            let found = contact.reading.of(&u) - contact.height;
            assert!(found >= promised - 1e-14, "run {run}: {found} and not {promised}: {contact:?}");
            over += usize::from(promised > 0.0);
        }
        for cell in 0..u.len() {
            assert!(skyline[cell] == f64::NEG_INFINITY || !beside.contacts(cell).is_empty(), "run {run}");
        }
    }
    // It is not a test of nothing.
    println!("{over} are over what sleeps");
    assert!(over > 1000);
}

/// Over the string over which a contact fell asleep, the skyline of it alone is as far below as the contact.
#[test]
fn a_string_at_a_slant_is_as_far_over_the_skyline_as_over_the_contact() {
    let mut seed = 2;
    for run in 0..300 {
        let (grid, contacts, heights, beside) = neck(run, &mut seed);
        let u = string(&grid, &mut seed);
        for index in (0..contacts.len()).filter(|&index| beside.may_sleep(index)) {
            let line = beside.line(index, &u);
            let mut asleep = vec![None; contacts.len()];
            asleep[index] = Some(line.rise);
            let mut skyline = Field::new(&grid);
            for cell in beside.cells(index) {
                beside.draw(cell, &heights, &asleep, &mut skyline);
                let off = (u[cell] - skyline[cell]) - (line.displacement - heights[index]);
                assert!(off.abs() < 1e-14, "run {run}, {index}: {off:e}");
            }
        }
    }
}

/// No part of the sag is more than there may be: a string that is bent, runs or has moved just so sags as much.
#[test]
fn some_string_sags_as_much_as_it_is_taken_to() {
    const NODES: usize = 40;
    const FIRST: usize = 17;
    let grid = Grid::new(1.0, NODES, 1e-5);
    // A string fixed at its ends with a second difference of 1 at one point.
    let bent_at = |kink: usize, node: usize| {
        let (near, far) = (node.min(kink) as f64, node.max(kink) as f64);
        -near * (NODES as f64 - far) / NODES as f64
    };
    let points = |heights: [f64; 4]| {
        let mut u = vec![0.0; NODES + 1];
        u[FIRST - 1..][..4].copy_from_slice(&heights);
        u
    };
    for part in [0.1, 0.37, 0.5, 0.8] {
        let Sag { bend, slope, motion } = Sag::at(part);
        let (a, b) = (2.0 - part, 1.0 + part);
        let bent = (0..=NODES).map(|node| a * bent_at(FIRST, node) + b * bent_at(FIRST + 1, node));
        let moved = [a, b - 2.0 * a, a - 2.0 * b, b];
        let size = |numbers: &[f64]| numbers.iter().map(|number| number * number).sum::<f64>().sqrt();
        for (name, shape, most) in [
            ("bend", bent.collect(), bend * size(&[a, b])),
            ("slope", points([0.0, -a, -b, 0.0]), slope * size(&[a, a - b, b])),
            ("motion", points(moved), motion * size(&moved)),
        ] {
            let mut u = Field::new(&grid);
            (1..NODES).for_each(|node| u[grid.cell(node)] = shape[node]);
            let straight = shape[FIRST] + part * (shape[FIRST + 1] - shape[FIRST]);
            let sags = straight - grid.reading((FIRST as f64 + part) * grid.spacing).of(&u);
            assert!((sags / most - 1.0).abs() < 1e-12, "{name} at {part}: {sags} m and not {most}");
        }
    }
}
