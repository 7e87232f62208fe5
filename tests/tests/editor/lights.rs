//! Promise: the editor says what a player should know of: that there is not time enough, and that a set-up file of theirs
//! is not played, and why, at the top or, where there is no room, in a menu there. Otherwise it is silent about both.

use egui_kittest::kittest::Queryable;
use low_action_tests::desk::Desk;

const LATE: &str = "Over budget: contacts are solved less exactly";

#[test]
fn too_little_time() {
    let mut desk = Desk::new();
    assert!(desk.harness.query_by_label(LATE).is_none());
    desk.meters.see_load(0.95, true);
    desk.picture();
    assert!(desk.harness.query_by_label(LATE).is_some());
    desk.meters.see_load(0.4, false);
    desk.picture();
    assert!(desk.harness.query_by_label(LATE).is_none());
}

/// `Relax when late` is off.
#[test]
fn too_little_time_for_what_is_not_relaxed() {
    let mut desk = Desk::new();
    for (load, relaxed, is_told) in [(1.3, false, true), (0.95, false, false), (1.3, true, false)] {
        desk.meters.see_load(load, relaxed);
        desk.picture();
        let told = desk.harness.query_by_label("Over budget: the sound breaks up").is_some();
        assert_eq!(told, is_told, "{load} {relaxed}");
    }
}

#[test]
fn a_file_that_is_not_played() {
    let mut desk = Desk::new();
    for message in ["there is no set-up file 3; electric is played instead", &"so long a reason ".repeat(20)]
    {
        desk.params.shelf.tell(Some(message.to_owned()));
        desk.picture();
        assert!(desk.harness.query_by_label(message).is_some(), "{message}");
    }
    desk.params.shelf.tell(None);
    desk.picture();
    for part in ["set-up file", "so long a reason"] {
        assert!(desk.harness.query_by_label_contains(part).is_none(), "{part}");
    }
}

#[test]
fn a_narrow_window_says_it_in_its_menu() {
    let mut desk = Desk::sized(0.5, 1.0);
    desk.wait(0.05);
    desk.meters.see_load(0.95, true);
    desk.params.shelf.tell(Some("there is no set-up file 3; electric is played instead".into()));
    desk.picture();
    let is_said = |desk: &Desk, part| desk.harness.query_by_label_contains(part).is_some();
    assert!(!is_said(&desk, LATE), "there is room for it");
    desk.click(desk.named("More"));
    desk.wait(0.1);
    assert!(is_said(&desk, LATE) && is_said(&desk, "set-up file 3"));
    desk.meters.see_load(0.4, false);
    desk.params.shelf.tell(None);
    desk.picture();
    assert!(!is_said(&desk, LATE) && !is_said(&desk, "set-up file 3"));
}

/// There is no menu then, and one of them takes all the room.
#[test]
fn two_messages_can_both_be_read_at_every_width() {
    let other = "there is no set-up file 3; electric is played instead";
    for width in [440, 560, 860, 880, 900, 960, 1120, 1400] {
        let mut desk = Desk::new();
        desk.harness.set_size(egui::vec2(width as f32, 760.0));
        desk.meters.see_load(0.95, true);
        desk.params.shelf.tell(Some(other.into()));
        desk.wait(0.05);
        if desk.harness.query_by_label("More").is_some() {
            desk.click(desk.named("More"));
        } else {
            let place =
                desk.harness.query_all_by_label_contains(LATE).next().map(|node| node.rect().center());
            desk.point(place.unwrap_or_else(|| panic!("{width}: nothing is said")));
        }
        desk.wait(1.0);
        for message in [LATE, other] {
            let said = desk.harness.query_all_by_label_contains(message).next().is_some();
            assert!(said, "{width}: {message} cannot be read");
        }
    }
}

#[test]
fn what_was_loud_while_nobody_looked_is_not_shown() {
    let mut desk = Desk::new();
    let meter = |desk: &Desk| desk.harness.get_by_label("Meter").value();
    desk.meters.see_output(&[1.0], &[1.0]);
    desk.picture();
    assert_eq!(meter(&desk).as_deref(), Some("0.0 dB"));
    desk.meters.see_output(&[1.0], &[1.0]);
    desk.harness.state_mut().open();
    desk.picture();
    assert_eq!(meter(&desk).as_deref(), Some("-60.0 dB"));
}

#[test]
fn full_scale_is_told_until_it_was_seen() {
    let mut desk = Desk::new();
    let meter = desk.harness.get_by_label("Meter").rect().center();
    let says = |desk: &mut Desk, what: &str| {
        desk.point(meter);
        desk.wait(1.0);
        desk.harness.query_by_label_contains(&format!("Highest so far: {what} dB")).is_some()
    };
    desk.meters.see_output(&[0.5, 2.0], &[0.1]);
    desk.wait(4.0);
    assert!(says(&mut desk, "6.0"), "long after");
    assert!(desk.harness.query_by_label("6.0 dB").is_some(), "under the meter, without the mouse");
    desk.click(meter);
    desk.point(egui::pos2(2.0, 2.0));
    desk.wait(0.1);
    assert!(says(&mut desk, "-60.0"));
    assert!(desk.harness.query_by_label("6.0 dB").is_none());
}
