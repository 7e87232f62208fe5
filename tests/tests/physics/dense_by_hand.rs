//! The plain string that the fast one is compared with gives the numbers worked by hand on three points.

use low_action_tests::dense::{
    Finger, Fret, Fretboard, Law, Placement, Pluck, Reference, Setup, Stencil, straight_weights, weights,
};
use low_action_tests::numbers::largest;
use std::f64::consts::{LN_2, PI};

/// Asserts that every entry is within 1e-13 of the hand-worked one, relative to the largest.
#[track_caller]
fn assert_near(got: &[f64], expected: &[f64]) {
    assert_eq!(got.len(), expected.len());
    let scale = largest(expected.iter().map(|value| value.abs()));
    for (a, b) in got.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-13 * scale, "{got:?} is not {expected:?}");
    }
}

/// Four intervals of 1 m, steps of 1 s, every coefficient a simple fraction:
/// ρ = 1, T = 1/2, so λ² = 1/2; EI = 1/16 and EA = 1/4 with r = 1, so E = 1/(4π); σ₀ = 1/4, σ₁ = 1/128.
/// Stable on 4 intervals (1/2 + 1/4 + 1/32 < 1), not on 5 (0.78 + 0.61 > 1).
fn three_points() -> Setup {
    Setup {
        sample_rate: 1.0,
        stencil: Stencil::Paper,
        length: 4.0,
        linear_density: 1.0,
        tension: vec![[0.0, 0.5]],
        youngs_modulus: 1.0 / (4.0 * PI),
        core_radius: 1.0,
        loss_0: 0.25,
        loss_1: 1.0 / 128.0,
        tension_modulation: true,
        stilling: vec![],
        velocity: vec![],
        shape: vec![[1.0, 0.0], [2.0, 8.0], [3.0, 0.0]],
        fretboard: None,
        // Ends at t = 0: from −1/2 to 1/2 it pushes by 6 N in the mean, for ∫ (1 − cos πτ)/2 dτ from 1/2 to 1 is 1/4 + 1/(2π).
        plucks: vec![Pluck {
            start: -1.0,
            duration: 1.0,
            release: 0.0,
            position: 1.0,
            force: 6.0 / (0.25 + 0.5 / PI),
        }],
        fingers: vec![],
    }
}

// With u⁰ = u⁻¹ = (0, 8, 0):
//   D_xx u = (8, −16, 8),  D_xx² u = 8 (−4, 6, −4) = (−32, 48, −32),  D_xx³ u = 8 (14, −20, 14)
//   a = (1/2) √(EAh/ρL) D_xx u = (1/2)(1/4) D_xx u = (1, −2, 1),  aᵀa = 6,  aᵀu⁻¹ = −16
//   s = 1 + σ₀k = 5/4,  A⁻¹ w = (4/5)(w − a aᵀw/(5/4 + 6))
//
//   2u                  ( 0,  16,  0)
//   (1/2) D_xx u        ( 4,  −8,  4)
//   −(1/16) D_xx² u     ( 2,  −3,  2)
//   (1/64) D_xx(u−u⁻)   ( 0,   0,  0)
//   −(3/4) u⁻           ( 0,  −6,  0)
//   −a aᵀu⁻             (16, −32, 16)
//   pluck               ( 6,   0,  0)
//   w                   (28, −33, 22),  aᵀw = 28 + 66 + 22 = 116,  116/(29/4) = 16
//   u¹ = (4/5)(w − 16a) = (4/5)(12, −1, 6) = (9.6, −0.8, 4.8)
const FREE: [f64; 3] = [9.6, -0.8, 4.8];

