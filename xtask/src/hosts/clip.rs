//! The music hosts play: a chord, a melody, the pedal and the wheel, as a standard MIDI file.

use midly::live::LiveEvent;
use midly::num::{u15, u28};
use midly::{Format, Header, MetaMessage, Smf, Timing, TrackEvent, TrackEventKind};

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
    let mut now = 0;
    let mut track: Vec<TrackEvent> = MESSAGES
        .iter()
        .filter(|(_, [status, key, _])| without != Some(*key) || !matches!(status >> 4, 0x8 | 0x9))
        .map(|(time, message)| {
            let Ok(LiveEvent::Midi { channel, message }) = LiveEvent::parse(message) else {
                panic!("{message:?} is no message of a channel");
            };
            let delta = u28::new(time - std::mem::replace(&mut now, *time));
            TrackEvent { delta, kind: TrackEventKind::Midi { channel, message } }
        })
        .collect();
    let end = TrackEventKind::Meta(MetaMessage::EndOfTrack);
    track.push(TrackEvent { delta: u28::new(0), kind: end });
    let header = Header::new(Format::SingleTrack, Timing::Metrical(u15::new(TICKS)));
    let mut file = Vec::new();
    Smf { header, tracks: vec![track] }.write_std(&mut file).expect("memory takes every byte");
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ticks and channel messages as a host reads them.
    fn read(file: &[u8]) -> Vec<(u32, Vec<u8>)> {
        let Smf { header, tracks } = Smf::parse(file).expect("it is a MIDI file");
        assert_eq!((header.timing, tracks.len()), (Timing::Metrical(u15::new(TICKS)), 1));
        let mut now = 0;
        let mut messages = Vec::new();
        for event in &tracks[0] {
            now += event.delta.as_int();
            if let Some(live @ LiveEvent::Midi { .. }) = event.kind.as_live_event() {
                let mut bytes = Vec::new();
                live.write_std(&mut bytes).expect("memory takes every byte");
                messages.push((now, bytes));
            }
        }
        messages
    }

    #[test]
    fn the_file_holds_the_messages_at_their_ticks() {
        let expected = |without| {
            let kept = |(_, [status, key, _]): &&(u32, [u8; 3])| status & 0xF0 > 0x90 || *key != without;
            MESSAGES.iter().filter(kept).map(|(time, message)| (*time, message.to_vec())).collect::<Vec<_>>()
        };
        assert_eq!(read(&midi(None)), expected(u8::MAX));
        assert_eq!(read(&midi(Some(TAKEN_AWAY))), expected(TAKEN_AWAY));
        // A note goes down and up, and no controller has gone with it.
        assert_eq!(expected(TAKEN_AWAY).len() + 2, MESSAGES.len());
    }
}
