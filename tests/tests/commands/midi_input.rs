//! The promise: every Standard MIDI File plays, every event at its exact sample; what is no such file is
//! refused in one line, and no bytes at all make the reader panic or hang.

use low_action::midi_file::{CutOff, LARGEST_FILE, Selection, Song, SongWarning};
use low_action::performance::PlayerEvent;
use low_action_tests::cases::cases;
use low_action_tests::midi::{END, file, tempo, track};
use proptest::prelude::*;

const RATE: u32 = 48_000;
const ALL: Selection = Selection { track: None, channel: None, tenth: false, truncated: false };

fn read(bytes: &[u8]) -> Song {
    Song::from_midi(bytes, ALL).expect("the file is good")
}

fn refused(bytes: &[u8]) -> String {
    let message = Song::from_midi(bytes, ALL).expect_err("the file is bad").to_string();
    assert!(!message.contains('\n'), "one line: {message}");
    message
}

/// Samples and keys of the note-ons.
fn note_ons(song: &Song) -> Vec<(u64, u8)> {
    let note_on = |event: &low_action::midi_file::SongEvent| match event.event {
        PlayerEvent::NoteOn { key, .. } => Some((event.time.sample(RATE), key)),
        _ => None,
    };
    song.events.iter().filter_map(note_on).collect()
}

#[test]
fn running_status_carries_on_even_across_meta_events() {
    // One status byte for four notes; a text event stands between the second and the third.
    let notes = track(&[
        (0, &[0x90, 60, 100]),
        (96, &[62, 100]),
        (0, &[0xFF, 0x01, 2, b'h', b'i']),
        (96, &[64, 100]),
        (96, &[64, 0]),
    ]);
    let song = read(&file(0, 96, &[notes]));
    assert_eq!(note_ons(&song), [(0, 60), (24_000, 62), (48_000, 64)]);
    let last = song.events.last().expect("events");
    assert_eq!(last.event, PlayerEvent::NoteOff { channel: 0, key: 64 }, "velocity 0 lets go");
}

#[test]
fn smpte_time_ignores_tempo() {
    let slow = tempo(2_000_000);
    let notes = track(&[(0, &slow), (0, &[0x90, 60, 100]), (1000, &[0x90, 62, 100])]);
    // 25 frames of 40 ticks: a tick is a millisecond.
    assert_eq!(note_ons(&read(&file(0, 0xE728, std::slice::from_ref(&notes))))[1].0, 48_000);
    // Drop-frame: 30000/1001 frames of 100 ticks, so 1000 ticks are 1001/3000 s, exactly 16,016 samples.
    assert_eq!(note_ons(&read(&file(0, 0xE364, &[notes])))[1].0, 16_016);
}

#[test]
fn the_three_formats_order_their_tracks() {
    let long = track(&[(0, &[0x90, 60, 100]), (96, &[0x80, 60, 0]), (96, END)]);
    let short = track(&[(48, &[0x91, 62, 100]), (48, &[0x81, 62, 0])]);
    let tracks = [long, short];
    assert_eq!(note_ons(&read(&file(1, 96, &tracks))), [(0, 60), (12_000, 62)]);
    // In sequence, the second begins where the first ends: after two beats.
    assert_eq!(note_ons(&read(&file(2, 96, &tracks))), [(0, 60), (48_000 + 12_000, 62)]);
    assert_eq!(note_ons(&read(&file(0, 96, &tracks[..1]))), [(0, 60)]);
}

#[test]
fn a_tempo_map_an_hour_long_does_not_drift() {
    // 70,000 beats whose tempo changes at every one, between two values with awkward fractions, set in a
    // track of its own; the notes fall on every tenth beat.
    let tempi = [tempo(51_283), tempo(51_577)];
    let map: Vec<(u32, &[u8])> =
        (0..70_000).map(|beat| (96 * u32::from(beat > 0), &tempi[beat % 2][..])).collect();
    let notes: Vec<(u32, &[u8])> =
        (0..7_000).map(|note| (960 * u32::from(note > 0), &[0x90, 60, 100][..])).collect();
    let song = read(&file(1, 96, &[track(&map), track(&notes)]));
    for (index, (sample, _)) in note_ons(&song).into_iter().enumerate() {
        let microseconds = 5 * index as u64 * (51_283 + 51_577);
        let exact = microseconds as f64 * f64::from(RATE) / 1e6;
        assert!((sample as f64 - exact).abs() <= 0.5, "note {index}: {sample} for {exact}");
    }
}

