//! A file for each gesture: first the plain note, then the gesture, so that the ear can compare.

use super::score::*;

/// Every gesture, by the name of its file.
pub fn all() -> Vec<(&'static str, Score)> {
    vec![
        ("strokes", strokes()),
        ("hammer_and_pull", hammer_and_pull()),
        ("tap", tap()),
        ("slide", slide()),
        ("bend_and_vibrato", bend_and_vibrato()),
        ("harmonics", harmonics()),
        ("muted", muted()),
        ("palm", palm()),
        ("slap_and_pop", slap_and_pop()),
        ("pinch", pinch()),
        ("strum", strum()),
        ("tremolo", tremolo()),
        ("bar", bar()),
        ("capo_and_barre", capo_and_barre()),
        ("fretless", fretless()),
        ("positions", positions()),
        ("keyswitches", keyswitches()),
        ("too_many_notes", too_many_notes()),
    ]
}

const RUN: [u8; 8] = [45, 48, 50, 52, 55, 52, 50, 48];

fn strokes() -> Score {
    Score::solo(110, |track| {
        let mut now = 0;
        for stroke in [0, 1, 2, 3] {
            track.set(now, STROKE, stroke);
            now = track.line(&RUN, 96, now, EIGHTH, 0) + EIGHTH;
        }
    })
}

fn hammer_and_pull() -> Score {
    Score::solo(100, |track| {
        let phrase = [57, 59, 60, 59, 57, 59, 60, 62];
        let now = track.line(&phrase, 90, 0, EIGHTH, 0) + QUARTER;
        track.set(now, LEGATO, 127);
        let mut now = track.line(&phrase, 90, now, EIGHTH, 30) + QUARTER;
        // A trill: one key held, one struck, softer and harder.
        track.note(57, 96, now, 5 * QUARTER);
        for turn in 0..16 {
            track.note(60, 40 + 5 * turn as u8, now + EIGHTH + turn * SIXTEENTH, SIXTEENTH / 2);
        }
        now += 6 * QUARTER;
        // Down to the open string.
        track.note(55, 80, now, 3 * QUARTER);
        track.note(58, 100, now + QUARTER, EIGHTH + 30);
        track.note(57, 100, now + QUARTER + EIGHTH, EIGHTH);
    })
}

fn tap() -> Score {
    Score::solo(120, |track| {
        // Plucked, then the same with both hands on the neck.
        let broken = [57, 64, 69, 64, 57, 64, 72, 64, 57, 65, 69, 65, 57, 65, 74, 65];
        let now = track.line(&broken, 90, 0, SIXTEENTH, 0) + QUARTER;
        track.set(now, STROKE, 7);
        let now = track.line(&broken, 80, now, SIXTEENTH, 0);
        track.line(&broken, 120, now, SIXTEENTH, 0);
    })
}

fn slide() -> Score {
    Score::solo(90, |track| {
        track.set(0, LEGATO, 127);
        track.set(0, SLIDE, 127);
        let mut now = 0;
        for (time, length) in [(0, QUARTER), (60, 2 * QUARTER), (100, 4 * QUARTER)] {
            track.set(now, SLIDE_TIME, time);
            track.note(57, 110, now, EIGHTH + 40);
            track.note(64, 90, now + EIGHTH, length);
            track.note(60, 90, now + EIGHTH + length - 40, length);
            now += EIGHTH + 2 * length + QUARTER;
        }
    })
}

fn bend_and_vibrato() -> Score {
    Score::solo(80, |track| {
        track.note(67, 100, 0, 3 * QUARTER);
        track.bend(QUARTER, EIGHTH, [0.0, 1.0]);
        track.bend(2 * QUARTER + EIGHTH, EIGHTH, [1.0, 0.0]);
        let now = 4 * QUARTER;
        track.note(67, 100, now, 4 * QUARTER);
        track.sweep(now + QUARTER, QUARTER, VIBRATO, [0, 127]);
        track.set(now + 4 * QUARTER, VIBRATO, 0);
        // Past three semitones the finger slides, and the string is pulled the rest.
        let now = 9 * QUARTER;
        for (controller, value) in [(101, 0), (100, 0), (6, 12)] {
            track.set(now, controller, value);
        }
        track.note(60, 110, now, 5 * QUARTER);
        track.bend(now + QUARTER, 2 * QUARTER, [0.0, 7.0 / 12.0]);
        track.bend(now + 3 * QUARTER, QUARTER, [7.0 / 12.0, 0.0]);
    })
}

