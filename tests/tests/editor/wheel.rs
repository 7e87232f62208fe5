//! Promise: the wheel moves the value that it is over by steps, none of which is lost, and scrolls a narrow panel only to the side.

use egui::{Modifiers, MouseWheelUnit, vec2};
use low_action_tests::desk::{Desk, Told, is_gesture};
use nice_plug::prelude::ParamSetter;

use crate::controls::{at, wheel};

/// A host sets what it is told at the end of a block, which may be some pictures later.
#[test]
fn no_step_is_lost_on_the_way() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Sound", "Level");
    desk.point(place);
    let value = |desk: &Desk| desk.params.output.level.value();
    let notch = |desk: &mut Desk| {
        desk.harness.event(wheel(MouseWheelUnit::Line, vec2(0.0, -1.0)));
        desk.picture();
    };
    notch(&mut desk);
    let one = value(&desk);
    assert!(one < 0.0);
    desk.host.be_late();
    for _ in 0..2 {
        notch(&mut desk);
        // The longest block there is takes a second.
        desk.wait(1.0);
        notch(&mut desk);
        notch(&mut desk);
        desk.host.catch_up();
    }
    assert!((value(&desk) - 7.0 * one).abs() < 0.01, "{} dB, {one} dB each", value(&desk));
    // What a host does not grant is not waited for.
    notch(&mut desk);
    desk.wait(2.0);
    notch(&mut desk);
    let asked = desk.host.take().into_iter().filter(|told| matches!(told, Told::Set(..)));
    let asked: Vec<Told> = asked.collect();
    assert_eq!(asked[asked.len() - 1], asked[asked.len() - 2]);
    // And what it has moved itself stays so.
    ParamSetter::new(&*desk.host).set_parameter(&desk.params.output.level, -20.0);
    desk.host.catch_up();
    desk.wait(0.1);
    notch(&mut desk);
    desk.host.catch_up();
    assert!((value(&desk) - (one - 20.0)).abs() < 0.01, "{} dB", value(&desk));
}

/// In a narrow window the panel is scrolled so.
#[test]
fn a_swipe_to_the_side_sets_nothing() {
    let mut desk = Desk::sized(0.8, 1.0);
    let place = at(&mut desk, "Sound", "Level");
    desk.point(place);
    desk.host.take();
    desk.harness.event(wheel(MouseWheelUnit::Point, vec2(60.0, 0.0)));
    desk.wait(0.1);
    assert_eq!(desk.host.take(), []);
}

/// Systems turn the wheel to the side then, as a swipe is.
#[test]
fn with_shift_the_wheel_moves_the_value_and_not_the_panel() {
    let mut desk = Desk::sized(0.5, 1.0);
    desk.open("Player");
    let place = |desk: &Desk| desk.control("Pluck force").expect("it is there");
    let (before, middle) = (place(&desk), desk.params.player.pluck_force.value());
    desk.point(before);
    for delta in [vec2(0.0, -3.0), vec2(-3.0, 0.0)] {
        desk.harness.event_modifiers(wheel(MouseWheelUnit::Line, delta), Modifiers::SHIFT);
        desk.wait(0.5);
        assert_eq!(place(&desk), before, "{delta:?}");
    }
    assert!(desk.params.player.pluck_force.value() < middle);
    desk.harness.event(wheel(MouseWheelUnit::Line, vec2(-3.0, 0.0)));
    desk.wait(0.5);
    assert_ne!(place(&desk), before, "without Shift it is scrolled");
}

#[test]
fn the_wheel_moves_by_steps() {
    let mut desk = Desk::new();
    let place = at(&mut desk, "Sound", "Level");
    desk.point(place);
    let notch = |lines: f32| wheel(MouseWheelUnit::Line, vec2(0.0, lines));
    desk.harness.event(notch(-2.0));
    desk.picture();
    let down = desk.params.output.level.value();
    assert!((-4.0..-1.0).contains(&down), "{down} dB");
    assert!(is_gesture(&desk.host.take(), "level"));
    desk.harness.event(notch(2.0));
    desk.picture();
    assert_eq!(desk.params.output.level.value(), 0.0);
}
