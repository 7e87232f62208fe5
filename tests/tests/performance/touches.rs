//! The promise: what touches a string shapes its sound as it does under hands. A light finger at a node leaves a
//! harmonic, a palm near the saddle shortens a note, a bar and a capo stop it, a thumb throws it against the
//! frets; bends and vibrato reach the depth they are asked for.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, Setup};
use low_action_tests::numbers::{largest, smallest};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, amplitude, at, cc, decibels, hertz, off, on, peak};

const RATE: f64 = 48_000.0;

/// Time in which a partial (Hz) falls by 60 dB, s, from its level in 60 ms after two moments.
fn t60(sound: &[f32], frequency: f64, [from, to]: [f64; 2]) -> f64 {
    let level = |time| decibels(amplitude(&sound[at(time)..at(time + 0.06)], RATE, frequency));
    60.0 * (to - from) / (level(from) - level(to))
}

/// The open string's own frequency when it rings freely.
fn fundamental(stage: &mut Stage, key: u8) -> f64 {
    let sound = &stage.play(&[(0.0, on(key, 90))], 1.2).strings[0];
    frequency_near(&sound[at(0.1)..], RATE, hertz(f64::from(key)))
}

const STRINGS: [(&str, usize, u8); 6] = [
    ("electric", 0, 64),
    ("electric", 2, 55),
    ("electric", 5, 40),
    ("classical", 0, 64),
    ("steel", 5, 40),
    ("bass", 3, 28),
];

#[test]
fn the_harmonic_of_the_twelfth_fret_has_no_odd_partials() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let played = stage.play(&[(0.0, cc(23, 1)), (0.0, on(open + 12, 100))], 1.6);
        // The finger has left.
        assert!(played.gestures.iter().any(|g| matches!(g.gesture, Gesture::Lift { .. })));
        let sound = &played.strings[0][at(0.4)..];
        let octave = frequency_near(sound, RATE, hertz(f64::from(open + 12)));
        assert!(cents(octave, hertz(f64::from(open + 12))).abs() < 5.0, "{setup} {string}: {octave} Hz");
        let level = |partial: f64| amplitude(sound, RATE, 0.5 * octave * partial);
        for odd in [1.0, 3.0, 5.0] {
            let down = decibels(level(odd) / level(2.0));
            assert!(down < -40.0, "{setup} {string} partial {odd}: {down} dB");
        }
        assert!(peak(sound) > 0.01, "{setup} {string}: it rings on");
    }
}

#[test]
fn a_harmonic_sounds_at_its_key_on_a_string_that_lets_it_be_heard() {
    let mut stage = Stage::new(&Setup::builtin("electric").expect("built in"));
    // Natural ones, and those of stopped notes; E6 would lie under the pickup's node on the first string.
    for key in [52, 59, 64, 67, 69, 71, 74, 76, 78, 81, 83, 88] {
        let played = stage.play(&[(0.0, cc(23, 1)), (0.0, on(key, 100))], 1.2);
        let sounds = played.strings.iter().max_by(|a, b| peak(a).total_cmp(&peak(b))).expect("strings");
        let sound = &sounds[at(0.3)..];
        let off = cents(frequency_near(sound, RATE, hertz(f64::from(key))), hertz(f64::from(key)));
        // A natural harmonic is where nature has it: the fifth partial 14 cents under the key.
        assert!(off.abs() < 20.0, "key {key}: {off} cents");
        let strength = amplitude(sound, RATE, frequency_near(sound, RATE, hertz(f64::from(key))));
        // Under the node of the pickup it would be 77 dB down.
        assert!(decibels(strength) > -65.0, "key {key}: {} dB", decibels(strength));
    }
}