fn harmonics() -> Score {
    Score::solo(80, |track| {
        track.note(40, 90, 0, 2 * QUARTER);
        track.set(2 * QUARTER, STOP, 1);
        track.set(2 * QUARTER, PEDAL, 127);
        // Twelfth, seventh and fifth fret of all strings, then harmonics of stopped notes.
        let mut now = 2 * QUARTER;
        for over in [12, 19, 24] {
            for open in [40, 45, 50, 55, 59] {
                track.note(open + over, 90, now, EIGHTH);
                now += EIGHTH;
            }
            now += QUARTER;
        }
        now = track.line(&[69, 72, 74, 76, 74, 72], 96, now, EIGHTH, 0) + 3 * QUARTER;
        track.set(now, PEDAL, 0);
    })
}

fn muted() -> Score {
    Score::solo(110, |track| {
        let mut now = 0;
        for beat in 0..16 {
            let dead = beat % 4 != 0;
            track.set(now, STOP, if dead { 2 } else { 0 });
            track.chord(&[50, 57, 62, 66], if dead { 80 } else { 100 }, now, EIGHTH - 20);
            now += EIGHTH;
        }
    })
}

fn palm() -> Score {
    Score::solo(140, |track| {
        let riff = [40, 40, 52, 40, 40, 51, 40, 50];
        let mut now = track.line(&riff, 105, 0, EIGHTH, 0) + EIGHTH;
        for pressure in [20, 60, 90, 127] {
            track.set(now, PALM, pressure);
            now = track.line(&riff, 105, now, EIGHTH, 0) + EIGHTH;
        }
        // A palm that comes down on a chord and goes away again.
        track.set(now, PALM, 0);
        track.chord(&[40, 47, 52], 110, now, 8 * QUARTER);
        track.sweep(now + 2 * QUARTER, QUARTER, PALM, [0, 127]);
        track.set(now + 4 * QUARTER, PALM, 0);
        track.chord(&[40, 47, 52], 110, now + 4 * QUARTER, 4 * QUARTER);
    })
}

fn slap_and_pop() -> Score {
    Score::solo(104, |track| {
        let mut now = 0;
        for bar in 0..4 {
            let root = [28, 28, 33, 31][bar];
            for (eighth, (stroke, key)) in
                [(4, 0), (4, 0), (5, 12), (4, 0), (2, 0), (5, 12), (4, 7), (5, 10)].into_iter().enumerate()
            {
                let start = now + eighth as u32 * EIGHTH;
                track.set(start, STROKE, stroke);
                track.set(start, STOP, if stroke == 2 { 2 } else { 0 });
                track.note(root + key, 100, start, EIGHTH - 30);
            }
            now += 8 * EIGHTH;
        }
    })
}

fn pinch() -> Score {
    Score::solo(90, |track| {
        for (place, brightness) in [(0, 64), (1, 40), (2, 80), (3, 100)] {
            let now = place * 3 * QUARTER;
            // The hand that goes along the string finds other nodes.
            track.set(now, 74, brightness);
            track.set(now, STROKE, 0);
            track.note(52, 110, now, QUARTER);
            track.set(now + QUARTER, STROKE, 6);
            track.note(52, 120, now + QUARTER, 2 * QUARTER);
        }
    })
}

fn strum() -> Score {
    let e_minor = [40, 47, 52, 55, 59, 64];
    let c_major = [48, 52, 55, 60, 64];
    Score::solo(100, |track| {
        let mut now = 0;
        for (time, stroke, accent) in
            [(0, 0, 64), (30, 0, 64), (30, 1, 64), (100, 0, 64), (60, 0, 120), (60, 0, 8)]
        {
            track.set(now, STRUM, time);
            track.set(now, STROKE, stroke);
            track.set(now, ACCENT, accent);
            track.chord(&e_minor, 90, now, 2 * QUARTER);
            now += 2 * QUARTER;
        }
        track.set(now, STRUM, 24);
        track.set(now, STROKE, 2);
        track.set(now, ACCENT, 64);
        for beat in 0..16_u32 {
            let keys: &[u8] = if beat < 8 { &e_minor } else { &c_major };
            let velocity = if beat % 2 == 0 { 96 } else { 70 };
            track.chord(keys, velocity, now + beat * EIGHTH, EIGHTH);
        }
    })
}

