//! Promise: instruments are chosen and saved in the editor. What is saved is what was heard; choosing and saving are one
//! step back each, as is every gesture; A and B are two sets of values; what cannot be saved is told in one line.

use std::fs;

use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use low_action_dsp::Setup;
use low_action_tests::desk::Desk;
use low_action_tests::user::isolate as folder;
use nice_plug::prelude::{Enum, ParamSetter, Params};
use serde_json::{Value, json};

/// Types a value into the control of a parameter.
fn enter(desk: &mut Desk, tab: &str, name: &str, value: &str) {
    desk.open(tab);
    let place = desk.control(&format!("Type {name}")).expect("it has a number");
    desk.click(place);
    desk.wait(0.05);
    desk.harness.event(Event::Text(value.into()));
    desk.key(Key::Enter);
    desk.wait(0.5);
}

/// Saves what is played under a name.
fn save(desk: &mut Desk, name: &str) {
    desk.click(desk.named("Save"));
    desk.wait(0.1);
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Text(name.into()));
    desk.key(Key::Enter);
    desk.wait(0.1);
}

/// The action, to the step of its parameter.
fn action(desk: &Desk) -> f32 {
    (100.0 * desk.params.setup.action.value()).round() / 100.0
}

fn undo(desk: &mut Desk) {
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    desk.wait(0.05);
}

fn redo(desk: &mut Desk) {
    desk.harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    desk.wait(0.05);
}

#[test]
fn one_is_chosen_as_its_maker_left_it() {
    let mut desk = Desk::new();
    enter(&mut desk, "Luthier", "Action", "150");
    desk.open("Player");
    desk.click(desk.named("Electric *"));
    desk.wait(0.1);
    desk.click(desk.named("Steel"));
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.instrument.to_string(), "Steel");
    assert_eq!(action(&desk), 1.0);
    undo(&mut desk);
    assert_eq!(desk.params.instrument.instrument.to_string(), "Electric");
    assert_eq!(action(&desk), 1.5);
    desk.click(desk.named("›"));
    desk.wait(0.05);
    assert_eq!(desk.params.instrument.instrument.to_string(), "Classical");
}

#[test]
fn nothing_of_the_last_one_is_left() {
    let mut desk = Desk::new();
    let setter = ParamSetter::new(&*desk.host);
    for (_, param, group) in desk.params.param_map() {
        if ["Set-up", "Strings", "Player"].iter().any(|of| group.starts_with(of)) {
            // SAFETY: the pointers lead into the parameters, which the desk keeps.
            unsafe { setter.raw_context.raw_set_parameter_normalized(param, 0.3) };
        }
    }
    desk.click(desk.named("›"));
    desk.wait(0.1);
    save(&mut desk, "As it comes");
    let text = fs::read_to_string(folder().join("As it comes.toml")).expect("it was written");
    let saved = Setup::from_toml(&text).expect("it is a set-up");
    let classical = Setup::builtin("classical").expect("it is built in");
    assert_eq!(saved, Setup { name: "As it comes".into(), ..classical });
}