#[test]
fn two_steps_by_hand() {
    let mut string = Reference::new(&three_points());
    assert_eq!(string.now.as_slice(), [0.0, 8.0, 0.0]);
    string.step();
    assert_near(string.now.as_slice(), &FREE);

    // The pluck is over; now u = (9.6, −0.8, 4.8), u⁻ = (0, 8, 0):
    //   D_xx u = (−20, 16, −10.4),  D_xx² u = (56, −62.4, 36.8),  D_xx u⁻ = (8, −16, 8)
    //   a = (−2.5, 2, −1.3),  aᵀa = 6.25 + 4 + 1.69 = 11.94,  aᵀu⁻ = 16
    //   2u                  ( 19.2,    −1.6,   9.6   )
    //   (1/2) D_xx u        (−10,       8,    −5.2   )
    //   −(1/16) D_xx² u     ( −3.5,     3.9,  −2.3   )
    //   (1/64) D_xx(u−u⁻)   ( −0.4375,  0.5,  −0.2875)
    //   −(3/4) u⁻           (  0,      −6,     0     )
    //   −a aᵀu⁻             ( 40,     −32,    20.8   )
    //   w                   ( 45.2625, −27.2, 22.6125)
    //   aᵀw = −113.15625 − 54.4 − 29.39625 = −196.9525,  u² = (4/5)(w + a 196.9525/13.19)
    string.step();
    let along_a = 196.9525 / 13.19;
    let expected = [45.2625 - 2.5 * along_a, -27.2 + 2.0 * along_a, 22.6125 - 1.3 * along_a].map(|w| 0.8 * w);
    assert_near(string.now.as_slice(), &expected);
}

/// What pushes half as hard but takes as long to let go as it took to grow pushes as much in that step: as much after t = 0 as
/// before it.
#[test]
fn a_pluck_that_takes_a_while_to_let_go_by_hand() {
    let mut setup = three_points();
    (setup.plucks[0].force, setup.plucks[0].release) = (0.5 * setup.plucks[0].force, 1.0);
    let mut string = Reference::new(&setup);
    string.step();
    assert_near(string.now.as_slice(), &FREE);
}

/// A hand laid along the string takes as the string itself does, while it is there.
#[test]
fn a_stilling_hand_by_hand() {
    let setup = Setup { loss_0: 0.125, stilling: vec![[0.0, 0.125], [1.0, 0.625]], ..three_points() };
    let mut string = Reference::new(&setup);
    string.step();
    assert_near(string.now.as_slice(), &FREE);
    assert_near(&[string.stilling()], &[0.625]);
}

/// Velocities are those of a moment, the mean of the motions before it and after it, and of a spacing about each point.
#[test]
fn a_thrown_string_by_hand() {
    // Without σ₁, which damps what moves before. A triangle over point 2: from 3/2 to 5/2 it is 3 in the mean, from 1/2 to 3/2 it
    // is 0 in the first half and 1 in the second.
    let setup = Setup {
        loss_1: 0.0,
        shape: vec![],
        plucks: vec![],
        velocity: vec![[1.0, 0.0], [2.0, 4.0], [3.0, 0.0]],
        ..three_points()
    };
    let mut string = Reference::new(&setup);
    assert_near(string.change.as_slice(), &[0.5, 3.0, 0.5]);
    string.let_go();
    let before = string.change.clone();
    string.step();
    assert_near((before + &string.change).as_slice(), &[1.0, 6.0, 1.0]);
}

#[test]
fn better_stencils_by_hand() {
    // κ₂² = 1/16 + (1/2)(1/12)(1 − 1/2) = 1/12
    // κ₆ = (1/2)((1/2)(7/2)/360 + (1/16)/6) = (1/2)(14/2880 + 30/2880) = 11/1440
    // Without pluck and tension modulation, with the lines of the table above:
    //   u₁ = (4/5)(4 + 32/12 + κ₆ 112)   u₂ = (4/5)(16 − 8 − 48/12 − 6 − κ₆ 160)
    for (stencil, kappa6) in [(Stencil::Corrected, 0.0), (Stencil::Wide, 11.0 / 1440.0)] {
        let setup = Setup { stencil, tension_modulation: false, plucks: vec![], ..three_points() };
        assert_near(&[setup.stencil_stiffness(1.0, 0.5).0], &[1.0 / 12.0]);
        assert_near(&[setup.stencil_stiffness(1.0, 0.5).1], &[kappa6]);
        let mut string = Reference::new(&setup);
        string.step();
        let side = 0.8 * (4.0 + 32.0 / 12.0 + kappa6 * 112.0);
        assert_near(string.now.as_slice(), &[side, 0.8 * (-2.0 - kappa6 * 160.0), side]);
    }
}

