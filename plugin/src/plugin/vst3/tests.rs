mod host;

use nice_plug::midi::{Channel, Key, VoiceID};

use super::*;
use host::{Host, Silence, bend, expression, factory, off, on};

#[test]
fn expression_and_brightness_are_what_the_host_means() {
    let (timing, voice_id) = (3, VoiceID::ID(7));
    let (channel, key) = (Channel::Number(1), Key::Number(60));
    let expression = NoteEvent::<()>::PolyExpression { timing, voice_id, channel, key, expression: 0.25 };
    let brightness = NoteEvent::<()>::PolyBrightness { timing, voice_id, channel, key, brightness: 0.25 };
    assert_eq!(mended(brightness), expression);
    assert_eq!(mended(expression), brightness);
    let pressure = NoteEvent::<()>::PolyPressure { timing, voice_id, channel, key, pressure: 0.25 };
    assert_eq!(mended(pressure), pressure);
}

#[test]
fn the_factory_has_one_class_and_makes_it() {
    let (factory, class) = factory();
    // SAFETY: there is room for what is told.
    unsafe {
        let mut told = class;
        assert_eq!(factory.countClasses(), 1);
        assert_eq!(factory.getClassInfo(1, &mut told), kInvalidArgument);
        assert_eq!(factory.getClassInfo(0, std::ptr::null_mut()), kInvalidArgument);
    }
    let made = host::made(&factory, class.cid.map(|byte| byte as u8)).expect("it is made");
    // SAFETY: nothing is asked for but a number.
    assert_eq!(unsafe { made.getLatencySamples() }, Engine::LATENCY, "right after it is made");
    assert!(host::made(&factory, *b"somebody else's.").is_none());
}

/// Half a second, and what is left of it when a damped string has gone silent.
const LENGTH: usize = 24_000;

fn loudness(sound: &[f32]) -> f32 {
    sound[LENGTH - 4_800..].iter().fold(0.0, |most, sample| most.max(sample.abs()))
}

/// Changes and events of a call.
type Call<'a> = (&'a [(ParamID, f64)], &'a [Event]);

/// What the framework leaves out wholly: no samples, no bus, a bus without channels' memory. And one whose channels' memory is
/// nowhere, as of an output that has been switched off.
const SILENCES: [Silence; 4] = [Silence::Samples, Silence::Outputs, Silence::Memory, Silence::Addresses];

/// The bus has two, whatever a host makes of it.
#[test]
fn two_channels_are_played_and_others_are_silent() {
    let note = [on(0, 1, 52)];
    let [left, right] = Host::new().play_into(LENGTH, &[], &note);
    assert!(loudness(&left) > 0.01 && loudness(&right) > 0.01);
    let four = Host::new().play_into(LENGTH, &[], &note);
    assert!(four == [left, right, vec![0.0; LENGTH], vec![0.0; LENGTH]]);
}

/// One channel is no output: what comes with it waits.
#[test]
fn notes_without_a_second_channel_are_played_with_the_next_samples() {
    let host = Host::new();
    let [_] = host.play_into(512, &[], &[on(0, 1, 52)]);
    assert!(host.play(LENGTH, &[], &[]) == Host::new().play(LENGTH, &[], &[on(0, 1, 52)]));
}

#[test]
fn notes_and_note_offs_without_sound_are_played_with_the_next_samples() {
    let heard = |last: &[Event]| {
        let host = Host::new();
        host.play(512, &[], &[on(0, 1, 52)]);
        host.play(LENGTH, &[], last)
    };
    let ended = heard(&[off(0, 1, 52), on(0, 2, 59)]);
    assert!(ended != heard(&[off(0, 1, 52)]) && ended != heard(&[on(0, 2, 59)]));
    for silence in SILENCES {
        let host = Host::new();
        host.play(512, &[], &[on(0, 1, 52)]);
        host.flush(silence, &[], &[off(0, 1, 52), on(0, 2, 59)]);
        assert!(host.play(LENGTH, &[], &[]) == ended, "{silence:?}");
        // Once, and not again: the second key goes up.
        assert!(loudness(&host.play(LENGTH, &[], &[off(0, 2, 59)])) < 1e-3, "{silence:?}");
    }
}

