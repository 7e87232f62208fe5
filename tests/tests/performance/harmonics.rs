//! The promise: a harmonic is one whatever stops its string, and wherever a wheel has that. A light finger is at the node of what
//! sounds from the beginning, and goes with the finger that slides.

use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, amplitude, at, cc, decibels, hertz, octave, on, wheel};

const RATE: f64 = 48_000.0;
/// When the note begins, s, and what of it is heard then, from and to.
const START: f64 = 0.1;
const HEARD: [f64; 2] = [0.3, 0.6];

/// What is heard of a harmonic on a string alone, so many semitones over the open string, under a wheel that goes somewhere
/// (semitones) so many seconds after its note began.
fn heard(stage: &mut Stage, over: i32, [turned, semitones]: [f64; 2]) -> Vec<f32> {
    let key = (stage.instrument.geometry(0).open_pitch.round() as i32 + over) as u8;
    let note = [(0.0, cc(23, 1)), (START, on(key, 100)), (START + turned, wheel(semitones))];
    let mut events = [&octave()[..], &note].concat();
    events.sort_by(|one, other| one.0.total_cmp(&other.0));
    let [from, to] = HEARD.map(|time| START + time);
    stage.play(&events, to).strings.swap_remove(0)[at(from)..].to_vec()
}

/// Levels of a sound, dB: at a pitch so many semitones over the open string, and the loudest of what is half and one and a half times
/// as high. And how far off that is, cents.
fn levels(stage: &Stage, sound: &[f32], over: f64) -> [f64; 3] {
    let asked = hertz(stage.instrument.geometry(0).open_pitch + over);
    let pitch = frequency_near(sound, RATE, asked);
    let [half, itself, more] = [0.5, 1.0, 1.5].map(|times| decibels(amplitude(sound, RATE, times * pitch)));
    [itself, half.max(more), cents(pitch, asked)]
}

/// Past the reach of pulling: 1 semitone on `classical`, 0.8 on `ukulele`, 3 on `electric`; and where nothing keeps what stops a string
/// on frets.
const SLID: [(&str, usize, i32, f64); 9] = [
    ("classical", 0, 18, 2.0),
    ("classical", 0, 20, -2.0),
    ("classical", 2, 15, 2.0),
    ("ukulele", 1, 15, 2.0),
    ("electric", 1, 15, 5.0),
    ("electric", 4, 20, -5.0),
    ("steel", 3, 15, 5.0),
    ("fretless-bass", 1, 15, 2.0),
    ("lap-steel", 1, 15, 2.0),
];

/// As loud as between those at the frets beside it. (It was 1.5 dB softer: its finger came down as at its fret.)
#[test]
fn one_between_two_frets_is_as_loud_as_they_are() {
    let mut stage = Stage::alone("fretless-bass", 2);
    for over in [3, 5] {
        let mut level = |over: i32, wheel: f64| {
            let sound = heard(&mut stage, over, [-0.05, wheel]);
            levels(&stage, &sound, f64::from(over) + wheel)[0]
        };
        let [below, between, above] = [level(over, 0.0), level(over, 0.5), level(over + 1, 0.0)];
        println!("{over}: {below:.2}, {between:.2}, {above:.2} dB");
        assert!((between - 0.5 * (below + above)).abs() < 0.7, "{over}: {below}, {between}, {above} dB");
    }
}

/// (On `classical` it was nearly mute, and beside its pitch by a semitone.)
#[test]
fn it_begins_where_a_wheel_has_it() {
    for (setup, string, over, wheel) in SLID {
        let mut stage = Stage::alone(setup, string);
        let there = f64::from(over) + wheel;
        let alone = heard(&mut stage, over + wheel as i32, [0.0, 0.0]);
        let bent = heard(&mut stage, over, [-0.05, wheel]);
        let [[usual, ..], [level, others, off]] = [&alone, &bent].map(|sound| levels(&stage, sound, there));
        let what = format!("{setup} {string}, {over} and {wheel}");
        println!("{what}: {level:.1} dB for {usual:.1}, {others:.1}, {off:.1} cents");
        assert!((level - usual).abs() < 1.0, "{what}: {level} dB for {usual}");
        assert!(others < level - 30.0, "{what}: {others} of {level} dB");
        assert!(off.abs() < 6.0, "{what}: {off} cents");
    }
}

/// Where an open string has it as a partial, too: it would be as far off as pulling falls short.
#[test]
fn so_does_that_of_an_open_string() {
    for (setup, string, over) in
        [("classical", 0, 12), ("classical", 3, 19), ("ukulele", 1, 12), ("ukulele", 1, 24)]
    {
        let mut stage = Stage::alone(setup, string);
        let bent = heard(&mut stage, over, [-0.05, 2.0]);
        let [level, _, off] = levels(&stage, &bent, f64::from(over) + 2.0);
        println!("{setup} {string}, {over}: {level:.1} dB, {off:.1} cents");
        assert!(level > -60.0 && off.abs() < 10.0, "{setup} {string}, {over}: {level} dB, {off} cents");
    }
}

/// It falls no faster under its light finger than without: that is half way from the fret, and not from what presses the string to
/// it.
#[test]
fn a_light_finger_lets_it_through_over_a_fret() {
    for (setup, string, over) in
        [("classical", 0, 14), ("classical", 0, 20), ("steel", 4, 14), ("ukulele", 1, 14)]
    {
        let mut stage = Stage::alone(setup, string);
        let key = (stage.instrument.geometry(0).open_pitch.round() as i32 + over) as u8;
        let sound = &stage.play(&[(0.0, cc(23, 1)), (0.0, on(key, 100))], 0.4).strings[0];
        let level =
            |from| decibels(amplitude(&sound[at(from)..at(from + 0.04)], RATE, hertz(f64::from(key))));
        let falls = |from| (level(from) - level(from + 0.04)) / 0.04;
        let [touched, free] = [falls(0.03), falls(0.3)];
        println!("{setup} {string}, {over}: {touched:.1} dB/s, {free:.1} dB/s");
        assert!(touched < free + 10.0, "{setup} {string}, {over}: {touched} dB/s, {free} dB/s");
    }
}

/// The light finger goes with it. (What frets that go by after it has gone make of the string is heard, as under any finger.)
#[test]
fn it_slides_with_its_finger() {
    for (setup, string, over, wheel) in SLID {
        let mut stage = Stage::alone(setup, string);
        let alone = heard(&mut stage, over, [0.0, 0.0]);
        let [usual, ..] = levels(&stage, &alone, f64::from(over));
        for turned in [0.005, 0.02, 0.06] {
            let sound = heard(&mut stage, over, [turned, wheel]);
            let [level, others, off] = levels(&stage, &sound, f64::from(over) + wheel);
            let what = format!("{setup} {string}, {over} and {wheel} after {turned} s");
            println!("{what}: {level:.1} dB for {usual:.1}, {others:.1}, {off:.1} cents");
            assert!(level > usual - 12.0, "{what}: {level} dB for {usual}");
            assert!(others < level - 10.0, "{what}: {others} of {level} dB");
            assert!(off.abs() < 6.0, "{what}: {off} cents");
        }
    }
}