#[test]
fn what_is_saved_is_what_was_heard() {
    let mut desk = Desk::new();
    enter(&mut desk, "Luthier", "Action", "150");
    enter(&mut desk, "Luthier", "Relief", "0.1");
    enter(&mut desk, "Player", "Finger force", "80");
    enter(&mut desk, "Sound", "Tuning", "-50");
    save(&mut desk, "Mine 1");
    let text = fs::read_to_string(folder().join("Mine 1.toml")).expect("it was written");
    let saved = Setup::from_toml(&text).expect("it is a set-up");
    let mut expected = Setup::builtin("electric").expect("it is built in");
    expected.name = "Mine 1".into();
    expected.neck.action *= 1.5;
    expected.neck.nut_clearance *= 1.5;
    expected.neck.relief += 1e-4;
    expected.player.fretting.force *= 0.8;
    expected.tuning = -0.5;
    assert_eq!(saved, expected);
    // It is played, and nothing is done to it twice.
    let number = desk.params.instrument.file.value();
    assert!(number > 0);
    assert_eq!(desk.params.shelf.name(number as u32).as_deref(), Some("Mine 1"));
    assert_eq!([action(&desk), desk.params.player.finger_force.value()], [1.0, 1.0]);
    undo(&mut desk);
    assert_eq!((desk.params.instrument.file.value(), action(&desk)), (0, 1.5));
    redo(&mut desk);
    // Saved again under its name, it is the same number, read anew.
    enter(&mut desk, "Luthier", "Action", "50");
    save(&mut desk, "Mine 1");
    assert_eq!(desk.params.instrument.file.value(), number);
    let text = fs::read_to_string(folder().join("Mine 1.toml")).expect("it was written");
    assert_eq!(Setup::from_toml(&text).expect("it is a set-up").neck.action, expected.neck.action * 0.5);
    // Back comes what was heard: the file as it was, with what was changed of it, and not that change twice. In the folder it
    // stays as it was saved.
    let heard = |desk: &Desk| -> (f64, f32) {
        let kept: Value =
            serde_json::from_str(&desk.params.serialize_fields()["instrument_file"]).expect("JSON");
        let setup = Setup::from_toml(kept["text"].as_str().expect("a text")).expect("it is a set-up");
        (setup.neck.action, action(desk))
    };
    assert_eq!(heard(&desk), (expected.neck.action * 0.5, 1.0));
    undo(&mut desk);
    assert_eq!(desk.params.instrument.file.value(), number);
    assert_eq!(heard(&desk), (expected.neck.action, 0.5));
    redo(&mut desk);
    assert_eq!(heard(&desk), (expected.neck.action * 0.5, 1.0));
    assert_eq!(fs::read_to_string(folder().join("Mine 1.toml")).expect("it was written"), text);
}

/// Were the file another before the changes are taken off it, they would be heard twice.
#[test]
fn what_is_replaced_waits_for_its_values() {
    let mut desk = Desk::new();
    save(&mut desk, "Mine 2");
    enter(&mut desk, "Luthier", "Action", "150");
    let text = |desk: &Desk| {
        let kept: Value =
            serde_json::from_str(&desk.params.serialize_fields()["instrument_file"]).expect("JSON");
        kept["text"].as_str().expect("a text").to_owned()
    };
    let before = text(&desk);
    desk.host.be_late();
    save(&mut desk, "Mine 2");
    assert_eq!((text(&desk), action(&desk)), (before.clone(), 1.5));
    desk.host.catch_up();
    desk.wait(0.05);
    assert_ne!(text(&desk), before);
    assert_eq!(action(&desk), 1.0);
}

/// As with quick fingers, or a long block.
#[test]
fn what_is_taken_back_before_it_came_does_not_come() {
    let mut desk = Desk::new();
    save(&mut desk, "Mine 4");
    enter(&mut desk, "Luthier", "Action", "50");
    let heard = |desk: &Desk| {
        let kept: Value =
            serde_json::from_str(&desk.params.serialize_fields()["instrument_file"]).expect("JSON");
        (kept["text"].as_str().expect("a text").to_owned(), action(desk))
    };
    let before = heard(&desk);
    desk.host.be_late();
    save(&mut desk, "Mine 4");
    undo(&mut desk);
    for _ in 0..2 {
        desk.host.catch_up();
        desk.wait(0.1);
    }
    assert_eq!(heard(&desk), before);
    redo(&mut desk);
    desk.host.catch_up();
    desk.wait(0.1);
    let after = heard(&desk);
    assert!(after.0 != before.0 && after.1 == 1.0, "{after:?}");
}

#[test]
fn names_that_cannot_be_are_told() {
    let mut desk = Desk::new();
    for name in ["electric", "../elsewhere", " "] {
        save(&mut desk, name);
        let told = desk.harness.query_by_label_contains("name").is_some();
        assert!(told, "{name:?}");
        assert_eq!(desk.params.instrument.file.value(), 0);
    }
    assert!(!folder().join("electric.toml").exists());
    // What was typed is there to be put right, and has the keyboard.
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Text("My/guitar".into()));
    desk.key(Key::Enter);
    desk.wait(0.1);
    desk.harness.event(Event::Text(" 2".into()));
    desk.wait(0.1);
    let typed = desk.harness.get_by_role(egui::accesskit::Role::TextInput).value();
    assert_eq!(typed.as_deref(), Some("My/guitar 2"));
    assert!(desk.harness.query_by_label_contains("named \"My/guitar\"").is_some());
    // Asked anew it is forgotten.
    desk.key(Key::Escape);
    desk.wait(0.1);
    desk.click(desk.named("Save"));
    desk.wait(0.1);
    assert!(desk.harness.query_by_label_contains("named").is_none());
}

