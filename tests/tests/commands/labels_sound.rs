//! The promise: what labels say of a note is what sounds. Its string begins at its onset, has its pitch, bent as they say,
//! and is silent where they say nothing.

use std::fs;
use std::path::Path;

use low_action_dsp::Setup;
use low_action_tests::command::Workplace;
use low_action_tests::labelled::{Labelled, RATE, held, list, number, render, sample, samples, song};
use low_action_tests::labelled_pitch::{bend_at, check_pitches};
use low_action_tests::pages::must_say;
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{amplitude, at_the_bridge, decibels, hertz, peak};
use serde_json::Value;

const PROGRAM: &str = env!("CARGO_BIN_EXE_low-action-command");

/// A song of the documentation.
fn documented(name: &str, options: &[&str]) -> Labelled {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name);
    render(PROGRAM, &fs::read(path).expect("readable"), options)
}

/// The first sample of a sound from `from` on that is more than so large.
fn first_above(sound: &[f32], from: usize, size: f64) -> usize {
    sound[from..].iter().position(|&sample| f64::from(sample.abs()) > size).map_or(usize::MAX, |n| from + n)
}

#[test]
fn a_string_begins_to_sound_at_its_onset() {
    // Open strings in a slow strum, which no finger touches before; then, when the hands that damped them have gone, one by one,
    // as late as they may be.
    let open = [40, 45, 50, 55, 59, 64];
    let mut messages = vec![(0, [0xB0, 21, 127])];
    messages.extend(open.map(|key| (0, [0x90, key, 90])));
    messages.extend(open.map(|key| (1000, [0x80, key, 0])));
    messages.push((2500, [0xB0, 21, 0]));
    messages.extend(
        (0..6).flat_map(|n| held(open[n], 30 + 15 * n as u8, 2500 + 300 * n as u32, 2700 + 300 * n as u32)),
    );
    let played = render(PROGRAM, &song(&messages), &["--variation", "1"]);
    assert_eq!(played.notes().len(), 12);
    let mut latest = 0;
    for note in played.notes() {
        let sound = played.string_of(note);
        let (asked, onset) = (sample(note, "asked_sample"), sample(note, "onset_sample"));
        let attack = peak(&sound[onset..onset + samples(0.03)]);
        let first = first_above(sound, asked, 0.01 * attack);
        // What is documented of plucks; nothing before, but for the ripple of the filters that bring strings to the rate.
        assert!((onset..onset + samples(0.003)).contains(&first), "{first}: {note}");
        latest = latest.max(onset - asked);
    }
    // The last string of the strum.
    assert!((samples(0.39)..samples(0.41)).contains(&latest), "{latest}");
}

#[test]
fn an_onset_is_right_to_a_few_samples() {
    let open = [40, 45, 50, 55, 59, 64];
    let messages: Vec<_> =
        open.iter().zip(0..).flat_map(|(&key, n)| held(key, 100, 100 + 500 * n, 400 + 500 * n)).collect();
    let played = render(PROGRAM, &song(&messages), &["--variation", "0.5"]);
    let pickup = &played.labels["setup"]["pickup"];
    assert_eq!(played.notes().len(), 6);
    for note in played.notes() {
        let string = &list(&played.labels, "strings")[sample(note, "string") - 1];
        let (length, onset) = (number(string, "length"), sample(note, "onset_sample"));
        // The wave runs from the pluck to the edge of the coil's field at 2Lf. What it brings grows as a power of time, and is
        // a ten-thousandth of its largest after some samples.
        let coil = length - number(pickup, "position");
        let way = (number(note, "stroke_position") - coil).abs() - 0.5 * number(pickup, "aperture");
        let travel = way.max(0.0) / (2.0 * length * number(string, "frequency")) * RATE;
        let sound = played.string_of(note);
        let attack = peak(&sound[onset..onset + samples(0.03)]);
        let first = first_above(sound, onset - samples(0.01), 1e-4 * attack) as f64 - onset as f64;
        assert!((travel..travel + 8.0).contains(&first), "{first} samples, {travel} on the way: {note}");
    }
}

