//! What the answer of the contacts must be, whatever they are.

use super::*;
use crate::field::Field;
use crate::grid::{Grid, Reading};

struct Point(Reading);

/// One that the tension pulls, of a pad that moves by itself, or of a fret that does not.
struct Pulled {
    reading: Reading,
    pull: f64,
    own: f64,
}

impl Coupled for Pulled {
    fn span(&self) -> (usize, usize) {
        self.reading.span()
    }
    fn coupling(&self, other: &Self) -> f64 {
        self.reading.overlap(&other.reading)
    }
    fn own_mobility(&self) -> f64 {
        self.own
    }
    fn pull(&self) -> f64 {
        self.pull
    }
}

impl Coupled for Point {
    fn span(&self) -> (usize, usize) {
        self.0.span()
    }
    fn coupling(&self, other: &Self) -> f64 {
        self.0.overlap(&other.0)
    }
    fn own_mobility(&self) -> f64 {
        0.0
    }
    fn pull(&self) -> f64 {
        1.0
    }
}

/// Numbers from 0 to 1 that look random (the constants of Knuth's MMIX generator).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// Points of a board that ends somewhere, of frets (every other one kinked, and some in the last spacing) and of fingers, all in
/// order.
fn points(grid: &Grid, fingers: usize, state: &mut u64) -> (Vec<Reading>, Vec<Reading>) {
    let board = (random(state) * grid.intervals as f64) as usize;
    let crowd = random(state);
    let places = (0..(random(state) * 20.0) as usize).map(|_| 0.01 + 0.98 * random(state) * crowd);
    let mut fixed: Vec<_> = places.map(|place| grid.reading(place)).collect();
    fixed.extend(
        (0..(random(state) * 4.0) as usize)
            .map(|_| grid.straight_reading(1.0 - random(state) * grid.spacing)),
    );
    fixed.extend((1..=board.min(grid.intervals - 1)).map(|node| Reading::at_node(grid, node)));
    let mut all = fixed.clone();
    all.extend((0..fingers).map(|_| grid.reading(0.01 + 0.98 * random(state) * crowd)));
    for readings in [&mut fixed, &mut all] {
        readings.sort_by(Reading::order);
    }
    (fixed, all)
}

/// x/D + M x = g for any few contacts, two of which share a point; and, where each has its own, for secants that have
/// been doubled some fifty times.
#[test]
fn springs_answer_what_they_are_asked() {
    fn check<const N: usize>(slope: f64, apart: bool, state: &mut u64) {
        let grid = Grid::new(1.0, 40, 1e-5);
        let mut points = [0.0; N];
        for (i, point) in points.iter_mut().enumerate() {
            *point = 0.1 + if apart { 0.08 * i as f64 } else { 0.1 * random(state) };
        }
        if !apart {
            points[N - 1] = points[0];
        }
        let points = points.map(|place| Point(grid.reading(place)));
        let mut few = Few::gather(&points, 0.0);
        let slopes = [(); N].map(|()| slope * random(state));
        let asked = [(); N].map(|()| random(state) - 0.5);
        let (mut forces, mut moved) = (asked, [0.0; N]);
        few.springs(&slopes, &mut forces);
        few.product(&forces, &mut moved);
        let largest = forces.iter().fold(1.0f64, |most, force| most.max(force.abs()));
        for i in 0..N {
            let off = forces[i] / slopes[i] + moved[i] - asked[i];
            // NaN is refused too.
            assert!(off.abs() < 1e-13 * largest, "{N} springs of {slope:e}: {off:e} of {largest}");
        }
    }
    let mut state = 1;
    for _ in 0..100 {
        for (slope, apart) in [(1e-3, false), (1.0, false), (1e4, false), (1e8, false), (1e24, true)] {
            check::<1>(slope, apart, &mut state);
            check::<2>(slope, apart, &mut state);
            check::<3>(slope, apart, &mut state);
            check::<4>(slope, apart, &mut state);
            check::<5>(slope, apart, &mut state);
            check::<6>(slope, apart, &mut state);
            check::<7>(slope, apart, &mut state);
            check::<8>(slope, apart, &mut state);
            check::<9>(slope, apart, &mut state);
            check::<10>(slope, apart, &mut state);
        }
    }
}

