//! The music hosts play: a chord, a melody, the pedal and the wheel, as a standard MIDI file.

/// Ticks in a beat. At MIDI's usual 120 beats a minute and 48 kHz a tick is exactly 50 samples, so that no
/// host can round an event to another sample.
const TICKS: u16 = 480;

/// Which note-on of the clip is taken away to see whether the comparison notices.
pub(super) const TAKEN_AWAY: u8 = 64;

/// When, in ticks, and the bytes of each message. Notes come at any time. VST3 knows controllers as parameters,
/// and hosts built with JUCE pass them on at the start of a block: those stand at every 256th tick, where
/// blocks of 512 samples begin.
const MESSAGES: &[(u32, [u8; 3])] = &[
    (240, [0x90, 45, 100]),
    (480, [0x90, 52, 90]),
    (720, [0x90, 64, 70]),
    (768, [0xB0, 64, 127]),
    (960, [0x80, 45, 0]),
    (1024, [0xE0, 0, 96]),
    (1280, [0xE0, 0, 64]),
    (1280, [0xB0, 64, 0]),
    (1400, [0x80, 52, 0]),
    (1440, [0x80, 64, 0]),
    (1500, [0x90, 57, 120]),
    (1680, [0x90, 59, 60]),
    (1900, [0x80, 57, 0]),
    (2400, [0x80, 59, 0]),
];

/// The file's bytes, without the notes of one key if one is given.
pub(super) fn midi(without: Option<u8>) -> Vec<u8> {
    let mut track = Vec::new();
    let mut now = 0;
    for &(time, message) in MESSAGES {
        let is_note = message[0] >> 4 == 0x9 || message[0] >> 4 == 0x8;
        if is_note && without == Some(message[1]) {
            continue;
        }
        variable_length(time - now, &mut track);
        track.extend(message);
        now = time;
    }
    track.extend([0, 0xFF, 0x2F, 0]);
    let mut file = b"MThd\0\0\0\x06\0\0\0\x01".to_vec();
    file.extend(TICKS.to_be_bytes());
    file.extend(b"MTrk");
    file.extend((track.len() as u32).to_be_bytes());
    file.extend(track);
    file
}

/// A number in groups of seven bits, the highest first, all but the last marked.
fn variable_length(number: u32, bytes: &mut Vec<u8>) {
    let groups = (1..5).rev().filter(|group| number >> (7 * group) != 0);
    bytes.extend(groups.map(|group| (number >> (7 * group)) as u8 | 0x80));
    bytes.push(number as u8 & 0x7F);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_standard() {
        // Examples of the MIDI file specification.
        for (number, expected) in [
            (0x40, &[0x40][..]),
            (0x80, &[0x81, 0x00]),
            (0x2000, &[0xC0, 0x00]),
            (0x10_0000, &[0xC0, 0x80, 0x00]),
            (0x0FFF_FFFF, &[0xFF, 0xFF, 0xFF, 0x7F]),
        ] {
            let mut bytes = Vec::new();
            variable_length(number, &mut bytes);
            assert_eq!(bytes, expected);
        }
    }

    #[test]
    fn a_note_can_be_taken_away() {
        assert_eq!(midi(None).len() - midi(Some(TAKEN_AWAY)).len(), 2 * 4);
    }
}