#[test]
fn board_and_finger_by_hand() {
    // The first step of `two_steps_by_hand` with the board at 0 under point 2 (far below elsewhere) and a
    // finger over point 1. Left alone the string would reach (9.6, −0.8, 4.8).
    //   Finger: M = 1/ln 2, R = 1, so that half of its motion is left after a step and M̃ = (R/2)/tanh(R/(2M)) = 3/2;
    //   f₀ = 2, u_f⁰ = −1, v = 5, so u_f⁻¹ = −6:
    //   free u_f¹ = (2M̃ u_f⁰ − (M̃ − R/2) u_f⁻¹ − f₀)/(M̃ + R/2) = (−3 + 6 − 2)/2 = 1/2
    //   A⁻¹e₁ = (4/5)(25, 8, −4)/29,  A⁻¹e₂ = (4/5)(8, 13, 8)/29
    // Let the forces be f_b = 29/8 (board) and f_f = 29/4 (finger); then
    //   u¹ = (9.6, −0.8, 4.8) + (4/5)(−(1/4)(25, 8, −4) + (1/8)(8, 13, 8)) = (5.4, −1.1, 6.4)
    //   u_f¹ = 1/2 + f_f/2 = 4.125
    //   board: η⁻¹ = 0 − 8 = −8, η¹ = 1.1, r = 9.1, Φ(η¹) = K_b 1.1³/3 (α = 2), λ = K_b 1.331/27.3
    //   finger: η⁻¹ = 0 + 6 = 6, η⁰ = 0 + 1 = 1, η¹ = 5.4 − 4.125 = 1.275, r = −4.725
    //           λ = K_f(6 − 4.725/2) = 3.6375 K_f (α = 1), P = β K_f/2 = K_f/4 (β = 1/2), P r = −1.18125 K_f
    // and these forces are the answer if K_b = f_b 27.3/1.331 and K_f = f_f/2.45625.
    let setup = Setup {
        fretboard: Some(Fretboard {
            stiffness: 29.0 / 8.0 * 27.3 / 1.331,
            exponent: 2.0,
            damping: 0.0,
            board: Some(vec![[1.0, -1e3], [2.0, 0.0], [3.0, -1e3]]),
            board_reference_spacing: None,
            frets: vec![],
            placement: Placement::Exact,
        }),
        fingers: vec![Finger {
            mass: 1.0 / LN_2,
            stiffness: 29.0 / 4.0 / 2.45625,
            exponent: 1.0,
            damping: 0.5,
            hand_damping: 1.0,
            position: vec![[0.0, 1.0]],
            height: -1.0,
            velocity: 5.0,
            force: vec![[0.0, 2.0]],
        }],
        ..three_points()
    };
    let mut string = Reference::new(&setup);
    string.step();
    assert_near(string.forces.as_slice(), &[0.0, 29.0 / 8.0, 0.0, 29.0 / 4.0]);
    assert_near(string.now.as_slice(), &[5.4, -1.1, 6.4]);
    assert_near(string.finger_now.as_slice(), &[4.125]);
}

