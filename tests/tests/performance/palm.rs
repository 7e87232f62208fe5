//! The promise: a palm mutes every partial, and whatever the thumb of its hand does beside it. It is back when a pinch has been heard and a slap
//! has bounced off, and so is one that is laid on meanwhile. It waits on the strings, so that the first note of a riff is as short
//! as the others. An open string is as loud after a stopped one as after itself.

use low_action::controls::Touching;
use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{Neck, control, note, of_string};
use low_action_tests::stage::{Stage, amplitude, at, cc, decibels, hertz, level, off, on, peak};

const RATE: f64 = 48_000.0;
/// The slot of palm and thumb.
const RIGHT_HAND: usize = 4;

/// How far a sound has fallen from its first 80 ms to 0.4 s later, dB.
fn fallen(events: &[(f64, PlayerEvent)], start: f64) -> f64 {
    let sound = &Stage::alone("electric", 4).play(events, start + 0.6).strings[0];
    let level = |from, to| decibels(peak(&sound[at(start + from)..at(start + to)]));
    level(0.0, 0.08) - level(0.45, 0.6)
}

#[test]
fn the_palm_comes_back_after_the_thumb() {
    for stroke in [4, 6] {
        let note = [(0.0, cc(22, stroke)), (0.0, on(45, 110))];
        let bare = fallen(&note, 0.0);
        let muted = fallen(&[&[(0.0, cc(20, 100))], &note[..]].concat(), 0.0);
        println!("stroke {stroke}: {muted:.1} dB under the palm, {bare:.1} dB without");
        // 85 dB more of a slap, 106 of a pinch.
        assert!(muted > bare + 70.0, "stroke {stroke}: {muted} dB under the palm, {bare} dB without");
        // The same for one that is laid on while the thumb is there.
        let later = fallen(&[&note[..], &[(0.003, cc(20, 100))]].concat(), 0.0);
        println!("stroke {stroke}: {later:.1} dB under one that comes later");
        assert!(later > bare + 70.0, "stroke {stroke}: {later} dB, {bare} dB without");
    }
}

#[test]
fn a_palm_laid_on_during_a_graze_stays() {
    for moved in [0.01, 0.03] {
        let events = [(0.0, cc(22, 6)), (0.0, cc(20, 40)), (0.0, on(45, 110)), (moved, cc(20, 100))];
        let played = Stage::alone("electric", 4).play(&events, 0.5);
        let any = |does: fn(&Gesture) -> bool| played.gestures.iter().any(|timed| does(&timed.gesture));
        let laid = any(|gesture| matches!(gesture, Gesture::Place { finger: RIGHT_HAND, .. }));
        let lifted = any(|gesture| matches!(gesture, Gesture::Lift { finger: RIGHT_HAND, .. }));
        assert!(laid && !lifted, "moved after {moved} s: laid on {laid}, lifted {lifted}");
    }
}

/// (A palm that touched the string at one place left partials with a node there 18 to 35 dB below the stroke.)
#[test]
fn no_partial_rings_on_under_a_palm() {
    for (setup, string, key) in [("drop-d", 3, 52), ("steel", 4, 45), ("electric", 5, 40), ("bass", 3, 33)] {
        let mut stage = Stage::alone(setup, string);
        for palm in [76, 100, 127] {
            let events = [(0.0, cc(20, palm)), (0.2, on(key, 90))];
            let sound = &stage.play(&events, 0.95).strings[0];
            let stroke = level(&sound[at(0.205)..at(0.3)]);
            // All that rings for so long has a peak so wide.
            let step = 1.0 / 0.5;
            let above = |n: u32| 3.5 * hertz(f64::from(key)) + step * f64::from(n);
            let rings = |n: u32| decibels(amplitude(&sound[at(0.45)..at(0.95)], RATE, above(n)));
            let loudest = (0..1500).map(rings).fold(f64::NEG_INFINITY, f64::max);
            println!("{setup} {string}, palm {palm}: {:.1} dB below the stroke", stroke - loudest);
            // 56 dB below it or more on the bass, 90 on guitars.
            assert!(
                loudest < stroke - 54.0,
                "{setup} {string}, palm {palm}: a partial of {loudest} dB after a stroke of {stroke} dB"
            );
        }
    }
}

