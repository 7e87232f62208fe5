//! Instruments drawn at random: as many strings, as long a neck, as low an action as set-ups allow.

use low_action_dsp::neck::Neck;
use low_action_dsp::setup::{Body, Bridge, Intonation, Pickup};
use low_action_dsp::{EngineSettings, Instrument, Quality, Setup, Stencil};

use super::draw::Draw;
use super::scenes;

/// The most grid points times steps a second of an instrument: more would leave no time for anything else.
const MOST_WORK: f64 = 3e8;

/// How often one is drawn anew that cannot be built, or would take too long.
const TRIES: usize = 30;

/// The least that a neck may be below the strings, m.
const LEAST_CLEARANCE: f64 = 1e-5;

/// An instrument whose set-up is drawn by `setup`, computed anyhow.
///
/// # Errors
/// When none of many could be built; says why the last one could not.
pub fn instrument(
    draw: &mut Draw,
    sample_rate: f64,
    mut setup: impl FnMut(&mut Draw) -> Setup,
) -> Result<(Setup, Instrument), String> {
    let mut reason = String::new();
    for _ in 0..TRIES {
        let setup = setup(draw);
        match Instrument::new(&setup, &settings(draw, sample_rate)) {
            Ok(instrument) if work(&instrument) <= MOST_WORK => return Ok((setup, instrument)),
            Ok(_) => reason = "sample_rate is refused: too many points and steps".into(),
            Err(error) => reason = error.to_string(),
        }
    }
    Err(reason)
}

/// Grid points times steps a second.
fn work(instrument: &Instrument) -> f64 {
    let of = |string| instrument.ratio(string).value() * instrument.model(string).grid.intervals as f64;
    instrument.sample_rate() * (0..instrument.string_count()).map(of).sum::<f64>()
}

/// A quality, or anything.
fn settings(draw: &mut Draw, sample_rate: f64) -> EngineSettings {
    if draw.chance(0.3) {
        return draw.one_of(&[Quality::Draft, Quality::Live, Quality::Studio]).settings(sample_rate);
    }
    EngineSettings {
        sample_rate,
        widest_spacing: draw.over(3e-3, 0.1),
        stencil: draw.one_of(&Stencil::ALL),
        max_iterations: draw.one_of(&scenes::CAPS),
        tolerance: draw.over_or_nothing(0.1, 1e-15, 1e-6),
    }
}

/// Any instrument: another number of strings, none of them alike, over another neck. A part of them, `close`, have a neck as near
/// to the strings as there may be.
pub fn any(draw: &mut Draw, close: f64) -> Setup {
    let mut setup = Setup::builtin(draw.one_of(&Setup::BUILTIN)).expect("it is built in");
    stretch(&mut setup, draw.over(0.3, 3.0));
    let count = if draw.chance(0.1) { draw.whole(7, 32) } else { draw.whole(1, 6) };
    let strings = std::mem::take(&mut setup.string);
    setup.string = (0..count).map(|_| strings[draw.whole(0, strings.len() - 1)].clone()).collect();
    for string in &mut setup.string {
        string.linear_density *= draw.over(0.1, 10.0);
        string.youngs_modulus *= draw.over_or_nothing(0.1, 0.1, 10.0);
        string.pitch = (string.pitch + draw.between(-24.0, 24.0)).clamp(0.0, 127.0);
    }
    set_up(draw, &mut setup, close);
    setup
}

/// The same strings, nearly as long and as heavy, set up otherwise.
pub fn alike(draw: &mut Draw, of: &Setup, close: f64) -> Setup {
    let mut setup = of.clone();
    stretch(&mut setup, draw.between(0.81, 1.24));
    for string in &mut setup.string {
        string.linear_density *= draw.between(0.81, 1.24);
        string.youngs_modulus *= draw.over(0.5, 2.0);
        string.pitch = (string.pitch + draw.between(-6.0, 6.0)).clamp(0.0, 127.0);
    }
    set_up(draw, &mut setup, close);
    setup
}