#[test]
fn a_tempo_that_is_none_is_passed_over_with_one_warning() {
    let (fast, none, short) = (tempo(250_000), tempo(0), [0xFF, 0x51, 2, 7, 8]);
    let notes = track(&[
        (0, &none),
        (96, &[0x90, 60, 100]),
        (0, &fast),
        (96, &[0x90, 62, 100]),
        (0, &short),
        (96, &[0x90, 64, 100]),
    ]);
    let song = read(&file(0, 96, std::slice::from_ref(&notes)));
    // The usual tempo, and then the one that was set, goes on.
    assert_eq!(note_ons(&song), [(24_000, 60), (36_000, 62), (48_000, 64)]);
    assert_eq!(song.warnings, [SongWarning::NoTempo { changes: 2 }]);
    let said = song.warnings[0].to_string();
    assert!(said.contains("1 to 16777215") && said.contains("2 changes to anything else"), "{said}");
    // Frames do not ask what the tempo is.
    assert!(read(&file(0, 0xE728, &[notes])).warnings.is_empty());
}

#[test]
fn odd_but_legal_contents_play() {
    let same_instant: Vec<[u8; 3]> = (0..100).map(|n| [0x90, n, 90]).collect();
    let hundred: Vec<(u32, &[u8])> = same_instant.iter().map(|event| (0, &event[..])).collect();
    assert_eq!(note_ons(&read(&file(0, 96, &[track(&hundred)]))).len(), 100);

    let no_length = track(&[(0, &[0x90, 60, 100]), (0, &[0x80, 60, 0])]);
    assert_eq!(read(&file(0, 96, &[no_length])).events.len(), 2);

    let nothing = read(&file(1, 96, &[track(&[]), track(&[])]));
    assert_eq!(nothing.warnings, [SongWarning::NoNotes]);
    assert_eq!(nothing.duration(), 0.0);
    assert_eq!(read(&file(1, 96, &[])).warnings, [SongWarning::NoNotes]);

    // Unknown chunks, a longer header and bytes after the end are all allowed.
    let notes = track(&[(0, &[0x90, 60, 100])]);
    let mut odd = b"MThd\0\0\0\x08\0\x01\0\x01\0\x60\xAB\xCD".to_vec();
    odd.extend(b"XFIH\0\0\0\x03abc");
    odd.extend(&file(0, 96, std::slice::from_ref(&notes))[14..]);
    odd.extend(b"rest");
    assert_eq!(note_ons(&read(&odd)).len(), 1);

    // The same in a RIFF wrapper.
    let inner = file(0, 96, &[notes]);
    let mut wrapped = b"RIFF\0\0\0\0RMIDdata".to_vec();
    wrapped.extend((inner.len() as u32).to_le_bytes());
    wrapped.extend(inner);
    assert_eq!(note_ons(&read(&wrapped)).len(), 1);
}

#[test]
fn tracks_that_the_header_does_not_announce_are_left_out_with_one_warning() {
    let note = |key| track(&[(0, &[0x90, key, 100])]);
    let mut bytes = file(1, 96, &[note(60), note(61), note(62)]);
    // The header's count of tracks.
    bytes[11] = 1;
    let song = read(&bytes);
    assert_eq!(note_ons(&song), [(0, 60)]);
    assert_eq!(song.warnings, [SongWarning::TracksLeftOut { announced: 1, left_out: 2 }]);
    assert!(song.warnings[0].to_string().contains("the last 2 left out"), "{}", song.warnings[0]);
    // What follows without being a track is no matter.
    bytes[11] = 3;
    bytes.extend(b"XFIH\0\0\0\x03abcMTrk\0");
    assert_eq!(read(&bytes).warnings, []);
}