#[test]
fn what_comes_without_sound_stays_in_order_and_comes_before_the_rest() {
    let host = Host::new();
    let pedal = |down| host.controller(0, 64, f64::from(u8::from(down)));
    let ring = |flushed: &[Call<'_>], own: &[Event]| {
        let host = Host::new();
        flushed.iter().for_each(|(changes, events)| host.flush(Silence::Samples, changes, events));
        loudness(&host.play(LENGTH, &[], own))
    };
    let (on, off) = (&[on(0, 1, 52)][..], &[off(0, 1, 52)][..]);
    let down: &[(ParamID, f64)] = &[pedal(true)];
    let long = ring(&[(&[], on)], &[]);
    assert!(long > 0.01, "{long}");
    // A pedal keeps what goes up after it, and not what has gone up before.
    assert!(ring(&[(&[], on), (down, &[]), (&[], off)], &[]) > 0.5 * long);
    assert!(ring(&[(&[], on), (&[], off), (down, &[])], &[]) < 0.1 * long);
    // Within a call, controllers come first.
    assert!(ring(&[(&[], on), (down, off)], &[]) > 0.5 * long);
    assert!(ring(&[(&[], on)], off) < 0.1 * long);
    assert!(ring(&[(&[], off)], on) > 0.5 * long);
}

#[test]
fn parameters_and_controllers_without_sound_are_as_with_the_next_samples() {
    for silence in SILENCES {
        let [flushed, whole] = [0, 1].map(|_| Host::new());
        let changes =
            [flushed.parameter("Pluck force", 0.25), flushed.controller(0, 74, 0.0), bend(&whole, 0, 512)];
        flushed.flush(silence, &changes[..2], &[]);
        flushed.flush(silence, &changes[2..], &[]);
        // (At the step of it that is nearest.)
        assert!((flushed.value(changes[0].0) - 0.25).abs() < 0.01, "{silence:?}");
        let note = [on(0, 1, 52)];
        let expected = whole.play(LENGTH, &changes, &note);
        assert!(flushed.play(LENGTH, &[], &note) == expected, "{silence:?}");
        assert!(Host::new().play(LENGTH, &changes[..1], &note) != expected);
    }
}

/// Hosts that put everything back to what it usually is say nothing by it.
#[test]
fn controllers_are_usually_what_they_are_where_nothing_was_said() {
    let host = Host::new();
    let hidden = host.hidden();
    assert_eq!(hidden.len(), 16 * 130);
    for &(id, usual) in &hidden {
        assert_eq!(host.value(id), usual, "{id}");
    }
    for (number, usual) in [(64, 0.0), (129, 0.5), (11, 1.0)] {
        let meant = host.controller(0, number, usual);
        assert!(hidden.contains(&meant), "{number}");
    }
    let notes = [on(0, 1, 52), on(0, 2, 59)];
    let plain = Host::new().play(LENGTH, &[], &notes);
    assert!(host.play(LENGTH, &hidden, &notes) == plain);
    // Of all of them at once, those that count are seen.
    let told: Vec<_> = hidden.iter().map(|&(id, _)| (id, 0.0)).collect();
    assert!(Host::new().play(LENGTH, &told, &notes) != plain);
}

