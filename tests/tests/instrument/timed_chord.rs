//! The promise: the chord by which speed is told (`docs/speed.md`, `docs/trade.md`, `docs/features.md`) is what those pages say, six
//! strings from the lowest on, each stopped behind its fret, all of them ringing for as long as any of them is timed.

use low_action_dsp::{Instrument, Quality};
use low_action_tests::numbers::rms;
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{decibels, hertz};
use xtask::measure::chord;

const RATE: f64 = 48_000.0;
/// MIDI notes of the open strings of a guitar.
const OPEN: [u8; 6] = [40, 45, 50, 55, 59, 64];

#[test]
fn six_stopped_strings_ring() {
    let setup = chord::lowest_strings(6);
    let mut instrument = Instrument::new(&setup, &Quality::Live.settings(RATE)).unwrap();
    assert_eq!(instrument.string_count(), OPEN.len());
    for string in 0..OPEN.len() {
        chord::stop(&mut instrument, &setup, string, chord::fret(string)).unwrap();
        chord::pluck(&mut instrument, &setup, string).unwrap();
    }
    // `trade` times from 0.1 to 0.4 s, `features` and the benchmarks from 0.1 to 0.2 s.
    let samples = (0.4 * RATE) as usize;
    let mut stems = vec![vec![0.0; samples]; OPEN.len()];
    let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
    let mut views: Vec<_> = stems.iter_mut().map(Vec::as_mut_slice).collect();
    instrument.process_stems(&mut views, &mut left, &mut right);
    for (string, (stem, open)) in stems.iter().zip(OPEN).enumerate() {
        let fret = [3, 4, 5, 3, 4, 5][string];
        let part = |from: f64, to: f64| &stem[(from * RATE) as usize..(to * RATE) as usize];
        let pitch = hertz(f64::from(open) + f64::from(fret));
        let off = cents(frequency_near(part(0.1, 0.4), RATE, pitch), pitch);
        // What rings after a pluck is up to ten cents sharp; another fret would be a hundred.
        assert!(off.abs() < 20.0, "string {string} is {off} cents off fret {fret}");
        let falls = decibels(rms(part(0.35, 0.4)) / rms(part(0.1, 0.15)));
        // A string that is damped falls by 40 dB in 150 ms, one that rings by less than half of that in all.
        assert!(falls > -20.0, "string {string} falls by {falls} dB while it is timed");
    }
}

#[test]
fn fewer_strings_are_the_lowest() {
    for count in 1..=6 {
        let pitches: Vec<f64> =
            chord::lowest_strings(count).string.iter().map(|string| string.pitch).collect();
        assert_eq!(pitches, OPEN.map(f64::from)[..count]);
    }
}