#[test]
fn drums_are_left_out_with_one_warning() {
    let notes =
        track(&[(0, &[0x99, 38, 100]), (10, &[0x99, 42, 100]), (0, &[0x90, 60, 100]), (0, &[0x99, 42, 0])]);
    let bytes = file(0, 96, &[notes]);
    let song = read(&bytes);
    assert_eq!(note_ons(&song), [(2_500, 60)]);
    assert_eq!(song.warnings, [SongWarning::DrumsSkipped { notes: 2 }]);

    let drums = Song::from_midi(&bytes, Selection { channel: Some(10), ..ALL }).expect("good");
    assert_eq!(note_ons(&drums).len(), 2, "asking for the channel plays it");
    assert!(drums.warnings.is_empty());

    // Where channels are strings or notes of MPE it is one like the others.
    let strings = Song::from_midi(&bytes, Selection { tenth: true, ..ALL }).expect("good");
    assert_eq!((note_ons(&strings).len(), strings.warnings.len()), (3, 0));
    let announced =
        [(0, &[0xB0, 101, 0][..]), (0, &[0xB0, 100, 6]), (0, &[0xB0, 6, 15]), (5, &[0x99, 38, 100])];
    let mpe = read(&file(0, 96, &[track(&announced)]));
    assert_eq!((note_ons(&mpe).len(), mpe.warnings.len()), (1, 0));
    // Nine members are channels 2 to 10, and eight end before it; those before it that were announced first count.
    for (announced, left) in [(&[8][..], 0), (&[9], 1), (&[5], 0), (&[15, 5], 1)] {
        let mut events = vec![(0, &[0xB0, 101, 0][..]), (0, &[0xB0, 100, 6])];
        let counts: Vec<[u8; 3]> = announced.iter().map(|&count| [0xB0, 6, count]).collect();
        events.extend(counts.iter().map(|count| (0, &count[..])));
        events.push((5, &[0x99, 38, 100]));
        events.push((0, &[0x91, 60, 100]));
        let song = read(&file(0, 96, &[track(&events)]));
        assert_eq!(note_ons(&song).len(), 1 + left, "{announced:?} members");
        let skipped = (left == 0).then_some(SongWarning::DrumsSkipped { notes: 1 });
        assert_eq!(song.warnings, skipped.into_iter().collect::<Vec<_>>());
    }
}

#[test]
fn an_upper_zone_of_mpe_is_told_once() {
    let zone = |channel: u8, count: u8| {
        let status = 0xB0 | channel;
        [[status, 101, 0], [status, 100, 6], [status, 6, count]]
    };
    for (zones, is_told) in [
        (vec![zone(0, 7)], false),
        (vec![zone(15, 0)], false),
        (vec![zone(15, 7), zone(0, 7), zone(15, 7)], true),
        (vec![zone(15, 7)], true),
    ] {
        let messages = zones.concat();
        let mut events: Vec<(u32, &[u8])> = messages.iter().map(|message| (0, &message[..])).collect();
        events.push((0, &[0x91, 60, 100]));
        let told = if is_told { vec![SongWarning::UpperZone] } else { vec![] };
        assert_eq!(read(&file(0, 96, &[track(&events)])).warnings, told, "{zones:?}");
    }
}

#[test]
fn bends_reach_both_ends() {
    let bends = track(&[(0, &[0xE0, 0, 0]), (0, &[0xE0, 0, 64]), (0, &[0xE0, 127, 127])]);
    let values: Vec<PlayerEvent> =
        read(&file(0, 96, &[bends])).events.iter().map(|event| event.event).collect();
    assert_eq!(values, [-1.0, 0.0, 1.0].map(|value| PlayerEvent::PitchBend { channel: 0, value }));
}

#[test]
fn what_is_no_midi_file_is_refused() {
    for bytes in
        [&b""[..], b"\0", b"RIFF", b"RIFF\0\0\0\0WAVEfmt ", b"<html>", b"MTrk\0\0\0\0", &[0xFF; 4096]]
    {
        assert!(refused(bytes).contains("MIDI"), "{bytes:?}");
    }
    assert!(refused(&vec![0; LARGEST_FILE + 1]).contains("at most"));
    assert!(refused(&file(3, 96, &[])).contains("must be 0, 1 or 2"));
    let message = refused(b"MThd\0\0\0\x04\0\0\0\x01");
    assert_eq!(message, "impossible MIDI header: its chunk has 4 bytes, and at least 6 are needed");
    assert_eq!(refused(b"MThd"), "truncated MIDI file: the header begins with 8 bytes, 4 are left");
    for division in [0, 0x8000, 0x8001, 0xE700, 0xE800, 0xFF01] {
        let message = refused(&file(0, division, &[track(&[])]));
        assert!(message.contains("1 to 32767") && message.contains("frames"), "{message}");
    }
}

