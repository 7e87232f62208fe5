//! Hard playing without a pause: every string of every built-in instrument plucked, pressed, slid and bent at
//! random many times a second, while other set-ups take over the ringing strings and the solver's effort changes
//! from block to block.

use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Result, anyhow, bail, ensure};
use low_action_dsp::setup::{Bridge, Intonation};
use low_action_dsp::{EngineSettings, Gesture, Instrument, Setup, Stencil, TimedGesture};

use super::balance::Flow;
use super::draw::Draw;
use super::progress::Progress;
use super::{scenes, setups};

const RATE: f64 = 48e3;
const BLOCK: usize = 480;

/// What was seen of one instrument.
struct Seen {
    /// The loudest sample.
    loudest: f64,
    /// Set-ups that took over.
    exchanges: u32,
    /// The most that the balance of a string was open, as a part of what was put in.
    open: f64,
}

/// Plays all built-in instruments, so many seconds of audio between them, and says of each how it went.
///
/// # Errors
/// As [`play`].
pub fn play_all(seed: u64, seconds: f64, threads: usize) -> Result<()> {
    let names = Setup::BUILTIN;
    let each = seconds / names.len() as f64;
    let look = "{wide_bar} {percent} % of hard playing, {elapsed} of {duration}";
    let progress = Progress::new((seconds * RATE) as u64, "samples of hard playing", look)?;
    let next = AtomicUsize::new(0);
    let work = || -> Result<()> {
        while let Some(name) = names.get(next.fetch_add(1, Ordering::Relaxed)) {
            let Seen { loudest, exchanges, open } = play(name, seed, each, &progress)?;
            progress.println(&format!(
                "hard playing on {name}, {each} s: finite, loudest sample {loudest:.3e}; balance open by at \
                 most {open:.0e} through {exchanges} exchanged set-ups"
            ));
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..threads.clamp(1, names.len())).map(|_| scope.spawn(work)).collect();
        threads.into_iter().try_for_each(|thread| thread.join().expect("playing does not panic"))
    })?;
    progress.finish();
    Ok(())
}

/// Plays one built-in instrument for so many seconds of audio.
///
/// # Errors
/// When a sample or a string is not finite, energy is above what was put in, or a balance is open.
fn play(name: &str, seed: u64, seconds: f64, progress: &Progress) -> Result<Seen> {
    let mut draw = Draw::new(seed, name.len() as u64);
    let mut seen = Seen { loudest: 0.0, exchanges: 0, open: 0.0 };
    let mut setup = other_setup(name, &mut draw)?;
    let mut instrument = Instrument::new(&setup, &settings(&mut draw))?;
    instrument.open_ledgers();
    let mut put_in = vec![Flow::default(); instrument.string_count()];
    let mut until_exchange = 0;
    for block in 0..(seconds * RATE / BLOCK as f64).ceil() as u64 {
        if until_exchange == 0 && !instrument.is_fading() {
            drop(instrument.take_before());
            setup = other_setup(name, &mut draw)?;
            let successor = Instrument::new(&setup, &settings(&mut draw))?;
            ensure!(instrument.hand_over(Box::new(successor)).is_ok(), "an instrument is still in the way");
            seen.exchanges += 1;
            if instrument.ledger(0).is_none() {
                // The strings were too different to ring on.
                instrument.open_ledgers();
                put_in.fill(Flow::default());
            }
            until_exchange = draw.whole(3, 200);
        }
        until_exchange = until_exchange.saturating_sub(1);
        instrument.set_effort(draw.one_of(&[0, 1, 3, 8, 20, 50]), draw.over(1e-15, 1e-3));
        if draw.chance(0.002) {
            instrument.reset();
        }
        excite(&mut instrument, &setup, &mut draw);
        let loudest = sound(&mut instrument);
        seen.loudest = seen.loudest.max(loudest);
        let time = block as f64 * BLOCK as f64 / RATE;
        ensure!(loudest.is_finite(), "{name} after {time:.2} s of hard playing from seed {seed}: not finite");
        for (string, flow) in put_in.iter_mut().enumerate() {
            let Some(ledger) = instrument.ledger(string) else { bail!("the ledger is not open") };
            let parts = flow
                .check(ledger)
                .map_err(|fault| anyhow!("{name}, string {string}, {time:.2} s into seed {seed}: {fault}"))?;
            seen.open = seen.open.max(parts.open);
        }
        progress.inc(BLOCK as u64);
    }
    Ok(seen)
}

/// How an instrument is computed, anyhow.
fn settings(draw: &mut Draw) -> EngineSettings {
    EngineSettings {
        sample_rate: RATE,
        widest_spacing: draw.over(2e-3, 0.1),
        stencil: draw.one_of(&Stencil::ALL),
        max_iterations: 20,
        tolerance: 1e-10,
    }
}

