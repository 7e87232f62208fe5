//! What is played: strings of the built-in instruments, open, stopped, buzzing, tapped, slid and as a chord.
//!
//! Every number is the instrument's own; nothing depends on the sample rate, so that all rates play the same.

use anyhow::{Context, Result};
use low_action_dsp::curve::{CountOrList, Curve, OneOrEach};
use low_action_dsp::scene::{
    FingerSpec, FretPlacement, FretboardSpec, ListeningPoint, OutputSpec, PluckSpec, StringSpec,
};
use low_action_dsp::setup::{SetupString, frequency};
use low_action_dsp::{Scene, Setup};

use super::settings::Setting;

/// Length of a scene, s.
pub const DURATION: f64 = 0.75;
/// When plucks begin, s: what is pressed before has come to rest.
pub const PLUCK: f64 = 0.15;
/// From when on partials are looked at, s.
pub const RINGING: f64 = 0.2;

/// What the left hand does on one string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hand {
    /// Nothing.
    Open,
    /// Stops a fret.
    Stops(usize),
    /// Comes down on the string behind a fret, and makes it sound by that.
    Taps(usize),
    /// Stops one fret and slides to another.
    Slides(usize, usize),
}

/// One string of a scene.
pub struct Part {
    /// Name of the string.
    string: &'static str,
    hand: Hand,
    /// Force of the pluck, N, and how much later than the first string it is plucked, s.
    pluck: (f64, f64),
}

/// What a scene is good for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// One note that rings without contact.
    Open,
    /// A string that is pressed on a fret and rings.
    Pressed,
    /// A light string that strikes frets on its own.
    BuzzingLight,
    /// A heavy one.
    BuzzingHeavy,
    /// Other contact: struck, slid, several strings.
    Mixed,
}

/// One scene.
pub struct Playing {
    /// What it is called.
    pub name: &'static str,
    /// What it is good for.
    pub kind: Kind,
    instrument: &'static str,
    parts: &'static [Part],
}

const fn part(string: &'static str, hand: Hand, force: f64, later: f64) -> Part {
    Part { string, hand, pluck: (force, later) }
}

/// All scenes, in the order of the tables. How one string bounces is an accident, so that several plucks are
/// looked at where it buzzes.
pub const SCENES: &[Playing] = &[
    Playing {
        name: "open, light (electric E4)",
        kind: Kind::Open,
        instrument: "electric",
        parts: &[part("E4", Hand::Open, 0.1, 0.0)],
    },
    Playing {
        name: "open, heavy (bass E1)",
        kind: Kind::Open,
        instrument: "bass",
        parts: &[part("E1", Hand::Open, 0.3, 0.0)],
    },
    Playing {
        name: "stopped, light (electric E4, fret 12)",
        kind: Kind::Pressed,
        instrument: "electric",
        parts: &[part("E4", Hand::Stops(12), 0.1, 0.0)],
    },
    Playing {
        name: "stopped, heavy (electric E2, fret 3)",
        kind: Kind::Pressed,
        instrument: "electric",
        parts: &[part("E2", Hand::Stops(3), 0.2, 0.0)],
    },
    Playing {
        name: "buzzing, light (electric E4, 0.8, 1, 1.3 and 1.6 N)",
        kind: Kind::BuzzingLight,
        instrument: "electric",
        parts: &[
            part("E4", Hand::Open, 0.8, 0.0),
            part("E4", Hand::Open, 1.0, 0.0),
            part("E4", Hand::Open, 1.3, 0.0),
            part("E4", Hand::Open, 1.6, 0.0),
        ],
    },
    Playing {
        name: "buzzing, heavy (bass E1, 3 and 4 N)",
        kind: Kind::BuzzingHeavy,
        instrument: "bass",
        parts: &[part("E1", Hand::Open, 3.0, 0.0), part("E1", Hand::Open, 4.0, 0.0)],
    },
    Playing {
        name: "tapped (electric G3, fret 9)",
        kind: Kind::Mixed,
        instrument: "electric",
        parts: &[part("G3", Hand::Taps(9), 0.0, 0.0)],
    },
    Playing {
        name: "slid (steel D3, frets 5 to 9)",
        kind: Kind::Mixed,
        instrument: "steel",
        parts: &[part("D3", Hand::Slides(5, 9), 0.4, 0.0)],
    },
    Playing {
        name: "chord (electric E2, A2, D3)",
        kind: Kind::Mixed,
        instrument: "electric",
        parts: &[
            part("E2", Hand::Open, 0.5, 0.0),
            part("A2", Hand::Stops(2), 0.5, 0.015),
            part("D3", Hand::Stops(2), 0.5, 0.03),
        ],
    },
];

/// Force of a tap while it comes down, N, and how long it lasts, s.
const TAP: (f64, f64) = (30.0, 0.02);
/// Height from which it comes, m.
const TAP_HEIGHT: f64 = 1e-3;
/// When a slide begins and ends, s.
const SLIDE: [f64; 2] = [0.25, 0.55];
/// What every contact law yields the same force at: penetration, m.
const SAME_AT: f64 = 1e-6;