/// Every truncation is refused. A download that broke off is the same music up to there, as long as no whole track is missing:
/// whoever asks for it hears that, and is told so. With a track less it would be other music.
#[test]
fn every_truncation_is_refused_and_a_last_track_that_is_cut_off_plays_if_asked_for() {
    let notes = track(&[(0, &[0x90, 60, 100]), (96, &[0x80, 60, 0]), (0, &[0x90, 62, 100])]);
    let data = notes.len();
    let whole = file(1, 96, &[notes.clone(), notes]);
    for length in 0..whole.len() {
        let there = (length + data).saturating_sub(whole.len());
        let bytes = &whole[..length];
        let asked_for = Song::from_midi(bytes, Selection { truncated: true, ..ALL });
        let message = refused(bytes);
        if there > 0 {
            let song = asked_for.expect("something is there");
            // The first track, and of the second the events that are whole.
            let keys: Vec<u8> = note_ons(&song).into_iter().map(|(_, key)| key).collect();
            let expected: &[u8] = match there {
                ..4 => &[60, 62],
                4..12 => &[60, 60, 62],
                _ => &[60, 60, 62, 62],
            };
            assert_eq!(keys, expected, "{there} bytes of the last track");
            let cut = CutOff { track: 2, expected: data, found: there };
            assert_eq!(song.warnings, [SongWarning::CutOff(cut)]);
            let told = format!("truncated MIDI file: track 2 announces {data} bytes, {there} are left");
            assert!(song.warnings[0].to_string().starts_with(&told), "{}", song.warnings[0]);
            assert_eq!(message, format!("{told} (--allow-truncated plays what they hold)"));
            continue;
        }
        let expected = if length < 4 { "MIDI file" } else { "truncated MIDI file" };
        assert!(message.contains(expected), "{length} bytes: {message}");
        assert_eq!(asked_for.expect_err("a whole track is missing").to_string(), message);
    }
}

/// A chunk's length that is too large for a file that has all there is to play, as some programs write.
#[test]
fn a_track_that_announces_too_much_plays_to_its_end() {
    let mut bytes = file(0, 96, &[track(&[(0, &[0x90, 60, 100]), (96, &[0x80, 60, 0])])]);
    bytes[21] += 3;
    let song = read(&bytes);
    assert_eq!((note_ons(&song).len(), song.events.len()), (1, 2));
    assert!(matches!(song.warnings[..], [SongWarning::CutOff { .. }]), "{:?}", song.warnings);
}

/// What is said of a song with some controllers before a note.
fn told(controllers: &[[u8; 3]]) -> String {
    let mut events: Vec<(u32, &[u8])> = controllers.iter().map(|event| (0, &event[..])).collect();
    events.push((0, &[0x90, 60, 100]));
    let warnings = read(&file(0, 96, &[track(&events)])).warnings;
    assert!(warnings.len() <= 1, "{warnings:?}");
    warnings.first().map(ToString::to_string).unwrap_or_default()
}

#[test]
fn volume_and_pan_that_ask_for_something_are_told_once() {
    assert_eq!(
        told(&[[0xB0, 7, 90], [0xB0, 7, 80]]),
        "controller 7 (volume) is passed over: use 11, or gain in a set-up file"
    );
    assert_eq!(told(&[[0xB0, 10, 0]]), "controller 10 (pan) is passed over: use pan in a set-up file");
    assert_eq!(
        told(&[[0xB0, 10, 127], [0xB0, 7, 0]]),
        "controllers 7 (volume) and 10 (pan) are passed over: use 11, or gain and pan in a set-up file"
    );
    // What General MIDI begins with anyway, and what is said to a channel without notes.
    assert_eq!(told(&[[0xB0, 7, 100], [0xB0, 10, 64]]), "");
    assert_eq!(told(&[[0xB1, 7, 30], [0xB9, 10, 0]]), "");
}

#[test]
fn program_changes_are_counted_where_there_are_notes() {
    let said = |programs: &[[u8; 2]]| {
        let mut events: Vec<(u32, &[u8])> = programs.iter().map(|event| (0, &event[..])).collect();
        // A note of the first channel, and one of percussion, which is left out.
        events.extend([(0, &[0x90, 60, 100][..]), (0, &[0x99, 36, 100])]);
        let warnings = read(&file(0, 96, &[track(&events)])).warnings;
        let told: Vec<String> = warnings.iter().map(ToString::to_string).collect();
        told.into_iter().filter(|told| told.contains("program change")).collect::<Vec<_>>().join("; ")
    };
    assert_eq!(said(&[[0xC0, 25]]), "1 program change is passed over: use --instrument");
    assert_eq!(
        said(&[[0xC0, 25], [0xC1, 30], [0xC0, 0]]),
        "2 program changes are passed over: use --instrument"
    );
    assert_eq!(said(&[[0xC1, 25], [0xC9, 0]]), "");
}

