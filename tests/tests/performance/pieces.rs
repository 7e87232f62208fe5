//! The promise: music of ordinary density is played to the last note. Every note that begins sounds, no note is
//! left out, no note and no finger stays when the music is over, and nothing is clipped. Every gesture has its
//! file and every set-up its phrase.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use low_action::engine::{Engine, EngineOptions};
use low_action::midi_file::{Selection, Song};
use low_action::performance::{InputMode, PlayerEvent, Style};
use low_action_dsp::{Quality, Setup, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, any_left, of_string};
use low_action_tests::numbers::largest;

const RATE: u32 = 48_000;

/// Names and songs of a folder of the documentation.
fn songs(folder: &str) -> Vec<(String, Song)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(folder);
    let mut paths: Vec<PathBuf> = fs::read_dir(root)
        .expect("the folder is there")
        .map(|entry| entry.expect("readable").path())
        .collect();
    paths.sort();
    let song = |path: PathBuf| {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let song = Song::from_midi(&fs::read(path).expect("readable"), Selection::default()).expect("a song");
        assert!(song.warnings.is_empty(), "{name}: {:?}", song.warnings);
        (name, song)
    };
    paths.into_iter().map(song).collect()
}

/// The set-up for a piece, and what its channels mean.
fn played_on(name: &str) -> (&'static str, InputMode) {
    match name {
        "fingerpicking" => ("classical", InputMode::Keyboard),
        "strumming" => ("steel", InputMode::Keyboard),
        "bass_line" => ("bass", InputMode::Keyboard),
        "midi_guitar" => ("electric", InputMode::Strings { first: 0, from_last: false }),
        _ => ("electric", InputMode::Keyboard),
    }
}

/// The instrument that the documentation names for a gesture's file.
fn documented<'a>(page: &'a str, name: &str) -> &'a str {
    let link = format!("| [{name}](gestures/{name}.mid) | ");
    let row = page.lines().find_map(|line| line.strip_prefix(&link));
    row.and_then(|rest| rest.split(" |").next())
        .unwrap_or_else(|| panic!("{name} is not in the documentation"))
}

/// What became of a song's notes.
struct Fate {
    notes: usize,
    left_out: u64,
    late: u64,
}

/// Plays a song with hands alone: every note must sound once it has begun, and nothing may stay.
fn play(name: &str, song: &Song, setup: &str, input: InputMode) -> Fate {
    let mut performance = Neck::of(setup).player(Style { variation: 0.25, ..EXACT });
    performance.set_input(input);
    let mut gestures: Vec<TimedGesture> = Vec::new();
    let events: Vec<(u64, PlayerEvent)> =
        song.events.iter().map(|event| (event.time.sample(RATE), event.event)).collect();
    let mut switches = 0_u8;
    let mut notes = 0;
    let mut index = 0;
    while index < events.len() {
        let time = events[index].0;
        let instant: Vec<PlayerEvent> =
            events[index..].iter().take_while(|event| event.0 == time).map(|event| event.1).collect();
        index += instant.len();
        let late_before = performance.compromises().arpeggiated;
        for &event in &instant {
            performance.event(time, event, &mut gestures);
            if let PlayerEvent::Controller { number: 27, value, .. } = event {
                switches = (value * 127.0).round() as u8;
            }
        }
        performance.advance(time + 1, &mut gestures);
        let late = performance.compromises().arpeggiated - late_before;
        let mut silent = 0;
        for &event in &instant {
            let PlayerEvent::NoteOn { channel, key, .. } = event else { continue };
            if switches > 0 && (switches..switches + 20).contains(&key) {
                continue;
            }
            notes += 1;
            silent += u64::from(!performance.sounds(channel, key));
        }
        assert_eq!(silent, late, "{name}: notes at sample {time} that do not sound");
    }
    let end = events.last().expect("events").0;
    performance.advance(end + u64::from(RATE) * 9 / 2, &mut gestures);
    for channel in 0..16 {
        assert!(
            (0..128).all(|key| !performance.sounds(channel, key)),
            "{name}: a note of channel {channel} hangs"
        );
    }
    assert!(!any_left(&gestures), "{name}: a finger stays");
    let compromises = performance.compromises();
    Fate { notes, left_out: compromises.left_out, late: compromises.arpeggiated }
}

