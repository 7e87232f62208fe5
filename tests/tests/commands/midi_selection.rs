//! The promise: of a song a track or a channel can be chosen, and is played as it is in the whole song.

use low_action::midi_file::{MidiFileError, Selection, Song, SongEvent};
use low_action::performance::PlayerEvent;
use low_action_tests::midi::{file, tempo, track};

const RATE: u32 = 48_000;
const ALL: Selection = Selection { track: None, channel: None, tenth: false, truncated: false };

/// Samples and keys of the note-ons.
fn note_ons(song: &Song) -> Vec<(u64, u8)> {
    let note_on = |event: &SongEvent| match event.event {
        PlayerEvent::NoteOn { key, .. } => Some((event.time.sample(RATE), key)),
        _ => None,
    };
    song.events.iter().filter_map(note_on).collect()
}

#[test]
fn tracks_and_channels_can_be_chosen() {
    let slow = tempo(1_000_000);
    let tracks = [
        track(&[(0, &slow), (0, &[0x90, 40, 100])]),
        track(&[(96, &[0x91, 50, 100]), (0, &[0x92, 51, 100])]),
    ];
    let bytes = file(1, 96, &tracks);
    let chosen = |track, channel| {
        Song::from_midi(&bytes, Selection { track, channel, ..ALL })
            .map(|song| note_ons(&song))
            .expect("good")
    };
    assert_eq!(chosen(Some(2), None), [(48_000, 50), (48_000, 51)], "the tempo of track 1 still counts");
    assert_eq!(chosen(None, Some(3)), [(48_000, 51)]);
    assert_eq!(chosen(Some(1), Some(2)), []);
    for asked in [0, 3] {
        let error = Song::from_midi(&bytes, Selection { track: Some(asked), ..ALL });
        assert_eq!(error, Err(MidiFileError::NoSuchTrack { asked, count: 2 }));
    }
    // Of sequences, only the chosen one takes time.
    let second = Song::from_midi(&file(2, 96, &tracks), Selection { track: Some(2), ..ALL });
    assert_eq!(note_ons(&second.expect("good"))[0], (24_000, 50), "and no other's tempo counts");
}

/// A sequence that is cut off is nothing to those before it; a track is, as its tempo counts.
#[test]
fn only_what_is_read_is_missed() {
    let notes = track(&[(0, &[0x90, 40, 100]), (96, &[0x80, 40, 0])]);
    for (format, is_missed) in [(1, true), (2, false)] {
        let whole = file(format, 96, &[notes.clone(), notes.clone()]);
        let cut = &whole[..whole.len() - 4];
        for truncated in [false, true] {
            let chosen = |track| Song::from_midi(cut, Selection { track: Some(track), truncated, ..ALL });
            assert!(chosen(2).is_err() != truncated, "format {format}");
            match chosen(1) {
                Ok(song) => assert_eq!(song.warnings.len(), usize::from(is_missed), "{:?}", song.warnings),
                Err(error) => assert!(is_missed && !truncated, "format {format}: {error}"),
            }
        }
    }
}

/// MPE is announced on channel 1 and the reach of its wheels on any other: most often in another track than the notes.
#[test]
fn what_is_chosen_of_an_mpe_song_is_bent_as_in_the_whole() {
    let first = track(&[
        (0, &[0xB0, 101, 0]),
        (0, &[0xB0, 100, 6]),
        (0, &[0xB0, 6, 15]),
        (0, &[0xB1, 101, 0]),
        (0, &[0xB1, 100, 0]),
        (0, &[0xB1, 6, 24]),
        // A maker's own parameter, which data entry must not be taken for.
        (0, &[0xB1, 99, 1]),
        (0, &[0xB1, 98, 1]),
        (0, &[0xB1, 6, 2]),
        // Its own affair.
        (0, &[0xB1, 1, 100]),
        (0, &[0x91, 40, 100]),
        (960, &[0xB0, 101, 127]),
    ]);
    let second = track(&[
        (0, &[0xE2, 0, 80]),
        (0, &[0x92, 50, 100]),
        (0, &[0xE9, 0, 70]),
        (0, &[0x99, 52, 100]),
        (96, &[0x82, 50, 0]),
    ]);
    let bytes = file(1, 96, &[first, second]);
    let whole = Song::from_midi(&bytes, ALL).expect("good");
    let announced = &whole.events[..9];
    let of = |channels: &[u8]| -> Vec<SongEvent> {
        let own = |event: &&SongEvent| event.event.channel().is_some_and(|own| channels.contains(&own));
        announced.iter().chain(whole.events[9..].iter().filter(own)).copied().collect()
    };
    for (track, channel, channels) in
        [(Some(2), None, &[2, 9][..]), (None, Some(3), &[2]), (Some(2), Some(10), &[9])]
    {
        let song = Song::from_midi(&bytes, Selection { track, channel, ..ALL }).expect("good");
        assert_eq!(song.events, of(channels), "{track:?}, {channel:?}");
        assert_eq!(song.warnings, []);
    }
    // What is announced when it is over makes it no longer.
    let last = Song::from_midi(&bytes, Selection { track: Some(2), ..ALL }).expect("good").duration();
    assert!((last - 0.5).abs() < 1e-9 && whole.duration() > 4.0, "{last}");
}
