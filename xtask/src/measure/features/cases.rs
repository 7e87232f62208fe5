//! What is measured: a bare string, the same string with one element more, and instruments.

use anyhow::{Context, Result};
use low_action_dsp::curve::Curve;
use low_action_dsp::{
    Drive, EngineSettings, Gesture, Instrument, Model, Quality, Scene, Scratch, Setup, Simulation, State,
    StringParameters, TimedGesture,
};

use crate::measure::chord;

/// Samples that an instrument runs at once: of any case only so many or a multiple are run.
pub const BLOCK: usize = 64;

/// Something that runs sample by sample.
pub struct Case {
    /// What it is called, in the table and on the command line.
    pub name: &'static str,
    /// The name of the case it is compared with.
    pub over: &'static str,
    /// What it is.
    what: What,
}

/// What a case runs.
enum What {
    /// A scene: lines for its `[[string]]`, what stands after it, and how it is run.
    Scene(&'static str, &'static str, Extra),
    /// The bare string with nobody to ask what else there is: its model stepped by hand.
    ByHand,
    /// An instrument in which so many strings ring, of so many that are asked for, over a body or none.
    Instrument { strings: usize, ringing: usize, fretted: bool, body: bool },
}

/// What is asked of a running scene besides its steps.
#[derive(PartialEq)]
enum Extra {
    Nothing,
    Output,
    Ledger,
    SecondString,
}
use Extra::{Ledger, Nothing, Output, SecondString};

/// The name of what everything is compared with.
pub const BARE: &str = "bare string, as a scene";
/// The same string without a scene around it.
pub const BY_HAND: &str = "bare string";
/// The names of an instrument with one string that rings, and of one with five silent strings besides.
pub const ONE_RINGS: &str = "one string of an instrument, ringing";
pub const FIVE_SILENT: &str = "five silent strings besides";

/// A low E string at 48 kHz, flexible and lossless, released from a triangle 2 mm high.
const STRING: &str = "length = 0.6477\nlinear_density = 6.8246e-3\ntension = 77.8\n\
                      shape = [[0, 0], [0.5, 2e-3], [0.6477, 0]]\n";
/// So stiff that the operator needs its neighbours, and so little that the grid stays that of the bare
/// string: the passes are the same for any stiffness.
const STIFF: &str = "youngs_modulus = 2e11\ncore_radius = 1e-5\n";
const STRETCHED: &str = "youngs_modulus = 2e11\ncore_radius = 1e-5\ntension_modulation = true\n";
const LOSSY: &str = "loss_0 = 0.3\nloss_1 = 1e-6\n";
const BOARD: &str = "[fretboard]\nstiffness = 1e10\nexponent = 1.5\nboard = -0.01\n";
const FRETS: &str = "[fretboard]\nstiffness = 1e10\nexponent = 1.5\nfrets = 22\nfret_top = -0.01\n";
const LOW_FRETS: &str = "[fretboard]\nstiffness = 1e10\nexponent = 1.5\nfrets = 22\nfret_top = -0.001\n";

/// A finger at a place with a height, a force and a hand's damping.
macro_rules! finger {
    ($place:literal, $rest:literal) => {
        concat!("[[finger]]\nmass = 5e-3\nstiffness = 1e7\nexponent = 2.0\nposition = ", $place, "\n", $rest)
    };
}
const HOVERING: &str = finger!("0.5", "height = 0.01\n");
const RESTING: &str = finger!("0.5", "height = 1e-3\nforce = 0.5\nhand_damping = 5.0\n");
const TWO_RESTING: &str = concat!(
    finger!("0.5", "height = 1e-3\nforce = 0.5\nhand_damping = 5.0\n"),
    finger!("0.3", "height = 1e-3\nforce = 0.5\nhand_damping = 5.0\n"),
);

/// A scene with one element more than the bare string.
const fn scene(name: &'static str, string: &'static str, rest: &'static str) -> Case {
    Case { name, over: BARE, what: What::Scene(string, rest, Nothing) }
}

/// The bare string with something asked of it while it runs.
const fn asked(name: &'static str, extra: Extra) -> Case {
    Case { name, over: BARE, what: What::Scene("", "", extra) }
}

/// An instrument with so many strings, so many of them ringing.
const fn instrument(name: &'static str, strings: usize, ringing: usize) -> Case {
    Case { name, over: ONE_RINGS, what: What::Instrument { strings, ringing, fretted: false, body: false } }
}

