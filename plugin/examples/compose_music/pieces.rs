//! Pieces of ordinary density: melodies in the public domain and music of our own, in several tracks.

use super::score::*;

/// Every piece, by the name of its file.
pub fn all() -> Vec<(&'static str, Score)> {
    vec![
        ("fingerpicking", fingerpicking()),
        ("strumming", strumming()),
        ("bass_line", bass_line()),
        ("fast_run", fast_run()),
        ("midi_guitar", midi_guitar()),
    ]
}

/// Greensleeves (English, before 1580), in six-eight time and in the key that guitarists play it in: the
/// melody on the first string, the thumb's bass, and two notes between.
fn fingerpicking() -> Score {
    /// (key, eighths)
    const MELODY: &[(u8, u32)] = &[
        (64, 1), // the upbeat
        (67, 2),
        (69, 1),
        (71, 1),
        (72, 1),
        (71, 1), // E minor
        (69, 2),
        (66, 1),
        (62, 1),
        (64, 1),
        (66, 1), // D
        (67, 2),
        (64, 1),
        (64, 1),
        (63, 1),
        (64, 1), // E minor
        (66, 2),
        (63, 1),
        (59, 2),
        (64, 1), // B
        (67, 2),
        (69, 1),
        (71, 1),
        (72, 1),
        (71, 1),
        (69, 2),
        (66, 1),
        (62, 1),
        (64, 1),
        (66, 1),
        (67, 1),
        (66, 1),
        (64, 1),
        (63, 1),
        (61, 1),
        (63, 1),
        (64, 3),
        (64, 3),
        (74, 3),
        (74, 1),
        (72, 1),
        (71, 1), // G
        (69, 2),
        (66, 1),
        (62, 1),
        (64, 1),
        (66, 1), // D
    ];
    const CHORDS: [[u8; 3]; 10] = [
        [40, 55, 59],
        [50, 57, 62],
        [40, 55, 59],
        [47, 51, 57],
        [40, 55, 59],
        [50, 57, 62],
        [47, 51, 57],
        [40, 55, 59],
        [55, 59, 59],
        [50, 57, 62],
    ];
    let mut score = Score::new(120);
    let melody = score.track("melody", 1);
    for verse in 0..2 {
        let mut now = verse * 61 * EIGHTH;
        for (index, &(key, eighths)) in MELODY.iter().enumerate() {
            let velocity = if index % 3 == 0 { 92 } else { 80 };
            melody.note(key, velocity, now, eighths * EIGHTH - 20);
            now += eighths * EIGHTH;
        }
    }
    let bars = || (0..2).flat_map(|verse| (0..10_u32).map(move |bar| (verse * 61 + 1 + 6 * bar, bar)));
    let bass = score.track("thumb", 2);
    for (eighth, bar) in bars() {
        let [root, ..] = CHORDS[bar as usize];
        bass.note(root, 84, eighth * EIGHTH, 3 * EIGHTH - 10);
        let fifth = if root > 43 { root - 5 } else { root + 7 };
        bass.note(fifth, 66, (eighth + 3) * EIGHTH, 3 * EIGHTH - 10);
    }
    let inner = score.track("fingers", 3);
    for (eighth, bar) in bars() {
        let [_, low, high] = CHORDS[bar as usize];
        for (place, key) in [(1, low), (2, high), (4, low), (5, high)] {
            inner.note(key, 58, (eighth + place) * EIGHTH, EIGHTH - 10);
        }
    }
    score
}

/// Sixteenths back and forth over four chords, some of them muted, under a tune.
fn strumming() -> Score {
    const CHORDS: [&[u8]; 4] =
        [&[43, 47, 50, 55, 59, 67], &[40, 47, 52, 55, 59, 64], &[48, 52, 55, 60, 64], &[50, 57, 62, 66]];
    // Down, down, up, up, down, up: 0 is a rest, a small number a muted stroke.
    const PATTERN: [u8; 16] = [100, 0, 74, 60, 92, 0, 70, 64, 20, 66, 96, 62, 24, 70, 90, 66];
    let mut score = Score::new(104);
    let chords = score.track("strummed", 1);
    chords.set(0, STROKE, 2);
    chords.set(0, STRUM, 14);
    for bar in 0..8_u32 {
        let strokes = (0..16_u32).filter(|&place| PATTERN[place as usize] > 0);
        for place in strokes {
            let velocity = PATTERN[place as usize];
            // A chord rings on over a rest.
            let next = (place + 1..16).find(|&next| PATTERN[next as usize] > 0).unwrap_or(16);
            let start = bar * 4 * QUARTER + place * SIXTEENTH;
            let muted = velocity < 30;
            chords.set(start, STOP, if muted { 2 } else { 0 });
            let length = (next - place) * SIXTEENTH - 5;
            chords.chord(CHORDS[bar as usize % 4], velocity.max(55), start, length);
        }
    }
    let bass = score.track("bass notes", 2);
    for bar in 0..8_u32 {
        let root = CHORDS[bar as usize % 4][0];
        bass.note(
            root - if root > 51 { 12 } else { 0 },
            70,
            bar * 4 * QUARTER + QUARTER + SIXTEENTH,
            SIXTEENTH,
        );
    }
    score
}