#[test]
fn tuning_that_asks_for_something_is_told_once() {
    let of = |channel: u8, number, values: &[[u8; 2]]| {
        let select = [[0xB0 | channel, 101, 0], [0xB0 | channel, 100, number]];
        let values = values.iter().map(|&[number, value]| [0xB0 | channel, number, value]);
        told(&select.into_iter().chain(values).collect::<Vec<_>>())
    };
    let passed_over = "registered parameters 1 and 2 (tuning of a channel) are passed over: use the pitch wheel, or pitches in \
                       a set-up file";
    for values in [&[[6, 63], [38, 0], [6, 70]][..], &[[6, 64], [38, 1]], &[[6, 70]]] {
        assert_eq!(of(0, 1, values), passed_over, "{values:?}");
    }
    assert_eq!(of(0, 2, &[[6, 52]]), passed_over);
    // What asks for nothing: no tuning, the lower half that means nothing, a channel without notes, other parameters.
    for told in [
        of(0, 1, &[[6, 64], [38, 0]]),
        of(0, 2, &[[6, 64], [38, 5]]),
        of(1, 2, &[[6, 52]]),
        of(0, 0, &[[6, 12], [38, 50]]),
        of(0, 2, &[[98, 0], [99, 0], [6, 52]]),
        of(0, 2, &[[121, 0], [6, 52]]),
    ] {
        assert_eq!(told, "");
    }
}

#[test]
fn damaged_events_are_refused_with_their_place() {
    for event in [&[0x60, 60][..], &[0xF1, 0], &[0xF8]] {
        let message = refused(&file(0, 96, &[track(&[(0, event)])]));
        assert!(message.contains("byte 0 of track 1"), "{message}");
    }
    // A note cut off inside an intact chunk.
    assert!(refused(&file(0, 96, &[vec![0, 0x90, 60]])).contains("byte 0 of track 1"));
    // A track that merely lacks its end plays, with a word about it.
    let song = read(&file(0, 96, &[vec![0, 0x90, 60, 100]]));
    assert_eq!((note_ons(&song).len(), song.warnings), (1, vec![SongWarning::NoEndOfTrack { track: 1 }]));
}

/// What nothing is played by may say anything, as long as it ends where it says.
#[test]
fn meta_events_that_say_what_cannot_be_are_passed_over() {
    for odd in [
        // Hour 25, and drop-frame television's thirty-first frame: where a song begins on a tape.
        &[0xFF, 0x54, 5, 0x19, 0, 0, 0, 0][..],
        &[0xFF, 0x54, 5, 0, 0, 0, 25, 0],
        &[0xFF, 0x54, 5, 0x1F, 0, 0, 0, 0],
        // Keys that say too little.
        &[0xFF, 0x59, 0],
        &[0xFF, 0x59, 1, 2],
        &[0xFF, 0x54, 0],
    ] {
        // They take their time, and running status goes on across them.
        let notes = track(&[(0, &[0x90, 60, 100]), (96, odd), (0, odd), (96, &[62, 100]), (0, &[60, 0])]);
        let song = read(&file(0, 96, std::slice::from_ref(&notes)));
        assert_eq!(note_ons(&song), [(0, 60), (48_000, 62)], "{odd:?}");
        assert_eq!((song.events.len(), song.warnings), (3, vec![]), "{odd:?}");
        // One that reaches beyond its track is damage.
        let mut cut = odd.to_vec();
        cut[2] += 1;
        let message = refused(&file(0, 96, &[[&[0, 0x90, 60, 100, 0][..], &cut].concat()]));
        assert!(message.contains("byte 4 of track 1"), "{odd:?}: {message}");
    }
}

#[test]
fn the_longest_times_neither_overflow_nor_hang() {
    let slowest = tempo(0xFF_FFFF);
    let mut events: Vec<(u32, &[u8])> = vec![(0, &slowest)];
    events.extend((0..10_000).map(|_| (0x0FFF_FFFF, &[0x90, 60, 100][..])));
    let song = read(&file(0, 1, &[track(&events)]));
    let exact = 10_000.0 * f64::from(0x0FFF_FFFF) * f64::from(0xFF_FFFF) / 1e6;
    assert!((song.duration() / exact - 1.0).abs() < 1e-12);
    assert!(note_ons(&song).is_sorted());
}

