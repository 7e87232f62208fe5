//! The promise: labels have the pitch of what sounds however firmly fingers are set to press, and wherever the arm is set to stand.

use low_action_dsp::Setup;
use low_action_tests::command::Workplace;
use low_action_tests::labelled::{Labelled, held, list, number, render, sample, samples, song};
use low_action_tests::labelled_pitch::{bend_at, check_pitches};
use low_action_tests::pages::must_say;
use low_action_tests::pitch::cents;
use low_action_tests::stage::at_the_bridge;

const PROGRAM: &str = env!("CARGO_BIN_EXE_low-action-command");

/// Frets from the first to where the board ends.
const FRETS: [u8; 6] = [0, 1, 5, 9, 14, 20];

/// All strings of a guitar on these frets, struck so hard, with such settings.
fn set(instrument: &str, velocity: u8, settings: &[&str]) -> Labelled {
    let open = [64, 59, 55, 50, 45, 40].into_iter().zip(0..);
    let notes = FRETS.into_iter().zip(0..).flat_map(|(fret, turn)| {
        open.clone().flat_map(move |(key, channel)| {
            let [on, off] = held(key + fret, velocity, 1100 * turn, 1100 * turn + 800);
            [on, off].map(|(time, [status, key, value])| (time, [status | channel, key, value]))
        })
    });
    let mut messages: Vec<_> = notes.collect();
    messages.sort_by_key(|&(time, _)| time);
    let mut options = vec!["--instrument", instrument, "--input", "strings", "--variation", "0"];
    options.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    render(PROGRAM, &song(&messages), &options)
}

#[test]
fn frequencies_are_those_of_the_force_that_is_set() {
    let usual = set("electric", 60, &[]);
    // The farthest that labels are from those of the usual force, cents: what pressing stretches.
    for (force, least) in [("finger_force=60", 4.0), ("finger_force=150", 8.0), ("finger_force=400", 50.0)] {
        let played = set("electric", 60, &[force]);
        // A cent for the quality; half a newton more or less is otherwise 5.
        assert_eq!(check_pitches(force, &played, 1.0), 36);
        let off = |(one, other)| cents(number(one, "frequency"), number(other, "frequency")).abs();
        let farthest = played.notes().iter().zip(usual.notes()).map(off).fold(0.0, f64::max);
        assert!(farthest > least, "{force}: {farthest} cents");
    }
}

#[test]
fn bends_have_what_the_arm_does_to_a_string_that_is_stopped() {
    // Slack strings swing farther, and are the sharper for it: at −12 a quarter of the tension is left, and at velocity 60 up to 13
    // cents come of that, 4 at 30 and 2 at 20.
    for (settings, most) in [
        (&["tremolo_arm=3"][..], 1.0),
        (&["tremolo_arm=-2"], 1.0),
        (&["tremolo_arm=-6"], 2.0),
        (&["tremolo_arm=-12"], 5.0),
        (&["tremolo_arm=-3.5", "finger_force=250"], 1.0),
    ] {
        let played = set("electric", 30, settings);
        assert_eq!(check_pitches(&settings.join(" "), &played, most), 36);
    }
}

/// The grid of an instrument has room for its largest bend, and for some of what stretches strings besides.
#[test]
fn full_bends_are_short_by_what_the_grid_does_not_bear() {
    let short = |(instrument, most): (&str, f64)| {
        let played = set(instrument, 30, &[&format!("tremolo_arm={most}")]);
        let reached = played.notes().iter().map(|note| {
            let sounds = sample(note, "onset_sample") + samples(0.1);
            bend_at(list(&played.labels, "bends"), sample(note, "string"), sounds)
        });
        100.0 * (most - reached.fold(f64::INFINITY, f64::min))
    };
    let others =
        [("electric", 3.0), ("steel", 2.0), ("sitar", 3.0)].map(short).into_iter().fold(0.0, f64::max);
    let school_guitar = short(("school-guitar", 2.0));
    must_say(
        "formats.md",
        &format!(
            "up to {:.0} cents below a full `max_bend`, {:.0} on a `school-guitar`",
            others.ceil(),
            school_guitar.ceil()
        ),
    );
}

/// Hands take the frets of a neck without compensation for such as need none.
#[test]
fn so_they_do_where_frets_stand_in_equal_temperament() {
    let place = Workplace::new(PROGRAM);
    let setup = at_the_bridge(&Setup::shipped("school-guitar").expect("it comes with the program"));
    place.write("rigid.toml", setup.to_toml().expect("it can be written"));
    let rigid = place.path("rigid.toml").to_string_lossy().into_owned();
    for setting in ["finger_force=150", "tremolo_arm=2", "tremolo_arm=-4"] {
        assert_eq!(check_pitches(setting, &set(&rigid, 30, &[setting]), 3.0), 36);
    }
}
