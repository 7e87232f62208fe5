//! What can be played is, as asked.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::Stdio;

use hound::{SampleFormat, WavReader};
use midly::{MetaMessage, TrackEventKind};

use crate::room::{Room, message, midi, midi_of, peak, song};

#[test]
fn a_song_becomes_a_24_bit_stereo_file_named_after_it() {
    let room = Room::new();
    fs::create_dir(room.path("songs")).unwrap();
    fs::rename(room.path("song.mid"), room.path("songs/two.notes.mid")).unwrap();
    let said = room.renders(&["songs/two.notes.mid"]);
    assert!(said.starts_with("two.notes.wav: ") && said.lines().count() == 1, "{said}");
    let reader = WavReader::open(room.path("two.notes.wav")).unwrap();
    let spec = reader.spec();
    assert_eq!((spec.channels, spec.sample_rate, spec.bits_per_sample), (2, 48_000, 24));
    assert_eq!(spec.sample_format, SampleFormat::Int);
    // A quarter of a second and the tail of damped strings.
    let seconds = f64::from(reader.duration()) / 48_000.0;
    assert!((0.35..1.5).contains(&seconds), "{seconds} s");
    assert!(peak(&room.path("two.notes.wav")) > 0.01);
    // Nothing else is left in the folder, and the file has ordinary permissions.
    assert_eq!(room.files(), [room.path("songs"), room.path("two.notes.wav")]);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::write(room.path("ordinary"), "").unwrap();
        let mode = |name| fs::metadata(room.path(name)).unwrap().permissions().mode();
        assert_eq!(mode("two.notes.wav"), mode("ordinary"));
    }
}

#[test]
fn formats_rates_and_tails_are_as_asked() {
    let room = Room::new();
    room.renders(&[
        "song.mid",
        "-o",
        "a.wav",
        "--bit-depth",
        "16",
        "--sample-rate",
        "44100",
        "--tail",
        "none",
    ]);
    let reader = WavReader::open(room.path("a.wav")).unwrap();
    assert_eq!((reader.spec().bits_per_sample, reader.spec().sample_rate), (16, 44_100));
    assert_eq!(reader.duration(), 11_025, "a quarter of a second and not a sample more");

    room.renders(&["song.mid", "-o", "b.wav", "--bit-depth", "32f", "--tail", "0.5"]);
    let reader = WavReader::open(room.path("b.wav")).unwrap();
    assert_eq!(reader.spec().sample_format, SampleFormat::Float);
    assert_eq!(reader.duration(), 36_000);

    for (quality, rate) in [("draft", "8000"), ("studio", "22050"), ("reference", "22050")] {
        room.renders(&["song.mid", "-o", "c.wav", "--quality", quality, "--sample-rate", rate]);
        assert!(peak(&room.path("c.wav")) > 0.01, "{quality}");
    }
}

#[test]
fn the_same_bits_on_every_run_and_others_with_another_seed() {
    let room = Room::new();
    let render = |options: &[&str]| {
        room.renders(&[&["song.mid", "-o", "out.wav"], options].concat());
        fs::read(room.path("out.wav")).unwrap()
    };
    let usual = render(&[]);
    assert!(render(&[]) == usual);
    assert!(render(&["--seed", "1"]) != usual);
    assert!(render(&["--variation", "0"]) == render(&["--variation", "0", "--seed", "1"]));
}