/// Reads the bytes in every way; whatever comes out must make sense.
fn survives(bytes: &[u8]) {
    for selection in [ALL, Selection { track: Some(1), ..ALL }, Selection { channel: Some(1), ..ALL }] {
        match Song::from_midi(bytes, selection) {
            Ok(song) => {
                assert!(song.duration() >= 0.0);
                assert!(song.events.is_sorted_by_key(|event| event.time.sample(RATE)));
            }
            Err(error) => assert!(!error.to_string().contains('\n')),
        }
    }
}

/// A file with a bit of everything, for mutation.
fn rich() -> Vec<u8> {
    let (fast, slow) = (tempo(300_000), tempo(900_000));
    let first =
        track(&[(0, &fast), (10, &[0x90, 60, 100]), (5, &[62, 90]), (200, &slow), (0, &[0x80, 60, 0])]);
    let second = track(&[
        (0, &[0xF0, 3, 1, 2, 0xF7]),
        (7, &[0xE1, 3, 80]),
        (130, &[0xB1, 64, 127]),
        (20_000, &[0x91, 50, 50]),
        (0, &[0xFF, 0x03, 4, b'n', b'a', b'm', b'e']),
        (9, &[0xC1, 5]),
        (0, &[0x91, 50, 0]),
    ]);
    file(1, 480, &[first, second])
}

/// The name of a chunk, most often of a track.
fn any_name() -> impl Strategy<Value = [u8; 4]> {
    prop_oneof![6 => Just(*b"MTrk"), 1 => Just(*b"MThd"), 1 => any::<[u8; 4]>()]
}

/// How long a chunk says it is, if that is not the truth.
fn any_length() -> impl Strategy<Value = Option<u32>> {
    prop_oneof![6 => Just(None), 1 => (0..80_u32).prop_map(Some), 1 => any::<u32>().prop_map(Some)]
}

proptest! {
    #![proptest_config(cases(4_000))]

    #[test]
    fn random_chunks_behind_a_header(
        fields: [u8; 6],
        sane: bool,
        chunks in prop::collection::vec((any_name(), any_length(), prop::collection::vec(any::<u8>(), 0..60)), 0..6),
    ) {
        // Format 1 and 96 ticks a beat, or anything at all.
        let mut bytes = [&b"MThd\0\0\0\x06"[..], if sane { &[0, 1, 0, 2, 0, 96] } else { &fields }].concat();
        for (name, length, data) in chunks {
            bytes.extend(name);
            bytes.extend(length.unwrap_or(data.len() as u32).to_be_bytes());
            bytes.extend(data);
        }
        survives(&bytes);
    }

    #[test]
    fn random_bytes_in_a_track(division: u16, bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        survives(&file(0, division, &[bytes]));
    }

    #[test]
    fn mutated_files(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12), cut: prop::sample::Index) {
        let mut bytes = rich();
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        survives(&bytes);
        survives(&bytes[..cut.index(bytes.len())]);
    }
}

/// A text or a system exclusive message that announces more than its track has would swallow the rest of it.
#[test]
fn what_announces_more_than_there_is_is_refused() {
    let chunk = |data: &[u8]| [b"MTrk", &(data.len() as u32).to_be_bytes()[..], data].concat();
    let notes = [0x00, 0x90, 60, 100, 0x60, 0x80, 60, 0];
    let header = [b"MThd", &[0, 0, 0, 6, 0, 1, 0, 1, 0, 96][..]].concat();
    for begin in [&[0x00, 0xFF, 0x03, 0x40, b'G'][..], &[0x00, 0xF0, 0x20, 1], &[0x00, 0xF7, 0x81, 0x00, 1]] {
        let data = [begin, &notes, &[0x00, 0xFF, 0x2F, 0x00]].concat();
        let message = refused(&[&header[..], &chunk(&data)].concat());
        assert_eq!(message, "damaged MIDI file: no readable event at byte 0 of track 1");
    }
    // What is as long as it says may be the last there is.
    let whole = [&notes[..], &[0x00, 0xFF, 0x01, 2, b'h', b'i']].concat();
    let song = read(&[&header[..], &chunk(&whole)].concat());
    assert_eq!(note_ons(&song).len(), 1);
    assert_eq!(song.warnings, [SongWarning::NoEndOfTrack { track: 1 }]);
}
