//! Promise: every sample rate from 8 to 384 kHz works, and the pitch stays where it is.

use low_action_dsp::{EngineSettings, Gesture, Instrument, Quality, Setup, TimedGesture};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{decibels, hertz, peak};

/// What is measured sounds: at least so loud, −60 dBFS. The gain is made so that a chord of six strings struck with 0.7 of the
/// hardest force peaks at −12 to −3 dBFS (`level`); one string of it is 8 to 16 dB below that, one plucked with 0.2 of the
/// force 11 dB below that, and 0.3 s later all is some dB less: −40 to −22 dBFS.
const HEARD: f64 = 1e-3;

#[test]
fn pitch_is_the_same_at_every_rate() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let rates = [8e3, 11_025.0, 22_050.0, 44_100.0, 48e3, 88_200.0, 96e3, 176_400.0, 192e3, 384e3];
    // As they are played, and every string at the rate itself.
    for (rate, alone) in rates.into_iter().flat_map(|rate| [(rate, false), (rate, true)]) {
        let live = Quality::Live.settings(rate);
        let settings = if alone { EngineSettings { widest_spacing: f64::INFINITY, ..live } } else { live };
        let mut instrument = Instrument::new(&setup, &settings).expect("it can be built");
        for (string, fret) in [(0, 0), (2, 5), (5, 3)] {
            instrument.reset();
            let geometry = instrument.geometry(string).clone();
            let at = |gesture| TimedGesture { time: 0, string, gesture };
            let player = &setup.player;
            let place = Gesture::Place {
                finger: 0,
                touch: player.fretting.touch,
                position: geometry.finger_position(fret),
                clearance: player.fretting.hover,
            };
            let press =
                Gesture::Press { finger: 0, force: player.fretting.force, duration: player.fretting.landing };
            let position = geometry.length - player.pluck_position;
            let pluck = Gesture::Pluck {
                position,
                force: 0.2 * player.pluck_force,
                duration: player.pluck_duration,
                release: 0.0,
            };
            for gesture in [place, press].into_iter().filter(|_| fret > 0).chain([pluck]) {
                instrument.schedule(at(gesture)).expect("there is room");
            }
            let count = (0.8 * rate) as usize;
            let (mut left, mut right) = (vec![0.0; count], vec![0.0; count]);
            instrument.process(&mut left, &mut right);
            assert!(left.iter().chain(&right).all(|sample| sample.is_finite()), "{rate} Hz");
            let target = hertz(geometry.open_pitch + fret as f64);
            let measured = &left[(0.3 * rate) as usize..];
            let loud = peak(measured);
            assert!(loud > HEARD, "{rate} Hz, string {string}, fret {fret}: {} dBFS", decibels(loud));
            let cents = cents(frequency_near(measured, rate, target), target);
            println!(
                "{rate} Hz, string {string}, fret {fret}: {cents:+.2} cents, {:.1} dBFS",
                decibels(loud)
            );
            assert!(cents.abs() < 3.0, "{rate} Hz, string {string}, fret {fret}: {cents:+.2} cents");
        }
    }
}