#[test]
fn a_stopped_harmonic_is_no_louder_after_another_note() {
    for fret in [2, 3, 9] {
        let mut stage = Stage::plucked_at_once("electric", 0);
        let harmonic = |start, stage: &mut Stage, before: &[(f64, PlayerEvent)]| {
            let events = [before, &[(start, cc(23, 1)), (start, on(64 + 12 + fret, 90))]].concat();
            decibels(peak(&stage.play(&events, start + 0.3).strings[0][at(start)..]))
        };
        let alone = harmonic(0.5, &mut stage, &[]);
        // A finger that still presses behind another fret must leave by itself. (Alone the new one sets the string down from
        // farther up, which is some of the peak: 3.6 dB on fret 9.)
        let after = harmonic(0.5, &mut stage, &[(0.0, on(64 + fret - 1, 40))]);
        assert!(
            (-5.0..3.0).contains(&(after - alone)),
            "fret {fret}: {after} dB after a note, {alone} dB alone"
        );
    }
}

#[test]
fn what_has_touched_a_string_lightly_is_off_it_at_the_next_note() {
    let level = |events: &[(f64, PlayerEvent)], start: f64| {
        let sound = &Stage::alone("electric", 2).play(events, start + 0.3).strings[0];
        decibels(amplitude(&sound[at(start + 0.1)..], RATE, hertz(55.0)))
    };
    // A palm that is lifted as the note begins, or just before, on a string that has just been played. Without one some of the note
    // before rings on, a second old and stilled by 8 dB; under one it has gone. That is 0.73 dB here.
    let again = level(&[(0.0, on(55, 90)), (1.0, on(55, 90))], 1.0);
    for wait in [0.0, 0.02] {
        let events = [(0.0, cc(20, 127)), (0.0, on(55, 90)), (1.0 - wait, cc(20, 0)), (1.0, on(55, 90))];
        let lifted = level(&events, 1.0);
        assert!((lifted - again).abs() < 1.0, "{lifted} dB, {again} dB without a palm");
    }
    // The finger of a harmonic, which leaves its node after 0.12 s. The note before, at velocity 30, has 0.19 of
    // the force, and stilled by 8 dB 0.08 of the sound, which is 0.65 dB either way (0.35 here).
    for wait in [0.1, 0.13, 0.16] {
        let events = [(0.0, cc(23, 1)), (0.0, on(67, 30)), (wait, cc(23, 0)), (wait, on(55, 90))];
        let after = level(&events, wait);
        let again = level(&[(0.0, on(55, 30)), (wait, on(55, 90))], wait);
        assert!(
            (after - again).abs() < 0.65,
            "{after} dB {wait} s after a harmonic, {again} dB after a note"
        );
    }
}

#[test]
fn the_palm_shortens_notes_tenfold() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        let pitch = fundamental(&mut stage, open);
        let mut last = t60(&stage.play(&[(0.0, on(open, 100))], 2.0).strings[0], pitch, [0.1, 1.8]);
        let plain = last;
        // The palm's loss grows 1.7 times from 32 to 64 and 2.8 times to 127 (eight times over the whole range), and as long as it
        // is under what takes most out of the string, the string's does with it: a note lasts 0.59 times as long or less.
        for pressure in [32, 64, 127] {
            let played = stage.play(&[(0.0, cc(20, pressure)), (0.0, on(open, 100))], 1.0);
            let time = t60(&played.strings[0], pitch, [0.03, 0.13]);
            assert!(time < 0.6 * last, "{setup} {string} at {pressure}: {time} s after {last} s");
            last = time;
        }
        assert!(last < 0.1 * plain, "{setup} {string}: {last} s of {plain} s");
        // A palm laid on later does the same, and one taken off lets the next note ring.
        let later = [(0.0, on(open, 100)), (0.5, cc(20, 127)), (1.0, cc(20, 0)), (1.2, on(open, 100))];
        let sound = &stage.play(&later, 3.0).strings[0];
        assert!(t60(sound, pitch, [0.6, 0.7]) < 0.2 * plain, "{setup} {string}");
        assert!(t60(sound, pitch, [1.4, 2.9]) > 0.7 * plain, "{setup} {string}");
    }
}