/// A walking line with ghost notes, then slaps and pops with hammered octaves.
fn bass_line() -> Score {
    const WALK: [u8; 32] = [
        33, 36, 40, 42, 38, 41, 45, 44, 43, 40, 38, 35, 36, 40, 43, 45, 41, 45, 48, 45, 38, 41, 45, 47, 40,
        44, 47, 44, 45, 43, 41, 40,
    ];
    let mut score = Score::new(126);
    let walking = score.track("walking", 1);
    for (beat, key) in (0..).zip(WALK) {
        walking.note(key, if beat % 2 == 0 { 96 } else { 86 }, beat * QUARTER, QUARTER - 30);
    }
    let ghosts = score.track("ghost notes", 2);
    ghosts.set(0, STOP, 2);
    for beat in (1..32).step_by(2) {
        ghosts.note(33, 64, beat * QUARTER + 2 * QUARTER / 3, 60);
    }
    let slapped = score.track("slapped", 3);
    slapped.set(0, LEGATO, 127);
    for bar in 0..8_u32 {
        let root = [28, 28, 31, 33][bar as usize % 4];
        for (place, stroke, over) in
            [(0, 4, 0), (3, 5, 12), (6, 4, 0), (7, 5, 10), (10, 4, 0), (11, 4, 0), (14, 5, 12)]
        {
            let start = (32 + 4 * bar) * QUARTER + place * SIXTEENTH;
            slapped.set(start, STROKE, stroke);
            slapped.note(root + over, 96, start, SIXTEENTH - 20);
        }
        // A hammer from the seventh to the octave.
        let start = (32 + 4 * bar) * QUARTER + 12 * SIXTEENTH;
        slapped.set(start, STROKE, 0);
        slapped.note(root + 10, 90, start, SIXTEENTH);
        slapped.note(root + 12, 90, start + SIXTEENTH / 2, SIXTEENTH);
    }
    score
}

/// Sixteenths at 160, picked back and forth and then connected, over a droning chord.
fn fast_run() -> Score {
    const SCALE: [u8; 15] = [52, 54, 55, 57, 59, 60, 62, 64, 66, 67, 69, 71, 72, 74, 76];
    let mut score = Score::new(160);
    let run = score.track("run", 1);
    run.set(0, STROKE, 2);
    for bar in 0..8_u32 {
        run.set(bar * 4 * QUARTER, LEGATO, if bar >= 4 { 127 } else { 0 });
        for place in 0..16_u32 {
            // Up in threes, and down again.
            let step = if bar % 2 == 0 { place } else { 15 - place };
            let key = SCALE[((step / 3 * 2 + step % 3 + bar / 2) as usize).min(14)];
            let overlap = if bar >= 4 { 15 } else { 0 };
            let velocity = if place % 4 == 0 { 100 } else { 82 };
            run.note(key, velocity, (bar * 16 + place) * SIXTEENTH, SIXTEENTH + overlap - 5);
        }
    }
    let drone = score.track("drone", 2);
    drone.set(0, PALM, 70);
    for bar in 0..8_u32 {
        for eighth in 0..8 {
            drone.chord(&[40, 47], 88, bar * 4 * QUARTER + eighth * EIGHTH, EIGHTH - 20);
        }
    }
    score
}

/// What a guitar with a pickup for each string sends: a channel for every string, the first the highest, short
/// overlaps, bends on one string while others ring. A canon on Frère Jacques.
fn midi_guitar() -> Score {
    // (key, eighths); every phrase is sung twice.
    const PHRASES: [&[(u8, u32)]; 4] = [
        &[(60, 2), (62, 2), (64, 2), (60, 2)],
        &[(64, 2), (65, 2), (67, 4)],
        &[(67, 1), (69, 1), (67, 1), (65, 1), (64, 2), (60, 2)],
        &[(60, 2), (55, 2), (60, 4)],
    ];
    const OPEN: [u8; 6] = [64, 59, 55, 50, 45, 40];
    let tune = || PHRASES.iter().flat_map(|phrase| phrase.repeat(2));
    let mut score = Score::new(132);
    let mut strings: [Vec<(u8, u8, u32, u32)>; 6] = Default::default();
    for (voice, transposed, delay) in [(0, 4, 0), (1, -8, 16), (2, -20, 32)] {
        let mut now = delay * EIGHTH;
        for (key, eighths) in tune().chain(tune()) {
            let key = (i32::from(key) + transposed) as u8;
            // Each voice keeps to two strings: the higher one for what that has.
            let string = 2 * voice + usize::from(key < OPEN[2 * voice]);
            let low = OPEN[string];
            let key = if key < low { key + 12 } else { key };
            strings[string].push((key, 80 + (now / EIGHTH % 3) as u8 * 8, now, eighths * EIGHTH - 15));
            now += eighths * EIGHTH;
        }
    }
    for (string, notes) in (0..).zip(strings) {
        let track = score.track(["E4", "B3", "G3", "D3", "A2", "E2"][usize::from(string)], string + 1);
        for (index, (key, velocity, start, length)) in notes.into_iter().enumerate() {
            track.note(key, velocity, start, length);
            // Every fourth note is pulled a quarter tone and let go.
            if index % 4 == 3 {
                track.bend(start + length / 4, length / 4, [0.0, 0.25]);
                track.bend(start + 3 * length / 4, length / 8, [0.25, 0.0]);
            }
        }
    }
    score
}
