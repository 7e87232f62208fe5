//! The promise: notes that overlap on one string are connected as a left hand does it. A hammer sounds
//! without a pluck and the louder the faster it comes, a pull-off gives the note behind it, a slide crosses
//! each semitone where the fret is; and each gives way to a new pluck where a hand would not reach.

use low_action::performance::PlayerEvent;
use low_action_dsp::{FINGERS_PER_STRING, Gesture, Setup, TimedGesture};
use low_action_tests::hands::count_plucks as plucks;
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{
    Stage, amplitude, at, cc, decibels, hertz, level, octave, off, on, peak, wheel,
};

const RATE: f64 = 48_000.0;

/// Set-up, string, its open key.
const STRINGS: [(&str, usize, u8); 5] =
    [("electric", 0, 64), ("electric", 2, 55), ("electric", 5, 40), ("classical", 4, 45), ("bass", 3, 28)];

#[test]
fn a_finger_that_taps_sounds_by_its_own_speed() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let mut before = 0.0;
        for velocity in [20, 64, 100, 127] {
            let played = stage.play(&[(0.0, cc(22, 7)), (0.0, on(open + 7, velocity))], 0.8);
            assert_eq!(plucks(&played.gestures), 0);
            let sound = &played.strings[0];
            let loud = peak(&sound[..at(0.3)]);
            // A string that is set down in less than half a period moves as far however fast that is: its first partial has at most
            // π/2 times what it has at half a period, which is 3.9 dB for all that velocities above that are louder by.
            let louder = if velocity <= 64 { 1.2 } else { 1.1 };
            assert!(loud > louder * before, "{setup} {string} at {velocity}: {loud} after {before}");
            assert!(
                off_key(&sound[at(0.2)..], f64::from(open + 7)).abs() < 3.0,
                "{setup} {string} at {velocity}"
            );
            before = loud;
        }
    }
}

/// The finger of the tap before has left with its key: the string it held down could not be struck.
#[test]
fn a_string_tapped_again_sounds_as_it_did() {
    for ((setup, string, open), velocity) in
        STRINGS.into_iter().flat_map(|string| [(string, 40), (string, 100)])
    {
        for (fret, other) in [(7, 7), (7, 5), (5, 8)] {
            let note = |start, key| [(start, on(open + key, velocity)), (start + 0.25, off(open + key))];
            let events =
                [&[(0.0, cc(22, 7))], &note(0.0, fret)[..], &note(0.5, other), &note(1.0, fret)].concat();
            let sound = &Stage::alone(setup, string).play(&events, 1.5).strings[0];
            let level = |start| {
                let heard = &sound[at(start + 0.05)..at(start + 0.25)];
                decibels(amplitude(heard, RATE, hertz(f64::from(open + fret))))
            };
            let [first, again] = [0.0, 1.0].map(level);
            let difference = again - first;
            assert!(
                difference.abs() < 1.0,
                "{setup} {string} at {fret}, velocity {velocity}: {difference} dB"
            );
        }
    }
}

/// The wave has yet to travel to the pickup; the string under the finger moves at once.
#[test]
fn a_tap_moves_the_string_within_three_milliseconds() {
    for (setup, string, open) in STRINGS {
        for velocity in [1, 127] {
            let mut first = f64::NAN;
            let mut stage = Stage::alone(setup, string);
            stage.watch(&[(0.01, cc(22, 7)), (0.01, on(open + 5, velocity))], 0.05, |time, instrument| {
                let state = instrument.state(0);
                let moves = state.displacement().any(|u| u.abs() > 1e-6);
                if moves && first.is_nan() {
                    first = time - 0.01;
                }
            });
            assert!(first < 0.003, "{setup} {string} at {velocity}: {first} s");
        }
    }
}

#[test]
fn a_hammer_and_a_pull_connect_two_notes() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let events = |velocity| {
            [(0.0, cc(68, 127)), (0.0, on(open + 5, 90)), (0.5, on(open + 7, velocity)), (1.0, off(open + 7))]
        };
        let [soft, hard] = [40, 127].map(|velocity| stage.play(&events(velocity), 1.6));
        for played in [&soft, &hard] {
            let hammered: Vec<&TimedGesture> =
                played.gestures.iter().filter(|g| g.time > 0 && g.time < 48_000).collect();
            assert!(hammered.iter().all(|g| !matches!(g.gesture, Gesture::Pluck { .. })), "{hammered:?}");
            let sound = &played.strings[0];
            for (from, to, key) in [(0.2, 0.5, 5), (0.65, 1.0, 7), (1.1, 1.6, 5)] {
                let cents = off_key(&sound[at(from)..at(to)], f64::from(open + key));
                assert!(cents.abs() < 4.0, "{setup} {string} from {from} s: {cents} cents");
            }
        }
        let difference = |sound: &[f32]| -> f64 {
            sound.windows(2).map(|pair| f64::from(pair[1] - pair[0]).powi(2)).sum()
        };
        // The finger that pulls off plucks, and it is heard.
        let pulled = &hard.strings[0];
        let [before, after] = [0.95, 1.0].map(|from| difference(&pulled[at(from)..at(from + 0.05)]));
        assert!(after > 1.2 * before, "{setup} {string}: {}", after / before);
        let [soft, hard] = [&soft, &hard].map(|played| difference(&played.strings[0][at(0.5)..at(0.55)]));
        assert!(hard > 1.2 * soft, "{setup} {string}: a harder hammer is brighter: {}", hard / soft);
    }
}