#[test]
fn what_is_refused_the_host_is_told_of() {
    let host = Host::new();
    let force = host.parameter("Pluck force", 0.25);
    host.flush(Silence::Samples, &[force], &[]);
    let saved = host.save();
    let with_mark = |mark: &str| {
        let mut state: serde_json::Value = serde_json::from_slice(&saved).expect("it is a state");
        state["fields"]["state"] = mark.into();
        serde_json::to_vec(&state).expect("it can be written")
    };
    let other = Host::new();
    let before = other.save();
    for (what, bytes) in [
        ("a truncated state", saved[..saved.len() - 20].to_vec()),
        ("a newer form", with_mark(r#"{"owner":"low-action","version":99}"#)),
        ("somebody else's mark", with_mark(r#"{"owner":"high-action","version":1}"#)),
    ] {
        assert!(!other.load(&bytes), "{what}");
        assert!(other.save() == before, "{what} was taken in");
    }
    assert!(other.load(&saved) && other.save() == saved);
}

/// The time for which the longest string rings, before it has been played, while it sounds and afterwards, also while a string moves
/// that nobody hears: hosts cut what they export, and ask for nothing more, where there is none.
#[test]
fn the_tail_is_known_before_anything_sounds_and_afterwards() {
    let host = Host::new();
    let before = host.tail();
    let seconds = f64::from(before) / 48e3;
    assert!((20.0..40.0).contains(&seconds), "{seconds} s");
    // With ten times the losses, so that it is soon silent.
    let losses = ["Loss, all frequencies", "Loss, high frequencies"].map(|name| host.parameter(name, 1.0));
    host.play(512, &losses, &[]);
    let short = host.tail();
    assert!((5.0..30.0).contains(&(f64::from(before) / f64::from(short))), "{short} after {before} samples");
    // A key that is held, on a fret.
    host.play(LENGTH, &[], &[on(0, 1, 53)]);
    assert_eq!(host.tail(), short, "while it sounds");
    while host.play(LENGTH, &[], &[]).iter().any(|sample| sample.abs() > 1e-7) {}
    host.play(LENGTH, &[], &[]);
    assert_eq!(host.tail(), short, "while it is held");
    host.play(LENGTH, &[], &[off(0, 1, 53)]);
    while host.play(LENGTH, &[], &[]).iter().any(|&sample| sample != 0.0) {}
    assert_eq!(host.tail(), short, "when nothing moves");
}

/// As many as fill any room. What they say last counts, and the note's end is not lost.
#[test]
fn a_note_off_is_not_lost_among_too_many_others() {
    let host = Host::new();
    host.play(512, &[], &[on(0, 1, 52)]);
    let swell: Vec<_> = (0..20_000).map(|n| host.controller(3, 11, f64::from(n % 128) / 127.0)).collect();
    let notes: Vec<_> = (0..20_000).map(|n| on(3, 100 + n, 20)).collect();
    host.flush(Silence::Samples, &swell, &[]);
    host.flush(Silence::Outputs, &[host.controller(3, 11, 0.0)], &notes);
    host.flush(Silence::Samples, &[], &[off(0, 1, 52)]);
    assert!(loudness(&host.play(LENGTH, &[], &[])) < 1e-3);
}

#[test]
fn note_expressions_reach_the_notes_they_are_for() {
    const VOLUME: u32 = 0;
    const VIBRATO: u32 = 3;
    const FORCE: u32 = 4;
    const BRIGHTNESS: u32 = 5;
    const TUNING: u32 = 2;
    let notes = [on(0, 7, 48), on(1, 8, 55)];
    let played = |changes: &[(ParamID, f64)], said: &[Event]| {
        Host::new().play(LENGTH, changes, &[&notes[..], said].concat())
    };
    let plain = played(&[], &[]);
    // Each is what its channel's controllers would say, of either.
    for (id, channel) in [(7, 0), (8, 1)] {
        let host = Host::new();
        for (kind, value, change) in [
            // (A number of which a wheel of 14 bits has the same: −1.875 semitones.)
            (TUNING, 0.5 - 1.0 / 128.0, bend(&host, channel, 512)),
            (BRIGHTNESS, 0.0, host.controller(channel, 74, 0.0)),
            (FORCE, 0.5, host.controller(channel, 11, 64.0 / 127.0)),
            // (Its scale goes to 12 dB.)
            (VOLUME, 0.125, host.controller(channel, 11, 64.0 / 127.0)),
            (VIBRATO, 1.0, host.controller(channel, 1, 1.0)),
        ] {
            let said = played(&[], &[expression(id, kind, value)]);
            let meant = played(&[change], &[]);
            let apart = |other: &[f32]| -> f32 {
                said.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt()
            };
            println!("{kind} of {id}: {} from what is meant, {} from none", apart(&meant), apart(&plain));
            assert!(apart(&meant) < 0.05 * apart(&plain), "expression {kind} of note {id}");
        }
        // Those that come without sound, too, with their notes.
        for said in [expression(id, BRIGHTNESS, 0.0), expression(id, VOLUME, 0.1)] {
            let host = Host::new();
            host.flush(Silence::Samples, &[], &[notes[0], notes[1], said]);
            assert!(host.play(LENGTH, &[], &[]) == played(&[], &[said]));
        }
    }
}