#[test]
fn a_lossy_board_by_hand() {
    // A straight string at rest, no string forces at all: A = 5/4, q = 0. Under point 2 the board is at 1, as deep in
    // the string at −1 as at 0: η⁻¹ = η⁰ = 1. With f the force, u¹ = (4/5) f at point 2, r = −(4/5) f,
    // λ = K(1 − (2/5) f) (α = 1, still in contact if f < 5/4), P = β K/2 = K/4 (β = 1/2), P r = −(1/5) K f;
    // f = 1 if K (1 − 3/5) = 1.
    let setup = Setup {
        shape: vec![],
        plucks: vec![],
        fretboard: Some(Fretboard {
            stiffness: 2.5,
            exponent: 1.0,
            damping: 0.5,
            board: Some(vec![[1.0, -1e3], [2.0, 1.0], [3.0, -1e3]]),
            board_reference_spacing: None,
            frets: vec![],
            placement: Placement::Exact,
        }),
        ..three_points()
    };
    let mut string = Reference::new(&setup);
    string.step();
    assert_near(string.forces.as_slice(), &[0.0, 1.0, 0.0]);
    assert_near(string.now.as_slice(), &[0.0, 0.8, 0.0]);
}

#[test]
fn a_kinked_fret_by_hand() {
    // No bending, σ₁ = 0, T = 1: half way between points 1 and 2 the string gives way by Γ = (3/2)(5/2)/4 = 15/16, and read and
    // pushed by w = (1/2, 1/2, 0) on the grid by (3/4 + 2/2 + 1)/4 = 11/16: by p(1 − p)h/T = 1/4 less.
    // K = 2, α = 2: the knee is where 4η = 4, φ = 2 and Φ = 2/3 there, and from there on φ′ = 4. √(Tρ) = 1.
    // The string is at 0 and fell by 2 there: η⁻¹ = 3/2 − 2 = −1/2 and η⁰ = 3/2, contact has been made just now and
    // P = 2β/2 + 1 (5/5), with φ no more than at the knee.
    // Left alone d¹ = (3/5)(−2, −2, 0). With f = 4, d¹ = (4/5)(4/2 − 3/2) = 2/5 at points 1 and 2, η¹ = 3/2 − 2/5 = 11/10,
    // r = 8/5, λ = (2/3 + 2/10 + 2/100)/r = 2.66/4.8; that is the answer if P = (4 − λ)/r.
    let beta = (4.0 - 2.66 / 4.8) / 1.6 - 1.0;
    let setup = Setup {
        tension: vec![[0.0, 1.0]],
        youngs_modulus: 0.0,
        loss_1: 0.0,
        shape: vec![],
        plucks: vec![],
        fretboard: Some(Fretboard {
            stiffness: 2.0,
            exponent: 2.0,
            damping: beta,
            board: None,
            board_reference_spacing: None,
            frets: vec![Fret { position: 1.5, top: 1.5 }, Fret { position: 3.05, top: -1e3 }],
            placement: Placement::Kinked,
        }),
        ..three_points()
    };
    let mut string = Reference::new(&setup);
    assert_near(&[string.barriers[0].law.knee, string.barriers[0].resistance], &[1.0, 2.0]);
    // The other one stands so near to a point that nothing is made up for.
    assert_eq!(string.barriers[1].law.knee, f64::INFINITY);
    string.change.copy_from_slice(&[-2.0, -2.0, 0.0]);
    string.step();
    assert_near(&string.forces.as_slice()[..1], &[4.0]);
    assert_near(string.now.as_slice(), &[0.4, 0.4, 0.0]);

    // In the next step four fifths of the resistance are left: η⁻¹ = 3/2, η⁰ = 11/10, and the string comes up to where η¹ is
    // before the knee, λ = (2η³/3 − 2/3 − 1 − 1/2)/r.
    string.step();
    let after = 1.5 - 0.5 * (string.now[0] + string.now[1]);
    let r = after - 1.5;
    let force = (2.0 / 3.0 * after.powi(3) - 13.0 / 6.0) / r + (beta + 0.8) * r;
    assert!(after < 1.0 && force > 1.0, "{after} {force}");
    assert_near(&string.forces.as_slice()[..1], &[force]);
}

