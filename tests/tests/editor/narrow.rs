//! Promise: everything at the top of the window can be reached at every width that it can have; what has no room there
//! is in a menu, which mouse and keyboard open and use alike; so can the tabs of the panels at its bottom.

use egui::accesskit::Role;
use egui::{Key, MouseWheelUnit, Pos2, Rect, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use low_action_tests::desk::Desk;

use crate::controls::wheel;

/// What has no room in a narrow window.
const MOVED: [&str; 5] = ["A", "B", "A to B", "Undo", "Redo"];

/// The smallest window.
fn desk() -> Desk {
    let mut desk = Desk::sized(0.5, 1.0);
    desk.wait(0.05);
    desk
}

/// Clicks on things one after another.
fn click(desk: &mut Desk, names: &[&str]) {
    for name in names {
        desk.click(desk.named(name));
        desk.wait(0.1);
    }
}

fn instrument(desk: &Desk) -> String {
    desk.params.instrument.instrument.to_string()
}

fn is_seen(desk: &Desk, name: &str) -> bool {
    desk.harness.query_by_label(name).is_some()
}

/// What has the focus.
fn focused(desk: &Desk) -> Option<String> {
    desk.harness.query_by(|node| node.is_focused()).and_then(|node| node.accesskit_node().label())
}

#[test]
fn a_narrow_window_undoes_and_compares() {
    let mut desk = desk();
    click(&mut desk, &["›"]);
    assert_eq!(instrument(&desk), "Classical");
    assert!(MOVED.iter().all(|name| !is_seen(&desk, name)), "before the menu is opened");
    click(&mut desk, &["More", "Undo"]);
    assert_eq!(instrument(&desk), "Electric");
    click(&mut desk, &["Redo", "B"]);
    assert_eq!(instrument(&desk), "Classical");
    // A click beside the menu closes it.
    desk.click(pos2(48.0, 24.0));
    desk.wait(0.1);
    assert!(!is_seen(&desk, "Undo"), "the menu is still open");
    click(&mut desk, &["›"]);
    assert_eq!(instrument(&desk), "Steel");
    click(&mut desk, &["More", "A"]);
    assert_eq!(instrument(&desk), "Classical");
    click(&mut desk, &["B", "B to A", "A"]);
    assert_eq!(instrument(&desk), "Steel");
}

#[test]
fn the_menu_needs_no_mouse() {
    let mut desk = desk();
    click(&mut desk, &["›"]);
    for _ in 0..20 {
        if focused(&desk).as_deref() == Some("More") {
            break;
        }
        desk.key(Key::Tab);
    }
    desk.key(Key::Enter);
    let mut reached = Vec::new();
    while reached.last().is_none_or(|name| name != "Undo") && reached.len() < 10 {
        desk.key(Key::ArrowDown);
        reached.extend(focused(&desk));
    }
    assert_eq!(reached, ["A", "B", "A to B", "Undo"]);
    desk.key(Key::Enter);
    assert_eq!(instrument(&desk), "Electric");
    desk.key(Key::Escape);
    assert!(!is_seen(&desk, "Undo"), "the menu is still open");
}

/// What has no room in a narrow panel is scrolled to.
#[test]
fn tab_shows_where_it_goes() {
    let mut desk = desk();
    let names = desk.names();
    for tab in ["Player", "Luthier"] {
        desk.open(tab);
        let room = Rect::from_min_max(pos2(16.0, desk.named(tab).y), pos2(544.0, 380.0));
        let mut reached = 0;
        for _ in 0..60 {
            desk.key(Key::Tab);
            desk.wait(0.4);
            let Some(node) = desk.harness.query_by(|node| node.is_focused()) else { continue };
            let (name, place) = (node.accesskit_node().label(), node.rect().center());
            // Not a mark in the picture of the strings.
            if let Some(name) = name.filter(|name| names.contains(name) && place.y > room.top()) {
                assert!(room.contains(place), "{name} is at {place}");
                reached += 1;
            }
        }
        assert!(reached > 10, "{tab}: only {reached}");
    }
}

/// The smallest window has few points where they are large.
#[test]
fn panels_open_and_close_however_little_room_there_is() {
    let mut desk = desk();
    for zoom in [1.0, 1.5, 2.0, 2.5, 3.0] {
        let size = vec2(560.0, 380.0) / zoom;
        desk.harness.set_size(size);
        desk.wait(0.05);
        let room = Rect::from_min_max(pos2(0.0, 48.0), size.to_pos2());
        for (index, tab) in ["Player", "Luthier", "Sound", "Engine"].into_iter().enumerate() {
            // Opens, and closes with the second click.
            for click in 0..2 {
                desk.open(tab);
                assert_eq!(desk.params.layout.seen().panel, index, "{tab} at {size}, click {click}");
                let place = desk.harness.get_by_role_and_label(Role::Tab, tab).rect();
                assert!(room.contains_rect(place), "{tab} at {size}, click {click}: {place}");
            }
        }
    }
}

#[test]
fn nothing_overlaps_at_any_width() {
    let mut desk = desk();
    // From the smallest window with everything in it twice as large to one without a menu.
    for width in (280..1120).step_by(20) {
        desk.harness.set_size(vec2(width as f32, 380.0));
        desk.wait(0.05);
        let window = Rect::from_min_size(Pos2::ZERO, vec2(width as f32, 48.0));
        let moved: &[&str] = if is_seen(&desk, "More") { &["More"] } else { &MOVED };
        let names = ["‹", "Electric", "›", "Save"].iter().chain(moved);
        let places = names.map(|name| desk.harness.get_by_label(name).rect()).collect::<Vec<_>>();
        assert!(places.iter().all(|place| window.contains_rect(*place)), "{width}: {places:?}");
        assert!(places.is_sorted_by(|left, right| left.right() < right.left()), "{width}: {places:?}");
        // The meter has a fifth of the window, up to 160 points, and keeps its distance.
        let meter = width as f32 - 16.0 - 160_f32.min(0.2 * (width as f32 - 32.0));
        assert!(places.iter().all(|place| place.right() < meter - 4.0), "{width}: {places:?}");
        assert!(width < 880 || !is_seen(&desk, "More"), "{width}");
    }
}

/// What has no room in a low panel is scrolled to.
#[test]
fn no_control_lies_over_another_however_low_the_panel_is() {
    let mut desk = desk();
    for height in [380.0, 300.0, 240.0, 190.0, 130.0] {
        desk.harness.set_size(vec2(1120.0, height));
        for tab in ["Player", "Luthier", "Sound", "Engine"] {
            desk.open(tab);
            let tabs = desk.harness.get_by_role_and_label(Role::Tab, tab).rect();
            let mut places: Vec<(String, Rect)> = Vec::new();
            for name in desk.names() {
                let found = desk.harness.query_all_by_label(&name).map(|node| node.rect());
                places.extend(
                    found.filter(|place| place.top() >= tabs.bottom()).map(|place| (name.clone(), place)),
                );
            }
            for (index, (name, place)) in places.iter().enumerate() {
                for (other, beside) in &places[..index] {
                    assert!(
                        !place.shrink(0.5).intersects(*beside),
                        "{tab} in {height} points: {name}, {other}"
                    );
                }
            }
            // Closed again, for the next to open.
            desk.open(tab);
        }
    }
}

/// What was typed and not entered before the window became too low for the panel is forgotten with it.
#[test]
fn a_number_that_went_out_of_sight_is_not_typed_in_any_more() {
    let mut desk = Desk::new();
    desk.wait(0.05);
    let field = |desk: &Desk| desk.control("Type Pluck force");
    desk.click(field(&desk).expect("it has a number"));
    desk.wait(0.05);
    assert_eq!(field(&desk), None, "it is being typed");
    for size in [vec2(560.0, 380.0), vec2(1120.0, 760.0)] {
        desk.harness.set_size(size);
        desk.wait(0.1);
    }
    assert!(field(&desk).is_some());
}

#[test]
fn the_wheel_moves_a_value_and_not_the_low_panel_that_it_is_in() {
    let mut desk = desk();
    desk.harness.set_size(vec2(1120.0, 190.0));
    desk.open("Player");
    let place = |desk: &Desk| desk.control("Pluck force").expect("it is there");
    let turn = |desk: &mut Desk, at: Pos2| {
        desk.point(at);
        desk.harness.event(wheel(MouseWheelUnit::Line, vec2(0.0, -1.0)));
        desk.wait(0.5);
    };
    let before = place(&desk);
    turn(&mut desk, before);
    assert!(desk.params.player.pluck_force.value() < 1.0);
    assert_eq!(place(&desk), before);
    // Between the controls it scrolls.
    let width = desk.harness.get_all_by_label("Pluck force").map(|node| node.rect().width()).next_back();
    turn(&mut desk, before + vec2(0.5 * width.unwrap_or_default() + 8.0, 0.0));
    assert_ne!(place(&desk), before);
}
