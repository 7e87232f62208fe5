//! Promise: where there is no host the computer's keys play, as a piano or as strings and frets, unless something is
//! typed. Every string and fret can be reached, the note is that of the fret, and no key leaves one hanging.

use std::collections::HashSet;

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use low_action::params::InputChoice;
use low_action::performance::{InputMode, PlayerEvent, StringDeed};
use low_action::plugin::layout::{KeyMap, Keyboard};
use low_action_dsp::Setup;
use low_action_tests::desk::{Desk, RATE};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::peak;
use nice_plug::prelude::{ParamSetter, Params};

/// The rows of keys as they lie.
const ROWS: [&str; 4] = ["1234567890", "QWERTYUIOP", "ASDFGHJKL", "ZXCVBNM"];

fn keys(row: usize) -> impl Iterator<Item = Key> {
    ROWS[row].chars().map(|letter| Key::from_name(&letter.to_string()).expect("it is a key"))
}

fn down(desk: &mut Desk, key: Key, pressed: bool, modifiers: Modifiers) {
    desk.harness.event(egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
    desk.picture();
}

fn tap(desk: &mut Desk, key: Key, modifiers: Modifiers) {
    down(desk, key, true, modifiers);
    down(desk, key, false, modifiers);
}

/// A stand-alone instrument whose keys are strings and frets.
fn fretted() -> Desk {
    let mut desk = Desk::alone();
    desk.params.layout.set_keys(Keyboard { map: KeyMap::Frets, ..Keyboard::default() });
    desk.wait(0.05);
    desk
}

/// What is done to the strings, since this was last asked.
fn deeds(desk: &mut Desk) -> Vec<(u8, StringDeed)> {
    let touched = |event| match event {
        PlayerEvent::Touched { string, deed } => (string, deed),
        other => panic!("{other:?}"),
    };
    std::mem::take(&mut desk.played).into_iter().map(touched).collect()
}

/// The string and the fret that a key has just played.
fn stopped(desk: &mut Desk) -> Option<(u8, usize)> {
    let setup = Setup::builtin("electric").expect("it is built in");
    let places = setup.neck.equal_places();
    let deeds = deeds(desk);
    let (string, _) = *deeds.first()?;
    assert!(deeds.iter().all(|(other, _)| *other == string));
    let fret = match deeds[..] {
        [(_, StringDeed::Lift), (_, StringDeed::Pluck { .. }), (_, StringDeed::Damp)] => 0,
        [
            (_, StringDeed::Lift),
            (_, StringDeed::Press { position }),
            (_, StringDeed::Pluck { .. }),
            (_, StringDeed::Damp),
        ] => 1 + places.partition_point(|place| *place < f64::from(position)),
        _ => panic!("{deeds:?}"),
    };
    Some((string, fret))
}

#[test]
fn they_are_a_piano() {
    let mut desk = Desk::alone();
    down(&mut desk, Key::Q, true, Modifiers::NONE);
    assert!(
        matches!(desk.played[..], [PlayerEvent::NoteOn { channel: 0, key: 60, .. }]),
        "{:?}",
        desk.played
    );
    desk.wait(0.2);
    assert!(desk.sound.iter().any(|sample| sample.abs() > 1e-3), "it is heard");
    down(&mut desk, Key::Q, false, Modifiers::NONE);
    assert!(matches!(desk.played[1..], [PlayerEvent::NoteOff { channel: 0, key: 60 }]));
    desk.played.clear();
    tap(&mut desk, Key::PageDown, Modifiers::NONE);
    down(&mut desk, Key::S, true, Modifiers::NONE);
    assert!(matches!(desk.played[..], [PlayerEvent::NoteOn { key: 37, .. }]), "{:?}", desk.played);
}

#[test]
fn each_row_is_a_string_and_along_it_are_frets() {
    let mut desk = fretted();
    for row in 0..ROWS.len() {
        for (fret, key) in keys(row).enumerate() {
            tap(&mut desk, key, Modifiers::NONE);
            assert_eq!(stopped(&mut desk), Some((row as u8, fret)), "{}", key.name());
        }
    }
}

#[test]
fn every_string_and_fret_can_be_reached() {
    let mut desk = fretted();
    let mut reached = HashSet::new();
    for _ in 0..3 {
        for _ in 0..4 {
            for key in (0..ROWS.len()).flat_map(keys) {
                tap(&mut desk, key, Modifiers::NONE);
                reached.extend(stopped(&mut desk));
            }
            for _ in 0..6 {
                tap(&mut desk, Key::ArrowRight, Modifiers::COMMAND);
            }
        }
        for _ in 0..22 {
            tap(&mut desk, Key::ArrowLeft, Modifiers::COMMAND);
        }
        tap(&mut desk, Key::PageDown, Modifiers::NONE);
    }
    let all = (0..6).flat_map(|string| (0..=22).map(move |fret| (string, fret)));
    assert_eq!(reached, all.collect());
    // And back.
    for _ in 0..3 {
        tap(&mut desk, Key::PageUp, Modifiers::NONE);
    }
    assert_eq!(desk.params.layout.seen().keys, Keyboard { map: KeyMap::Frets, ..Keyboard::default() });
}

#[test]
fn the_note_is_that_of_the_fret_and_ends_with_the_key() {
    let mut desk = fretted();
    // B3 at its fifth fret is E4.
    down(&mut desk, Key::Y, true, Modifiers::NONE);
    desk.wait(0.15);
    let from = desk.sound.len();
    desk.wait(0.6);
    let expected = 440.0 * (-5.0_f64 / 12.0).exp2();
    let off = cents(frequency_near(&desk.sound[from..], RATE, expected), expected);
    assert!(off.abs() < 8.0, "{off} cents");
    let before = peak(&desk.sound[from..]);
    down(&mut desk, Key::Y, false, Modifiers::NONE);
    desk.wait(1.0);
    let after = peak(&desk.sound[desk.sound.len() - 4800..]);
    assert!(after < 0.01 * before, "{before} before, {after} after");
}

#[test]
fn a_key_that_is_still_down_takes_its_string_again() {
    let mut desk = fretted();
    down(&mut desk, Key::Num3, true, Modifiers::NONE);
    down(&mut desk, Key::Num6, true, Modifiers::NONE);
    let first = deeds(&mut desk)[1];
    down(&mut desk, Key::Num6, false, Modifiers::NONE);
    assert_eq!(deeds(&mut desk), [(0, StringDeed::Lift), first], "pulled off, without a pluck");
    // One that goes up under another says nothing.
    down(&mut desk, Key::Num6, true, Modifiers::NONE);
    deeds(&mut desk);
    down(&mut desk, Key::Num3, false, Modifiers::NONE);
    assert_eq!(deeds(&mut desk), []);
    down(&mut desk, Key::Num6, false, Modifiers::NONE);
    assert_eq!(deeds(&mut desk), [(0, StringDeed::Damp)]);
}

#[test]
fn no_key_hangs() {
    for held in [Key::Q, Key::Num2] {
        for map in [KeyMap::Piano, KeyMap::Frets] {
            let ends: [fn(&mut Desk); 5] = [
                |desk| down(desk, Key::PageDown, true, Modifiers::NONE),
                |desk| desk.harness.key_press_modifiers(Modifiers::SHIFT, Key::Enter),
                |desk| desk.harness.event(egui::Event::WindowFocused(false)),
                |desk| desk.params.layout.set_keys(Keyboard { octave: 1, fret: 3, ..Keyboard::default() }),
                |desk| {
                    let place = desk.control("Type Pluck force").expect("it has a number");
                    desk.click(place);
                },
            ];
            for end in ends {
                let mut desk = Desk::alone();
                desk.params.layout.set_keys(Keyboard { map, ..Keyboard::default() });
                desk.wait(0.05);
                down(&mut desk, held, true, Modifiers::NONE);
                assert!(!desk.played.is_empty());
                end(&mut desk);
                desk.wait(0.1);
                let is_over = |event: &PlayerEvent| {
                    matches!(
                        event,
                        PlayerEvent::NoteOff { .. } | PlayerEvent::Touched { deed: StringDeed::Damp, .. }
                    )
                };
                assert!(desk.played.last().is_some_and(is_over), "{:?}", desk.played);
            }
        }
    }
}

/// As X11 tells of a key that is held, some 25 times a second.
#[test]
fn a_key_that_repeats_is_one_that_is_held() {
    let stroke = |pressed| egui::Event::Key {
        key: Key::Q,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    for map in [KeyMap::Piano, KeyMap::Frets] {
        let mut desk = Desk::alone();
        desk.params.layout.set_keys(Keyboard { map, ..Keyboard::default() });
        desk.wait(0.05);
        down(&mut desk, Key::Q, true, Modifiers::NONE);
        desk.wait(0.3);
        let begun = std::mem::take(&mut desk.played);
        assert!(!begun.is_empty());
        for _ in 0..10 {
            desk.harness.event(stroke(false));
            desk.harness.event(stroke(true));
            desk.wait(0.04);
        }
        assert_eq!(desk.played, [], "both at one picture");
        for _ in 0..10 {
            down(&mut desk, Key::Q, false, Modifiers::NONE);
            down(&mut desk, Key::Q, true, Modifiers::NONE);
        }
        assert_eq!(desk.played, [], "one at each of two pictures");
        down(&mut desk, Key::Q, false, Modifiers::NONE);
        desk.wait(0.05);
        assert_eq!(desk.played.len(), 1, "and it ends: {:?}", desk.played);
    }
}

/// Also where pictures are so slow that it goes up and comes down between two.
#[test]
fn a_key_that_is_pressed_once_more_plays_once_more() {
    let stroke = |pressed| egui::Event::Key {
        key: Key::Q,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let mut desk = Desk::alone();
    let notes = |desk: &mut Desk| {
        let is_on = |event: &PlayerEvent| matches!(event, PlayerEvent::NoteOn { .. });
        std::mem::take(&mut desk.played).iter().map(is_on).collect::<Vec<_>>()
    };
    for pressed in [true, false, true] {
        desk.harness.event(stroke(pressed));
    }
    desk.picture();
    assert_eq!(notes(&mut desk), [true, false, true]);
    desk.wait(0.06);
    for pressed in [false, true] {
        desk.harness.event(stroke(pressed));
    }
    desk.picture();
    assert_eq!(notes(&mut desk), [false, true]);
}

/// Under Caps Lock nothing is heard of a letter but what it writes.
#[test]
fn caps_lock_lets_go() {
    let mut desk = Desk::alone();
    down(&mut desk, Key::Q, true, Modifiers::NONE);
    desk.harness.event(egui::Event::Text("A".into()));
    desk.picture();
    assert!(matches!(desk.played[1..], [PlayerEvent::NoteOff { key: 60, .. }]), "{:?}", desk.played);
}

#[test]
fn where_channels_are_strings_the_piano_plays_on_them() {
    let mut desk = Desk::alone();
    let setter = ParamSetter::new(&*desk.host);
    let control = &desk.params.control;
    setter.set_parameter(&control.input_mode, InputChoice::Strings);
    setter.set_parameter(&control.first_channel, 11);
    desk.engine.set_input(InputMode::Strings { first: 10, from_last: false });
    // Middle C on the string B3, and beside it D5 and E4, which is not left to the string that has it already.
    for key in [Key::Q, Key::Num9, Key::E] {
        down(&mut desk, key, true, Modifiers::NONE);
    }
    let channels: Vec<_> = desk.played.iter().filter_map(PlayerEvent::channel).collect();
    assert_eq!(channels, [11, 10, 12], "{:?}", desk.played);
    desk.wait(0.2);
    assert!(desk.sound.iter().any(|sample| sample.abs() > 1e-3), "it is heard");
    desk.played.clear();
    down(&mut desk, Key::Num9, false, Modifiers::NONE);
    assert!(matches!(desk.played[..], [PlayerEvent::NoteOff { channel: 10, .. }]), "{:?}", desk.played);
}

#[test]
fn they_are_chosen_in_the_editor_and_come_back() {
    let mut desk = Desk::alone();
    desk.open("Player");
    desk.click(desk.named("Frets"));
    desk.wait(0.05);
    tap(&mut desk, Key::PageDown, Modifiers::NONE);
    let mut other = Desk::alone();
    other.params.deserialize_fields(&desk.params.serialize_fields());
    other.wait(0.05);
    other.played.clear();
    tap(&mut other, Key::W, Modifiers::NONE);
    assert_eq!(stopped(&mut other), Some((2, 1)));
    other.click(other.named("Piano"));
    other.wait(0.05);
    other.played.clear();
    down(&mut other, Key::Q, true, Modifiers::NONE);
    assert!(matches!(other.played[..], [PlayerEvent::NoteOn { key: 60, .. }]), "{:?}", other.played);
}

#[test]
fn while_a_number_is_typed_they_are_letters() {
    let mut desk = Desk::alone();
    desk.open("Sound");
    let number = desk.control("Type Level").expect("it has a number");
    desk.click(number);
    desk.wait(0.05);
    down(&mut desk, Key::W, true, Modifiers::NONE);
    assert!(desk.played.is_empty(), "{:?}", desk.played);
}

#[test]
fn they_are_the_hosts_where_there_is_one() {
    let mut desk = Desk::new();
    desk.open("Player");
    assert!(desk.harness.query_by_label("Frets").is_none());
    for map in [KeyMap::Piano, KeyMap::Frets] {
        desk.params.layout.set_keys(Keyboard { map, ..Keyboard::default() });
        desk.wait(0.05);
        down(&mut desk, Key::Q, true, Modifiers::NONE);
        assert!(desk.played.is_empty());
    }
}