/// Makes everything along the strings so much longer.
fn stretch(setup: &mut Setup, by: f64) {
    let scale = setup.neck.scale_length;
    let by = (scale * by).clamp(0.1, 5.0) / scale;
    setup.neck.scale_length *= by;
    setup.player.pluck_position *= by;
    setup.player.damper.position *= by;
    if let Pickup::Magnetic { position, aperture, .. } = &mut setup.pickup {
        *position *= by;
        *aperture *= by;
    }
}

/// Turns every screw there is.
fn set_up(draw: &mut Draw, setup: &mut Setup, close: f64) {
    let is_close = draw.chance(close);
    let neck = &mut setup.neck;
    neck.frets = if draw.chance(0.1) { 0 } else { draw.whole(1, Neck::MOST_FRETS) };
    neck.fretless = draw.chance(0.1);
    neck.worn = if neck.frets > 0 && draw.chance(0.2) {
        vec![(draw.whole(1, neck.frets), draw.over(1e-6, 0.02))]
    } else {
        Vec::new()
    };
    neck.nut_clearance = if is_close { LEAST_CLEARANCE } else { draw.over(LEAST_CLEARANCE, 0.02) };
    neck.action = if is_close && draw.chance(0.7) {
        neck.nut_clearance
    } else {
        (neck.nut_clearance + draw.over(1e-6, Neck::HIGHEST_ACTION)).min(Neck::HIGHEST_ACTION)
    };
    neck.fret_height = draw.over_or_nothing(0.2, 1e-5, 0.02);
    neck.relief = draw.one_of(&[0.0, 0.5, 1.0]) * neck.most_relief();
    neck.exponent = draw.one_of(&[1.0, 1.5, 2.0, 2.5, 3.0]);
    // From a tenth of a newton to what only springs of steel push with, at a tenth of a millimetre.
    neck.stiffness = draw.over(0.1, 1e4) * libm::pow(1e4, neck.exponent);
    neck.damping = scenes::damping(draw).unwrap_or(neck.damping);
    for touch in [&mut setup.player.fretting.touch, &mut setup.player.damper.touch] {
        touch.mass *= draw.over(0.03, 30.0);
        touch.stiffness *= draw.over(0.01, 10.0);
        touch.damping *= draw.over(0.1, 10.0);
        touch.hand_damping *= draw.over(0.1, 10.0);
    }
    setup.bridge =
        draw.chance(0.2).then(|| Bridge { length: draw.over(5e-3, 0.02), radius: draw.over(1e-2, 100.0) });
    // Putting frets in tune takes long, and is another place for each.
    setup.intonation = if draw.chance(0.05) { Intonation::Compensated } else { Intonation::Physical };
    setup.max_bend = draw.between(0.0, 12.0);
    setup.tuning = draw.between(-2.0, 2.0);
    setup.tension_modulation = draw.chance(0.8);
    for string in &mut setup.string {
        string.loss_0 = draw.over_or_nothing(0.1, 0.01, 1e3);
        string.loss_1 = draw.over_or_nothing(0.1, 1e-5, 1e-1);
        string.pan = draw.between(-1.0, 1.0);
    }
    // From what is nearly as light as the strings to what hardly gives way. (One that is too light is drawn anew.)
    setup.body = draw.chance(0.4).then(|| Body {
        frequency: draw.over(30.0, 2000.0),
        mass: draw.over(0.01, 1000.0),
        area: draw.over(1e-4, 1.0),
        quality: draw.over(1.0, 200.0),
        spacing: draw.over(5.0, 1000.0),
        volume: draw.over(1e-4, 1.0),
        hole: draw.over(1e-5, 0.1),
    });
    bear(setup);
}

/// Takes away the body of one that has a wide bridge, which stands still, and a microphone in front of none.
pub fn bear(setup: &mut Setup) {
    if setup.bridge.is_some() {
        setup.body = None;
    }
    if setup.body.is_none() && setup.pickup == (Pickup::Microphone {}) {
        setup.pickup = Pickup::Bridge {};
    }
}