/// Each stroke of a tremolo finds the palm where it was.
#[test]
fn a_tremolo_of_pinches_or_slaps_stays_muted() {
    for stroke in [4, 6] {
        let tremolo = [(0.0, cc(22, stroke)), (0.0, cc(25, 30)), (0.0, on(45, 110)), (0.45, cc(25, 0))];
        let last = 3.0 / (3.0 + 17.0 * 30.0 / 127.0);
        let bare = fallen(&tremolo, last);
        let muted = fallen(&[&[(0.0, cc(20, 100))], &tremolo[..]].concat(), last);
        println!("stroke {stroke}: {muted:.1} dB under the palm, {bare:.1} dB without");
        assert!(muted > bare + 70.0, "stroke {stroke}: {muted} dB under the palm, {bare} dB without");
    }
}

/// (A palm that came with the stroke alone had yet to sink in: the first note after each rest was 2 to 6 dB louder.)
#[test]
fn the_first_note_under_a_palm_is_as_loud_as_the_others() {
    for (setup, string, key) in
        [("drop-d", 5, 38), ("electric", 5, 40), ("electric", 4, 47), ("steel", 5, 43), ("bass", 3, 28)]
    {
        let mut stage = Stage::alone(setup, string);
        for palm in [50, 80, 110] {
            for (lead, rest) in [(0.1, 0.2), (0.45, 1.5), (0.45, 2.5)] {
                let begins = |n: usize| lead + n as f64 * rest;
                let mut events = vec![(0.0, cc(20, palm))];
                for n in 0..3 {
                    events.push((begins(n), on(key, 100)));
                    events.push((begins(n) + 0.15, off(key)));
                }
                let sound = &stage.play(&events, begins(3)).strings[0];
                let heard = [0, 1, 2].map(|n| level(&sound[at(begins(n))..at(begins(n) + 0.06)]));
                let louder = [heard[0] - heard[2], heard[1] - heard[2]];
                assert!(
                    louder.iter().all(|louder| louder.abs() < 2.0),
                    "{setup} {string}, palm {palm}, {rest} s apart: the first two are {louder:?} dB louder than the third"
                );
            }
        }
    }
}

/// A finger that leaves for the open string lets that up, which is a pluck of its own, and the palm is on what is struck, not on that.
/// (Where it left as fast as without a palm the open string was 4 to 7 dB louder.)
#[test]
fn an_open_string_under_a_palm_is_as_loud_after_a_stopped_one() {
    for (setup, string, open) in [("drop-d", 5, 38), ("electric", 5, 40), ("steel", 5, 40), ("bass", 3, 28)] {
        let mut stage = Stage::alone(setup, string);
        for palm in [40, 76, 100, 127] {
            for velocity in [70, 100] {
                let mut heard = |before: u8| {
                    let events = [
                        (0.0, cc(20, palm)),
                        (0.05, on(open + before, velocity)),
                        (0.195, off(open + before)),
                        (0.2, on(open, velocity)),
                    ];
                    level(&stage.play(&events, 0.34).strings[0][at(0.2)..])
                };
                let after_itself = heard(0);
                for fret in [3, 5, 12] {
                    let louder = heard(fret) - after_itself;
                    println!("{setup}, palm {palm}, velocity {velocity}, after fret {fret}: {louder:.1} dB");
                    assert!(
                        (-2.0..4.0).contains(&louder),
                        "{setup}, palm {palm}, velocity {velocity}: {louder} dB louder after fret {fret}"
                    );
                }
            }
        }
    }
}

/// So is one that is asked for again when it has waited long enough and gone.
#[test]
fn a_palm_that_has_gone_comes_back_when_it_is_asked_for_again() {
    let keyswitches = [(0.0, cc(27, 1)), (0.0, on(4, 90)), (0.1, off(4)), (4.0, on(4, 90)), (4.1, off(4))];
    for events in [&[(0.0, cc(20, 80)), (4.0, cc(20, 80))][..], &keyswitches] {
        let played = Stage::alone("electric", 5).play(events, 4.2);
        let laid = played.gestures.iter().filter(|timed| match timed.gesture {
            Gesture::Place { finger, .. } => finger == RIGHT_HAND,
            _ => false,
        });
        assert_eq!(laid.map(|timed| timed.time).collect::<Vec<_>>(), [0, at(4.0) as u64]);
    }
}

/// One that is laid on while the hands of the note before leave, too: 0.4 to 0.6 s after the end of an open string's, 0.9 to 1.1 s
/// after that of a stopped one's. It comes all the same.
#[test]
fn a_palm_laid_on_while_hands_leave_goes() {
    for (key, leaving) in [(45, 0.4), (47, 0.9)] {
        for later in [-0.05, 0.05, 0.1, 0.15, 0.25] {
            let laid = 0.1 + leaving + later;
            let events = [(0.0, on(key, 90)), (0.1, off(key)), (laid, cc(20, 1))];
            let [mut came, mut stays] = [false; 2];
            Stage::alone("electric", 4).watch(&events, 4.5, |time, instrument| {
                let fingers = instrument.state(0).fingers();
                came |= (laid..4.2).contains(&time) && fingers[RIGHT_HAND].is_some();
                stays |= time > 4.2 && fingers.iter().any(Option::is_some);
            });
            assert!(came && !stays, "key {key}, laid on at {laid} s: it came {came}, stays {stays}");
        }
    }
}