#[test]
fn what_fingers_strike_begins_there_too() {
    // On strings that were silent: plucked behind a fret, and tapped.
    let mut messages = vec![];
    for (turn, key) in [41, 50, 57, 66].into_iter().enumerate() {
        let from = 1000 * turn as u32;
        messages.push((from, [0xB0, 22, 0]));
        messages.extend(held(key, 100, from, from + 200));
        messages.push((from + 500, [0xB0, 22, 7]));
        messages.extend(held(key + 3, 100, from + 500, from + 700));
    }
    let played = render(PROGRAM, &song(&messages), &["--variation", "1"]);
    let mut techniques = Vec::new();
    for note in played.notes() {
        let sound = played.string_of(note);
        let onset = sample(note, "onset_sample");
        let attack = peak(&sound[onset..onset + samples(0.03)]);
        let early = samples(0.001);
        let first = first_above(sound, onset.saturating_sub(3 * early), 0.02 * attack);
        // A finger may land up to a millisecond before its pluck. What is struck runs to the pickup: 0.7 and 5.5 ms at most.
        let late = if note["technique"] == "tap" { samples(0.0062) } else { samples(0.003) };
        assert!((onset.saturating_sub(early)..onset + late).contains(&first), "{first}: {note}");
        techniques.push(note["technique"].as_str().expect("a word"));
    }
    assert_eq!(techniques, ["pluck", "tap"].repeat(4));
}

#[test]
fn a_note_has_its_pitch() {
    let place = Workplace::new(PROGRAM);
    let setup = at_the_bridge(&Setup::shipped("school-guitar").expect("it comes with the program"));
    place.write("rigid.toml", setup.to_toml().expect("it can be written"));
    let rigid = place.path("rigid.toml").to_string_lossy().into_owned();
    // A cent for the quality, half a cent for hard plucks; the sixth partial of G3 is 2.3 sharp by stiffness.
    let songs = [
        ("gestures/hammer_and_pull.mid", &[][..], 3.0, 20),
        ("gestures/harmonics.mid", &[], 3.0, 15),
        // The hand moves to the eighth partial of a stopped D3, which stiffness (866 B n² cents, B = 5.9e-5) has 3.2 sharp.
        ("gestures/pinch.mid", &[], 4.7, 6),
        ("gestures/slide.mid", &[], 3.0, 7),
        // A capo behind the finger stretches the string, too: E2 by 4.8 cents, and a hard pluck by 2 more.
        ("gestures/capo_and_barre.mid", &["--instrument", "steel"], 7.0, 15),
        // The end of a string under a bar gives way.
        ("gestures/bar.mid", &["--instrument", "lap-steel"], 3.0, 4),
        ("gestures/too_many_notes.mid", &[], 3.0, 10),
        // As sharp as pressing makes it, and plucked hard. (A body puts fundamentals near its two lowest modes off by up to 12.)
        ("phrases/school-guitar.mid", &["--instrument", &rigid], 3.0, 9),
        ("phrases/school-guitar.mid", &["--instrument", "school-guitar"], 15.0, 9),
    ];
    for (name, options, most, least) in songs {
        let checked = check_pitches(name, &documented(name, options), most);
        assert!(checked >= least, "{name}: {checked} notes last");
    }
    // So does a capo press, at the second fret and the fourth.
    let over = |capo: u8, from: u32| {
        let open = [40, 45, 50, 55, 59, 64].map(|key| key + capo).into_iter().zip(0..);
        let notes = open.flat_map(move |(key, n)| held(key, 60, from + 1500 * n, from + 1500 * n + 700));
        [(from, [0xB0, 26, capo])].into_iter().chain(notes)
    };
    let messages: Vec<_> = over(2, 0).chain(over(4, 9_000)).collect();
    let played = render(PROGRAM, &song(&messages), &["--instrument", &rigid]);
    assert!(played.notes().iter().all(|note| note["stop"] == "capo"));
    assert_eq!(check_pitches("capo", &played, 3.0), 12);
}

#[test]
fn bends_are_what_is_heard_all_the_way() {
    // A wheel that goes up by two semitones in steps, and a vibrato.
    let mut messages = vec![(0, [0x90, 62, 100])];
    messages.extend((0..=32).map(|n: u8| (300 + 20 * u32::from(n), [0xE0, 0, 64 + (2 * n).min(63)])));
    messages.extend([(1500, [0x80, 62, 0]), (2000, [0xE0, 0, 64])]);
    messages.extend([(2100, [0xB0, 1, 127]), (2100, [0x90, 70, 100]), (3100, [0x80, 70, 0])]);
    let played = render(PROGRAM, &song(&messages), &[]);
    let bends = list(&played.labels, "bends");
    let window = samples(0.024);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for note in played.notes() {
        let sound = played.string_of(note);
        let (from, to) = (sample(note, "onset_sample") + samples(0.1), sample(note, "end_sample") - window);
        for at in (from..to).step_by(samples(0.005)) {
            let bend = bend_at(bends, sample(note, "string"), at);
            let pitch = number(note, "frequency") * (bend / 12.0).exp2();
            let heard = frequency_near(&sound[at - window / 2..at + window / 2], RATE, pitch);
            // 3 cents for where a bend ends, and as much again for a window in which it goes on.
            assert!(cents(heard, pitch).abs() < 6.0, "{} cents at {at}: {note}", cents(heard, pitch));
            range = [range[0].min(bend), range[1].max(bend)];
        }
    }
    assert!(range[0] < -0.4 && range[1] > 1.9, "{range:?}");
}