/// G |v|², how much stiffer its stretching makes a string along its curvature.
const STRETCH: f64 = 9.0;

/// x/D + M x = g where the tension pulls all contacts together, for a few and for many, in one block and in several. M = S +
/// own − ω z zᵀ stands here in full, each of its numbers by itself. As of strings, z reads one field v, and ω |v|² = 9/10: of
/// the mobility along v the pull leaves a tenth.
#[test]
fn springs_answer_what_they_are_asked_where_the_tension_pulls() {
    fn check<const N: usize>(slope: f64, places: [f64; N], blocks: usize, state: &mut u64) {
        let grid = Grid::new(1.0, 40, 1e-5);
        let mut curvature = Field::new(&grid);
        for node in 1..grid.intervals {
            curvature[grid.cell(node)] = random(state) - 0.5;
        }
        let norm: f64 = curvature.iter().map(|v| v * v).sum();
        let factor = STRETCH / norm / (1.0 + STRETCH);
        let readings = places.map(|place| grid.reading(place));
        let contacts: [Pulled; N] = std::array::from_fn(|i| {
            let own = if i % 3 == 1 { random(state) } else { 0.0 };
            Pulled { reading: readings[i], pull: readings[i].of(&curvature), own }
        });
        let matrix: [[f64; N]; N] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let own = if i == j { contacts[i].own } else { 0.0 };
                contacts[i].coupling(&contacts[j]) + own - factor * contacts[i].pull * contacts[j].pull
            })
        });
        let slopes = [(); N].map(|()| slope * (0.1 + 0.9 * random(state)));
        let asked = [(); N].map(|()| random(state) - 0.5);
        let mut response = Response::with_capacity(&readings.map(|reading| reading.span()), 0);
        response.gather(&contacts, factor);
        assert_eq!(response.blocks.len(), blocks, "{N} contacts");
        let mut few = Few::gather(&contacts, factor);
        for (name, answer) in [("many", &mut response as &mut dyn Answer), ("few", &mut few)] {
            let (mut forces, mut moved) = (asked, [0.0; N]);
            answer.springs(&slopes, &mut forces);
            answer.product(&forces, &mut moved);
            // Elimination rounds as if its numbers were each off by the number of contacts times 2⁻⁵², 1e-14 of 40, and
            // the pull makes ten times that of it.
            let sizes = forces.iter().zip(slopes).map(|(force, slope)| force.abs() * (1.0 / slope + 3.0));
            let bound = 1e-13 * sizes.fold(0.1, |sum, size| sum + size);
            for i in 0..N {
                let answered = dot(&matrix[i], &forces);
                let off = forces[i] / slopes[i] + answered - asked[i];
                // NaN is refused too.
                assert!(off.abs() < bound, "{N} springs of {slope:e}, {name}: {off:e}, not {bound:e}");
                let off = moved[i] - answered;
                assert!(off.abs() < bound, "product of {N}, {name}: {off:e}, not {bound:e}");
            }
        }
    }
    /// All within two spacings, and in so many groups as wide that share no points.
    fn check_both<const N: usize>(blocks: usize, slope: f64, state: &mut u64) {
        let mut place = |i: usize, blocks: usize| 0.1 + 0.3 * (i * blocks / N) as f64 + 0.05 * random(state);
        let [together, apart] = [1, blocks].map(|blocks| {
            let mut places: [f64; N] = std::array::from_fn(|i| place(i, blocks));
            places.sort_by(f64::total_cmp);
            places
        });
        check(slope, together, 1, state);
        check(slope, apart, blocks, state);
    }
    let mut state = 1;
    for _ in 0..100 {
        for slope in [1e-3, 1.0, 1e4] {
            check_both::<1>(1, slope, &mut state);
            check_both::<6>(3, slope, &mut state);
            check_both::<7>(3, slope, &mut state);
            check_both::<40>(3, slope, &mut state);
        }
    }
}