#[test]
fn a_pull_off_reaches_the_open_string_and_a_trill_never_needs_a_pluck() {
    let mut stage = Stage::alone("electric", 2);
    let mut events = vec![(0.0, cc(68, 127)), (0.0, on(55, 90))];
    for turn in 0..5 {
        let start = 0.3 + 0.2 * f64::from(turn);
        events.extend([(start, on(57, 80)), (start + 0.1, off(57))]);
    }
    let played = stage.play(&events, 2.0);
    // The first note and one for each finger that pulls off.
    assert_eq!(plucks(&played.gestures), 6);
    let sound = &played.strings[0];
    assert!(off_key(&sound[at(1.4)..], 55.0).abs() < 3.0);
    assert!(peak(&sound[at(1.9)..]) > 0.01, "it rings on");
}

#[test]
fn a_slide_crosses_each_semitone_where_the_fret_is() {
    for (setup, string, open) in [("electric", 2, 55), ("electric", 5, 40), ("classical", 4, 45)] {
        let mut stage = Stage::alone(setup, string);
        let frets = stage.instrument.geometry(0).frets.clone();
        let mut places = Vec::new();
        // Half a second over five frets.
        let events = [
            (0.0, cc(5, 86)),
            (0.0, cc(65, 127)),
            (0.0, cc(68, 127)),
            (0.0, on(open + 3, 110)),
            (0.3, on(open + 8, 90)),
        ];
        let played = stage.watch(&events, 1.6, |time, instrument| {
            if let Some(finger) = instrument.state(0).fingers()[0] {
                places.push((time, finger.position));
            }
        });
        assert_eq!(plucks(&played.gestures), 1);
        let sound = &played.strings[0];
        for fret in 3..8_u8 {
            let crown = frets[usize::from(fret) - 1];
            let over = places.iter().find(|(_, place)| *place > crown).expect("it gets there").0;
            let [below, above] = [fret, fret + 1].map(|fret| hertz(f64::from(open + fret)));
            // A window must hold two periods and a half to tell one semitone from the next.
            let half = (1.25 * RATE / below) as usize;
            let strength = |n: usize, pitch: f64| -> f64 {
                let window = &sound[n - half..n + half];
                (1..4).map(|k| amplitude(window, RATE, pitch * f64::from(k))).sum()
            };
            let crossing = (at(over - 0.06)..at(over + 0.08))
                .step_by(48)
                .find(|&n| strength(n, above) > strength(n, below))
                .map(|n| n as f64 / RATE);
            let late = crossing.map(|time| time - over);
            // The new pitch is there one period after the fret, to the width of the window.
            let window = half as f64 / RATE;
            let within = late.is_some_and(|late| (-window..2.0 * window + 0.01).contains(&late));
            assert!(within, "{setup} {string} fret {fret}: {late:?} s, window {window} s");
        }
        assert!(off_key(&sound[at(1.2)..], f64::from(open + 8)).abs() < 4.0);
    }
}

#[test]
fn the_slide_takes_as_long_as_controller_5_says() {
    // At once is as fast as hands slide, 1 m/s: the fingers behind these frets are 61.4 mm apart.
    for (value, seconds) in [(0, 0.0614), (64, 0.25), (127, 2.0)] {
        let mut stage = Stage::alone("electric", 2);
        let events = [
            (0.0, cc(5, value)),
            (0.0, cc(65, 127)),
            (0.0, cc(68, 127)),
            (0.0, on(58, 90)),
            (0.1, on(60, 90)),
        ];
        let played = stage.play(&events, 0.2);
        let slide = played.gestures.iter().find_map(|g| match g.gesture {
            Gesture::Slide { duration, .. } => Some(duration),
            _ => None,
        });
        let duration = slide.expect("it slides");
        assert!((duration / seconds - 1.0).abs() < 0.03, "{value}: {duration} s");
    }
}

