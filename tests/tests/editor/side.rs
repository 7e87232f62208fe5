//! Promise: the side view shows the string that was played last, or on which the mouse rested last, and reads its contacts: over a fret it says how
//! deep the string is pressed into it and with what force, or how far it is away.

use egui_kittest::kittest::{NodeT, Queryable};
use low_action::params::InstrumentChoice;
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;
use low_action_tests::desk::Desk;
use nice_plug::prelude::{Enum, ParamSetter};

/// The words beside the mouse over a fret (counted from 1) of the string in the side view.
fn read(desk: &mut Desk, fret: usize) -> String {
    let area = desk.harness.get_by_label("Side view").rect();
    let place = 0.6477 * (1.0 - (-(fret as f32) / 12.0).exp2());
    let at = egui::pos2(desk.sight().x(place), area.center().y);
    desk.point(at);
    desk.wait(1.5);
    let named = format!("Fret {fret}:");
    let said = desk.harness.query_by_label_contains(&named);
    said.and_then(|node| node.accesskit_node().label().or(node.value())).unwrap_or_default()
}

/// The number before a unit.
fn number(words: &str, unit: &str) -> f32 {
    let before = words.split(unit).next().and_then(|words| words.split_whitespace().last());
    before.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no {unit} in {words:?}"))
}

/// The string that is shown.
fn shown(desk: &Desk) -> Option<String> {
    desk.harness.get_by_label("Side view").value()
}

#[test]
fn a_stopped_string_is_pressed_into_its_fret() {
    let mut desk = Desk::new();
    // The third fret of the string E2.
    desk.play(PlayerEvent::NoteOn { channel: 0, key: 43, velocity: 0.5 });
    desk.wait(0.5);
    let low_e = desk.at(0.5, 5.0);
    desk.point(low_e);
    desk.wait(0.3);
    let third = read(&mut desk, 3);
    assert!(third.contains("pressed in by"), "{third:?}");
    assert!((0.01..5.0).contains(&number(&third, "µm")) && number(&third, "N now") > 0.5, "{third:?}");
    let twelfth = read(&mut desk, 12);
    assert!(twelfth.contains("free"), "{twelfth:?}");
    assert!((0.3..2.0).contains(&number(&twelfth, "mm")), "{twelfth:?}");
}

#[test]
fn another_string_is_shown_where_the_mouse_rests() {
    let mut desk = Desk::new();
    for (string, name) in [(2, "G3"), (5, "E2")] {
        let at = desk.at(0.5, string as f32);
        desk.point(at);
        desk.wait(0.1);
        assert_ne!(shown(&desk).as_deref(), Some(name), "it may only be passing");
        desk.wait(0.2);
        assert_eq!(shown(&desk).as_deref(), Some(name));
    }
}

/// All others lie on the way from the first string to what is read of it.
#[test]
fn the_mouse_goes_down_to_the_side_view_without_changing_it() {
    let mut desk = Desk::new();
    desk.point(desk.at(0.3, 0.0));
    desk.wait(0.3);
    assert_eq!(shown(&desk).as_deref(), Some("E4"));
    let (from, to) = (desk.at(0.3, 0.0), desk.harness.get_by_label("Side view").rect().center());
    for step in 1..=10 {
        desk.point(from + (to - from) * (step as f32 / 10.0));
    }
    desk.wait(0.5);
    assert_eq!(shown(&desk).as_deref(), Some("E4"));
}

#[test]
fn a_string_that_is_played_is_shown_at_once() {
    let mut desk = Desk::new();
    for (place, string, name) in [(0.155, 3.0, "D3"), (0.56, 1.0, "B3")] {
        let at = desk.at(place, string);
        desk.click(at);
        desk.point(egui::pos2(at.x, 24.0));
        assert_eq!(shown(&desk).as_deref(), Some(name));
    }
}

#[test]
fn an_instrument_with_fewer_strings_still_shows_one() {
    let mut desk = Desk::new();
    desk.point(desk.at(0.5, 5.0));
    desk.wait(0.3);
    assert_eq!(shown(&desk).as_deref(), Some("E2"));
    desk.harness.event(egui::Event::PointerGone);
    desk.wait(0.1);
    ParamSetter::new(&*desk.host)
        .set_parameter(&desk.params.instrument.instrument, InstrumentChoice::from_index(3));
    desk.wait(0.1);
    assert_eq!(shown(&desk).as_deref(), Some("E1"));
}

/// The note is what is heard, whatever the string was called before.
#[test]
fn a_string_that_is_tuned_is_called_by_its_note() {
    let mut desk = Desk::new();
    desk.point(desk.at(0.5, 5.0));
    desk.wait(0.3);
    desk.open("Luthier");
    let said = |desk: &Desk| {
        let slider = desk.harness.get_by_label("String 6 tuning").value();
        [shown(desk), slider].map(Option::unwrap_or_default)
    };
    for (semitones, note) in [(-2.0, "D2"), (0.0, "E2"), (0.3, "E2 +30")] {
        ParamSetter::new(&*desk.host).set_parameter(&desk.params.strings[5].tuning, semitones);
        desk.wait(0.1);
        assert_eq!(said(&desk), [note.to_owned(), format!("String 6: {note}")]);
    }
}

/// As while a host does not process: what it played last is another instrument.
#[test]
fn strings_of_another_neck_are_not_seen_on_this_one() {
    let mut desk = Desk::new();
    let electric = 0.6477;
    let read = |desk: &mut Desk, scale: f32| {
        let area = desk.harness.get_by_label("Side view").rect();
        let place = electric * (1.0 - (-3.0_f32 / 12.0).exp2());
        // Room for names to the left and right of the string.
        let along = (area.width() - 48.0 - 32.0) / scale;
        desk.point(egui::pos2(area.left() + 48.0 + place * along, area.center().y));
        desk.wait(1.5);
        desk.harness.query_by_label_contains("Fret 3:").is_some()
    };
    assert!(read(&mut desk, electric));
    ParamSetter::new(&*desk.host)
        .set_parameter(&desk.params.instrument.instrument, InstrumentChoice::from_index(3));
    desk.wait(0.1);
    let bass = Setup::builtin("bass").expect("it is built in").neck.scale_length as f32;
    assert!(!read(&mut desk, bass), "the frets of a guitar are read on a bass");
}