/// A block of sound; returns its loudest sample, infinity if one or a point of a string is not finite.
fn sound(instrument: &mut Instrument) -> f64 {
    let (mut left, mut right) = ([0.0f32; BLOCK], [0.0f32; BLOCK]);
    instrument.process(&mut left, &mut right);
    let near = |u: f64| u.is_finite() && u.abs() < 1e3;
    let still =
        (0..instrument.string_count()).all(|string| instrument.state(string).displacement().all(near));
    if !still {
        return f64::INFINITY;
    }
    left.iter().chain(&right).fold(0.0, |most, sample| {
        if sample.is_finite() { most.max(f64::from(sample.abs())) } else { f64::INFINITY }
    })
}

/// Gestures at random for every string.
fn excite(instrument: &mut Instrument, setup: &Setup, draw: &mut Draw) {
    for string in 0..instrument.string_count() {
        // Now and then very many at once.
        let (count, spread) =
            if draw.chance(0.02) { (draw.whole(8, 30), 4) } else { (draw.whole(0, 3), BLOCK) };
        let first = instrument.now() + draw.whole(0, BLOCK - spread) as u64;
        for _ in 0..count {
            let time = first + draw.whole(0, spread) as u64;
            let gesture = gesture(draw, setup, instrument.geometry(string).length);
            // A full queue leaves a gesture out.
            let _ = instrument.schedule(TimedGesture { time, string, gesture });
        }
    }
}

/// Another action, relief, touch, tuning and set of strings, as far as set-ups allow.
fn other_setup(name: &str, draw: &mut Draw) -> Result<Setup> {
    let Some(mut setup) = Setup::builtin(name) else { bail!("no instrument is called {name}") };
    setup.intonation = Intonation::Physical;
    let neck = &mut setup.neck;
    neck.nut_clearance = draw.over(1e-4, 1e-3);
    neck.action = neck.nut_clearance + draw.over(1e-5, 4e-3);
    neck.relief = draw.over(1e-5, 5e-4).min(neck.most_relief());
    neck.fret_height = draw.over(1e-4, 2e-3);
    // Some instruments keep their own.
    neck.damping = scenes::damping(draw).unwrap_or(neck.damping);
    setup.player.fretting.touch.mass *= draw.over(0.1, 10.0);
    setup.player.fretting.touch.stiffness *= draw.over(0.1, 10.0);
    // Some get a wide bridge, from one exchange to the next.
    setup.bridge =
        draw.chance(0.2).then(|| Bridge { length: draw.over(5e-3, 0.02), radius: draw.over(1e-2, 100.0) });
    setups::bear(&mut setup);
    setup.tuning = draw.between(-0.5, 0.5);
    setup.tension_modulation = draw.chance(0.8);
    for string in &mut setup.string {
        string.linear_density *= draw.between(0.95, 1.05);
        string.loss_0 *= draw.between(0.2, 3.0);
    }
    Ok(setup)
}

/// Something a player in a rage might do.
pub fn gesture(draw: &mut Draw, setup: &Setup, length: f64) -> Gesture {
    let finger = draw.whole(0, low_action_dsp::FINGERS_PER_STRING - 1);
    let position = length * draw.between(0.0, 1.0);
    let duration = draw.over_or_nothing(0.2, 1e-4, 0.1);
    let touch = if draw.chance(0.5) { setup.player.fretting.touch } else { setup.player.damper.touch };
    match draw.whole(0, 12) {
        0..=3 => {
            let (force, release) = (draw.either_way(0.1, 100.0), draw.over_or_nothing(0.5, 1e-4, 0.1));
            Gesture::Pluck { position, force, duration, release }
        }
        4 | 5 => Gesture::Place { finger, touch, position, clearance: draw.over(1e-5, 1e-2) },
        6 => {
            let (clearance, speed) = (draw.over(1e-5, 1e-2), draw.over(1e-3, 10.0));
            Gesture::Throw { finger, touch, position, clearance, speed }
        }
        7 => Gesture::Press { finger, force: draw.either_way(0.1, 100.0), duration },
        8 => Gesture::Slide { finger, position, duration },
        9 => Gesture::Lift { finger, force: draw.over(0.1, 100.0), duration },
        // From what nobody hears to far more than brings the string to rest in a step, for no time, for a sample, for long: so
        // many that they follow one another, and that some are under way whenever a set-up is exchanged.
        10 | 11 => {
            let longest = if draw.chance(0.05) { 3.0 } else { 0.1 };
            Gesture::Still { loss: draw.over(0.1, 1e9), duration: draw.over_or_nothing(0.2, 1e-5, longest) }
        }
        _ => Gesture::Bend { tension_ratio: draw.over(0.1, 10.0), duration },
    }
}