#[test]
fn stems_are_each_strings_own_sound() {
    let room = Room::new();
    room.renders(&["song.mid", "-o", "mix.wav", "--stems", "deep/stems"]);
    let mut names: Vec<String> = fs::read_dir(room.path("deep/stems"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["1-E4.wav", "2-B3.wav", "3-G3.wav", "4-D3.wav", "5-A2.wav", "6-E2.wav"]);
    let length = |path: PathBuf| WavReader::open(path).unwrap().duration();
    for name in &names {
        assert_eq!(length(room.path("deep/stems").join(name)), length(room.path("mix.wav")));
    }
    // B3 is the open second string, and only the two strings that were plucked sound.
    assert!(peak(&room.path("deep/stems/2-B3.wav")) > 0.01);
    let sounding = names.iter().filter(|name| peak(&room.path("deep/stems").join(name)) > 0.0).count();
    assert_eq!(sounding, 2);
    // With stems or without, the mix is the same.
    room.renders(&["song.mid", "-o", "alone.wav"]);
    assert!(fs::read(room.path("mix.wav")).unwrap() == fs::read(room.path("alone.wav")).unwrap());
}

#[test]
fn stems_are_found_by_labels_and_are_the_whole_by_the_law_of_pan() {
    let room = Room::new();
    let own = "name = \"own\"\nbased_on = \"electric\"\n[[string]]\nname = \"E/4 é\"\npan = -1.0\n[[string]]\npan = 0.3\n";
    fs::write(room.path("own.toml"), own).unwrap();
    let options = ["song.mid", "-o", "x.wav", "-i", "own.toml", "-b", "32f", "--labels", "x.json"];
    room.renders(&[&options[..], &["--stems", "stems"]].concat());
    let samples = |name: &str| -> Vec<f64> {
        let mut reader = WavReader::open(room.path(name)).unwrap();
        reader.samples::<f32>().map(|sample| sample.unwrap().into()).collect()
    };
    let labels = read_labels(&room);
    let strings =
        labels["strings"].as_array().unwrap().iter().zip(labels["setup"]["string"].as_array().unwrap());
    let mut sum = vec![[0.0; 2]; samples("x.wav").len() / 2];
    for (string, setup) in strings {
        let name = string["stem"].as_str().unwrap();
        let angle = 0.25 * std::f64::consts::PI * (setup["pan"].as_f64().unwrap() + 1.0);
        for (sum, sample) in sum.iter_mut().zip(samples(&format!("stems/{name}"))) {
            sum[0] += angle.cos() * sample;
            sum[1] += angle.sin() * sample;
        }
    }
    assert_eq!(labels["strings"][0]["stem"], "1-E_4_é.wav");
    // Each stem is rounded to 32 bits, and so is the whole.
    let largest = samples("x.wav").into_iter().fold(0.0, |most: f64, sample| most.max(sample.abs()));
    for (pair, sum) in samples("x.wav").chunks(2).zip(sum) {
        assert!((0..2).all(|side| (pair[side] - sum[side]).abs() < 1e-6 * largest), "{pair:?} {sum:?}");
    }
    assert!(largest > 0.01);
}

#[test]
fn stems_of_another_song_are_told_of() {
    let room = Room::new();
    let put = |name: &str| fs::write(room.path("stems").join(name), "").unwrap();
    let render =
        || room.renders(&["song.mid", "-o", "stems/0-all.wav", "--stems", "stems", "--tail", "none"]);
    // All of it may go into a folder that is not there yet.
    assert!(!render().contains("warning"));
    assert_eq!(fs::read_dir(room.path("stems")).unwrap().count(), 7);
    ["cover.png", "notes-1.wav", "1-E4.wav", "-x.wav", "1-E4.txt"].into_iter().for_each(put);
    assert!(!render().contains("warning"));
    assert!(!render().contains("warning"));
    put("7-B1.wav");
    let said = render();
    assert!(
        said.contains("warning: song.mid: stems also holds 7-B1.wav, which is not of this song\n"),
        "{said}"
    );
    put("2-A2.wav");
    let said = render();
    assert!(
        said.contains("stems also holds 2 files, such as 2-A2.wav, which are not of this song\n"),
        "{said}"
    );
}

#[test]
fn a_sound_of_no_samples_is_told_of() {
    let room = Room::new();
    // A track that ends two seconds later than its only note begins.
    let words = (96, TrackEventKind::Meta(MetaMessage::Text(b"")));
    fs::write(room.path("end.mid"), midi_of(&[(0, message(&[0x90, 60, 90])), words, words])).unwrap();
    let said = room.renders(&["end.mid", "--tail", "none"]);
    assert!(said.contains("warning: end.mid: the sound has no samples"), "{said}");
    assert_eq!(WavReader::open(room.path("end.wav")).unwrap().duration(), 0);
    assert!(!room.renders(&["end.mid", "--tail", "0.1"]).contains("no samples"));
}

#[test]
fn standard_input_and_output_work() {
    let room = Room::new();
    room.renders(&["song.mid", "-o", "file.wav"]);
    let mut child = room
        .command(&["render", "-", "-o", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(&song()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout == fs::read(room.path("file.wav")).unwrap());
    assert!(String::from_utf8(output.stderr).unwrap().starts_with("standard output: "));
}

#[test]
fn the_demo_plays_without_a_song() {
    let room = Room::new();
    let said = room.renders(&["--quality", "draft", "--sample-rate", "8000"]);
    assert!(said.contains("demo.wav"), "{said}");
    assert!(!said.contains("moved") && !said.contains("left out"), "{said}");
    let reader = WavReader::open(room.path("demo.wav")).unwrap();
    assert!((20 * 8_000..40 * 8_000).contains(&reader.duration()));
}

#[test]
fn what_plays_differently_from_the_page_is_said_once() {
    let room = Room::new();
    let events: [(u8, &[u8]); 7] = [
        (0, &[0x90, 20, 90]),
        (0, &[0x90, 120, 90]),
        (0, &[0x99, 36, 90]),
        (0, &[0x99, 38, 90]),
        (24, &[0x80, 20, 0]),
        (0, &[0x80, 120, 0]),
        (0, &[0x99, 38, 0]),
    ];
    fs::write(room.path("odd.mid"), midi(&events)).unwrap();
    let said = room.renders(&["odd.mid"]);
    let warnings: Vec<&str> = said.lines().filter(|line| line.starts_with("warning: ")).collect();
    assert_eq!(warnings.len(), 2, "{said}");
    assert!(
        warnings[0].starts_with("warning: odd.mid: channel 10") && warnings[0].contains("2 of its notes"),
        "{said}"
    );
    assert!(warnings[1].starts_with("warning: odd.mid: 2 notes were moved by octaves"), "{said}");

    // Two octaves up on an open string, three times.
    let bent: [(u8, &[u8]); 4] =
        [(0, &[0x90, 64, 90]), (9, &[0xE0, 127, 127]), (9, &[0xE0, 0, 64]), (9, &[0xE0, 127, 127])];
    fs::write(room.path("bent.mid"), midi(&bent)).unwrap();
    let said = room.renders(&["bent.mid", "--bend-range", "24", "--tail", "0.1"]);
    assert!(said.contains("warning: bent.mid: 1 note was bent less far than asked"), "{said}");

    let faded: [(u8, &[u8]); 4] =
        [(0, &[0xB0, 7, 60]), (0, &[0x90, 64, 90]), (9, &[0xB0, 7, 30]), (9, &[0xB0, 10, 0])];
    fs::write(room.path("faded.mid"), midi(&faded)).unwrap();
    let said = room.renders(&["faded.mid", "--tail", "0.1"]);
    let expected = "warning: faded.mid: controllers 7 (volume) and 10 (pan) are passed over: use 11, or gain and pan in a set-up file\n";
    assert_eq!(said.matches("warning").count(), 1, "{said}");
    assert!(said.contains(expected), "{said}");

    let whole = fs::read(room.path("song.mid")).unwrap();
    fs::write(room.path("cut.mid"), &whole[..whole.len() - 9]).unwrap();
    let said = room.renders(&["cut.mid", "--allow-truncated", "--tail", "0.1"]);
    assert_eq!(said.matches("warning").count(), 1, "{said}");
    assert!(
        said.contains("warning: cut.mid: truncated MIDI file: track 1 announces 18 bytes, 9 are left"),
        "{said}"
    );
    assert!(peak(&room.path("cut.wav")) > 0.01);

    fs::write(room.path("empty.mid"), midi(&[])).unwrap();
    let said = room.renders(&["empty.mid"]);
    assert!(said.contains("warning: empty.mid: no notes") && said.contains("silent"), "{said}");
    assert_eq!(peak(&room.path("empty.wav")), 0.0);

    let chord: Vec<[u8; 3]> = (14..114).map(|key| [0x90, key, 60]).collect();
    let chord: Vec<(u8, &[u8])> = chord.iter().map(|event| (0, &event[..])).collect();
    fs::write(room.path("hundred.mid"), midi(&chord)).unwrap();
    let said = room.renders(&["hundred.mid", "--quality", "draft", "--tail", "0.2"]);
    assert!(said.contains("94 notes were played a moment late") && !said.contains("left out"), "{said}");
    // The last of them are heard, too.
    let seconds = f64::from(WavReader::open(room.path("hundred.wav")).unwrap().duration()) / 48_000.0;
    assert!((94.0 * 0.07 + 0.2..7.0).contains(&seconds), "{seconds} s");
}

/// The samples of a string's own sound, the first string first.
fn stem(room: &Room, number: usize) -> Vec<i32> {
    let name = ["1-E4", "2-B3", "3-G3", "4-D3", "5-A2", "6-E2"][number - 1];
    let mut reader = WavReader::open(room.path(&format!("stems/{name}.wav"))).unwrap();
    reader.samples().map(Result::unwrap).collect()
}

#[test]
fn each_channel_of_a_guitar_is_a_string_and_cuts_no_other() {
    let room = Room::new();
    fs::write(room.path("canon.mid"), include_bytes!("../../../docs/pieces/midi_guitar.mid")).unwrap();
    let fast = ["--quality", "draft", "--sample-rate", "8000", "--variation", "0", "--tail", "none"];
    let render = |options: &[&str]| {
        let arguments = ["canon.mid", "-o", "out.wav", "--stems", "stems", "--input", "strings"];
        room.renders(&[&arguments[..], &fast, options].concat())
    };
    let said = render(&[]);
    assert!(!said.contains("warning"), "{said}");
    let together: Vec<Vec<i32>> = (1..=6).map(|number| stem(&room, number)).collect();
    assert!(together.iter().all(|sound| sound.iter().any(|&sample| sample != 0)));
    for (channel, number) in [("1", 1), ("4", 4)] {
        render(&["--channel", channel]);
        let alone = stem(&room, number);
        assert!(alone.len() > 100_000 && together[number - 1][..alone.len()] == alone, "string {number}");
        let others = (1..=6).filter(|&other| other != number);
        assert!(others.into_iter().all(|other| stem(&room, other).iter().all(|&sample| sample == 0)));
    }
}

#[test]
fn channels_and_wheels_mean_what_is_said() {
    let room = Room::new();
    let write = |name: &str, events: &[(u8, &[u8])]| fs::write(room.path(name), midi(events)).unwrap();
    let render = |song: &str, options: &[&str]| {
        let said = room.renders(
            &[&[song, "-o", "out.wav", "--stems", "stems", "--variation", "0", "--tail", "0.2"], options]
                .concat(),
        );
        (said, (1..=6).map(|number| stem(&room, number)).collect::<Vec<_>>())
    };
    let heard = |stems: &[Vec<i32>]| -> Vec<usize> {
        (1..=6).filter(|&number| stems[number - 1].iter().any(|&sample| sample != 0)).collect()
    };
    // E4 on channel 10, which is the second of strings from 9 on; and one that has none.
    write("e4.mid", &[(0, &[0x99, 64, 90]), (0, &[0x90, 64, 90]), (48, &[0x89, 64, 0])]);
    assert_eq!(heard(&render("e4.mid", &[]).1), [1], "percussion");
    let guitar = ["--input", "strings", "--first-channel", "9"];
    let (said, stems) = render("e4.mid", &guitar);
    assert_eq!(heard(&stems), [2]);
    assert!(said.contains("1 note was left out") && said.contains("their channel has none"), "{said}");
    assert_eq!(heard(&render("e4.mid", &[&guitar[..], &["--string-order", "last_first"]].concat()).1), [5]);
    // Half a turn of two semitones is a whole turn of one; what the song says counts, or is passed over.
    let bent: [(u8, &[u8]); 3] = [(0, &[0x90, 64, 90]), (0, &[0xE0, 0, 0]), (48, &[0x80, 64, 0])];
    let half: [(u8, &[u8]); 3] = [(0, &[0x90, 64, 90]), (0, &[0xE0, 0, 32]), (48, &[0x80, 64, 0])];
    let announced: [(u8, &[u8]); 3] = [(0, &[0xB0, 101, 0]), (0, &[0xB0, 100, 0]), (0, &[0xB0, 6, 3])];
    write("bent.mid", &bent);
    write("half.mid", &half);
    write("announced.mid", &[&announced[..], &bent].concat());
    let semitone = render("half.mid", &[]).1;
    assert!(semitone == render("bent.mid", &["--bend-range", "1"]).1);
    assert!(semitone != render("bent.mid", &[]).1);
    let range = ["--bend-range", "1"];
    assert!(semitone != render("announced.mid", &range).1);
    assert!(semitone == render("announced.mid", &[&range[..], &["--ignore-rpn"]].concat()).1);
}

#[test]
fn clipping_is_said_and_saturates() {
    let room = Room::new();
    let setup = include_str!("../../../dsp/instruments/electric.toml");
    let gain = setup.lines().find(|line| line.starts_with("gain")).unwrap();
    fs::write(room.path("loud.toml"), setup.replace(gain, "gain = 1000.0")).unwrap();
    let arguments =
        ["song.mid", "-o", "loud.wav", "-i", "loud.toml", "--stems", "stems", "--labels", "x.json"];
    let said = room.renders(&arguments);
    assert!(said.contains("warning: song.mid: the sound peaks at +") && said.contains("clipped"), "{said}");
    assert_eq!(peak(&room.path("loud.wav")), 1.0);
    // The file's own peak is another matter than the sound's.
    assert!(said.contains(" s, peak 0.0 dBFS, clipped, "), "{said}");
    let above =
        said.split_once("peaks at ").and_then(|(_, rest)| rest.split_once(" dBFS")).unwrap().0.to_owned();
    // Which strings' files are clipped is named: of those that are played. Labels have the same lines.
    let names = said.split_once(" is clipped in ").and_then(|(_, rest)| rest.split_once(": use")).unwrap().0;
    assert_eq!(names, "2-B3.wav, 4-D3.wav", "{said}");
    let labels = read_labels(&room);
    let warnings: Vec<&str> =
        said.lines().filter_map(|line| line.strip_prefix("warning: song.mid: ")).collect();
    assert_eq!((labels["warnings"].as_array().unwrap().len(), warnings.len()), (2, 2), "{said}");
    assert_eq!(labels["warnings"], serde_json::json!(warnings));
    let clipped = labels["peak"].as_f64().unwrap();

    let said = room.renders(&[&arguments[..], &["--bit-depth", "32f"]].concat());
    assert!(!said.contains("warning"), "{said}");
    assert!(said.contains(&format!(" s, peak {above} dBFS, ")), "{said} {above}");
    assert!(peak(&room.path("loud.wav")) > 1.0);
    // What sounds is the same, whatever the file has room for.
    let labels = read_labels(&room);
    assert_eq!(labels["warnings"], serde_json::json!([]));
    assert_eq!((labels["peak"].as_f64(), clipped), (Some(clipped), peak(&room.path("loud.wav"))));
    for string in labels["strings"].as_array().unwrap() {
        let stem = format!("stems/{}-{}.wav", string["string"], string["name"].as_str().unwrap());
        assert_eq!(string["peak"].as_f64(), Some(peak(&room.path(&stem))), "{stem}");
    }
}

/// The labels `x.json`.
fn read_labels(room: &Room) -> serde_json::Value {
    serde_json::from_slice(&fs::read(room.path("x.json")).unwrap()).unwrap()
}

#[test]
fn frets_of_ones_own_that_cannot_be_in_tune_are_told_of() {
    let room = Room::new();
    let own = "name = \"own\"\nbased_on = \"electric\"\n[neck]\nfrets = ";
    let brief = ["song.mid", "-q", "live", "--tail", "none", "-i"];
    for (frets, is_told) in [(30, true), (22, false)] {
        fs::write(room.path("own.toml"), format!("{own}{frets}\n")).unwrap();
        let said = room.renders(&[&brief[..], &["own.toml"]].concat());
        let told = "warning: song.mid: fret 30 of string 5 stays out of tune: it is off by +69 cents";
        assert_eq!(said.matches(told).count(), usize::from(is_told), "{said}");
        assert_eq!(said.contains("warning"), is_told, "{said}");
    }
    assert!(!room.renders(&[&brief[..], &["sitar"]].concat()).contains("warning"));
}

/// How firmly fingers are set to press decides, as it does of the frequencies that labels have.
#[test]
fn frets_out_of_tune_are_those_that_labels_show_to_be() {
    let room = Room::new();
    let brief = ["song.mid", "-q", "live", "--tail", "none", "--labels", "x.json", "-i"];
    for (instrument, force, are_off) in
        [("electric", 100, false), ("electric", 400, true), ("light-fingers", 400, true)]
    {
        let set = format!("finger_force={force}");
        let said = room.renders(&[&brief[..], &[instrument, "--set", &set]].concat());
        let labels = read_labels(&room);
        let off = |string: &serde_json::Value| -> Vec<f64> {
            let open = string["frequency"].as_f64().unwrap();
            let frets =
                string["fret_frequencies"].as_array().unwrap().iter().map(|sounds| sounds.as_f64().unwrap());
            (1..)
                .zip(frets)
                .map(|(fret, sounds)| 1200.0 * (sounds / open).log2() - 100.0 * f64::from(fret))
                .collect()
        };
        let cents: Vec<f64> = labels["strings"].as_array().unwrap().iter().flat_map(off).collect();
        let farthest = cents.iter().copied().max_by(|one, other| one.abs().total_cmp(&other.abs())).unwrap();
        assert_eq!(farthest.abs() > 15.0, are_off, "{instrument} {force} %: {farthest} cents");
        let others = cents.iter().filter(|cents| cents.abs() > 15.0).count().saturating_sub(1);
        let told =
            format!(" stays out of tune: it is off by {farthest:+.0} cents, and {others} others by less");
        assert_eq!(said.contains(&told), are_off, "{said}{told}");
        assert_eq!(said.contains("out of tune"), are_off, "{said}");
    }
}