impl Playing {
    /// The scene as a setting computes it.
    pub fn scene(&self, setting: &Setting) -> Result<Scene> {
        let setup = Setup::builtin(self.instrument).context("a built-in instrument")?;
        let (mut string, mut pluck, mut finger) = (Vec::new(), Vec::new(), Vec::new());
        for (number, part) in (1..).zip(self.parts) {
            let spec = setup.string.iter().find(|spec| spec.name == part.string);
            string.push(tuned(&setup, spec.with_context(|| format!("no string `{}`", part.string))?));
            let (force, later) = part.pluck;
            if force > 0.0 {
                pluck.push(PluckSpec {
                    string: number,
                    start: PLUCK + later,
                    duration: setup.player.pluck_duration,
                    position: setup.neck.scale_length - setup.player.pluck_position,
                    force,
                });
            }
            finger.extend(hand(&setup, number, part.hand));
        }
        Ok(Scene {
            sample_rate: setting.rate,
            duration: DURATION,
            solver: setting.solver(),
            string,
            fretboard: Some(fretboard(&setup, setting.exponent)?),
            pluck,
            finger,
            output: OutputSpec { position: ListeningPoint::Bridge },
        })
    }

    /// Frequency f₁ of the string as it is stopped, Hz, and its inharmonicity B.
    pub fn pitch(&self) -> Result<(f64, f64)> {
        let setup = Setup::builtin(self.instrument).context("a built-in instrument")?;
        let part = &self.parts[0];
        let spec = setup.string.iter().find(|spec| spec.name == part.string).context("a string")?;
        let fret = match part.hand {
            Hand::Stops(fret) | Hand::Taps(fret) => fret,
            _ => 0,
        };
        let string = tuned(&setup, spec);
        let length = setup.neck.scale_length - setup.neck.equal_place(fret as f64);
        let bending = kappa_squared(spec) * spec.linear_density / string.tension.at(0.0);
        let inharmonicity = bending * (std::f64::consts::PI / length).powi(2);
        Ok((frequency(spec.pitch + fret as f64), inharmonicity))
    }
}

/// κ² = EI/ρ, m⁴/s².
fn kappa_squared(spec: &SetupString) -> f64 {
    spec.youngs_modulus * std::f64::consts::PI * spec.core_radius.powi(4) / 4.0 / spec.linear_density
}

/// A string tuned by theory, not on any grid; its grid leaves the room for bends that the instrument leaves.
fn tuned(setup: &Setup, spec: &SetupString) -> StringSpec {
    let length = setup.neck.scale_length;
    let wave_number = std::f64::consts::PI / length;
    let angular = std::f64::consts::TAU * frequency(spec.pitch);
    let c2 = (angular / wave_number).powi(2) - kappa_squared(spec) * wave_number * wave_number;
    let tension = c2 * spec.linear_density;
    let bent = setup.highest_tension_ratio() * tension;
    let far = 10.0 * DURATION;
    StringSpec {
        length,
        linear_density: spec.linear_density,
        tension: Curve::Points(vec![[0.0, tension], [far, tension], [2.0 * far, bent]]),
        youngs_modulus: spec.youngs_modulus,
        core_radius: spec.core_radius,
        loss_0: spec.loss_0,
        loss_1: spec.loss_1,
        tension_modulation: setup.tension_modulation,
        shape: None,
    }
}

/// The neck under every string, its frets in equal temperament; with another exponent as stiff at
/// [`SAME_AT`] as its own law.
fn fretboard(setup: &Setup, exponent: Option<f64>) -> Result<FretboardSpec> {
    let barrier = setup.neck.barrier(&setup.neck.equal_places())?;
    let own = setup.neck.exponent;
    let exponent = exponent.unwrap_or(own);
    let stiffness = setup.neck.stiffness * SAME_AT.powf(own - exponent);
    Ok(FretboardSpec {
        stiffness,
        exponent,
        board: barrier.board,
        frets: CountOrList::List(barrier.frets.iter().map(|fret| fret[0]).collect()),
        fret_top: Some(OneOrEach::Each(barrier.frets.iter().map(|fret| fret[1]).collect())),
        fret_placement: FretPlacement::Exact,
        board_reference_spacing: barrier.board_reference_spacing,
    })
}

/// The finger of a hand on a string.
fn hand(setup: &Setup, string: usize, hand: Hand) -> Option<FingerSpec> {
    let fretting = &setup.player.fretting;
    let place = |fret: usize| {
        let (crown, before) =
            (setup.neck.equal_place(fret as f64), setup.neck.equal_place(fret as f64 - 1.0));
        crown - fretting.behind * (crown - before)
    };
    let pressed = Curve::Points(vec![[0.0, 0.0], [fretting.landing, fretting.force]]);
    let (position, height, force) = match hand {
        Hand::Open => return None,
        Hand::Stops(fret) => (Curve::Constant(place(fret)), fretting.hover, pressed),
        Hand::Taps(fret) => {
            let [begin, end] = [PLUCK, PLUCK + TAP.1];
            let course = [[begin, 0.0], [begin + 0.002, TAP.0], [end, TAP.0], [end + 0.01, fretting.force]];
            (Curve::Constant(place(fret)), TAP_HEIGHT, Curve::Points(course.to_vec()))
        }
        Hand::Slides(from, to) => {
            let course = vec![[SLIDE[0], place(from)], [SLIDE[1], place(to)]];
            (Curve::Points(course), fretting.hover, pressed)
        }
    };
    let touch = fretting.touch;
    Some(FingerSpec {
        string,
        mass: touch.mass,
        stiffness: touch.stiffness,
        exponent: touch.exponent,
        damping: touch.damping,
        hand_damping: touch.hand_damping,
        position,
        height,
        velocity: 0.0,
        force,
    })
}
