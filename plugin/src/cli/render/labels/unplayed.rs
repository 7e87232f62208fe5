//! Notes that are in the song and not in the sound, a flat record for each.

use std::collections::BTreeSet;

use serde::Serialize;

use super::Clock;
use super::notes::Course;
use crate::midi_file::{LeftOut, WhyLeftOut};
use crate::performance::{Unplayed, Why};

/// A note that did not sound.
#[derive(Debug, Clone, Serialize)]
pub(super) struct LabelledUnplayed {
    asked_sample: u64,
    /// s.
    asked: f64,
    /// MIDI's own numbers: 1 to 16, 0 to 127, 1 to 127.
    channel: u8,
    key: u8,
    velocity: u8,
    why: &'static str,
}

/// Notes that no string got, those that were not struck on theirs, and those that no player was given, in order of time and of
/// channels and keys.
pub(super) fn unplayed(
    courses: &[Course],
    others: &[Unplayed],
    left_out: &[LeftOut],
    clock: Clock,
) -> Vec<LabelledUnplayed> {
    let others = others.iter().map(|note| {
        let Unplayed { channel, key, velocity, asked, why } = *note;
        let why = match why {
            Why::LeftOut => "left_out",
            Why::WithoutString => "without_string",
            Why::Doubled => "doubled",
        };
        label((asked, channel, key), velocity, why, clock)
    });
    let left_out = left_out.iter().map(|note| {
        let why = match note.why {
            WhyLeftOut::Percussion => "percussion",
            WhyLeftOut::NotChosen => "not_chosen",
        };
        label((clock.sample(note.time), note.channel, note.key), note.velocity.into(), why, clock)
    });
    let mut unplayed: Vec<LabelledUnplayed> = others.chain(left_out).collect();
    let has_sound = |course: &&Course| course.sounded.is_some_and(|(onset, _)| clock.has(onset));
    let heard: BTreeSet<Asked> = courses.iter().filter(has_sound).map(asked).collect();
    // One that moves to another string before it is struck there has a course for each.
    let mut told = BTreeSet::new();
    for course in courses.iter().rev().filter(|course| !course.note.returned) {
        let asked = asked(course);
        if !heard.contains(&asked) && told.insert(asked) {
            unplayed.push(label(asked, course.note.velocity, why(course), clock));
        }
    }
    unplayed.retain(|note| clock.has(note.asked_sample));
    unplayed.sort_by_key(|note| (note.asked_sample, note.channel, note.key, note.velocity));
    unplayed
}

/// Sample, channel and key of a note-on.
type Asked = (u64, u8, u8);

fn asked(course: &Course) -> Asked {
    (course.note.asked, course.note.channel, course.note.key)
}

/// Why a note that had a string is not heard.
fn why(course: &Course) -> &'static str {
    match (course.sounded, course.end) {
        (None, Some((_, "note"))) => "overtaken",
        (None, Some(_)) => "left_out",
        // It would have been.
        (Some(_), _) | (None, None) => "file",
    }
}

fn label((asked, channel, key): Asked, velocity: f64, why: &'static str, clock: Clock) -> LabelledUnplayed {
    LabelledUnplayed {
        asked_sample: asked,
        asked: clock.seconds(asked),
        channel: channel + 1,
        key,
        velocity: (velocity * 127.0).round() as u8,
        why,
    }
}