/// Everything that is measured, in the order of the table.
pub const CASES: &[Case] = &[
    Case { name: BY_HAND, over: BY_HAND, what: What::ByHand },
    Case { name: BARE, over: BY_HAND, what: What::Scene("", "", Nothing) },
    scene("stiffness", STIFF, ""),
    scene("losses", LOSSY, ""),
    scene("tension modulation and stiffness", STRETCHED, ""),
    scene("board, out of reach", "", BOARD),
    scene("22 frets, out of reach", "", FRETS),
    scene("22 frets, buzzing", "", LOW_FRETS),
    scene("finger, hovering", "", HOVERING),
    scene("finger, resting on the string", "", RESTING),
    scene("two fingers, resting on the string", "", TWO_RESTING),
    asked("pickup", Output),
    asked("second string", SecondString),
    asked("energy ledger, as in a trace", Ledger),
    instrument(ONE_RINGS, 1, 1),
    instrument(FIVE_SILENT, 6, 1),
    instrument("six strings, all ringing", 6, 6),
    Case {
        name: "six strings, all fretted and ringing",
        over: ONE_RINGS,
        what: What::Instrument { strings: 6, ringing: 6, fretted: true, body: false },
    },
    Case {
        name: "a guitar's body under one string",
        over: ONE_RINGS,
        what: What::Instrument { strings: 1, ringing: 1, fretted: false, body: true },
    },
    Case {
        name: "… under six, one of them ringing",
        over: ONE_RINGS,
        what: What::Instrument { strings: 6, ringing: 1, fretted: false, body: true },
    },
];

/// What is said of a name that no case has, in this and in all earlier versions.
pub fn unknown(name: &str) -> String {
    format!("no case is called `{name}`")
}

impl Case {
    /// The case of a name.
    pub fn find(name: &str) -> Result<&'static Case> {
        CASES.iter().find(|case| case.name == name).with_context(|| unknown(name))
    }

    /// Builds the case and returns what computes so many of its samples.
    pub fn prepare(&self) -> Result<Box<dyn FnMut(usize)>> {
        match &self.what {
            What::ByHand => prepare_by_hand(),
            What::Scene(string, rest, extra) => prepare_scene(string, rest, extra),
            &What::Instrument { strings, ringing, fretted, body } => {
                prepare_instrument(strings, ringing, fretted, body)
            }
        }
    }
}

fn prepare_by_hand() -> Result<Box<dyn FnMut(usize)>> {
    let scene = Scene::from_toml(&bare(1, ""))?;
    let spec = &scene.string[0];
    let model = Model::new(StringParameters::from_spec(spec), None, 0, scene.solver, scene.sample_rate)?;
    let (mut state, mut scratch, drive) = (State::new(&model), Scratch::new(&model), Drive::new(&model));
    if let Some(shape) = &spec.shape {
        state.set_shape(&model, &Curve::Points(shape.clone()));
    }
    Ok(Box::new(move |samples| {
        for _ in 0..samples {
            state.step(&model, &drive, &mut scratch);
        }
    }))
}

/// A scene of so many strings alike.
fn bare(count: usize, string: &str) -> String {
    let head = "sample_rate = 48000\nduration = 60\n[output]\nposition = 0.55\n";
    head.to_owned() + &format!("[[string]]\n{STRING}{string}").repeat(count)
}

fn prepare_scene(string: &str, rest: &str, extra: &Extra) -> Result<Box<dyn FnMut(usize)>> {
    let text = bare(if *extra == SecondString { 2 } else { 1 }, string) + rest;
    let mut simulation = Simulation::new(&Scene::from_toml(&text)?)?;
    if *extra == Ledger {
        simulation.open_ledger();
    }
    let listen = *extra == Output;
    let mut heard = 0.0;
    Ok(Box::new(move |samples| {
        for _ in 0..samples {
            simulation.step();
            if listen {
                heard += simulation.output();
            }
        }
        std::hint::black_box(heard);
    }))
}

/// The default instrument with its lowest strings, as many of which are plucked as are to ring; with the body of `classical`, or
/// none.
fn prepare_instrument(
    strings: usize,
    ringing: usize,
    fretted: bool,
    body: bool,
) -> Result<Box<dyn FnMut(usize)>> {
    let mut setup = chord::lowest_strings(strings);
    if body {
        setup.body = Setup::builtin("classical").context("it is built in")?.body;
    }
    // A sample is a step, for all strings alike.
    let settings = EngineSettings { widest_spacing: f64::INFINITY, ..Quality::Live.settings(48e3) };
    let mut instrument = Instrument::new(&setup, &settings)?;
    for string in 0..ringing {
        chord::stop(&mut instrument, &setup, string, if fretted { chord::fret(string) } else { 0 })?;
        // A little softer than the chord's own pluck: the counts in the table are of this one.
        let gesture = Gesture::Pluck { position: 0.52, force: 0.4, duration: 0.003, release: 0.0 };
        instrument.schedule(TimedGesture { time: 0, string, gesture })?;
    }
    let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
    Ok(Box::new(move |samples| {
        assert_eq!(samples % BLOCK, 0, "an instrument runs whole blocks");
        for _ in 0..samples / BLOCK {
            instrument.process(&mut left, &mut right);
        }
        std::hint::black_box((&left, &right));
    }))
}
