//! A phrase for each of the set-ups that come with the program beside the four instruments: what it is there
//! for.

use super::score::*;

/// Every phrase, by the name of its set-up.
pub fn all() -> Vec<(&'static str, Score)> {
    let line = |tempo, keys: &'static [u8], velocity, step, overlap| {
        Score::solo(tempo, |track| {
            let now = track.line(keys, velocity, 0, step, overlap);
            track.note(keys[0], velocity, now, 4 * QUARTER);
        })
    };
    vec![
        ("buzzing-bass", line(96, &[28, 28, 35, 28, 33, 28, 31, 30], 110, EIGHTH, 0)),
        ("slap-bass", slapped()),
        ("fretless-bass", sung()),
        ("low-action-funk", funk()),
        ("worn-fret", worn()),
        ("light-fingers", line(110, &[45, 48, 52, 55, 57, 55, 52, 48], 90, EIGHTH, 0)),
        ("school-guitar", line(90, &[48, 52, 55, 60, 64, 67, 72, 76], 80, EIGHTH, 4 * EIGHTH)),
        ("flatwound-jazz", line(150, &[57, 60, 64, 67, 66, 62, 59, 55, 60, 64, 67, 71], 76, EIGHTH, 0)),
        ("tanpura", drone()),
        ("sitar", line(100, &[52, 56, 57, 59, 64, 59, 57, 56], 100, EIGHTH, 0)),
        ("lap-steel", glided()),
        ("baritone", line(84, &[35, 42, 47, 50, 54, 50, 47, 42], 100, EIGHTH, 3 * EIGHTH)),
        ("drop-d", chugged()),
        ("flamenco", rolled()),
        ("ukulele", strummed()),
        ("five-string-bass", line(92, &[23, 23, 26, 28, 30, 28, 26, 25], 104, EIGHTH, 0)),
    ]
}

fn slapped() -> Score {
    Score::solo(108, |track| {
        for (place, (stroke, key)) in
            (0..).zip([(4, 28), (5, 40), (4, 28), (4, 31), (5, 43), (4, 33), (5, 45), (5, 43)])
        {
            track.set(place * EIGHTH, STROKE, stroke);
            // A pop is as loud as a slap twice as hard.
            let velocity = if stroke == 5 { 66 } else { 116 };
            track.note(key, velocity, place * EIGHTH, EIGHTH - 40);
        }
        track.note(28, 90, 8 * EIGHTH, 2 * QUARTER);
    })
}

fn sung() -> Score {
    Score::solo(70, |track| {
        track.set(0, LEGATO, 127);
        track.set(0, SLIDE, 127);
        track.set(0, SLIDE_TIME, 50);
        let now = [[36, 43], [41, 40]].into_iter().fold(0, |now, [from, to]| {
            track.note(from, 90, now, QUARTER + 40);
            track.note(to, 90, now + QUARTER, QUARTER - 10);
            now + 2 * QUARTER
        });
        track.note(38, 96, now, 4 * QUARTER);
        track.sweep(now + QUARTER, QUARTER, VIBRATO, [0, 110]);
    })
}

fn funk() -> Score {
    Score::solo(112, |track| {
        track.set(0, STROKE, 2);
        track.set(0, STRUM, 8);
        for place in 0..32 {
            let sounds = [0, 3, 6, 10, 11, 14].contains(&(place % 16));
            track.set(place * SIXTEENTH, STOP, if sounds { 0 } else { 2 });
            track.chord(&[62, 66, 69, 72], if sounds { 96 } else { 60 }, place * SIXTEENTH, SIXTEENTH - 10);
        }
    })
}

/// Up to the fifth fret and beside it, again and again.
fn worn() -> Score {
    Score::solo(100, |track| {
        track.set(0, HAND, 5);
        let now = track.line(&[48, 50, 52, 50, 49, 50, 51, 50], 96, 0, QUARTER, 0);
        track.note(50, 96, now, 4 * QUARTER);
    })
}

fn drone() -> Score {
    // First string first. The third stroke is on the string tuned two cents beside the second; that one sounds yet, and so the
    // key of another channel has the other string.
    const STROKES: [[&[u8]; 4]; 2] = [[&[43], &[48], &[], &[36]], [&[], &[], &[48], &[]]];
    let mut score = Score::new(60);
    for (name, strokes, channel) in [("first", STROKES[0], 1), ("second", STROKES[1], 2)] {
        let track = score.track(name, channel);
        for turn in 0..4 {
            for (place, keys) in (0..).zip(strokes) {
                // Each rings until its own next stroke, and the last ones ring out.
                let length = if turn < 3 { 4 * QUARTER } else { 6 * QUARTER };
                track.chord(keys, 80, (turn * 4 + place) * QUARTER, length);
            }
        }
    }
    score
}

fn glided() -> Score {
    Score::solo(72, |track| {
        track.set(0, STOP, 3);
        track.set(0, LEGATO, 127);
        track.set(0, SLIDE_TIME, 64);
        track.note(64, 96, 0, QUARTER + 60);
        track.note(67, 96, QUARTER, QUARTER + 60);
        track.note(71, 96, 2 * QUARTER, 4 * QUARTER);
        track.sweep(3 * QUARTER, QUARTER, VIBRATO, [0, 90]);
    })
}

fn chugged() -> Score {
    Score::solo(150, |track| {
        for place in 0..16_u32 {
            let open = [3, 7, 12].contains(&place);
            track.set(place * EIGHTH, PALM, if open { 0 } else { 100 });
            let keys: &[u8] = if open { &[41, 48, 53] } else { &[38, 45, 50] };
            track.chord(keys, 110, place * EIGHTH, EIGHTH - 20);
        }
        track.set(16 * EIGHTH, PALM, 0);
        track.chord(&[38, 45, 50], 110, 16 * EIGHTH, 3 * QUARTER);
    })
}

fn rolled() -> Score {
    Score::solo(120, |track| {
        let now = track.line(&[52, 53, 55, 56, 58, 56, 55, 53], 110, 0, EIGHTH, 0);
        track.set(now, STROKE, 2);
        track.set(now, STRUM, 24);
        for place in 0..6 {
            track.chord(&[40, 47, 52, 56, 59, 64], 100, now + place * SIXTEENTH, SIXTEENTH - 5);
        }
        track.chord(&[41, 48, 53, 57, 60, 64], 105, now + 6 * SIXTEENTH, 2 * QUARTER);
    })
}

fn strummed() -> Score {
    const CHORDS: [[u8; 4]; 4] = [[67, 60, 64, 72], [67, 62, 67, 71], [69, 60, 64, 69], [69, 60, 65, 69]];
    Score::solo(120, |track| {
        track.set(0, STROKE, 2);
        track.set(0, STRUM, 20);
        for (bar, chord) in (0..).zip(CHORDS) {
            // Each chord rings until the next stroke.
            for (place, velocity, length) in
                [(0, 96, 2), (2, 84, 1), (3, 70, 2), (5, 76, 1), (6, 90, 1), (7, 70, 1)]
            {
                // A key that two strings give is sent once.
                let keys: Vec<u8> =
                    (0..4).filter(|&n| !chord[..n].contains(&chord[n])).map(|n| chord[n]).collect();
                track.chord(&keys, velocity, (bar * 8 + place) * EIGHTH, length * EIGHTH - 10);
            }
        }
    })
}
