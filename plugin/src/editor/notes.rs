//! What strings are called: as the set-up has them, or, where they are tuned to something else, by the note that they sound.

use low_action_dsp::Setup;

/// The notes of an octave.
const NOTES: [&str; 12] = ["C", "C#", "D", "D#", "E", "F", "F#", "G", "G#", "A", "A#", "B"];

/// How far a pitch may be from another that is the same, semitones: a cent is the least that is written.
const SAME: f64 = 0.005;

/// Names strings that sound another pitch than those of the set-up as it comes.
pub(super) fn name_by_sound(setup: &mut Setup, own: &Setup) {
    for (string, own) in setup.string.iter_mut().zip(&own.string) {
        if (string.pitch - own.pitch).abs() > SAME {
            string.name = note(string.pitch);
        }
    }
}

/// A pitch (MIDI note number) as the note next to it, and how many cents it is off.
fn note(pitch: f64) -> String {
    let cents = (100.0 * pitch).round() as i32;
    let nearest = (cents + 50).div_euclid(100);
    let (octave, name) = (nearest.div_euclid(12) - 1, NOTES[nearest.rem_euclid(12) as usize]);
    match cents - 100 * nearest {
        0 => format!("{name}{octave}"),
        off => format!("{name}{octave} {off:+}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pitches_are_named_by_the_next_note_and_cents() {
        for (pitch, name) in [
            (38.0, "D2"),
            (40.0, "E2"),
            (69.0, "A4"),
            (54.0, "F#3"),
            (39.7, "E2 -30"),
            (40.3, "E2 +30"),
            (40.5, "F2 -50"),
            (40.4999, "F2 -50"),
            (0.0, "C-1"),
            (127.0, "G9"),
        ] {
            assert_eq!(note(pitch), name, "{pitch}");
        }
    }

    #[test]
    fn only_what_sounds_another_pitch_has_another_name() {
        let mut own = Setup::builtin("electric").expect("it is built in");
        own.string[1].name = "of gut".into();
        let mut setup = own.clone();
        setup.string[5].pitch -= 2.0;
        setup.string[0].pitch -= 0.001;
        name_by_sound(&mut setup, &own);
        let names: Vec<&str> = setup.string.iter().map(|string| string.name.as_str()).collect();
        assert_eq!(names, ["E4", "of gut", "G3", "D3", "A2", "D2"]);
    }
}