#[test]
fn a_bar_stops_a_string_without_its_frets() {
    for (setup, string, open) in
        [("electric", 0, 64), ("electric", 2, 55), ("electric", 4, 45), ("lap-steel", 1, 59)]
    {
        let mut stage = Stage::alone(setup, string);
        for fret in [3, 7, 12] {
            let events = [
                (0.0, cc(23, 3)),
                (0.0, on(open + fret, 80)),
                (0.8, PlayerEvent::PitchBend { channel: 0, value: 0.25 }),
            ];
            let mut touched = false;
            let played = stage.watch(&events, 2.0, |time, instrument| {
                let crown = instrument.geometry(0).frets[usize::from(fret) - 1];
                let state = instrument.state(0);
                let grid = instrument.model(0).grid.intervals;
                let node = (crown / instrument.geometry(0).length * grid as f64) as usize;
                touched |= time > 0.3 && state.displacement().nth(node - 1) < Some(-0.0012);
            });
            let sound = &played.strings[0];
            for (from, to, key) in
                [(0.3, 0.8, f64::from(open + fret)), (1.0, 2.0, f64::from(open + fret) + 0.5)]
            {
                let pitch = hertz(key);
                let off = cents(frequency_near(&sound[at(from)..at(to)], RATE, pitch), pitch);
                // Over a fret it is in tune; half way between two of them the grid makes a difference.
                assert!(off.abs() < 3.0, "{setup} {string} fret {fret} from {from} s: {off} cents");
            }
            if setup == "electric" {
                assert!(!touched, "{setup} {string} fret {fret}: the string lies on the frets");
            }
        }
    }
}

/// No finger reaches the frets of a lap steel: an open string that is connected with a stopped note gets the bar.
#[test]
fn a_bar_is_laid_on_an_open_string() {
    let mut stage = Stage::alone("lap-steel", 1);
    let events =
        [(0.0, cc(23, 3)), (0.0, cc(68, 127)), (0.0, on(59, 100)), (0.5, on(63, 90)), (1.5, off(63))];
    let sound = &stage.play(&events, 2.2).strings[0];
    for (from, to, key) in [(0.1, 0.5, 59.0), (0.8, 1.5, 63.0), (1.6, 2.2, 59.0)] {
        let part = &sound[at(from)..at(to)];
        let off = cents(frequency_near(part, RATE, hertz(key)), hertz(key));
        assert!(off.abs() < 3.0, "from {from} s: {off} cents");
        assert!(decibels(peak(part)) > -45.0, "from {from} s: {} dB", decibels(peak(part)));
    }
}

#[test]
fn a_capo_is_a_new_nut() {
    let mut stage = Stage::new(&Setup::builtin("electric").expect("built in"));
    // G with a capo at the third fret: the open shape of E, no finger but the capo.
    let chord = [43, 50, 55, 59, 62, 67];
    let mut events = vec![(0.0, cc(26, 3))];
    events.extend(chord.map(|key| (0.0, on(key, 80))));
    events.extend(chord.map(|key| (0.8, off(key))));
    let played = stage.play(&events, 3.5);
    let fingers: Vec<usize> = played
        .gestures
        .iter()
        .filter_map(|g| match g.gesture {
            Gesture::Place { finger: finger @ (0 | 1), .. } if g.time == 0 => Some(finger),
            _ => None,
        })
        .collect();
    assert_eq!(fingers.len(), 3, "only three strings are stopped beside the capo");
    for string in 0..6 {
        let key = f64::from([67, 62, 59, 55, 50, 43][string]);
        let sound = &played.strings[string][at(0.2)..at(0.8)];
        let off = cents(frequency_near(sound, RATE, hertz(key)), hertz(key));
        assert!(off.abs() < 12.0, "string {string}: {off} cents");
    }
    // Nothing is left on strings that nobody plays.
    let instrument = &stage.instrument;
    for string in 0..6 {
        assert!(instrument.state(string).fingers().iter().all(Option::is_none), "string {string}");
    }
    assert!(peak(&played.strings[0][at(3.3)..]) < 1e-4);
}

/// Wherever a controller that nobody thought of puts it, every key sounds; and resetting controllers takes it off again.
#[test]
fn a_capo_leaves_no_key_silent() {
    for setup in ["electric", "classical", "bass", "ukulele"] {
        let mut stage = Stage::new(&Setup::shipped(setup).expect("it is shipped"));
        for key in 60..72 {
            let played = stage.play(&[(0.0, cc(26, 127)), (0.0, on(key, 100))], 0.3);
            let loudest = played.strings.iter().map(|sound| peak(sound)).fold(0.0, f64::max);
            assert!(decibels(loudest) > -40.0, "{setup}, key {key}: {} dB", decibels(loudest));
        }
        let taken_off = |by| [(0.0, cc(26, 127)), (0.0, by), (0.1, on(60, 100))];
        let [one, other] = [cc(26, 0), cc(121, 0)].map(|by| stage.play(&taken_off(by), 0.5).strings);
        assert!(one == other, "{setup}: the capo is still there");
    }
}