/// From its onset on, though the finger before had slid far away; and through a slide, whose frets go by as steps.
#[test]
fn fingers_that_slide_are_in_the_contour() {
    let far = [(0, [0xB0, 101, 0]), (0, [0xB0, 100, 0]), (0, [0xB0, 6, 12]), (0, [0xB0, 14, 3])];
    let slid = [(0, [0x90, 57, 100]), (300, [0xE0, 0, 64 + 27]), (1000, [0xE0, 0, 64])];
    let next = [(1000, [0x80, 57, 0]), (1000, [0x90, 60, 100]), (1500, [0x80, 60, 0])];
    let legato = [(3000, [0xB0, 68, 127]), (3000, [0xB0, 65, 127]), (3000, [0xB0, 5, 90])];
    let slides =
        [(3100, [0x90, 57, 100]), (3400, [0x90, 64, 100]), (4600, [0x80, 64, 0]), (5600, [0x80, 57, 0])];
    let played =
        render(PROGRAM, &song(&[&far[..], &slid, &next, &legato, &slides].concat()), &["--variation", "0"]);
    let bends = list(&played.labels, "bends");
    let window = samples(0.03);
    let mut largest = [0.0_f64; 2];
    for note in played.notes() {
        let sound = played.string_of(note);
        let (from, to) = (sample(note, "onset_sample") + samples(0.02), sample(note, "end_sample") - window);
        let arrives = match note["technique"].as_str() {
            Some("slide") => from + samples(number(note, "stroke_duration")),
            _ => from,
        };
        for at in (from..to).step_by(samples(0.01)) {
            let bend = bend_at(bends, sample(note, "string"), at);
            let pitch = number(note, "frequency") * (bend / 12.0).exp2();
            let off = cents(frequency_near(&sound[at..at + window], RATE, pitch), pitch).abs();
            // The wheel's, too, over five frets, which are 0.145 m, at 1 m/s.
            let slides = at < arrives || (samples(0.28)..samples(0.48)).contains(&at);
            largest[usize::from(slides)] = largest[usize::from(slides)].max(off);
        }
    }
    assert!(played.notes().iter().filter(|note| note["technique"] == "slide").count() == 2);
    // Steps are half a semitone off their mean, a string is on the last fret until it touches the next, and a window has both.
    assert!(largest[0] < 3.0 && largest[1] < 200.0, "{largest:?}");
}

/// The contour of a slide that another one breaks off begins where the finger is, and one that another stroke breaks off is over with it.
#[test]
fn slides_that_are_broken_off_are_in_the_contour() {
    let on = |time, key| (time, [0x90, key, 100]);
    let off = |time, key| (time, [0x80, key, 0]);
    // From note to note, far before the finger gets there; then back to one whose key is still down.
    let slow = [(0, [0xB0, 65, 127]), (0, [0xB0, 5, 100])];
    let slides = [on(100, 57), on(500, 64), off(520, 57), on(600, 60), off(620, 64)];
    let back = [on(1000, 67), off(1500, 67), off(2500, 60)];
    // By a wheel, on the way home.
    let far = [(0, [0xB0, 101, 0]), (0, [0xB0, 100, 0]), (0, [0xB0, 6, 12])];
    let wheel = [on(100, 69), (300, [0xE0, 0, 64 + 37]), (900, [0xE0, 0, 64]), on(905, 71), off(1500, 71)];
    for (song_of, options) in [
        ([&slow[..], &slides, &back].concat(), &["--variation", "0"][..]),
        ([&far[..], &wheel].concat(), &["--variation", "0", "--input", "strings"]),
    ] {
        let played = render(PROGRAM, &song(&song_of), options);
        let bends = list(&played.labels, "bends");
        let window = samples(0.06);
        let mut farthest = 0.0_f64;
        for (note, next) in played.notes().iter().zip(played.notes().iter().skip(1).map(Some).chain([None])) {
            let sound = played.string_of(note);
            let to = next.map_or(sample(note, "end_sample"), |next| sample(next, "onset_sample"));
            let from = sample(note, "onset_sample") + samples(0.006);
            for at in (from..to.saturating_sub(window)).step_by(samples(0.01)) {
                let bend = bend_at(bends, sample(note, "string"), at + window / 2);
                let contour = number(note, "pitch") + bend;
                // Frets go by as steps: which of them it is is heard, if not exactly.
                let size = |key: &f64| amplitude(&sound[at..at + window], RATE, hertz(*key));
                let keys = (-8..=8).map(|beside| (contour + f64::from(beside)).round());
                let loudest = keys.max_by(|a, b| size(a).total_cmp(&size(b))).expect("there are some");
                farthest = farthest.max((loudest - contour).abs());
            }
        }
        println!("{options:?}: {farthest:.2} semitones");
        assert!(farthest < 2.0, "{options:?}: {farthest} semitones beside what sounds");
    }
}