fn tremolo() -> Score {
    Score::solo(80, |track| {
        track.note(69, 90, 0, 2 * QUARTER);
        track.set(2 * QUARTER, TREMOLO, 80);
        let now = track.line(&[69, 72, 71, 69, 68, 71, 69], 84, 2 * QUARTER, 2 * QUARTER, 0);
        track.note(57, 70, 2 * QUARTER, 6 * QUARTER);
        track.note(52, 70, 8 * QUARTER, 8 * QUARTER);
        track.sweep(now, 3 * QUARTER, TREMOLO, [20, 127]);
        track.note(69, 90, now, 4 * QUARTER);
    })
}

fn bar() -> Score {
    Score::solo(76, |track| {
        track.set(0, STOP, 3);
        track.set(0, LEGATO, 127);
        track.set(0, SLIDE_TIME, 70);
        let mut now = 0;
        for [low, high] in [[62, 64], [64, 67], [67, 69], [69, 74]] {
            track.note(low, 96, now, QUARTER + 60);
            track.note(high, 96, now + QUARTER, 3 * QUARTER);
            track.sweep(now + 2 * QUARTER, QUARTER, VIBRATO, [0, 90]);
            track.set(now + 4 * QUARTER, VIBRATO, 0);
            now += 4 * QUARTER;
        }
        // Two strings under one bar, moved by the wheel.
        track.chord(&[67, 71, 74], 90, now, 5 * QUARTER);
        track.bend(now + QUARTER, QUARTER, [0.0, -1.0]);
        track.bend(now + 3 * QUARTER, QUARTER, [-1.0, 0.0]);
    })
}

fn capo_and_barre() -> Score {
    Score::solo(96, |track| {
        // F barred, then the open shapes of G and D over a capo at the third fret.
        track.set(0, STRUM, 20);
        track.chord(&[41, 48, 53, 57, 60, 65], 90, 0, 3 * QUARTER);
        track.set(4 * QUARTER, CAPO, 3);
        track.chord(&[46, 50, 53, 58, 62, 70], 90, 4 * QUARTER, 3 * QUARTER);
        track.chord(&[53, 60, 65, 69], 90, 8 * QUARTER, 3 * QUARTER);
        track.set(12 * QUARTER, CAPO, 0);
        track.chord(&[43, 47, 50, 55, 59, 67], 90, 12 * QUARTER, 3 * QUARTER);
    })
}

fn fretless() -> Score {
    Score::solo(72, |track| {
        track.set(0, LEGATO, 127);
        track.set(0, SLIDE, 127);
        track.set(0, SLIDE_TIME, 60);
        let mut now = 0;
        for (from, to) in [(33, 40), (40, 38), (38, 45), (45, 43)] {
            track.note(from, 96, now, QUARTER + 40);
            track.note(to, 96, now + QUARTER, 3 * QUARTER - 20);
            track.sweep(now + 2 * QUARTER, QUARTER, VIBRATO, [0, 100]);
            track.set(now + 4 * QUARTER, VIBRATO, 0);
            now += 4 * QUARTER;
        }
    })
}

fn positions() -> Score {
    Score::solo(100, |track| {
        // The same phrase wherever the hand likes, then farther and farther up the neck, where strings are thicker.
        let phrase = [55, 59, 62, 64, 67, 64, 62, 59, 57, 60, 59, 55];
        let mut now = 0;
        for fret in [0, 5, 9, 12] {
            track.set(now, HAND, fret);
            now = track.line(&phrase, 96, now, EIGHTH, 0) + QUARTER;
        }
    })
}

fn keyswitches() -> Score {
    Score::solo(110, |track| {
        track.set(0, SWITCHES, 12);
        let mut now = 0;
        for switch in 0..12 {
            track.note(12 + switch, 100, now, 60);
            let overlap = if switch >= 10 { 40 } else { 0 };
            now = track.line(&[52, 55, 57, 55], 96, now, EIGHTH, overlap) + EIGHTH;
        }
        // The same note on three strings.
        track.note(12, 100, now, 60);
        for string in [1, 2, 3] {
            track.note(24 + string, 100, now, QUARTER);
            track.note(64, 96, now, QUARTER);
            now += QUARTER;
        }
    })
}

fn too_many_notes() -> Score {
    Score::solo(80, |track| {
        // Two hands of a pianist: what is in the way moves by octaves, the rest comes a moment later.
        track.chord(&[36, 43, 48, 52, 55, 60, 64, 67], 80, 0, 4 * QUARTER);
        track.chord(&[41, 42, 43, 44], 80, 5 * QUARTER, 3 * QUARTER);
    })
}