/// It leaves a quiet string slowly, last of all: a note below it that comes meanwhile must not sound from it.
#[test]
fn a_capo_that_is_leaving_stops_no_note() {
    for (setup, string, open) in [("electric", 2, 55), ("bass", 2, 33)] {
        let mut stage = Stage::alone(setup, string);
        for rest in [0.3, 0.95, 1.2, 1.5, 2.2] {
            let start = 0.5 + rest;
            let events = [
                (0.0, cc(26, 3)),
                (0.0, on(open + 5, 80)),
                (0.5, off(open + 5)),
                (0.5, cc(26, 0)),
                (start, on(open + 1, 80)),
            ];
            let sound = &stage.play(&events, start + 0.6).strings[0];
            let pitch = hertz(f64::from(open + 1));
            let off = cents(frequency_near(&sound[at(start + 0.1)..], RATE, pitch), pitch);
            assert!(off.abs() < 5.0, "{setup} {rest} s after: {off} cents");
        }
    }
}

/// What rings between nut, capo and finger comes out while hands still damp the string, and not as an open string when they
/// have gone.
#[test]
fn a_capo_goes_in_silence() {
    for (setup, string, open) in
        [("classical", 4, 45), ("bass", 3, 28), ("fretless-bass", 3, 28), ("electric", 5, 40)]
    {
        let mut stage = Stage::alone(setup, string);
        for (capo, fret) in [(3, 3), (3, 5), (3, 10), (5, 7), (7, 19)] {
            let events = [(0.0, cc(26, capo)), (0.0, on(open + fret, 100)), (0.5, off(open + fret))];
            let sound = &stage.play(&events, 3.0).strings[0];
            let level = |from, to| decibels(peak(&sound[at(from)..at(to)]));
            let [heard, shut_in, left] = [level(0.0, 0.5), level(0.75, 2.0), level(2.2, 3.0)];
            assert!(heard > -40.0, "{setup}, capo {capo}, fret {fret}: the note is at {heard} dB");
            assert!(shut_in < -50.0, "{setup}, capo {capo}, fret {fret}: {shut_in} dB");
            assert!(left < -90.0, "{setup}, capo {capo}, fret {fret}: {left} dB when all have gone");
        }
    }
}

#[test]
fn a_slap_throws_the_string_against_the_frets() {
    let mut stage = Stage::alone("bass", 3);
    stage.instrument.open_ledgers();
    let mut contact = |stroke: u8, velocity: u8| {
        let mut most = 0.0_f64;
        let events = [(0.0, cc(22, stroke)), (0.0, on(28, velocity))];
        let played = stage.watch(&events, 0.3, |_, instrument| {
            let ledger = instrument.ledger(0).expect("it is open");
            most = largest([most, ledger.energies().contact]);
        });
        (most, peak(&played.strings[0]))
    };
    let (soft, _) = contact(0, 40);
    let (slap, loud) = contact(4, 100);
    let (pop, _) = contact(5, 110);
    assert_eq!(soft, 0.0, "a soft pluck of an open string touches nothing");
    assert!(slap > 1e-6 && pop > 1e-6, "{slap} J, {pop} J");
    assert!(loud < 1.0);
}

#[test]
fn a_pinch_leaves_a_high_partial() {
    let mut stage = Stage::alone("electric", 3);
    let mut partials = |stroke: u8| {
        let played = stage.play(&[(0.0, cc(22, stroke)), (0.0, on(55, 110))], 1.0);
        let sound = played.strings[0][at(0.1)..at(0.9)].to_vec();
        let pitch = frequency_near(&sound, RATE, hertz(55.0));
        (1..10).map(|k| decibels(amplitude(&sound, RATE, pitch * f64::from(k)))).collect::<Vec<f64>>()
    };
    let plain = partials(0);
    let pinched = partials(6);
    let strongest = (0..9).max_by(|&a, &b| pinched[a].total_cmp(&pinched[b])).expect("partials") + 1;
    assert!((3..=9).contains(&strongest), "{pinched:?}");
    assert!(pinched[strongest - 1] > pinched[0] + 20.0, "{pinched:?}");
    assert!(plain[0] > plain[strongest - 1], "{plain:?}");
}