#[test]
fn what_somebody_else_has_saved_is_not_replaced_unasked() {
    let mut desk = Desk::new();
    fs::write(folder().join("Meanwhile.toml"), "based_on = \"steel\"\n").expect("it can be written");
    desk.click(desk.named("Save"));
    desk.wait(0.1);
    for (name, button, other) in [("Mean", "Save it", "Replace"), ("Meanwhile", "Replace", "Save it")] {
        desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        desk.harness.event(Event::Text(name.into()));
        desk.wait(0.1);
        assert!(desk.harness.query_by_label(button).is_some(), "{name}");
        assert!(desk.harness.query_by_label(other).is_none(), "{name}");
    }
}

/// As in a project from a time when the folder had other files: the session's own has the number of another one.
#[test]
fn what_a_session_keeps_gives_way_to_what_is_chosen() {
    for name in ["Kept aa", "Kept cc"] {
        fs::write(folder().join(format!("{name}.toml")), "based_on = \"steel\"\n")
            .expect("it can be written");
    }
    let mut desk = Desk::new();
    let place = |desk: &Desk, name| desk.params.shelf.names().iter().position(|known| known == name);
    let number = place(&desk, "Kept cc").expect("it is there") as u32 + 1;
    let kept = json!({ "number": number, "name": "Kept aa", "text": "based_on = \"bass\"\n" }).to_string();
    let field = |desk: &Desk| desk.params.serialize_fields()["instrument_file"].clone();
    desk.params.deserialize_fields(&[("instrument_file".to_owned(), kept.clone())].into());
    let setter = ParamSetter::new(&*desk.host);
    setter.set_parameter(&desk.params.instrument.file, number as i32);
    desk.wait(0.1);
    assert_eq!(desk.params.shelf.name(number).as_deref(), Some("Kept aa"));
    let parsed = |text: &str| -> Value { serde_json::from_str(text).expect("JSON") };
    assert_eq!(parsed(&field(&desk)), parsed(&kept), "nobody has chosen anything yet");
    // The one after it in the list has its number.
    desk.click(desk.named("›"));
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.file.value(), number as i32);
    assert_eq!(desk.params.shelf.name(number).as_deref(), Some("Kept cc"));
    let found = parsed(&field(&desk));
    assert_eq!((&found["name"], &found["text"]), (&json!("Kept cc"), &json!("based_on = \"steel\"\n")));
    // Back comes what the session kept, and so does what A was.
    undo(&mut desk);
    assert_eq!(parsed(&field(&desk)), parsed(&kept));
    redo(&mut desk);
    assert_eq!(parsed(&field(&desk)), found);
    undo(&mut desk);
    desk.click(desk.named("B"));
    desk.wait(0.05);
    for (button, expected) in [("›", &found), ("A", &parsed(&kept)), ("B", &found)] {
        desk.click(desk.named(button));
        desk.wait(0.1);
        assert_eq!(parsed(&field(&desk)), *expected, "{button}");
    }
    // From another instrument altogether, and with a host that takes its time.
    desk.click(desk.named("A"));
    desk.wait(0.1);
    desk.host.be_late();
    desk.click(desk.named("Kept aa"));
    desk.wait(0.1);
    desk.click(desk.named("Steel"));
    for late in 0..2 {
        desk.wait(0.1);
        desk.host.catch_up();
        desk.wait(0.1);
        if late == 0 {
            assert_eq!(desk.params.instrument.file.value(), 0);
            undo(&mut desk);
        }
    }
    assert_eq!(parsed(&field(&desk)), parsed(&kept));
    assert_eq!(desk.params.shelf.name(number).as_deref(), Some("Kept aa"));
    desk.click(desk.named("B"));
    desk.wait(0.1);
    desk.host.catch_up();
    desk.wait(0.1);
    desk.click(desk.named("‹"));
    desk.wait(0.1);
    desk.host.catch_up();
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.file.value(), place(&desk, "Kept aa").expect("it is there") as i32 + 1);
}

