//! Promise: pluck, pickup, action and relief are taken hold of in the picture itself. The host is told where each gesture
//! begins and ends, what is set is where the mouse is, and nothing leaves its range.

use egui::{Event, Key, Modifiers, Pos2, vec2};
use low_action::params::InstrumentChoice;
use low_action::setups::SHIPPED;
use low_action_dsp::Setup;
use low_action_dsp::neck::Neck;
use low_action_tests::desk::{Desk, Told, is_gesture};
use nice_plug::prelude::{Enum, ParamSetter};

/// Drags something with a name by so much.
fn drag(desk: &mut Desk, name: &str, way: egui::Vec2) -> Vec<Told> {
    desk.wait(0.1);
    let from = desk.named(name);
    desk.host.take();
    desk.drag(&[from, from + way], 0.2);
    desk.host.take()
}

/// Takes hold of something with a name and moves it a little to the left; gives back where it was.
fn hold(desk: &mut Desk, name: &str) -> Pos2 {
    let from = desk.named(name);
    desk.point(from);
    desk.press(from, true, Modifiers::NONE);
    desk.point(from - vec2(60.0, 0.0));
    from
}

#[test]
fn marks_along_the_strings_follow_the_mouse() {
    let mut desk = Desk::new();
    for (name, id) in [("Pluck position", "pluck_position"), ("Pickup position", "pickup_position")] {
        desk.wait(0.1);
        let (sight, from) = (desk.sight(), desk.named(name));
        let told = drag(&mut desk, name, vec2(-60.0, 3.0));
        assert!(is_gesture(&told, id), "{told:?}");
        desk.wait(0.1);
        let moved = desk.named(name).x - from.x;
        assert!((moved + 60.0).abs() < 2.0, "{name} went {moved} points");
        let param = if id == "pluck_position" {
            &desk.params.player.pluck_position
        } else {
            &desk.params.setup.pickup_position
        };
        let expected = 60e3 / sight.along;
        assert!((param.value() - expected).abs() < 1.0, "{} mm instead of {expected} mm", param.value());
    }
}

#[test]
fn action_and_relief_are_moved_in_the_side_view() {
    let mut desk = Desk::new();
    // The board where the mark of relief is, half way between frets 5 and 6, sinks by less than the relief grows, which is counted
    // from fret to fret while fret 12 stays where it is.
    let neck = Setup::builtin("electric").expect("it is built in").neck;
    let deeper = Neck { relief: neck.relief + 1e-4, ..neck.clone() };
    let [before, after] = [&neck, &deeper].map(|neck| neck.board_line(neck.equal_place(5.5)));
    let sinks = ((before - after) / 1e-4) as f32;
    for (name, id, follows, ways) in
        [("Action", "action", 1.0, [-10.0, 6.0]), ("Relief", "relief", sinks, [10.0, -6.0])]
    {
        for way in ways {
            desk.wait(0.1);
            let from = desk.named(name);
            let told = drag(&mut desk, name, vec2(3.0, way));
            assert!(is_gesture(&told, id), "{told:?}");
            desk.wait(0.1);
            let moved = desk.named(name) - from;
            println!("{name} went {moved:?}, the mouse {way} points down, of which {follows}");
            assert!((moved.y - follows * way).abs() < 2.0 && moved.x == 0.0, "{name} went {moved:?}");
        }
    }
    let [action, relief] = [&desk.params.setup.action, &desk.params.setup.relief].map(|param| param.value());
    println!("action {action}, relief {relief}");
    assert!(action < 1.0 && relief > 0.0, "action {action}, relief {relief}");
}

/// What is held may go: another instrument has no coil.
#[test]
fn what_is_dropped_has_ended() {
    let mut desk = Desk::new();
    let host = desk.host.clone();
    let setter = ParamSetter::new(&*host);
    let from = hold(&mut desk, "Pickup position");
    let moved = desk.params.setup.pickup_position.value();
    setter.set_parameter(&desk.params.instrument.instrument, InstrumentChoice::from_index(1));
    desk.host.take();
    desk.wait(0.05);
    assert_eq!(desk.host.take(), [Told::End("pickup_position".into())]);
    desk.press(from - vec2(60.0, 0.0), false, Modifiers::NONE);
    setter.set_parameter(&desk.params.instrument.instrument, InstrumentChoice::from_index(0));
    desk.wait(1.0);
    // Two more, and each is one step back.
    for _ in 0..2 {
        drag(&mut desk, "Pickup position", vec2(-30.0, 0.0));
    }
    let undo = |desk: &mut Desk| {
        desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        desk.wait(0.05);
        desk.params.setup.pickup_position.value()
    };
    assert!(undo(&mut desk) > moved);
    assert_eq!(undo(&mut desk), moved);
    assert_eq!(undo(&mut desk), 0.0);
}

