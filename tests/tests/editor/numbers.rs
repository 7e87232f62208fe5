//! Promise: numbers are typed with or without their unit. What is left is taken, and nothing else than what was typed.

use egui::Key;
use egui_kittest::kittest::Queryable;
use low_action_tests::desk::{Desk, is_gesture};

use crate::controls::{at, write};

/// Clicks on the number of the level and writes over it.
fn write_level(desk: &mut Desk, text: &str) {
    let number = at(desk, "Sound", "Type Level");
    desk.click(number);
    desk.wait(0.05);
    write(desk, text);
}

#[test]
fn numbers_are_typed_with_or_without_unit() {
    let mut desk = Desk::new();
    for (text, decibels) in
        [("-6", -6.0), ("-12 dB", -12.0), ("-7dB", -7.0), ("-8 db", -8.0), (" -9,5 ", -9.5), ("−3DB", -3.0)]
    {
        write_level(&mut desk, text);
        assert!(desk.host.take().is_empty(), "nothing is set before it is entered");
        desk.key(Key::Enter);
        assert_eq!(desk.params.output.level.value(), decibels);
        assert!(is_gesture(&desk.host.take(), "level"));
        desk.wait(1.0);
    }
}

#[test]
fn what_is_no_number_is_not_taken() {
    let mut desk = Desk::new();
    write_level(&mut desk, "loud");
    desk.key(Key::Enter);
    write(&mut desk, "and more");
    assert!(desk.host.take().is_empty());
    for text in ["nan", "NaN dB", "inf", "-infinity"] {
        write_level(&mut desk, text);
        desk.key(Key::Enter);
        assert!(desk.host.take().is_empty(), "{text}");
        desk.wait(1.0);
    }
    write_level(&mut desk, "-6");
    desk.key(Key::Escape);
    assert!(desk.host.take().is_empty());
    assert_eq!(desk.params.output.level.value(), 0.0);
}

#[test]
fn a_number_that_is_left_is_taken() {
    let mut desk = Desk::new();
    write_level(&mut desk, "-6");
    desk.key(Key::Tab);
    assert_eq!(desk.params.output.level.value(), -6.0);
    desk.wait(1.0);
    write_level(&mut desk, "-9");
    desk.click(egui::pos2(600.0, 24.0));
    desk.wait(0.05);
    assert_eq!(desk.params.output.level.value(), -9.0);
    assert!(is_gesture(&desk.host.take(), "level"));
}

/// It would be something else than what was typed.
#[test]
fn another_unit_and_what_is_out_of_range_are_not_taken() {
    let mut desk = Desk::new();
    for (name, text, range) in [
        ("Action", "500", "10 % to 300 %"),
        ("Action", "5", "10 % to 300 %"),
        ("Relief", "1 cm", "-0.50 mm to +2.00 mm"),
        ("String 6 tuning", "20 mm", "-12.00 semitones to +7.00 semitones"),
    ] {
        let number = at(&mut desk, "Luthier", &format!("Type {name}"));
        desk.click(number);
        desk.wait(0.05);
        write(&mut desk, text);
        desk.wait(0.1);
        assert!(
            desk.harness.query_by_label_contains(range).is_some(),
            "{text} in {name}: it tells the range"
        );
        desk.key(Key::Enter);
        assert_eq!(desk.host.take(), [], "{text} in {name}");
        desk.wait(1.0);
    }
    desk.enter("Luthier", "String 6 tuning", "-20 cents");
    assert!((desk.params.strings[5].tuning.value() + 0.2).abs() < 1e-6);
    desk.enter("Sound", "Tuning", "0.5 semitones");
    assert_eq!(desk.params.setup.tuning.value(), 50.0);
}
