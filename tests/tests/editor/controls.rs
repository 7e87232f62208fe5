//! Promise: everything that can be set has one control in the panels. It is dragged, turned with the
//! wheel, typed and moved by the keyboard, and the host is told of one whole gesture each time.

use egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, vec2};
use egui_kittest::kittest::Queryable;
use low_action::engine::Quality;
use low_action::params::words::heard_of;
use low_action::params::{InputChoice, InstrumentChoice};
use low_action::setups::SHIPPED;
use low_action_tests::desk::{Desk, is_gesture};
use nice_plug::prelude::{Enum, ParamSetter};

/// Opens a panel and points at one of its controls.
pub fn at(desk: &mut Desk, tab: &str, name: &str) -> egui::Pos2 {
    desk.open(tab);
    let place = desk.control(name).unwrap_or_else(|| panic!("{name} is not in {tab}"));
    desk.host.take();
    place
}

/// Writes into what has the keyboard.
pub fn write(desk: &mut Desk, text: &str) {
    desk.harness.event(Event::Text(text.into()));
    desk.wait(0.05);
}

#[test]
fn every_parameter_has_its_place() {
    let mut desk = Desk::new();
    let names = desk.names();
    let mut found = vec![0; names.len()];
    for tab in ["Player", "Luthier", "Sound", "Engine"] {
        desk.open(tab);
        for (found, name) in found.iter_mut().zip(&names) {
            *found += usize::from(desk.control(name).is_some());
        }
    }
    for (found, name) in found.iter().zip(&names) {
        assert_eq!(*found, 1, "{name}");
    }
}

#[test]
fn a_drag_is_one_gesture_and_shift_is_finer() {
    let mut desk = Desk::new();
    let from = at(&mut desk, "Player", "Variation");
    desk.drag(&[from, from + vec2(40.0, 0.0)], 0.2);
    assert!(is_gesture(&desk.host.take(), "variation"));
    let coarse = desk.params.player.variation.value() - 0.25;
    assert!((0.15..0.4).contains(&coarse), "{coarse}");
    // Ten times as far comes to as much, within the hundredths in which the value goes.
    desk.point(from);
    desk.press(from, true, Modifiers::SHIFT);
    for step in 1..=10 {
        let to = from + vec2(40.0 * step as f32, 0.0);
        desk.harness.event_modifiers(Event::PointerMoved(to), Modifiers::SHIFT);
        desk.picture();
    }
    desk.press(from + vec2(400.0, 0.0), false, Modifiers::SHIFT);
    let fine = 0.1 * (desk.params.player.variation.value() - 0.25 - coarse);
    println!("{coarse} and {fine}");
    assert!((9.5..10.5).contains(&(coarse / fine)), "{coarse} and {fine}");
}

#[test]
fn arrows_go_on_where_a_drag_has_ended() {
    let mut desk = Desk::new();
    let value = |desk: &Desk| desk.params.player.variation.value();
    let from = at(&mut desk, "Player", "Variation");
    desk.drag(&[from, from + vec2(40.0, 0.0)], 0.2);
    let dragged = value(&desk);
    desk.host.take();
    desk.key(Key::ArrowUp);
    assert!(value(&desk) > dragged);
    assert!(is_gesture(&desk.host.take(), "variation"));
    // A mark in the picture as well.
    let from = desk.named("Pluck position");
    desk.drag(&[from, from - vec2(40.0, 0.0)], 0.2);
    desk.host.take();
    desk.key(Key::ArrowLeft);
    assert!(is_gesture(&desk.host.take(), "pluck_position"));
}

#[test]
fn nothing_leaves_its_range_and_a_double_click_brings_back() {
    let mut desk = Desk::new();
    let from = at(&mut desk, "Player", "Pluck force");
    desk.drag(&[from, from + vec2(900.0, 0.0)], 0.2);
    assert_eq!(desk.params.player.pluck_force.value(), 5.0);
    desk.wait(1.0);
    desk.host.take();
    desk.click(from);
    desk.click(from);
    assert_eq!(desk.params.player.pluck_force.value(), 1.0);
    assert!(is_gesture(&desk.host.take(), "pluck_force"));
}

/// Hosts would write automation of it.
#[test]
fn what_changes_nothing_is_no_gesture() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Luthier", "Action");
    desk.click(place);
    for key in [Key::Delete, Key::Backspace] {
        desk.key(key);
    }
    desk.enter("Luthier", "Action", "100");
    assert_eq!(desk.host.take(), [], "it has its usual value");
    desk.click(place);
    desk.key(Key::End);
    assert!(is_gesture(&desk.host.take(), "action"));
    for key in [Key::ArrowUp, Key::End] {
        desk.key(key);
    }
    desk.harness.event(wheel(MouseWheelUnit::Line, vec2(0.0, 1.0)));
    desk.picture();
    assert_eq!(desk.host.take(), [], "it is at its end");
    let list = at(&mut desk, "Luthier", "Instrument");
    desk.click(list);
    desk.wait(0.1);
    let chosen = desk.harness.query_all_by_label("Electric").map(|node| node.rect().center()).next_back();
    desk.click(chosen.expect("the list is open"));
    desk.wait(0.1);
    assert_eq!(desk.host.take(), [], "it is chosen already");
}

/// A turn of the wheel.
pub fn wheel(unit: MouseWheelUnit, delta: egui::Vec2) -> Event {
    let (phase, source) = (TouchPhase::Move, MouseWheelSource::Wheel);
    Event::MouseWheel { unit, delta, phase, source, modifiers: Modifiers::NONE }
}

