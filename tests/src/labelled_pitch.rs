//! The pitch that labels say notes have, beside that of the sound.

use serde_json::Value;

use crate::labelled::{Labelled, RATE, list, number, sample, samples};
use crate::pitch::{cents, frequency_near};
use crate::stage::{amplitude, decibels, peak};

/// Where the bends of a string stand at some sample, semitones: each goes from where the one before has come by 3x² − 2x³.
pub fn bend_at(bends: &[Value], string: usize, at: usize) -> f64 {
    let own: Vec<&Value> = bends.iter().filter(|bend| sample(bend, "string") == string).collect();
    let mut value = 0.0;
    for (index, bend) in own.iter().enumerate() {
        let until = own.get(index + 1).map_or(at, |next| sample(next, "sample").min(at));
        let since = until.saturating_sub(sample(bend, "sample")) as f64 / RATE;
        let x = (since / number(bend, "duration")).min(1.0);
        value += (number(bend, "semitones") - value) * x * x * (3.0 - 2.0 * x);
        if until == at {
            break;
        }
    }
    value
}

/// Checks the pitch of all notes that last, and gives their number. `most` is how far off they may be, cents.
///
/// # Panics
/// When one is not what labels say.
pub fn check_pitches(name: &str, played: &Labelled, most: f64) -> usize {
    let bends = list(&played.labels, "bends");
    let mut checked = 0;
    for note in played.notes().iter().filter(|note| note["stop"] != "muted") {
        let string = sample(note, "string");
        // Slides are under way at first, and thumbs and light fingers leave.
        let settled = match note["technique"].as_str() {
            Some("slide") => number(note, "stroke_duration"),
            _ if !note["partial"].is_null() => 0.1,
            _ => 0.0,
        };
        let from = sample(note, "onset_sample") + samples(0.05 + settled);
        let to = sample(note, "end_sample").min(from + samples(0.5));
        let still =
            |bend: &Value| sample(bend, "string") != string || !(from..to).contains(&sample(bend, "sample"));
        if to < from + samples(0.15) || !bends.iter().all(still) {
            continue;
        }
        let sound = &played.string_of(note)[from..to];
        let pitch = number(note, "frequency") * (bend_at(bends, string, from) / 12.0).exp2();
        let off = cents(frequency_near(sound, RATE, pitch), pitch);
        assert!(off.abs() < most, "{name}: {off} cents: {note}");
        // It is no partial of what sounds, and no fraction of it.
        let size = |part: f64| decibels(amplitude(sound, RATE, pitch * part) / amplitude(sound, RATE, pitch));
        assert!(
            size(0.5) < -15.0 && size(1.0 / 3.0) < -15.0,
            "{name}: {} {} dB: {note}",
            size(0.5),
            size(1.0 / 3.0)
        );
        let loud = decibels(amplitude(sound, RATE, pitch) / peak(sound));
        assert!(loud > -40.0, "{name}: {loud} dB: {note}");
        checked += 1;
    }
    checked
}
