//! Promise: instruments are chosen and saved in the editor. What is saved is what was heard; choosing and saving are one
//! step back each; what cannot be saved is told in one line.

use std::fs;

use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use low_action_dsp::Setup;
use low_action_tests::desk::Desk;
use low_action_tests::user::isolate as folder;
use nice_plug::prelude::{ParamSetter, Params};
use serde_json::{Value, json};

/// Saves what is played under a name.
fn save(desk: &mut Desk, name: &str) {
    desk.click(desk.named("Save"));
    desk.wait(0.1);
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Text(name.into()));
    desk.key(Key::Enter);
    desk.wait(0.1);
}

/// What the session keeps of the file that is played.
fn kept(desk: &Desk) -> Value {
    serde_json::from_str(&desk.params.serialize_fields()["instrument_file"]).expect("JSON")
}

/// Its text.
fn kept_text(desk: &Desk) -> String {
    kept(desk)["text"].as_str().expect("a text").to_owned()
}

/// Has a session be loaded that keeps such a file.
fn load(desk: &mut Desk, session: &Value) {
    desk.params.deserialize_fields(&[("instrument_file".to_owned(), session.to_string())].into());
    let number = session["number"].as_i64().expect("a number") as i32;
    ParamSetter::new(&*desk.host).set_parameter(&desk.params.instrument.file, number);
    desk.wait(0.1);
}

/// Writes a file to the user's folder.
fn write(name: &str, text: &str) {
    fs::write(folder().join(format!("{name}.toml")), text).expect("it can be written");
}

/// The number under which a file of the folder can be chosen.
fn number(desk: &Desk, name: &str) -> u32 {
    let names = desk.params.shelf.names();
    names.iter().position(|known| known == name).expect("it is there") as u32 + 1
}

#[test]
fn one_is_chosen_as_its_maker_left_it() {
    let mut desk = Desk::new();
    desk.enter("Luthier", "Action", "150");
    desk.open("Player");
    desk.click(desk.named("Electric *"));
    desk.wait(0.1);
    desk.click(desk.named("Steel"));
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.instrument.to_string(), "Steel");
    assert_eq!(desk.action(), 1.0);
    desk.undo();
    assert_eq!(desk.params.instrument.instrument.to_string(), "Electric");
    assert_eq!(desk.action(), 1.5);
    desk.click(desk.named("›"));
    desk.wait(0.05);
    assert_eq!(desk.params.instrument.instrument.to_string(), "Classical");
}

#[test]
fn nothing_of_the_last_one_is_left() {
    let mut desk = Desk::new();
    let setter = ParamSetter::new(&*desk.host);
    let mut changed = 0;
    for (_, param, group) in desk.params.param_map() {
        if ["Set-up", "Strings", "Player"].iter().any(|of| group.starts_with(of)) {
            // SAFETY: the pointers lead into the parameters, which the desk keeps.
            unsafe { setter.raw_context.raw_set_parameter_normalized(param, 0.3) };
            changed += 1;
        }
    }
    assert!(changed > 20, "only {changed} belong to the last one");
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
    desk.enter("Luthier", "Action", "150");
    desk.enter("Luthier", "Relief", "0.1");
    desk.enter("Player", "Finger force", "80");
    desk.enter("Sound", "Tuning", "-50");
    desk.enter("Luthier", "String 6 tuning", "-2");
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
    (expected.string[5].pitch, expected.string[5].name) = (38.0, "D2".into());
    assert_eq!(saved, expected);
    // It is played, and nothing is done to it twice.
    let number = desk.params.instrument.file.value();
    assert!(number > 0);
    assert_eq!(desk.params.shelf.name(number as u32).as_deref(), Some("Mine 1"));
    assert_eq!([desk.action(), desk.params.player.finger_force.value()], [1.0, 1.0]);
    desk.undo();
    assert_eq!((desk.params.instrument.file.value(), desk.action()), (0, 1.5));
    desk.redo();
    // Saved again under its name, it is the same number, read anew.
    desk.enter("Luthier", "Action", "50");
    save(&mut desk, "Mine 1");
    assert_eq!(desk.params.instrument.file.value(), number);
    let text = fs::read_to_string(folder().join("Mine 1.toml")).expect("it was written");
    assert_eq!(Setup::from_toml(&text).expect("it is a set-up").neck.action, expected.neck.action * 0.5);
    // Back comes what was heard: the file as it was, with what was changed of it, and not that change twice. In the folder it
    // stays as it was saved.
    let heard = |desk: &Desk| -> (f64, f32) {
        let setup = Setup::from_toml(&kept_text(desk)).expect("it is a set-up");
        (setup.neck.action, desk.action())
    };
    assert_eq!(heard(&desk), (expected.neck.action * 0.5, 1.0));
    desk.undo();
    assert_eq!(desk.params.instrument.file.value(), number);
    assert_eq!(heard(&desk), (expected.neck.action, 0.5));
    desk.redo();
    assert_eq!(heard(&desk), (expected.neck.action * 0.5, 1.0));
    assert_eq!(fs::read_to_string(folder().join("Mine 1.toml")).expect("it was written"), text);
}

