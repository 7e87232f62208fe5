//! The promise: where labels have another pitch than the sound, or say nothing of what is heard, `docs/formats.md` says by how much.

use low_action_tests::labelled::{Labelled, RATE, held, number, render, sample, samples, song};
use low_action_tests::numbers::largest;
use low_action_tests::pages::must_say;
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{amplitude, decibels, peak};

const PROGRAM: &str = env!("CARGO_BIN_EXE_low-action-command");

/// Keys of one string, counted from 0, one after another for so long, ms, with pauses of two seconds.
fn one_by_one(instrument: &str, string: u8, keys: &[u8], velocity: u8, lasts: u32) -> Labelled {
    let notes = keys.iter().zip(0..).flat_map(|(&key, turn)| {
        let from = (lasts + 2000) * turn;
        held(key, velocity, from, from + lasts)
            .map(|(time, [status, key, value])| (time, [status | string, key, value]))
    });
    let options = ["--instrument", instrument, "--input", "strings", "--variation", "0", "--tail", "1"];
    render(PROGRAM, &song(&notes.collect::<Vec<_>>()), &options)
}

/// How far notes sound above their labels from a time after their onset on, for so long, s; cents, the least and the largest.
fn off(played: &Labelled, from: f64, lasts: f64) -> [f64; 2] {
    let off = played.notes().iter().map(|note| {
        let from = sample(note, "onset_sample") + samples(from);
        let sound = &played.string_of(note)[from..from + samples(lasts)];
        cents(frequency_near(sound, RATE, number(note, "frequency")), number(note, "frequency"))
    });
    off.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], off| [least.min(off), most.max(off)])
}

#[test]
fn strings_that_swing_far_are_sharper_at_first() {
    let played = one_by_one("buzzing-bass", 3, &[29, 30, 31, 32], 110, 600);
    let [least, most] = off(&played, 0.0, 0.25);
    must_say(
        "formats.md",
        &format!(
            "(the lowest string of `buzzing-bass` behind frets 1 to 4 at velocity 110 by {least:.0} to {most:.0} cents in its \
             first quarter of a second)"
        ),
    );
}

#[test]
fn strings_that_rattle_under_light_fingers_are_sharper() {
    let found = [64, 59, 55, 50, 45, 40].into_iter().zip(0..).map(|(open, string)| {
        off(&one_by_one("light-fingers", string, &[open + 3, open + 5], 80, 800), 0.1, 0.5)
    });
    let [least, most] =
        found.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])]).expect("six strings");
    must_say(
        "formats.md",
        &format!(
            "notes sound higher than labels say: by {least:.0} to {most:.0} cents at frets 3 and 5 (velocity 80)"
        ),
    );
}

/// Over a body a fundamental near a mode of it is two.
#[test]
fn a_note_near_a_mode_of_the_body_has_two_fundamentals() {
    let played = one_by_one("school-guitar", 5, &[54], 90, 1200);
    let [note] = played.notes() else { panic!("{:?}", played.notes()) };
    let from = sample(note, "onset_sample") + samples(0.05);
    let sound = &played.string_of(note)[from..from + samples(1.0)];
    let size =
        |cents: i32| amplitude(sound, RATE, number(note, "frequency") * (f64::from(cents) / 1200.0).exp2());
    let sizes: Vec<f64> = (-60..=60).map(size).collect();
    let most = largest(sizes.iter().copied());
    let is_peak = |&n: &usize| sizes[n] > sizes[n - 1] && sizes[n] > sizes[n + 1] && sizes[n] > 0.5 * most;
    let peaks: Vec<i32> = (1..120).filter(is_peak).map(|n| n as i32 - 60).collect();
    let [below, above] = peaks[..] else { panic!("{peaks:?}") };
    must_say(
        "formats.md",
        &format!(
            "F♯3 on the lowest string, has two fundamentals, {} cents below and {above} above",
            below.abs()
        ),
    );
}

#[test]
fn a_low_string_comes_up_under_a_finger_that_eases() {
    let mut loudest = [f64::NEG_INFINITY; 2];
    let mut nearest = f64::NEG_INFINITY;
    for (instrument, open) in [("electric", 40), ("baritone", 35), ("drop-d", 38)] {
        let keys: Vec<u8> = (15..=20).map(|fret| open + fret).collect();
        for (loudest, velocity) in loudest.iter_mut().zip([5, 110]) {
            let played = one_by_one(instrument, 5, &keys, velocity, 600);
            for note in played.notes() {
                let (sound, end) = (played.string_of(note), sample(note, "end_sample"));
                let comes = decibels(peak(&sound[end + samples(0.28)..end + samples(0.42)]));
                *loudest = loudest.max(comes);
                if velocity == 5 {
                    nearest = nearest.max(comes - decibels(peak(&sound[sample(note, "onset_sample")..end])));
                }
            }
        }
    }
    let [soft, hard] = loudest.map(|level| format!("−{:.0}", -level.ceil()));
    must_say(
        "formats.md",
        &format!(
            "at up to {soft} dBFS after a note of velocity 5, {:.0} dB under it, and {hard} after one of 110 (`electric`, \
             `baritone` and `drop-d`)",
            -nearest.ceil()
        ),
    );
}