#[test]
fn a_finger_on_the_move_by_hand() {
    // A straight string at rest, no string forces at all: A = 5/4, q = 0. The finger, β = 0, M = 1, R = 0,
    // rests at −1 and moves from point 1 at t = 0 to point 3 at t = 2: at t = 1, where it acts, it is at
    // point 2. η⁻¹ = 0 + 1 = 1. With f the force, u¹ = −(4/5) f at point 2 and u_f¹ = −1 + f:
    // η¹ = 1 − (9/5) f, r = −(9/5) f, λ = K(1 − (9/10) f) (α = 1, still in contact if f < 5/9);
    // f = 1/2 if K = (1/2)/(11/20) = 10/11.
    let setup = Setup {
        shape: vec![],
        plucks: vec![],
        fingers: vec![Finger {
            mass: 1.0,
            stiffness: 10.0 / 11.0,
            exponent: 1.0,
            damping: 0.0,
            hand_damping: 0.0,
            position: vec![[0.0, 1.0], [2.0, 3.0]],
            height: -1.0,
            velocity: 0.0,
            force: vec![],
        }],
        ..three_points()
    };
    let mut string = Reference::new(&setup);
    string.step();
    assert_near(string.now.as_slice(), &[0.0, -0.4, 0.0]);
    assert_near(string.finger_now.as_slice(), &[-0.5]);
}

#[test]
fn interpolation_by_hand() {
    // Halfway between points 2 and 3 of five: (−1, 9, 9, −1)/16 on points 1 to 4.
    assert_near(weights(2.5, 1.0, 6).as_slice(), &[-1.0, 9.0, 9.0, -1.0, 0.0].map(|w| w / 16.0));
    // Halfway from nut to point 1: nodes −1, 0, 1, 2, and node −1 reads −u₁.
    assert_near(weights(0.5, 1.0, 6).as_slice(), &[10.0, -1.0, 0.0, 0.0, 0.0].map(|w| w / 16.0));
    assert_near(weights(5.5, 1.0, 6).as_slice(), &[0.0, 0.0, 0.0, -1.0, 10.0].map(|w| w / 16.0));
    assert_near(weights(0.75, 0.25, 6).as_slice(), &[0.0, 0.0, 1.0, 0.0, 0.0]);
    // By a straight line, and where one of its ends is that of the string.
    assert_near(straight_weights(2.25, 1.0, 6).as_slice(), &[0.0, 0.75, 0.25, 0.0, 0.0]);
    assert_near(straight_weights(5.25, 1.0, 6).as_slice(), &[0.0, 0.0, 0.0, 0.0, 0.75]);
}

#[test]
fn contact_law_by_hand() {
    let law = Law::new(3.0, 2.0);
    // Φ(η) = η³ for η > 0: (27 − 8)/1, (0 − 8)/(−4), (8 − 0)/3, and Φ′(2) = 12 as r → 0.
    assert_near(&[law.quotient(2.0, 1.0)], &[19.0]);
    assert_near(&[law.quotient(2.0, -4.0)], &[2.0]);
    assert_near(&[law.quotient(-1.0, 3.0)], &[8.0 / 3.0]);
    assert_near(&[law.quotient(2.0, 1e-14), law.quotient(2.0, 0.0)], &[12.0, 12.0]);
    // With a spring of 1/12 m/N behind it the force goes on from η = 2 by 12 N/m, where it is 12 N and Φ = 8: Φ(3) = 8 + 12 + 6,
    // Φ(4) = 8 + 24 + 24. (56 − 1)/3 across, 12 + 12 (3/2) beyond, (0 − 26)/(−4) out of it, and nothing else before.
    let bent = law.giving_way(1.0 / 12.0);
    assert_near(&[bent.knee], &[2.0]);
    assert_near(&[bent.quotient(1.0, 3.0), bent.quotient(4.0, -3.0)], &[55.0 / 3.0; 2]);
    assert_near(&[bent.quotient(3.0, 1.0), bent.quotient(3.0, 0.0)], &[30.0, 24.0]);
    assert_near(&[bent.quotient(3.0, -4.0)], &[6.5]);
    assert_near(&[bent.quotient(2.0, 1e-14), bent.quotient(2.0, -1e-14)], &[12.0, 12.0]);
    assert_near(&[bent.quotient(1.0, 0.5)], &[19.0 / 4.0]);
}
