//! The promise: contours of fingers that glide where nothing keeps them on frets begin where those are, as all others do.

use low_action_tests::labelled::{RATE, list, number, render, sample, samples, song};
use low_action_tests::labelled_pitch::bend_at;
use low_action_tests::pitch::{cents, frequency_near};

const PROGRAM: &str = env!("CARGO_BIN_EXE_low-action-command");

/// The contour of a glide that another note breaks off begins where the finger is. (That goes at one speed, and contours slowly at first
/// and at the end, which is a tenth of its way beside that.)
#[test]
fn glides_that_are_broken_off_are_in_the_contour() {
    let on = |time, key| (time, [0x91, key, 100]);
    let off = |time, key| (time, [0x81, key, 0]);
    let far = [(0, [0xB1, 101, 0]), (0, [0xB1, 100, 0]), (0, [0xB1, 6, 12])];
    let slow = [(0, [0xB1, 68, 127]), (0, [0xB1, 65, 127]), (0, [0xB1, 5, 60])];
    let glides = [on(100, 50), (400, [0xE1, 0, 64 + 37])];
    for (what, song_of) in [
        ("by a slide", [&far[..], &slow, &glides, &[on(420, 52), off(1000, 52), off(1000, 50)]].concat()),
        ("by a stroke", [&far[..], &glides, &[on(420, 50), off(1000, 50)]].concat()),
        ("at its end", [&far[..], &glides, &[off(420, 50), on(425, 50), off(1000, 50)]].concat()),
    ] {
        let options = ["--instrument", "fretless-bass", "--variation", "0", "--input", "strings"];
        let played = render(PROGRAM, &song(&song_of), &options);
        let bends = list(&played.labels, "bends");
        let window = samples(0.04);
        let note = &played.notes()[1];
        let sound = played.string_of(note);
        let from = sample(note, "onset_sample") + samples(0.006);
        let mut farthest = 0.0_f64;
        for at in (from..from + samples(0.3)).step_by(samples(0.01)) {
            let bend = bend_at(bends, sample(note, "string"), at + window / 2);
            let pitch = number(note, "frequency") * (bend / 12.0).exp2();
            farthest = farthest.max(cents(frequency_near(&sound[at..at + window], RATE, pitch), pitch).abs());
        }
        println!("{what}: {farthest:.0} cents");
        assert!(farthest < 100.0, "{what}: {farthest} cents beside what sounds");
    }
}

/// Under a wheel that stands turned, or is turned between notes, a finger comes down where it is to be, and labels have it there from
/// the beginning, though the one before was elsewhere.
#[test]
fn contours_begin_where_fingers_come_down() {
    let on = |time, key| (time, [0x91, key, 100]);
    let off = |time, key| (time, [0x81, key, 0]);
    let far = [(0, [0xB1, 101, 0]), (0, [0xB1, 100, 0]), (0, [0xB1, 6, 12])];
    let turned = |time| (time, [0xE1, 0, 64 + 27]);
    let home = |time| (time, [0xE1, 0, 64]);
    let asked = 12.0 * 27.0 / 64.0;
    for (instrument, key) in [("fretless-bass", 45), ("electric", 64), ("lap-steel", 66)] {
        for (what, song_of, goes) in [
            ("from rest", vec![turned(50), on(100, key), off(600, key)], asked),
            (
                "turned between",
                vec![on(100, key), off(600, key), turned(610), on(640, key), off(1200, key)],
                asked,
            ),
            (
                "home between",
                vec![turned(50), on(100, key), off(600, key), home(610), on(640, key), off(1200, key)],
                0.0,
            ),
        ] {
            let options = ["--instrument", instrument, "--variation", "0", "--input", "strings"];
            let played = render(PROGRAM, &song(&[&far[..], &song_of].concat()), &options);
            let note = played.notes().last().expect("it is played");
            let onset = sample(note, "onset_sample") + samples(0.005);
            let bend = bend_at(list(&played.labels, "bends"), sample(note, "string"), onset);
            println!("{instrument} {what}: {bend:.2} for {goes:.2}");
            assert!((bend - goes).abs() < 0.1, "{instrument} {what}: {bend} semitones for {goes}");
        }
    }
}
