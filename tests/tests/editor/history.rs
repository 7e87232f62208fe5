//! Promise: every gesture is one step back, steps that follow at once are one together, and what a host does is none; A and B
//! are two sets of values; another session has neither.

use egui::Key;
use egui_kittest::kittest::Queryable;
use low_action_tests::desk::Desk;
use nice_plug::context::gui::GuiContextInner;
use nice_plug::prelude::{Enum, ParamSetter};

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
        desk.enter("Luthier", "Action", value);
    }
    desk.undo();
    assert_eq!(desk.action(), 0.6);
    desk.undo();
    assert_eq!(desk.action(), 1.5);
    desk.redo();
    assert_eq!(desk.action(), 0.6);
    desk.undo();
    desk.undo();
    desk.undo();
    assert_eq!(desk.action(), 1.0, "there is nothing before the beginning");
    desk.redo();
    desk.enter("Luthier", "Action", "70");
    desk.redo();
    assert_eq!(desk.action(), 0.7, "what was undone is gone when something else is done");
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
            desk.undo();
            desk.action()
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
    // Down the list as it stands there, and up again.
    for key in [Key::ArrowDown, Key::ArrowDown, Key::ArrowUp, Key::ArrowDown, Key::ArrowDown] {
        desk.key(key);
    }
    assert_eq!(desk.params.instrument.instrument.value().to_index(), 3);
    desk.undo();
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
    desk.enter("Luthier", "Action", "150");
    let setter = ParamSetter::new(&*desk.host);
    setter.set_parameter(&desk.params.player.variation, 0.5);
    desk.undo();
    assert_eq!((desk.action(), desk.params.player.variation.value()), (1.0, 0.5));
}

fn is_b_heard(desk: &Desk) -> bool {
    desk.harness.query_by_label("B to A").is_some()
}

/// Clicks on something, and gives back what is heard then.
fn heard_after(desk: &mut Desk, name: &str) -> (bool, f32) {
    desk.click(desk.named(name));
    desk.wait(0.05);
    (is_b_heard(desk), desk.action())
}

#[test]
fn who_goes_back_over_a_and_b_hears_each_under_its_letter() {
    let mut desk = Desk::new();
    assert_eq!(heard_after(&mut desk, "B"), (true, 1.0));
    desk.enter("Luthier", "Action", "150");
    for (step, (name, heard)) in [
        ("A", (false, 1.0)),
        ("Undo", (true, 1.5)),
        // Neither was lost by it.
        ("A", (false, 1.0)),
        ("Undo", (true, 1.5)),
        ("Undo", (true, 1.0)),
        ("Redo", (true, 1.5)),
        ("Redo", (false, 1.0)),
        ("B", (true, 1.5)),
        ("A", (false, 1.0)),
        // Made the same in between, the one that was heard is the one that comes back.
        ("A to B", (false, 1.0)),
        ("B", (true, 1.0)),
        ("Undo", (true, 1.5)),
        ("A", (false, 1.0)),
    ]
    .into_iter()
    .enumerate()
    {
        assert_eq!(heard_after(&mut desk, name), heard, "{name}, step {step}");
    }
}

/// What was done before belongs to another session: it would be set in this one.
#[test]
fn another_session_begins_anew() {
    let mut desk = Desk::new();
    desk.enter("Luthier", "Action", "150");
    let session = desk.host.get_state();
    heard_after(&mut desk, "B");
    desk.enter("Luthier", "Action", "60");
    desk.enter("Luthier", "Action", "80");
    desk.undo();
    desk.host.set_state(session);
    desk.wait(0.05);
    assert_eq!((is_b_heard(&desk), desk.action()), (false, 1.5));
    desk.undo();
    assert_eq!(desk.action(), 1.5);
    desk.redo();
    assert_eq!(desk.action(), 1.5);
    assert_eq!(heard_after(&mut desk, "B"), (true, 1.5));
    // From then on it is as ever.
    desk.enter("Luthier", "Action", "70");
    desk.undo();
    assert_eq!(desk.action(), 1.5);
}

#[test]
fn a_and_b_are_heard_in_turn() {
    let mut desk = Desk::new();
    desk.click(desk.named("B"));
    desk.enter("Luthier", "Action", "150");
    for (name, heard) in
        [("A", (false, 1.0)), ("B", (true, 1.5)), ("B to A", (true, 1.5)), ("A", (false, 1.5))]
    {
        assert_eq!(heard_after(&mut desk, name), heard, "{name}");
    }
}
