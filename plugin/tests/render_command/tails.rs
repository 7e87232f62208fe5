//! The usual tail ends where it is quiet; where it is cut off sooner, that is told.

use std::fs;

use hound::WavReader;
use low_action::setups;
use low_action_dsp::Setup;

use crate::room::{Room, midi};

/// As little work as there is.
const FAST: [&str; 6] = ["--quality", "draft", "--sample-rate", "8000", "--bit-depth", "32f"];
const RATE: usize = 8_000;
/// 72 dB down.
const QUIET: f32 = 2.511_886_4e-4;

/// What `low-action render` makes of an open string that nobody damps.
struct Rings {
    /// Its length, s.
    seconds: f64,
    /// How loud its last 50 ms are as a part of the loudest.
    last: f32,
    /// In which time it would fall by 72 dB as it does from the eighth tenth of it to the last, s.
    needed: f64,
    /// What was said.
    said: String,
}

/// Renders a string, 1 for the first.
fn rings(room: &Room, instrument: &str, string: usize, key: u8) -> Rings {
    fs::write(room.path("held.mid"), midi(&[(0, &[0x90 | (string as u8 - 1), key, 90])])).unwrap();
    let said = room.renders(&[&["held.mid", "-i", instrument, "--input", "strings"], &FAST[..]].concat());
    let mut reader = WavReader::open(room.path("held.wav")).unwrap();
    let sound: Vec<f32> = reader.samples::<f32>().map(|sample| sample.unwrap().abs()).collect();
    let peak = |part: &[f32]| part.iter().fold(0.0_f32, |most, &sample| most.max(sample));
    // (Stereo.)
    let last = peak(&sound[sound.len() - 2 * RATE / 20..]) / peak(&sound);
    let seconds = sound.len() as f64 / (2 * RATE) as f64;
    let power = |tenth: usize| -> f64 {
        let part = &sound[(tenth - 1) * sound.len() / 10..tenth * sound.len() / 10];
        part.iter().map(|sample| f64::from(*sample).powi(2)).sum()
    };
    let needed = 0.2 * seconds * f64::from(1.0 / QUIET).ln() / (0.5 * (power(8) / power(10)).ln());
    Rings { seconds, last, needed, said }
}

/// By its losses alone, s: the slowest partial's time to fall so far, which is the lowest but over a body.
fn need(setup: &Setup, string: usize) -> f64 {
    let slowest =
        (1..=10).map(|partial| setup.decay(string, f64::from(partial))).fold(f64::INFINITY, f64::min);
    f64::from(1.0 / QUIET).ln() / slowest
}

/// None rings longer than its slowest partial by itself would. That outlasts the others only at last, so that a sound still falls
/// faster, by a quarter at most.
#[test]
fn no_set_up_that_comes_with_the_program_is_cut_off() {
    let room = Room::new();
    let mut needs = Vec::new();
    let mut long = 0;
    for name in setups::SHIPPED {
        let setup = Setup::shipped(name).unwrap();
        let string = (0..setup.string.len()).max_by(|&a, &b| need(&setup, a).total_cmp(&need(&setup, b)));
        let (string, key) = string.map(|string| (string, setup.string[string].pitch.round() as u8)).unwrap();
        let stated = need(&setup, string);
        let Rings { seconds, last, needed, said } = rings(&room, name, string + 1, key);
        println!("{name}: {seconds:.1} s, at last it would need {needed:.1} s, of {stated:.1} s: {last:.1e}");
        assert!(last < 1.01 * QUIET, "{name}: {last} of the peak after {seconds} s");
        assert!(!said.contains("warning"), "{said}");
        assert!(seconds < stated, "{name}: {seconds} s and not {stated} s");
        let part = needed / stated;
        assert!((0.7..1.01).contains(&part), "{name}: it would need {needed} s and not {stated} s");
        long += usize::from(seconds > 30.0);
        needs.push((stated, name));
    }
    assert!(long > 0, "some ring for longer than half a minute");
    // What hosts are told is the same, and the page has it.
    let [electric, others] = [true, false].map(|electric| {
        let some = needs.iter().filter(|(_, name)| (*name == "electric") == electric).map(|(need, _)| *need);
        some.fold((f64::INFINITY, 0.0_f64), |(least, most), need| (least.min(need), most.max(need)))
    });
    let said =
        format!("electric guitar {:.0} s, other set-ups {:.0} to {:.0} s", electric.0, others.0, others.1);
    let page = include_str!("../../../docs/plugin.md");
    assert!(page.contains(&said), "docs/plugin.md does not say: {said}");
}

#[test]
fn a_tail_that_is_cut_off_is_told_of() {
    let room = Room::new();
    // The lowest partial is down by 10 dB in two minutes, and by 72 in a quarter of an hour.
    let endless = "name = \"own\"\nbased_on = \"electric\"\n".to_owned()
        + &"[[string]]\nloss_0 = 0.01\nloss_1 = 0.0\n".repeat(6);
    fs::write(room.path("endless.toml"), endless).unwrap();
    let Rings { seconds, last, said, .. } = rings(&room, "endless.toml", 6, 40);
    assert_eq!(seconds, 120.0);
    let told = said.split_once("warning: held.mid: the sound is cut off after 120 s, ").map(|(_, told)| told);
    let told: f32 = told.and_then(|told| told.split(' ').next()?.parse().ok()).expect(&said);
    let below = -20.0 * last.log10();
    assert!((10.0..20.0).contains(&told) && (told - below).abs() < 1.0, "{below} dB: {said}");
    // Labels say how far it has come, too.
    let labels = |instrument: &str, tail: &str| -> (String, Option<f64>) {
        let options = ["held.mid", "-i", instrument, "--tail", tail, "--labels", "held.json"];
        let said = room.renders(&[&options, &FAST[..]].concat());
        let labels = fs::read(room.path("held.json")).unwrap();
        let labels: serde_json::Value = serde_json::from_slice(&labels).unwrap();
        let warned: Vec<&str> = said.lines().filter(|line| line.starts_with("warning: ")).collect();
        assert_eq!(labels["warnings"].as_array().unwrap().len(), warned.len(), "{said}");
        (said, labels["cut_off"].as_f64())
    };
    let (said, cut) = labels("endless.toml", "auto");
    assert!(said.contains("cut off"), "{said}");
    assert!((cut.unwrap() - f64::from(below)).abs() < 1.0, "{cut:?} {below} dB");
    // Who asks for so much or none gets just that, and is told of it in labels alone.
    for tail in ["0.5", "2"] {
        let (said, cut) = labels("endless.toml", tail);
        assert!(!said.contains("cut off"), "{said}");
        assert!((0.0..10.0).contains(&cut.unwrap()), "{tail}: {cut:?}");
    }
    assert_eq!(labels("flatwound-jazz", "auto").1, None);
}
