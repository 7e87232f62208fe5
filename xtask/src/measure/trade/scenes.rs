//! What is played: strings of the built-in instruments, open, stopped, buzzing, tapped, slid and as a chord.
//!
//! Every number is the instrument's own; nothing depends on the sample rate, so that all rates play the same.

use std::sync::LazyLock;

use anyhow::{Context, Result};
use low_action_dsp::curve::{CountOrList, Curve, OneOrEach};
use low_action_dsp::intonation::finger_place;
use low_action_dsp::scene::{FingerSpec, FretboardSpec, ListeningPoint, OutputSpec, PluckSpec, StringSpec};
use low_action_dsp::setup::{SetupString, frequency};
use low_action_dsp::{Scene, Setup, Simulation};

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
    /// Its place among the strings of the instrument, 0 for the highest.
    string: usize,
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
    /// One of all open strings.
    EachOpen,
    /// One of all strings that strikes frets.
    EachBuzzing,
    /// A string stopped high on the neck.
    High,
}

impl Kind {
    /// Whether it is one of the scenes of which all tables are made.
    pub fn is_main(self) -> bool {
        !matches!(self, Kind::EachOpen | Kind::EachBuzzing | Kind::High)
    }
}

/// One scene.
pub struct Playing {
    /// What it is called.
    pub name: String,
    /// What it is good for.
    pub kind: Kind,
    instrument: &'static str,
    parts: Vec<Part>,
}

fn part(string: usize, hand: Hand, force: f64, later: f64) -> Part {
    Part { string, hand, pluck: (force, later) }
}

fn playing(name: impl Into<String>, kind: Kind, instrument: &'static str, parts: Vec<Part>) -> Playing {
    Playing { name: name.into(), kind, instrument, parts }
}

/// The same open string plucked with several forces. How one string bounces is an accident, so that several
/// plucks are looked at where it buzzes.
fn plucked(string: usize, forces: &[f64]) -> Vec<Part> {
    forces.iter().map(|force| part(string, Hand::Open, *force, 0.0)).collect()
}

/// Frets high on the neck at which the light strings of `electric` are looked at.
const HIGH: [usize; 4] = [12, 15, 18, 21];

/// All scenes: those of the tables first, in their order, then what only qualities are measured by.
pub static SCENES: LazyLock<Vec<Playing>> = LazyLock::new(|| {
    use Hand::{Open, Slides, Stops, Taps};
    let one = |string, hand, force| vec![part(string, hand, force, 0.0)];
    let chord = vec![part(5, Open, 0.5, 0.0), part(4, Stops(2), 0.5, 0.015), part(3, Stops(2), 0.5, 0.03)];
    let mut all = vec![
        playing("open, light (electric E4)", Kind::Open, "electric", one(0, Open, 0.1)),
        playing("open, heavy (bass E1)", Kind::Open, "bass", one(3, Open, 0.3)),
        playing("stopped, light (electric E4, fret 12)", Kind::Pressed, "electric", one(0, Stops(12), 0.1)),
        playing("stopped, heavy (electric E2, fret 3)", Kind::Pressed, "electric", one(5, Stops(3), 0.2)),
        playing(
            "buzzing, light (electric E4, 0.8, 1, 1.3 and 1.6 N)",
            Kind::BuzzingLight,
            "electric",
            plucked(0, &LIGHT),
        ),
        playing("buzzing, heavy (bass E1, 3 and 4 N)", Kind::BuzzingHeavy, "bass", plucked(3, &[3.0, 4.0])),
        playing("tapped (electric G3, fret 9)", Kind::Mixed, "electric", one(2, Taps(9), 0.0)),
        playing("slid (steel D3, frets 5 to 9)", Kind::Mixed, "steel", one(3, Slides(5, 9), 0.4)),
        playing("chord (electric E2, A2, D3)", Kind::Mixed, "electric", chord),
    ];
    for instrument in Setup::BUILTIN {
        let count = Setup::builtin(instrument).map_or(0, |setup| setup.string.len());
        for string in 0..count {
            let name = format!("open, {instrument}, string {}", string + 1);
            all.push(playing(name, Kind::EachOpen, instrument, one(string, Open, 0.1)));
        }
    }
    all.extend((0..6).map(|string| {
        let name = format!("buzzing, electric, string {}", string + 1);
        playing(name, Kind::EachBuzzing, "electric", plucked(string, &LIGHT))
    }));
    for (string, name) in ["E4", "B3", "G3"].into_iter().enumerate() {
        let high = |fret| one(string, Stops(fret), 0.1);
        all.extend(
            HIGH.map(|fret| playing(format!("{name}, fret {fret}"), Kind::High, "electric", high(fret))),
        );
    }
    all
});

/// Forces with which strings of a guitar are plucked until they buzz, N.
const LIGHT: [f64; 4] = [0.8, 1.0, 1.3, 1.6];