/// A host would be told of a second gesture within the first, and the end of one would be taken for that of both.
#[test]
fn nothing_else_moves_what_is_dragged() {
    let mut desk = Desk::new();
    let from = at(&mut desk, "Player", "Variation");
    desk.click(from);
    desk.wait(1.0);
    desk.host.take();
    let value = |desk: &Desk| desk.params.player.variation.value();
    let before = value(&desk);
    desk.press(from, true, Modifiers::NONE);
    desk.point(from + vec2(20.0, 0.0));
    desk.harness.event(wheel(MouseWheelUnit::Line, vec2(0.0, 2.0)));
    desk.picture();
    for key in [Key::ArrowUp, Key::End, Key::Delete] {
        desk.key(key);
    }
    desk.undo();
    desk.point(from + vec2(40.0, 0.0));
    desk.press(from + vec2(40.0, 0.0), false, Modifiers::NONE);
    let told = desk.host.take();
    assert!(is_gesture(&told, "variation"), "{told:?}");
    assert!((0.15..0.4).contains(&(value(&desk) - before)), "{}", value(&desk));
    desk.undo();
    assert_eq!(value(&desk), before);
}

#[test]
fn the_keyboard_does_all_of_it() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Luthier", "Action");
    desk.click(place);
    desk.host.take();
    let value = |desk: &Desk| desk.params.setup.action.value();
    desk.key(Key::ArrowUp);
    assert!(value(&desk) > 1.0);
    assert!(is_gesture(&desk.host.take(), "action"));
    desk.key(Key::End);
    assert_eq!(value(&desk), 3.0);
    desk.key(Key::Home);
    assert_eq!(value(&desk), 0.1);
    desk.key(Key::Delete);
    assert_eq!(value(&desk), 1.0);
    desk.key(Key::Enter);
    write(&mut desk, "150 %");
    desk.key(Key::Enter);
    assert_eq!(value(&desk), 1.5);
    desk.key(Key::Tab);
    desk.key(Key::End);
    assert_eq!(desk.params.setup.relief.value(), 2.0, "Tab goes to the next control");
}

#[test]
fn the_keyboard_stays_among_what_there_is_to_choose() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Luthier", "Instrument file");
    for _ in 0..2 {
        // Its list is not needed.
        desk.click(place);
        desk.wait(0.1);
    }
    let last = desk.params.shelf.count() as i32;
    for key in [Key::End, Key::ArrowDown, Key::ArrowRight] {
        desk.key(key);
        assert_eq!(desk.params.instrument.file.value(), last, "{key:?}");
    }
    desk.key(Key::Home);
    assert_eq!(desk.params.instrument.file.value(), 0);
}

#[test]
fn the_space_bar_is_the_hosts() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Sound", "Tension modulation");
    desk.click(place);
    assert!(!desk.params.setup.tension_modulation.value());
    desk.host.take();
    desk.key(Key::Space);
    assert_eq!(desk.host.take(), [], "it has the focus, but a host starts and stops with it");
    // On its own the program has no transport.
    let mut alone = Desk::alone();
    let place = at(&mut alone, "Sound", "Tension modulation");
    alone.click(place);
    alone.key(Key::Space);
    assert!(alone.params.setup.tension_modulation.value());
}

#[test]
fn choices_open_and_switches_turn() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Luthier", "Instrument");
    desk.click(place);
    desk.wait(0.1);
    desk.click(desk.named("Classical"));
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.instrument.to_string(), "Classical");
    assert!(is_gesture(&desk.host.take(), "instrument"));
    let place = at(&mut desk, "Engine", "Relax when late");
    desk.click(place);
    assert!(!desk.params.instrument.relax.value());
    assert!(is_gesture(&desk.host.take(), "relax"));
}

#[test]
fn a_list_says_what_each_of_it_is() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Engine", "Quality");
    let says =
        |desk: &Desk, quality: Quality| desk.harness.query_by_label_contains(heard_of(quality)).is_some();
    desk.point(place);
    desk.wait(1.0);
    assert!(says(&desk, Quality::Live) && !says(&desk, Quality::Reference), "the one that is chosen");
    desk.click(place);
    desk.wait(0.1);
    let line = desk.harness.get_by_label_contains("Reference: ").rect().center();
    desk.point(line);
    desk.wait(1.0);
    assert!(says(&desk, Quality::Reference), "the one under the mouse");
}

#[test]
fn what_nothing_comes_of_says_why() {
    let mut desk = Desk::new();
    let why = |desk: &mut Desk, tab: &str, name: &str, reason: &str| {
        let place = at(desk, tab, name);
        desk.point(place);
        desk.wait(1.0);
        desk.harness.query_by_label_contains(reason).is_some()
    };
    let reasons = [
        ("Luthier", "Pickup position", "without a coil"),
        ("Luthier", "String 5 tuning", "no such string"),
        ("Sound", "Idle hands", "no body"),
        ("Player", "First channel", "channel per string"),
        ("Player", "String order", "channel per string"),
    ];
    // An electric guitar has a coil, but no body, and is played by one keyboard.
    for ((tab, name, reason), expected) in reasons.into_iter().zip([false, false, true, true, true]) {
        assert_eq!(why(&mut desk, tab, name, reason), expected, "{name}");
    }
    let ukulele = SHIPPED.iter().position(|name| *name == "ukulele").expect("it comes with the program");
    let host = desk.host.clone();
    let setter = ParamSetter::new(&*host);
    setter.set_parameter(&desk.params.instrument.instrument, InstrumentChoice::from_index(ukulele));
    setter.set_parameter(&desk.params.control.input_mode, InputChoice::Strings);
    for ((tab, name, reason), expected) in reasons.into_iter().zip([true, true, false, false, false]) {
        assert_eq!(why(&mut desk, tab, name, reason), expected, "{name} of a ukulele");
    }
}