/// Were the file another before the changes are taken off it, they would be heard twice.
#[test]
fn what_is_replaced_waits_for_its_values() {
    let mut desk = Desk::new();
    save(&mut desk, "Mine 2");
    desk.enter("Luthier", "Action", "150");
    let before = kept_text(&desk);
    desk.host.be_late();
    save(&mut desk, "Mine 2");
    assert_eq!((kept_text(&desk), desk.action()), (before.clone(), 1.5));
    desk.host.catch_up();
    desk.wait(0.05);
    assert_ne!(kept_text(&desk), before);
    assert_eq!(desk.action(), 1.0);
}

/// As with quick fingers, or a long block.
#[test]
fn what_is_taken_back_before_it_came_does_not_come() {
    let mut desk = Desk::new();
    save(&mut desk, "Mine 4");
    desk.enter("Luthier", "Action", "50");
    let heard = |desk: &Desk| (kept_text(desk), desk.action());
    let before = heard(&desk);
    desk.host.be_late();
    save(&mut desk, "Mine 4");
    desk.undo();
    for _ in 0..2 {
        desk.host.catch_up();
        desk.wait(0.1);
    }
    assert_eq!(heard(&desk), before);
    desk.redo();
    desk.host.catch_up();
    // What comes back to where it was may have yet to set out: that it is there is known when the host has had its time.
    desk.wait(2.0);
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
    write("Meanwhile", "based_on = \"steel\"\n");
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

/// What is heard is another instrument, which is not what its name stands for.
#[test]
fn a_file_that_cannot_be_played_is_not_replaced_unasked() {
    for (name, text) in [("Broken", "not a set-up"), ("Whole", "based_on = \"steel\"\n")] {
        write(name, text);
        let mut desk = Desk::new();
        let number = number(&desk, name);
        ParamSetter::new(&*desk.host).set_parameter(&desk.params.instrument.file, number as i32);
        desk.wait(0.1);
        desk.click(desk.named("Save"));
        desk.wait(0.1);
        let offered = desk.harness.get_by_role(egui::accesskit::Role::TextInput).value();
        assert_eq!(offered.unwrap_or_default(), if name == "Whole" { name } else { "" });
        desk.key(Key::Enter);
        desk.wait(0.1);
        let after = fs::read_to_string(folder().join(format!("{name}.toml"))).expect("it is there");
        assert_eq!(after == text, name == "Broken", "{after}");
    }
}

/// As in a project from a time when the folder had other files: the session's own has the number of another one.
#[test]
fn what_a_session_keeps_gives_way_to_what_is_chosen() {
    for name in ["Kept aa", "Kept cc"] {
        write(name, "based_on = \"steel\"\n");
    }
    let mut desk = Desk::new();
    let other = number(&desk, "Kept aa");
    let number = number(&desk, "Kept cc");
    let session = json!({ "number": number, "name": "Kept aa", "text": "based_on = \"bass\"\n" });
    load(&mut desk, &session);
    assert_eq!(desk.params.shelf.name(number).as_deref(), Some("Kept aa"));
    assert_eq!(kept(&desk), session, "nobody has chosen anything yet");
    // The one after it in the list has its number.
    desk.click(desk.named("›"));
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.file.value(), number as i32);
    assert_eq!(desk.params.shelf.name(number).as_deref(), Some("Kept cc"));
    let found = kept(&desk);
    assert_eq!((&found["name"], &found["text"]), (&json!("Kept cc"), &json!("based_on = \"steel\"\n")));
    // Back comes what the session kept, and so does what A was.
    desk.undo();
    assert_eq!(kept(&desk), session);
    desk.redo();
    assert_eq!(kept(&desk), found);
    desk.undo();
    desk.click(desk.named("B"));
    desk.wait(0.05);
    for (button, expected) in [("›", &found), ("A", &session), ("B", &found)] {
        desk.click(desk.named(button));
        desk.wait(0.1);
        assert_eq!(kept(&desk), *expected, "{button}");
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
            desk.undo();
        }
    }
    assert_eq!(kept(&desk), session);
    assert_eq!(desk.params.shelf.name(number).as_deref(), Some("Kept aa"));
    desk.click(desk.named("B"));
    desk.wait(0.1);
    desk.host.catch_up();
    desk.wait(0.1);
    desk.click(desk.named("‹"));
    desk.wait(0.1);
    desk.host.catch_up();
    desk.wait(0.1);
    assert_eq!(desk.params.instrument.file.value(), other as i32);
}