/// The whole sound of a song; it must be there, and all there.
fn hear(name: &str, song: &Song, setup: &str, input: InputMode) {
    let setup = Setup::shipped(setup).expect("it comes with the program");
    let options = EngineOptions { quality: Quality::Draft, ..EngineOptions::new(setup, f64::from(RATE)) };
    let mut engine = Engine::new(&options).expect("it can be built");
    engine.set_input(input);
    let mut events = song.events.iter().map(|event| (event.time.sample(RATE), event.event)).peekable();
    let end = (song.duration() * f64::from(RATE)) as u64 + 2 * u64::from(RATE);
    let (mut peak, mut left, mut right) = (0.0, [0.0; 480], [0.0; 480]);
    let mut last = 0.0;
    for start in (0..end).step_by(480) {
        while let Some((time, event)) = events.next_if(|event| event.0 < start + 480) {
            engine.event((time - start) as u32, event);
        }
        engine.process(&mut left, &mut right);
        last = largest(left.iter().chain(&right).map(|sample| sample.abs()));
        assert!(last.is_finite());
        peak = largest([peak, last]);
    }
    let level = 20.0 * peak.log10();
    println!("{name}: {:.1} s, peak {level:.1} dBFS, {:?}", song.duration(), engine.compromises());
    assert!((-30.0..0.0).contains(&level), "{name}: {level} dBFS");
    assert!(last < 0.01 * peak, "{name}: it sounds on: {last} of {peak}");
    assert_eq!(engine.lost_events(), 0);
}

/// Does something with every song of a list, side by side.
fn each(songs: &[(String, Song)], check: impl Fn(&str, &Song) + Sync) {
    std::thread::scope(|scope| {
        for half in [0, 1] {
            let check = &check;
            scope.spawn(move || {
                songs.iter().skip(half).step_by(2).for_each(|(name, song)| check(name, song));
            });
        }
    });
}

#[test]
fn five_pieces_are_played_to_the_last_note() {
    let pieces = songs("pieces");
    assert!(pieces.len() >= 5);
    each(&pieces, |name, song| {
        let (setup, input) = played_on(name);
        let Fate { notes, left_out, late } = play(name, song, setup, input);
        println!("{name}: {notes} notes");
        assert!(notes > 100, "{name} has {notes} notes");
        assert_eq!((left_out, late), (0, 0), "{name}");
        hear(name, song, setup, input);
    });
}

#[test]
fn every_gesture_has_a_file_that_plays() {
    let gestures = songs("gestures");
    let page =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/gestures.md")).expect("there");
    // None is missing, and none is left that nobody finds.
    let names: BTreeSet<&str> = gestures.iter().map(|(name, _)| name.as_str()).collect();
    let links = page.split("](gestures/").skip(1).filter_map(|rest| rest.split_once(".mid)"));
    assert_eq!(names, links.map(|(name, _)| name).collect());
    assert!(!names.is_empty());
    each(&gestures, |name, song| {
        let (setup, input) = (documented(&page, name), InputMode::Keyboard);
        let Fate { left_out, late, .. } = play(name, song, setup, input);
        assert_eq!(left_out, 0, "{name}");
        assert!(late == 0 || name == "too_many_notes", "{name}: {late} notes come late");
        hear(name, song, setup, input);
    });
}

#[test]
fn every_set_up_has_a_phrase() {
    let phrases = songs("phrases");
    let names: Vec<&str> = phrases.iter().map(|(name, _)| name.as_str()).collect();
    let mut presets = Setup::PRESETS.to_vec();
    presets.sort_unstable();
    assert_eq!(names, presets);
    assert!(presets.len() >= 16);
    each(&phrases, |name, song| {
        let Fate { left_out, .. } = play(name, song, name, InputMode::Keyboard);
        assert_eq!(left_out, 0, "{name}");
        hear(name, song, name, InputMode::Keyboard);
    });
}

/// A channel for each string: a note on one never ends, bends or moves one on another.
#[test]
fn strings_with_their_own_channels_never_cut_one_another() {
    let (_, song) = songs("pieces").into_iter().find(|(name, _)| name == "midi_guitar").expect("it is there");
    let neck = Neck::of("electric");
    let gestures_of = |only: Option<u8>| {
        let mut performance = neck.player(EXACT);
        performance.set_input(InputMode::Strings { first: 0, from_last: false });
        let mut gestures = Vec::new();
        for event in &song.events {
            if only.is_none() || event.event.channel() == only {
                performance.event(event.time.sample(RATE), event.event, &mut gestures);
            }
        }
        performance.advance(200 * u64::from(RATE), &mut gestures);
        gestures
    };
    let all = gestures_of(None);
    for string in 0..6 {
        let alone = gestures_of(Some(string as u8));
        assert!(!alone.is_empty() && alone.iter().all(|g| g.string == string));
        assert_eq!(of_string(&all, string), alone, "string {string}");
    }
}