/// How hard the palm presses the string, N: what the hands have told it last by some time.
fn pressed(gestures: &[TimedGesture], time: f64) -> f64 {
    let mut force = 0.0;
    for timed in gestures.iter().filter(|timed| timed.time <= at(time) as u64) {
        match timed.gesture {
            Gesture::Press { finger: RIGHT_HAND, force: now, .. } => force = now,
            Gesture::Lift { finger: RIGHT_HAND, .. } => force = 0.0,
            _ => {}
        }
    }
    force
}

/// One that a keyswitch lays on is on notes that begin later: also on those that are hammered, pulled or slid, and not on the one
/// before when it comes back. Controller 20 is heard by all.
#[test]
fn a_keyswitch_lays_the_palm_on_connected_notes_and_not_on_those_that_come_back() {
    for (first, second) in [(60, 62), (62, 60), (62, 59)] {
        for slides in [0, 127] {
            // One note, another connected to it and let go of, and a keyswitch (36: no palm, 39: palm) between them.
            let with = |palm: u8, switch: u8| {
                [
                    (0.0, cc(27, 36)),
                    (0.0, cc(20, palm)),
                    (0.1, on(first, 90)),
                    (0.2, on(switch, 90)),
                    (0.2, off(switch)),
                    (0.3, cc(68, 127)),
                    (0.3, cc(65, slides)),
                    (0.4, on(second, 90)),
                    (0.7, off(second)),
                ]
            };
            let mut stage = Stage::alone("electric", 1);
            let mut palms = |events: &[(f64, PlayerEvent)]| {
                let found = stage.play(events, 1.0).gestures;
                [0.3, 0.6, 0.9].map(|time| pressed(&found, time))
            };
            let found = palms(&with(0, 39));
            let is_right = found[0] == 0.0 && found[1] > 0.0 && found[2] == 0.0;
            assert!(is_right, "{first} to {second}, slides {slides}: {found:?} N");
            // Off again by the next keyswitch, for the note after it alone.
            let found = palms(&with(80, 36));
            let is_right = found[0] > 0.0 && found[1] == 0.0 && found[2] == found[0];
            assert!(is_right, "{first} to {second}, slides {slides}: {found:?} N");
            let found = palms(&[&with(0, 39)[..8], &[(0.5, cc(20, 100)), (0.7, off(second))]].concat());
            assert!(found[1] > 0.0 && found[1] == found[2], "{found:?} N");
        }
    }
}

/// A member of MPE that is hammered has its own.
#[test]
fn a_member_of_mpe_has_its_own_palm_where_it_is_hammered() {
    let legato = [(0, control(0, 68, 127)), (0, control(2, 20, 100))];
    let notes = [(0, note(1, 60)), (24_000, note(2, 62))];
    let up = [(48_000, PlayerEvent::NoteOff { channel: 2, key: 62 }), (96_000, control(1, 7, 100))];
    let events = [&legato[..], &notes, &up].concat();
    let found = Neck::of("electric").told(InputMode::Mpe, &Touching::new(0.0, 2.0), &events);
    let string = |g: &&TimedGesture| matches!(g.gesture, Gesture::Pluck { .. });
    let string = found.iter().find(string).expect("it is plucked").string;
    let palms = [0.4, 0.9, 1.5].map(|time| pressed(&of_string(&found, string), time));
    assert!(palms[0] == 0.0 && palms[1] > 0.0 && palms[2] == 0.0, "{palms:?} N");
}

/// And it goes from strings that nobody plays.
#[test]
fn a_palm_does_not_wait_for_ever() {
    for events in [vec![(0.0, cc(20, 80))], vec![(0.0, cc(20, 80)), (0.5, on(40, 100)), (0.7, off(40))]] {
        let mut stage = Stage::alone("electric", 5);
        let mut there = [false; 2];
        stage.watch(&events, 4.5, |time, instrument| {
            let fingers = instrument.state(0).fingers().iter().flatten().count();
            there[usize::from(time > 4.2)] |= fingers > 0;
        });
        assert_eq!(there, [true, false]);
    }
}