/// The host goes to the other instrument and back between two pictures.
#[test]
fn what_a_session_keeps_outlives_what_is_taken_back_before_it_came() {
    write("Kept dd", "based_on = \"steel\"\n");
    let mut desk = Desk::new();
    let number = number(&desk, "Kept dd");
    let session = json!({ "number": number, "name": "Own", "text": "based_on = \"bass\"\n" });
    load(&mut desk, &session);
    desk.host.be_late();
    desk.click(desk.named("Own"));
    desk.wait(0.1);
    desk.click(desk.named("Steel"));
    desk.undo();
    desk.wait(0.1);
    desk.host.catch_up();
    for wait in [0.1, 2.0] {
        desk.wait(wait);
        assert_eq!(kept(&desk), session, "after {wait} s");
    }
}

/// Its list has what the session keeps under its number, and what is chosen is what the folder has there.
#[test]
fn what_the_luthier_chooses_anew_is_read_anew() {
    write("Anew", "based_on = \"steel\"\n");
    let mut desk = Desk::new();
    let number = number(&desk, "Anew");
    let choose = |desk: &mut Desk, name: &str| {
        desk.click(desk.control("Instrument file").expect("it is there"));
        desk.wait(0.1);
        desk.click(desk.named(&format!("{number}: {name}")));
        desk.wait(0.1);
    };
    desk.open("Luthier");
    choose(&mut desk, "Anew");
    let [steel, bass, own] = ["steel", "bass", "classical"].map(|name| format!("based_on = \"{name}\"\n"));
    assert_eq!(kept_text(&desk), steel);
    write("Anew", &bass);
    desk.wait(0.1);
    assert_eq!(kept_text(&desk), steel, "nobody has chosen it anew");
    choose(&mut desk, "Anew");
    assert_eq!(kept_text(&desk), bass);
    desk.undo();
    assert_eq!((desk.params.instrument.file.value(), kept_text(&desk)), (number as i32, steel));
    desk.undo();
    assert_eq!(desk.params.instrument.file.value(), 0);
    load(&mut desk, &json!({ "number": number, "name": "Own", "text": own }));
    choose(&mut desk, "Own");
    assert_eq!(kept_text(&desk), bass);
    desk.undo();
    assert_eq!(kept_text(&desk), own);
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
        desk.undo();
        assert_eq!(desk.params.instrument.instrument.to_string(), "Electric");
        assert_eq!(desk.params.instrument.file.value(), file, "one step back");
    }
}

/// As where two instances of a plugin are open.
#[test]
fn what_is_saved_in_one_window_is_in_the_lists_of_another() {
    let (mut one, mut other) = (Desk::new(), Desk::new());
    let before = other.params.shelf.names();
    save(&mut one, "Aa of another");
    other.click(other.named("Electric"));
    other.wait(0.1);
    assert!(other.harness.query_by_label("Aa of another").is_some(), "it is not in the list at the top");
    // Those that were there keep their numbers.
    let after = other.params.shelf.names();
    assert_eq!(after[..before.len()], before);
    other.key(Key::Escape);
    save(&mut one, "Ab of another");
    other.open("Luthier");
    other.click(other.control("Instrument file").expect("it is there"));
    other.wait(0.1);
    let number = number(&other, "Ab of another");
    let title = format!("{number}: Ab of another");
    assert!(other.harness.query_by_label(&title).is_some(), "it is not in the luthier's list");
    ParamSetter::new(&*other.host).set_parameter(&other.params.instrument.file, number as i32);
    other.wait(0.1);
    assert_eq!(kept(&other)["name"], json!("Ab of another"));
}