#[test]
fn bends_and_vibrato_have_their_depth() {
    for (setup, string, open) in
        [("electric", 0, 64), ("electric", 2, 55), ("electric", 5, 40), ("steel", 1, 59)]
    {
        let mut stage = Stage::alone(setup, string);
        for fret in [0, 4, 7, 12] {
            for (turn, semitones) in [(0.5, 1.0), (0.9, 1.8), (-0.5, -1.0)] {
                let bend = PlayerEvent::PitchBend { channel: 0, value: turn };
                let sound = &stage.play(&[(0.0, on(open + fret, 70)), (0.3, bend)], 1.8).strings[0];
                let pitch = hertz(f64::from(open + fret) + semitones);
                let off = cents(frequency_near(&sound[at(0.8)..], RATE, pitch), pitch);
                assert!(off.abs() < 3.0, "{setup} {string} fret {fret} by {semitones}: {off} cents");
            }
        }
    }
    // Half a semitone each way; frequency in windows much shorter than a swing.
    let mut stage = Stage::alone("electric", 0);
    let sound = &stage.play(&[(0.0, cc(1, 127)), (0.0, on(71, 90))], 1.5).strings[0];
    let width = at(0.024);
    let off: Vec<f64> = (at(0.2)..sound.len() - width)
        .step_by(96)
        .map(|n| cents(frequency_near(&sound[n..n + width], RATE, hertz(71.0)), hertz(71.0)))
        .collect();
    let (low, high) = (smallest(off.iter().copied()), largest(off.iter().copied()));
    assert!((low + 50.0).abs() < 3.0 && (high - 50.0).abs() < 3.0, "{low} to {high} cents");
}

#[test]
fn on_a_bare_board_the_finger_itself_swings_and_bends() {
    let mut stage = Stage::alone("fretless-bass", 0);
    let mut places = Vec::new();
    let played = stage.watch(&[(0.0, cc(1, 127)), (0.0, on(50, 90))], 1.0, |time, instrument| {
        if let Some(finger) = instrument.state(0).fingers()[0].filter(|_| time > 0.3) {
            places.push(finger.position);
        }
    });
    assert!(played.gestures.iter().all(|g| !matches!(g.gesture, Gesture::Bend { .. })), "no pull");
    let (near, far) = (smallest(places.iter().copied()), largest(places.iter().copied()));
    assert!((0.01..0.05).contains(&(far - near)), "the finger rolls over {} m", far - near);
    let bent = [(0.0, on(50, 90)), (0.3, PlayerEvent::PitchBend { channel: 0, value: 1.0 })];
    let sound = &stage.play(&bent, 1.5).strings[0];
    let off = cents(frequency_near(&sound[at(0.6)..], RATE, hertz(52.0)), hertz(52.0));
    assert!(off.abs() < 8.0, "{off} cents");
}

#[test]
fn every_stroke_is_heard_within_three_milliseconds_and_every_finger_leaves() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        for stroke in 0..7 {
            let events =
                [(0.0, cc(22, stroke)), (0.0, cc(20, 40)), (0.0, on(open + 3, 100)), (0.4, off(open + 3))];
            // A palm waits for another note.
            let played = stage.play(&events, 4.0);
            let sound = &played.strings[0];
            let attack = peak(&sound[..at(0.04)]);
            let first = sound.iter().position(|sample| f64::from(sample.abs()) > 0.01 * attack);
            assert!(
                first.is_some_and(|first| first < at(0.003)),
                "{setup} {string} stroke {stroke}: {first:?}"
            );
            let left = stage.instrument.state(0).fingers().iter().flatten().count();
            assert_eq!(left, 0, "{setup} {string} stroke {stroke}");
        }
    }
}