/// Force of a tap while it comes down, N, and how long it lasts, s.
const TAP: (f64, f64) = (30.0, 0.02);
/// Height from which it comes, m.
const TAP_HEIGHT: f64 = 1e-3;
/// When a slide begins and ends, s.
const SLIDE: [f64; 2] = [0.25, 0.55];
/// What every contact law yields the same force at: penetration, m.
const SAME_AT: f64 = 1e-6;

impl Playing {
    /// All strings of an instrument plucked at once with one force, each under a hand of its own; the lowest string is the first.
    pub fn plucked_at_once(
        instrument: &'static str,
        force: f64,
        hand: impl Fn(usize) -> Hand,
    ) -> Result<Playing> {
        let setup = Setup::builtin(instrument).context("a built-in instrument")?;
        let strings = (0..setup.string.len()).rev().enumerate();
        let parts =
            strings.map(|(from_lowest, string)| part(string, hand(from_lowest), force, 0.0)).collect();
        Ok(playing("plucked at once", Kind::Mixed, instrument, parts))
    }

    /// Its strings as a setting computes them, each a scene of its own at its own rate: strings do not hear
    /// each other.
    pub fn scenes(&self, setting: &Setting) -> Result<Vec<Scene>> {
        let setup = Setup::builtin(self.instrument).context("a built-in instrument")?;
        self.parts.iter().map(|part| part.scene(&setup, setting)).collect()
    }

    /// Name of its first string.
    pub fn string(&self) -> Result<String> {
        let setup = Setup::builtin(self.instrument).context("a built-in instrument")?;
        let spec = setup.string.get(self.parts[0].string).context("a string")?;
        Ok(spec.name.clone())
    }

    /// Spacing of the grid of its first string, m.
    pub fn spacing(&self, setting: &Setting) -> Result<f64> {
        let scenes = self.scenes(setting)?;
        Ok(Simulation::new(&scenes[0])?.string(0).model.grid.spacing)
    }

    /// Frequency f₁ of the string as it is stopped, Hz, and its inharmonicity B.
    pub fn pitch(&self) -> Result<(f64, f64)> {
        let setup = Setup::builtin(self.instrument).context("a built-in instrument")?;
        let part = &self.parts[0];
        let spec = setup.string.get(part.string).context("a string")?;
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

impl Part {
    fn scene(&self, setup: &Setup, setting: &Setting) -> Result<Scene> {
        let spec = setup.string.get(self.string).context("a string")?;
        let (force, later) = self.pluck;
        let pluck = (force > 0.0).then_some(PluckSpec {
            string: 1,
            start: PLUCK + later,
            duration: setup.player.pluck_duration,
            // At once: the most that a rate may have to carry.
            release: 0.0,
            position: setup.neck.scale_length - setup.player.pluck_position,
            force,
        });
        Ok(Scene {
            sample_rate: setting.rate * setting.engine().ratio(setup, spec).value(),
            duration: DURATION,
            solver: setting.solver(),
            string: vec![tuned(setup, spec)],
            fretboard: Some(fretboard(setup, setting)?),
            body: None,
            pluck: pluck.into_iter().collect(),
            finger: hand(setup, self.hand).into_iter().collect(),
            output: OutputSpec { position: ListeningPoint::Bridge },
        })
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
        loss_0: Some(spec.loss_0),
        loss_1: Some(spec.loss_1),
        t60: None,
        tension_modulation: setup.tension_modulation,
        shape: None,
        velocity: None,
    }
}

/// The neck under every string, its frets in equal temperament; with another exponent as stiff at
/// [`SAME_AT`] as its own law.
fn fretboard(setup: &Setup, setting: &Setting) -> Result<FretboardSpec> {
    let barrier = setup.neck.barrier(&setup.neck.equal_places())?;
    let own = setup.neck.exponent;
    let exponent = setting.exponent.unwrap_or(own);
    let stiffness = setup.neck.stiffness * SAME_AT.powf(own - exponent);
    Ok(FretboardSpec {
        stiffness,
        exponent,
        damping: setting.damping.unwrap_or(setup.neck.damping),
        board: barrier.board.map(Into::into),
        frets: CountOrList::List(barrier.frets.iter().map(|fret| fret[0]).collect()),
        fret_top: Some(OneOrEach::Each(barrier.frets.iter().map(|fret| fret[1]).collect())),
        fret_placement: setting.frets,
        board_reference_spacing: barrier.board_reference_spacing,
    })
}

/// The finger of a hand on a string.
fn hand(setup: &Setup, hand: Hand) -> Option<FingerSpec> {
    let fretting = &setup.player.fretting;
    let frets = setup.neck.equal_places();
    let place = |fret: usize| finger_place(&frets, fret - 1, setup.behind());
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
        string: 1,
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