/// Code of a fixed size finds the same bits as code for any, and several sides at once the same as each by itself.
#[test]
fn sizes_and_sides_do_not_change_a_bit() {
    fn check<const N: usize>(state: &mut u64) {
        let grid = Grid::new(1.0, 40, 1e-5);
        let points: [_; N] = std::array::from_fn(|_| Point(grid.reading(0.3 + 0.1 * random(state))));
        let entries = points.each_ref().map(|one| points.each_ref().map(|other| one.coupling(other)));
        let entries = entries.as_flattened();
        let slopes = [(); N].map(|()| 1e3 * random(state));
        let asked: [[f64; N]; 2] = [(); 2].map(|()| [(); N].map(|()| random(state) - 0.5));
        let [mut one, mut other] = asked;
        springs_of_several::<N, 2>(entries, &slopes, [&mut one, &mut other]);
        let (mut room, mut roots) = (Vec::new(), Vec::new());
        for (found, mut alone) in [one, other].into_iter().zip(asked) {
            springs_of_any(&mut room, &mut roots, entries, &slopes, [&mut alone]);
            assert_eq!(found.map(f64::to_bits), alone.map(f64::to_bits), "{N} springs");
        }
    }
    let mut state = 1;
    for _ in 0..100 {
        check::<7>(&mut state);
        check::<8>(&mut state);
        check::<9>(&mut state);
        check::<10>(&mut state);
    }
}

#[test]
fn room_is_enough_and_blocks_share_nothing() {
    let mut state = 1;
    for run in 0..3000 {
        let grid = Grid::new(1.0, 4 + run % 60, 1e-5);
        let fingers = run % 5;
        let (fixed, all) = points(&grid, fingers, &mut state);
        let spans: Vec<_> = fixed.iter().map(Reading::span).collect();
        let mut response = Response::with_capacity(&spans, fingers);
        let room = (response.entries.capacity(), response.matrix.capacity());
        let kept: Vec<_> =
            all.iter().filter(|_| random(&mut state) < 0.9).map(|&reading| Point(reading)).collect();
        response.gather(&kept, 1.0);
        assert_eq!(response.entries.capacity(), room.0);
        let block_of = |row: usize| response.blocks.iter().find(|block| row < block.start + block.len);
        for (i, point) in kept.iter().enumerate() {
            let block = block_of(i).expect("every contact is in a block");
            assert!(block.len * block.len <= room.1);
            for (j, other) in kept.iter().enumerate() {
                let apart = j < block.start || j >= block.start + block.len;
                assert!(!apart || point.coupling(other) == 0.0, "{i} and {j} of run {run}");
            }
        }
    }
}

/// Springs so steep that doubles do not tell 1 + D M from D M, where M is singular: what is found is poor, but no memory is
/// lost.
#[test]
fn room_is_kept_whatever_the_slopes() {
    let grid = Grid::new(1.0, 10, 1e-5);
    let readings: Vec<_> = (0..12).map(|i| grid.reading(0.51 + 0.005 * f64::from(i))).collect();
    let spans: Vec<_> = readings.iter().map(Reading::span).collect();
    let points: Vec<_> = readings.into_iter().map(Point).collect();
    let mut response = Response::with_capacity(&spans, 0);
    let room = response.matrix.capacity();
    response.gather(&points, 0.0);
    for slope in [1.0, 1e8, 1e15, 1e17, 1e30, 1e300] {
        let mut forces = [1.0; 12];
        response.springs(&[slope; 12], &mut forces);
        assert_eq!(response.matrix.capacity(), room, "slopes of {slope:e}");
    }
}