#[test]
fn what_the_luthier_chooses_is_played_in_place_of_a_file() {
    let mut desk = Desk::new();
    save(&mut desk, "Mine 3");
    let file = desk.params.instrument.file.value();
    desk.open("Luthier");
    // Also the one that would be played without the file.
    for title in ["Steel", "Electric"] {
        desk.click(desk.control("Instrument").expect("it is there"));
        desk.wait(0.1);
        desk.click(desk.named(title));
        desk.wait(0.1);
        assert_eq!(desk.params.instrument.instrument.to_string(), title);
        assert_eq!(desk.params.instrument.file.value(), 0);
        assert!(desk.harness.query_by_label("Mine 3").is_none(), "it is not the title");
        undo(&mut desk);
        assert_eq!(desk.params.instrument.instrument.to_string(), "Electric");
        assert_eq!(desk.params.instrument.file.value(), file, "one step back");
    }
}

#[test]
fn buttons_say_their_keys_also_while_there_is_nothing_to_do() {
    let mut desk = Desk::new();
    let place = desk.named("Undo");
    desk.point(place);
    desk.wait(1.0);
    let keys = if cfg!(target_os = "macos") { "Cmd+Z" } else { "Ctrl+Z" };
    assert!(desk.harness.query_by_label(keys).is_some());
}

#[test]
fn every_gesture_is_one_step_back() {
    let mut desk = Desk::new();
    for value in ["150", "60", "200"] {
        enter(&mut desk, "Luthier", "Action", value);
    }
    undo(&mut desk);
    assert_eq!(action(&desk), 0.6);
    undo(&mut desk);
    assert_eq!(action(&desk), 1.5);
    redo(&mut desk);
    assert_eq!(action(&desk), 0.6);
    undo(&mut desk);
    undo(&mut desk);
    undo(&mut desk);
    assert_eq!(action(&desk), 1.0, "there is nothing before the beginning");
    redo(&mut desk);
    enter(&mut desk, "Luthier", "Action", "70");
    redo(&mut desk);
    assert_eq!(action(&desk), 0.7, "what was undone is gone when something else is done");
}

#[test]
fn steps_at_once_are_one_step_back() {
    let mut desk = Desk::new();
    desk.open("Luthier");
    desk.click(desk.control("Action").expect("it is there"));
    for pause in [0.1, 1.0] {
        for _ in 0..3 {
            desk.wait(pause);
            desk.key(Key::ArrowUp);
        }
    }
    let steps: Vec<f32> = (0..5)
        .map(|_| {
            undo(&mut desk);
            action(&desk)
        })
        .collect();
    assert!(steps[0] > steps[1] && steps[1] > steps[2] && steps[2] > 1.0, "{steps:?}");
    assert_eq!(steps[3..], [1.0, 1.0], "the first three were one");
}

#[test]
fn steps_from_instrument_to_instrument_are_one_step_back() {
    let mut desk = Desk::new();
    desk.open("Luthier");
    desk.click(desk.control("Instrument").expect("it is there"));
    desk.wait(0.1);
    // Its list is not needed.
    desk.click(desk.control("Instrument").expect("it is there"));
    desk.wait(0.1);
    for _ in 0..3 {
        desk.key(Key::ArrowUp);
    }
    assert_eq!(desk.params.instrument.instrument.value().to_index(), 3);
    undo(&mut desk);
    assert_eq!(desk.params.instrument.instrument.value().to_index(), 0);
}

#[test]
fn two_clicks_go_two_instruments_on() {
    let mut desk = Desk::new();
    desk.host.be_late();
    let next = desk.named("›");
    desk.click(next);
    desk.click(next);
    desk.host.catch_up();
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.instrument.to_string(), "Steel");
}

#[test]
fn what_a_host_does_is_not_undone() {
    let mut desk = Desk::new();
    enter(&mut desk, "Luthier", "Action", "150");
    let setter = ParamSetter::new(&*desk.host);
    setter.set_parameter(&desk.params.player.variation, 0.5);
    undo(&mut desk);
    assert_eq!((action(&desk), desk.params.player.variation.value()), (1.0, 0.5));
}

#[test]
fn a_and_b_are_heard_in_turn() {
    let mut desk = Desk::new();
    desk.click(desk.named("B"));
    enter(&mut desk, "Luthier", "Action", "150");
    desk.click(desk.named("A"));
    desk.wait(0.05);
    assert_eq!(action(&desk), 1.0);
    desk.click(desk.named("B"));
    desk.wait(0.05);
    assert_eq!(action(&desk), 1.5);
    desk.click(desk.named("B to A"));
    desk.wait(0.05);
    desk.click(desk.named("A"));
    desk.wait(0.05);
    assert_eq!(action(&desk), 1.5);
}