/// Nothing is set outside of a gesture, also where what is held goes and comes back under the mouse.
#[test]
fn what_comes_back_is_a_gesture_of_its_own() {
    let mut desk = Desk::new();
    let host = desk.host.clone();
    let setter = ParamSetter::new(&*host);
    let from = hold(&mut desk, "Pickup position");
    for index in [1, 0] {
        setter.set_parameter(&desk.params.instrument.instrument, InstrumentChoice::from_index(index));
        desk.host.take();
        desk.wait(0.1);
    }
    let mut told = desk.host.take();
    desk.point(from - vec2(90.0, 0.0));
    desk.press(from - vec2(90.0, 0.0), false, Modifiers::NONE);
    told.extend(desk.host.take());
    assert!(is_gesture(&told, "pickup_position"), "{told:?}");
}

#[test]
fn what_is_held_when_the_window_is_closed_has_ended() {
    let mut desk = Desk::new();
    hold(&mut desk, "Pluck position");
    let Desk { harness, host, .. } = desk;
    drop(harness);
    let told = host.take();
    assert!(is_gesture(&told, "pluck_position"), "{told:?}");
}

#[test]
fn nothing_leaves_its_range() {
    let mut desk = Desk::new();
    let told = drag(&mut desk, "Pluck position", vec2(-900.0, 0.0));
    let inside = |told: &Told| !matches!(told, Told::Set(_, value) if !(0.0..=1.0).contains(value));
    let moves = told.iter().filter(|told| matches!(told, Told::Set(..))).count();
    assert!(moves > 1 && told.iter().all(inside), "{told:?}");
    assert_eq!(desk.params.player.pluck_position.value(), 200.0);
}

/// The parameters go farther than the strings of one instrument.
#[test]
fn there_is_no_way_to_come_back_beyond_the_string() {
    let mut desk = Desk::new();
    // One that is plucked, and heard, near the saddle.
    let place = SHIPPED.iter().position(|name| *name == "drop-d").expect("it comes with the program");
    let instrument = InstrumentChoice::from_index(place);
    ParamSetter::new(&*desk.host).set_parameter(&desk.params.instrument.instrument, instrument);
    desk.wait(0.1);
    for (name, way) in
        [("Pluck position", vec2(1.0, 0.0)), ("Pickup position", vec2(1.0, 0.0)), ("Relief", vec2(0.0, -1.0))]
    {
        drag(&mut desk, name, 400.0 * way);
        desk.wait(0.1);
        let before = desk.named(name);
        drag(&mut desk, name, -20.0 * way);
        desk.wait(0.1);
        let back = (before - desk.named(name)).dot(way);
        // The middle of the neck sinks by less than the relief, which is counted from fret to fret.
        let least = if name == "Relief" { 8.0 } else { 17.0 };
        assert!((least..23.0).contains(&back), "{name} came back by {back} points");
    }
}

#[test]
fn shift_is_finer_and_a_double_click_brings_back() {
    let mut desk = Desk::new();
    drag(&mut desk, "Pickup position", vec2(-100.0, 0.0));
    let coarse = desk.params.setup.pickup_position.value();
    desk.wait(0.1);
    let from = desk.named("Pickup position");
    let shifted = |desk: &mut Desk, at: Pos2| {
        desk.harness.event_modifiers(Event::PointerMoved(at), Modifiers::SHIFT);
        desk.picture();
    };
    desk.point(from);
    desk.press(from, true, Modifiers::SHIFT);
    for step in 1..=10 {
        shifted(&mut desk, from + vec2(-40.0 * step as f32, 0.0));
    }
    desk.press(from + vec2(-400.0, 0.0), false, Modifiers::SHIFT);
    // Four times as far, so that the millimetres in which the value goes do not hide what it comes to.
    let fine = 0.25 * (desk.params.setup.pickup_position.value() - coarse);
    println!("{coarse} mm and {fine} mm");
    assert!((9.5..10.5).contains(&(coarse / fine)), "{coarse} mm and {fine} mm");
    desk.wait(1.0);
    desk.host.take();
    let at = desk.named("Pickup position");
    for _ in 0..2 {
        desk.drag(&[at], 0.0);
    }
    assert_eq!(desk.params.setup.pickup_position.value(), 0.0);
    assert!(is_gesture(&desk.host.take(), "pickup_position"));
}

#[test]
fn arrows_move_them_where_they_point() {
    let mut desk = Desk::new();
    let ways = [
        ("Pluck position", "pluck_position", Key::ArrowRight, vec2(1.0, 0.0)),
        ("Pickup position", "pickup_position", Key::ArrowLeft, vec2(-1.0, 0.0)),
        ("Action", "action", Key::ArrowDown, vec2(0.0, 1.0)),
        ("Relief", "relief", Key::ArrowUp, vec2(0.0, -1.0)),
    ];
    for (name, id, key, way) in ways {
        desk.wait(0.1);
        let before = desk.named(name);
        desk.click(before);
        desk.host.take();
        for _ in 0..3 {
            desk.key(key);
        }
        let told = desk.host.take();
        assert!(told.chunks(3).count() == 3 && told.chunks(3).all(|told| is_gesture(told, id)), "{told:?}");
        desk.wait(0.1);
        let moved = desk.named(name) - before;
        assert!(moved.dot(way) > 0.0, "{name} went {moved:?}");
    }
    let action = desk.named("Action");
    desk.click(action);
    desk.key(Key::Delete);
    assert_eq!(desk.params.setup.action.value(), 1.0);
}