#[test]
fn what_a_hand_does_not_reach_is_plucked() {
    let count =
        |events: &[(f64, PlayerEvent)]| plucks(&Stage::alone("electric", 2).play(events, 0.5).gestures);
    let legato = (0.0, cc(68, 127));
    // Six frets are too many for a hammer, not for a slide; thirteen are too many for both.
    assert_eq!(count(&[legato, (0.0, on(57, 90)), (0.2, on(62, 90))]), 1);
    assert_eq!(count(&[legato, (0.0, on(57, 90)), (0.2, on(63, 90))]), 2);
    assert_eq!(count(&[legato, (0.0, cc(65, 127)), (0.0, on(57, 90)), (0.2, on(63, 90))]), 1);
    assert_eq!(count(&[legato, (0.0, cc(65, 127)), (0.0, on(57, 90)), (0.2, on(70, 90))]), 2);
    // Neither without the pedal, nor after the key is up, nor for a key struck again.
    assert_eq!(count(&[(0.0, on(57, 90)), (0.2, on(60, 90))]), 2);
    assert_eq!(count(&[legato, (0.0, on(57, 90)), (0.15, off(57)), (0.2, on(60, 90))]), 2);
    assert_eq!(count(&[legato, (0.0, on(57, 90)), (0.2, on(57, 90))]), 2);
}

/// No hammer and no pull leads from a string that is touched lightly, and none leads back: a harmonic would come back octaves low, and
/// a muted note ringing.
#[test]
fn what_is_touched_lightly_is_not_connected() {
    for (stop, first, second) in [(1, 59, 52), (1, 76, 69), (2, 52, 54), (2, 45, 47)] {
        let mut stage = Stage::new(&Setup::shipped("electric").expect("it comes with the program"));
        let told = [(0.0, cc(68, 127)), (0.0, cc(23, stop)), (0.0, on(first, 90)), (0.2, cc(23, 0))];
        let played = stage.play(&[&told[..], &[(0.4, on(second, 90)), (0.8, off(second))]].concat(), 1.6);
        assert_eq!(plucks(&played.gestures), 2, "{stop}: {first}, {second}");
        // The second has another string, and when it is damped nothing is heard but a harmonic.
        let pluck = |g: &&TimedGesture| matches!(g.gesture, Gesture::Pluck { .. });
        let own = played.gestures.iter().find(pluck).expect("it is plucked").string;
        let again = |g: &TimedGesture| g.string == own && g.time >= at(0.4) as u64;
        assert!(!played.gestures.iter().any(again), "{stop}: {first}, {second}");
        for (string, sound) in played.strings.iter().enumerate() {
            let left = level(&sound[at(1.3)..]);
            let rings = stop == 1 && string == own;
            assert_eq!(left > -70.0, rings, "{stop}: {first}, {second}: {left} dB on string {string}");
        }
    }
}

/// A finger that eases off after its note is still the player's: struck again at any moment until it is gone,
/// the note has its pitch, and no finger is told to press that was lifted for good. (Once one was while the
/// player counted on it, and where it was clear of the string by then the open string sounded.)
#[test]
fn a_note_struck_again_while_its_finger_leaves_is_stopped() {
    let mut stage = Stage::alone("electric", 2);
    for step in 0..14 {
        let again = 0.35 + 0.1 * f64::from(step);
        let played = stage.play(&[(0.0, on(60, 90)), (0.3, off(60)), (again, on(60, 90))], again + 0.6);
        let mut there = [false; FINGERS_PER_STRING];
        for TimedGesture { gesture, .. } in &played.gestures {
            match *gesture {
                Gesture::Place { finger, .. } | Gesture::Throw { finger, .. } => there[finger] = true,
                Gesture::Lift { finger, .. } => there[finger] = false,
                Gesture::Press { finger, .. } => assert!(there[finger], "struck again after {again} s"),
                _ => {}
            }
        }
        let sound = &played.strings[0][at(again + 0.1)..];
        let [stopped, open] = [60.0, 55.0].map(|key| amplitude(sound, RATE, hertz(key)));
        assert!(off_key(sound, 60.0).abs() < 3.0 && stopped > 10.0 * open, "struck again after {again} s");
    }
}

/// A finger that is held down behind the one that sounds is out of the way of what comes next: a slide past it, or the open
/// string.
#[test]
fn a_finger_held_behind_is_in_nobodys_way() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let octave = octave();
        let hammered = [(0.0, cc(68, 127)), (0.0, on(open + 5, 90)), (0.3, on(open + 8, 90))];
        let sound = &stage.play(&[&octave[..], &hammered, &[(0.6, wheel(-5.0))]].concat(), 1.4).strings[0];
        let cents = off_key(&sound[at(0.8)..], f64::from(open + 3));
        assert!(cents.abs() < 8.0, "{setup} {string}, down to fret 3: {cents} cents");
        let ended = [(0.6, off(open + 5)), (0.6, off(open + 8)), (0.7, on(open, 90))];
        let sound = &stage.play(&[&hammered[..], &ended].concat(), 1.4).strings[0];
        let cents = off_key(&sound[at(0.75)..at(0.95)], f64::from(open));
        assert!(cents.abs() < 6.0, "{setup} {string}, open: {cents} cents");
    }
}

