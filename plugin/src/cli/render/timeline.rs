//! A song's events at their samples.

use crate::midi_file::Song;
use crate::performance::PlayerEvent;

/// All events in order. A sequence of format 2 is over, and let go of, at the sample at which the next one begins. What has no
/// sample before that is not heard: neither a sequence nor a note that begins at the end of one.
pub(super) fn timeline(song: &Song, sample_rate: u32) -> Vec<(u64, PlayerEvent)> {
    let mut events: Vec<(u64, PlayerEvent)> = Vec::with_capacity(song.events.len());
    // The first sample of the present sequence, and the place of its first event.
    let (mut begins, mut first) = (0, 0);
    for event in &song.events {
        let sample = event.time.sample(sample_rate);
        events.push((sample, event.event));
        if event.event != PlayerEvent::AllNotesOff {
            continue;
        }
        if sample == begins {
            events.truncate(first);
            continue;
        }
        let own = events.split_off(first);
        let begins_late = |&(time, event): &_| time == sample && matches!(event, PlayerEvent::NoteOn { .. });
        events.extend(own.into_iter().filter(|own| !begins_late(own)));
        (begins, first) = (sample, events.len());
    }
    events
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::midi_file::Selection;

    /// A file of format 2 whose sequences are a note each, that end so many ticks after it with another; a tick is a millisecond.
    fn sequences(lengths: &[u8]) -> Song {
        let mut bytes = [&b"MThd\0\0\0\x06\0\x02\0"[..], &[lengths.len() as u8, 0xe7, 40]].concat();
        for (key, &length) in (60..).zip(lengths) {
            // Another one is struck at the very end.
            bytes.extend(b"MTrk\0\0\0\x0c");
            bytes.extend([0, 0x90, key, 100, length, 0x90, key + 20, 100, 0, 0xff, 0x2f, 0]);
        }
        Song::from_midi(&bytes, Selection::default()).unwrap()
    }

    #[test]
    fn sequences_are_over_where_the_next_one_begins() {
        let note = |key| PlayerEvent::NoteOn { channel: 0, key, velocity: 100.0 / 127.0 };
        let notes = |lengths: &[u8], rate| -> Vec<_> {
            let events = timeline(&sequences(lengths), rate);
            assert!(events.is_sorted_by_key(|&(sample, _)| sample));
            let kept = |event| matches!(event, PlayerEvent::NoteOn { .. } | PlayerEvent::AllNotesOff);
            events.into_iter().filter(|&(_, event)| kept(event)).collect()
        };
        let end = PlayerEvent::AllNotesOff;
        let two = [(0, note(60)), (4_800, end), (4_800, note(61)), (4_800, note(81))];
        assert_eq!(notes(&[100, 0], 48_000), two);
        // What has no sample, the last sequence excepted, after which nothing comes.
        let others = [(0, note(61)), (4_800, end), (4_800, note(64)), (4_800, note(84))];
        assert_eq!(notes(&[0, 100, 0, 0, 0], 48_000), others);
        assert_eq!(notes(&[1, 0], 1_000), [(0, note(60)), (1, end), (1, note(61)), (1, note(81))]);
    }
}