#[test]
fn strings_are_silent_where_labels_say_nothing() {
    let mut messages: Vec<(u32, [u8; 3])> = Vec::new();
    for (turn, key) in [40, 50, 57, 64, 43, 55, 70].into_iter().enumerate() {
        let from = 700 * turn as u32;
        messages.extend(held(key, 100, from, from + 300));
    }
    let played = render(PROGRAM, &song(&messages), &["--tail", "2"]);
    assert_eq!(played.notes().len(), 7);
    for (index, sound) in played.strings.iter().enumerate() {
        let own: Vec<&Value> =
            played.notes().iter().filter(|note| sample(note, "string") == index + 1).collect();
        // Filters ripple a little ahead of what happens.
        let mut loudest = 1e-4_f64;
        let mut quiet = 0;
        for note in own {
            let (asked, end) = (sample(note, "asked_sample"), sample(note, "end_sample"));
            // Nothing at all before the first, and what hands that leave make is 60 dB below 0.4 s after the end.
            let before = if quiet < asked { peak(&sound[quiet..asked]) } else { 0.0 };
            assert!(before <= 1e-3 * loudest, "{before} beside {loudest} before {note}");
            loudest = loudest.max(peak(&sound[asked..end]));
            quiet = end + samples(0.4);
        }
        let after = if quiet == 0 { peak(sound) } else { peak(&sound[quiet..]) };
        assert!(after <= 1e-3 * loudest, "{after} beside {loudest} at the end of string {}", index + 1);
    }
}

/// Over a body they sing along with the others, as loud as the page says and no louder; without one they are silent.
#[test]
fn strings_that_nobody_plays_sing_along_over_a_body() {
    // All open strings but G3, and that between their strokes.
    let others = [40, 45, 50, 59, 64];
    let mut messages: Vec<_> = [0, 2000]
        .iter()
        .flat_map(|&from| others.map(|key| held(key, 100, from, from + 900)))
        .flatten()
        .collect();
    messages.extend(held(55, 100, 1200, 1400));
    messages.sort_by_key(|&(time, _)| time);
    let mut loudest = Vec::new();
    for (instrument, range) in
        [("steel", -40.0..-30.0), ("classical", -40.0..-30.0), ("electric", f64::NEG_INFINITY..-140.0)]
    {
        let played = render(PROGRAM, &song(&messages), &["--instrument", instrument, "--tail", "none"]);
        let own: Vec<&Value> = played.notes().iter().filter(|note| sample(note, "string") == 3).collect();
        let [note] = own.as_slice() else { panic!("{own:?}") };
        let sound = played.string_of(note);
        let before = decibels(peak(&sound[..sample(note, "asked_sample")]));
        let after = decibels(peak(&sound[sample(note, "end_sample") + samples(0.4)..]));
        println!("{instrument}: {before:.1} dBFS before, {after:.1} dBFS after");
        assert!(range.contains(&before), "{instrument}: {before} dBFS before its note");
        assert!(after < range.end.max(-60.0), "{instrument}: {after} dBFS after it");
        // (Rounded up, as what it is at most.)
        loudest.push([before, after].map(|level| format!("−{:.0}", -level.ceil())));
    }
    let [[steel, steel_after], [classical, classical_after], _] = &loudest[..] else { panic!("{loudest:?}") };
    let said = format!(
        "by up to {steel} dBFS on `steel` and {classical} on `classical` before that note, and by up to {steel_after} and \
         {classical_after} from 0.4 s after its end on"
    );
    must_say("formats.md", &said);
}

#[test]
fn what_is_called_off_has_no_label() {
    // All sound off while the hand is on its way over open strings.
    let mut messages = vec![(0, [0xB0, 21, 127])];
    messages.extend([40, 45, 50, 55, 59, 64].map(|key| (0, [0x90, key, 90])));
    messages.push((200, [0xB0, 120, 0]));
    let played = render(PROGRAM, &song(&messages), &[]);
    for (index, sound) in played.strings.iter().enumerate() {
        let labels = played.notes().iter().filter(|note| sample(note, "string") == index + 1).count();
        assert_eq!(
            labels == 1,
            peak(sound) > 1e-3,
            "string {}: {labels} labels, peak {}",
            index + 1,
            peak(sound)
        );
    }
    assert_eq!(played.notes().len(), 3, "0, 80 and 160 ms");
    assert_eq!(played.labels["compromises"]["left_out"], 3);
}