/// What a pedal kept gives way to a key that is still down under it, as it would have without the pedal.
#[test]
fn a_pedal_that_goes_up_leaves_the_key_below() {
    // Sustain, sostenuto, and both put back by one message.
    for (pedal, up) in [(64, cc(64, 0)), (66, cc(66, 0)), (64, cc(121, 0)), (66, cc(121, 0))] {
        let events = [
            (0.0, cc(68, 127)),
            (0.0, on(55, 90)),
            (0.3, on(57, 90)),
            (0.4, cc(pedal, 127)),
            (0.6, off(57)),
            (0.8, up),
        ];
        let sound = &Stage::alone("electric", 2).play(&events, 1.6).strings[0];
        for (from, to, key) in [(0.4, 0.8, 57), (0.9, 1.6, 55)] {
            let part = &sound[at(from)..at(to)];
            let cents = off_key(part, f64::from(key));
            assert!(cents.abs() < 4.0 && peak(part) > 0.01, "pedal {pedal} from {from} s: {cents} cents");
        }
    }
}

/// A capo that is moved while a note sounds is where it has been told to be before the next one stops the string.
#[test]
fn a_capo_moves_under_a_run() {
    let legato = [(0.0, cc(68, 127)), (0.0, cc(26, 3)), (0.0, on(69, 90))];
    for (capo, key) in [(0, 66), (0, 64), (2, 66), (2, 71), (4, 68), (1, 67)] {
        let mut stage = Stage::alone("electric", 0);
        let moved = [(0.2, cc(26, capo)), (0.4, on(key, 90))];
        let played = stage.play(&[&legato[..], &moved].concat(), 1.2);
        let off = off_key(&played.strings[0][at(0.8)..], f64::from(key));
        assert!(off.abs() < 10.0, "capo {capo}, key {key}: {off} cents");
    }
}

/// What lies under a capo that has come with another note does not come back; over a note that comes back none is laid.
#[test]
fn no_note_comes_back_under_a_capo() {
    let mut stage = Stage::alone("electric", 5);
    let legato = (0.0, cc(68, 127));
    let ends = |events: &[(f64, PlayerEvent)], stage: &mut Stage| {
        let played = stage.play(&[&[legato], events, &[(0.9, off(47))]].concat(), 1.8);
        let sound = played.strings.into_iter().next().expect("one string");
        let heard = sound[at(1.0)..at(1.4)].to_vec();
        (level(&sound[at(1.5)..]) - level(&sound[at(0.6)..at(0.9)]), heard)
    };
    // At fret 3, or open: a capo at the fifth has come with the note at the seventh, and what ends is damped.
    for below in [43, 40] {
        let (left, _) = ends(&[(0.0, on(below, 90)), (0.3, cc(26, 5)), (0.5, on(47, 90))], &mut stage);
        assert!(left < -60.0, "{below}: {left} dB");
    }
    // At fret 6 the finger is over it.
    let over = [(0.0, on(46, 90)), (0.3, cc(26, 5)), (0.5, on(47, 90))];
    let cents = off_key(&ends(&over, &mut stage).1, 46.0);
    assert!(cents.abs() < 10.0, "{cents} cents");
    // One that is asked for when both sound waits, for the next note.
    for below in [43, 40, 46] {
        let (_, heard) = ends(&[(0.0, on(below, 90)), (0.3, on(47, 90)), (0.6, cc(26, 5))], &mut stage);
        let cents = off_key(&heard, f64::from(below));
        assert!(cents.abs() < 10.0, "{below}: {cents} cents");
    }
    // Also where the hand goes back by a hammer.
    let hammered = [(0.0, on(44, 90)), (0.3, on(43, 90)), (0.6, cc(26, 5)), (0.7, off(43))];
    let cents = off_key(&ends(&hammered, &mut stage).1, 44.0);
    assert!(cents.abs() < 10.0, "{cents} cents");
}

/// Of two notes the later one, though a strum has yet to reach the other.
#[test]
fn the_latest_note_is_that_which_began_last() {
    let mut stage = Stage::new(&Setup::shipped("electric").expect("it comes with the program"));
    // The strum takes 0.4 s to the highest string, on which neither of the others can be played.
    let strum = [(0.0, cc(68, 127)), (0.0, cc(21, 127)), (0.0, on(40, 90)), (0.0, on(64, 90))];
    let played = stage.play(&[&strum[..], &[(0.1, on(59, 90)), (0.2, on(61, 90))]].concat(), 0.6);
    let plucked = played.gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. }));
    assert_eq!(plucked.map(|g| g.string).collect::<Vec<_>>(), [5, 1, 0]);
}
