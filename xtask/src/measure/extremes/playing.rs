//! Hard playing without a pause: every string of every built-in instrument plucked, pressed, slid and bent at
//! random many times a second, with other set-ups in between.

use anyhow::{Result, bail};
use low_action_dsp::{EngineSettings, Gesture, Instrument, Setup, Stencil, TimedGesture};

use super::draw::Draw;

const RATE: f64 = 48e3;
const BLOCK: usize = 480;

/// How long one set-up is played before another takes its place, s.
const EXCHANGE: f64 = 10.0;

/// Plays one built-in instrument for so many seconds of audio; returns the loudest sample.
///
/// # Errors
/// When a sample or a string is not finite.
pub fn play(name: &str, seed: u64, seconds: f64) -> Result<f64> {
    let mut draw = Draw::new(seed, name.len() as u64);
    let (mut left, mut right) = (vec![0.0f32; BLOCK], vec![0.0f32; BLOCK]);
    let mut loudest = 0.0f64;
    let mut played = 0.0;
    while played < seconds {
        let Some(mut setup) = Setup::builtin(name) else { bail!("no instrument is called {name}") };
        change(&mut setup, &mut draw);
        let settings = EngineSettings {
            sample_rate: RATE,
            widest_spacing: f64::INFINITY,
            stencil: draw.one_of(&[Stencil::Paper, Stencil::Corrected, Stencil::Wide]),
            max_iterations: draw.one_of(&[0, 1, 3, 8, 20, 50]),
            tolerance: draw.over(1e-15, 1e-6),
        };
        let mut instrument = Instrument::new(&setup, &settings)?;
        let end = (played + EXCHANGE).min(seconds);
        while played < end {
            for string in 0..instrument.string_count() {
                for _ in 0..draw.whole(0, 3) {
                    let time = instrument.now() + draw.whole(0, BLOCK) as u64;
                    let gesture = gesture(&mut draw, &setup, instrument.geometry(string).length);
                    // A full queue leaves a gesture out.
                    let _ = instrument.schedule(TimedGesture { time, string, gesture });
                }
            }
            instrument.process(&mut left, &mut right);
            played += BLOCK as f64 / RATE;
            let most = left.iter().chain(&right).fold(0.0f64, |most, sample| {
                if sample.is_finite() { most.max(f64::from(sample.abs())) } else { f64::INFINITY }
            });
            loudest = loudest.max(most);
            let still = (0..instrument.string_count()).all(|string| {
                instrument.state(string).displacement().iter().all(|u| u.is_finite() && u.abs() < 1e3)
            });
            if !most.is_finite() || !still {
                bail!("{name} after {played:.2} s of hard playing from seed {seed}: not finite");
            }
        }
    }
    Ok(loudest)
}

/// Another action, relief and touch, as far as set-ups allow.
fn change(setup: &mut Setup, draw: &mut Draw) {
    setup.intonation = low_action_dsp::setup::Intonation::Physical;
    let neck = &mut setup.neck;
    neck.nut_clearance = draw.over(1e-4, 1e-3);
    neck.action = neck.nut_clearance + draw.over(1e-5, 4e-3);
    neck.relief = draw.over(1e-5, 5e-4);
    neck.fret_height = draw.over(1e-4, 2e-3);
    setup.player.fretting.touch.mass *= draw.over(0.1, 10.0);
    setup.player.fretting.touch.stiffness *= draw.over(0.1, 10.0);
}

/// Something a player in a rage might do.
fn gesture(draw: &mut Draw, setup: &Setup, length: f64) -> Gesture {
    let finger = draw.whole(0, low_action_dsp::FINGERS_PER_STRING - 1);
    let position = length * draw.between(0.0, 1.0);
    let duration = draw.over_or_nothing(0.2, 1e-4, 0.1);
    let touch = if draw.chance(0.5) { setup.player.fretting.touch } else { setup.player.damper.touch };
    match draw.whole(0, 9) {
        0..=3 => Gesture::Pluck { position, force: draw.either_way(0.1, 100.0), duration },
        4 | 5 => Gesture::Place { finger, touch, position, clearance: draw.over(1e-5, 1e-2) },
        6 => Gesture::Press { finger, force: draw.either_way(0.1, 100.0), duration },
        7 => Gesture::Slide { finger, position, duration },
        8 => Gesture::Lift { finger, force: draw.over(0.1, 100.0), duration },
        _ => Gesture::Bend { tension_ratio: draw.over(0.1, 10.0), duration },
    }
}
