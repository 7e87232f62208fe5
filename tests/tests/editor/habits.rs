//! Promise: text can be read against everything it stands on; Tab reaches every control of every panel; the editor comes
//! back as it was left, in its panel, string, window and zoom; a small window opens its panels when asked.

use egui::{Color32, Key, Modifiers, Pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use low_action::editor::{Editor, theme};
use low_action_tests::desk::Desk;
use nice_plug::prelude::Params;

/// Relative luminance as WCAG 2 defines it.
fn luminance(colour: Color32) -> f64 {
    let linear = |part: u8| {
        let part = f64::from(part) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
}

fn contrast(one: Color32, other: Color32) -> f64 {
    let (one, other) = (luminance(one), luminance(other));
    (one.max(other) + 0.05) / (one.min(other) + 0.05)
}

#[test]
fn text_can_be_read() {
    assert!((contrast(Color32::BLACK, Color32::WHITE) - 21.0).abs() < 1e-9);
    let texts = [
        ("TEXT", theme::TEXT),
        ("SOFT_TEXT", theme::SOFT_TEXT),
        ("ACCENT", theme::ACCENT),
        ("ALARM", theme::ALARM),
        ("PLUCK", theme::PLUCK),
        ("FINGER", theme::FINGER),
    ];
    let grounds = [("GROUND", theme::GROUND), ("SURFACE", theme::SURFACE), ("BOARD", theme::BOARD[0])];
    for (text, colour) in texts {
        for (ground, behind) in grounds {
            let contrast = contrast(colour, behind);
            assert!(contrast >= 4.5, "{text} on {ground}: {contrast:.2}");
        }
    }
    // What can be taken hold of bears nothing but plain text.
    for behind in [theme::RAISED, theme::LIFTED] {
        assert!(contrast(theme::TEXT, behind) >= 4.5);
    }
    // What does nothing at present lies behind a veil, and can be read through it.
    let veil = theme::faint(theme::SURFACE, theme::VEIL);
    for (text, colour) in [("TEXT", theme::TEXT), ("SOFT_TEXT", theme::SOFT_TEXT)] {
        let contrast = contrast(colour.blend(veil), theme::SURFACE);
        assert!(contrast >= 3.0, "{text} behind a veil: {contrast:.2}");
        assert!(contrast < self::contrast(colour, theme::SURFACE) - 1.0, "{text} is not veiled");
    }
    // What is chosen, or marked to be written over, lies over all of them.
    let context = egui::Context::default();
    Editor::dress(&context);
    let selection = context.global_style().visuals.selection;
    for behind in [theme::GROUND, theme::SURFACE, theme::RAISED, theme::LIFTED] {
        let contrast = contrast(selection.stroke.color, behind.blend(selection.bg_fill));
        assert!(contrast >= 4.5, "what is chosen on {behind:?}: {contrast:.2}");
    }
}

#[test]
fn tab_reaches_every_control() {
    let mut desk = Desk::new();
    let names = desk.names();
    let mut controls = 0;
    for tab in ["Player", "Luthier", "Sound", "Engine"] {
        desk.open(tab);
        // Where the focus has been: a handle over the strings may have the name of a control. Once round there are fewer.
        let mut reached: Vec<(String, Pos2)> = Vec::new();
        for _ in 0..150 {
            desk.key(Key::Tab);
            if let Some(node) = desk.harness.query_by(|node| node.is_focused()) {
                reached.extend(node.accesskit_node().label().map(|label| (label, node.rect().center())));
            }
        }
        let missing = |name: &str, place: Pos2| {
            !reached.iter().any(|(label, there)| label == name && there.distance(place) < 1.0)
        };
        for name in &names {
            if let Some(place) = desk.control(name) {
                controls += 1;
                assert!(!missing(name, place), "{name} in {tab} is not among {reached:?}");
            }
        }
        for name in ["Player", "Luthier", "Sound", "Engine", "Save"] {
            assert!(!missing(name, desk.named(name)), "{name} is not among {reached:?}");
        }
    }
    assert_eq!(controls, names.len(), "each has its place in one panel");
}

#[test]
fn it_comes_back_as_it_was_left() {
    let mut desk = Desk::new();
    desk.open("Engine");
    desk.point(desk.at(0.3, 4.0));
    desk.wait(0.3);
    let fields = desk.params.serialize_fields();
    let mut other = Desk::new();
    other.params.deserialize_fields(&fields);
    other.wait(0.05);
    assert!(other.control("Quality").is_some());
    assert_eq!(other.params.layout.seen(), desk.params.layout.seen());
    assert_eq!(desk.params.layout.seen().string, 4);
}

#[test]
fn the_window_is_as_large_as_it_was() {
    let mut desk = Desk::new();
    let fields = [("editor".to_owned(), r#"{"size": [1400.0, 900.0]}"#.to_owned())].into();
    desk.params.deserialize_fields(&fields);
    desk.harness.state_mut().open();
    desk.wait(0.1);
    assert_eq!(desk.harness.ctx.content_rect().size(), egui::vec2(1400.0, 900.0));
    let nonsense =
        [("editor".to_owned(), r#"{"size": [1e9, 0.0], "zoom": 77, "panel": 9}"#.to_owned())].into();
    desk.params.deserialize_fields(&nonsense);
    // The largest window and the smallest, counted in points that are three times as large.
    assert_eq!(desk.params.layout.seen().size, Some([1120.0, 380.0 / 3.0]));
    assert_eq!(desk.params.layout.seen().zoom, 3.0);
    desk.wait(0.1);
}

/// There are few points in a window of the usual size where they are large, and many where they are small.
#[test]
fn size_and_zoom_come_back_together() {
    let sizes = [(3.0, [380.0, 260.0]), (2.0, [1120.0, 760.0]), (0.5, [4000.0, 2000.0])];
    for (zoom, [width, height]) in sizes {
        let mut desk = Desk::new();
        let left = format!(r#"{{"size": [{width:?}, {height:?}], "zoom": {zoom:?}}}"#);
        desk.params.deserialize_fields(&[("editor".to_owned(), left)].into());
        desk.harness.state_mut().open();
        desk.wait(0.1);
        let ctx = &desk.harness.ctx;
        assert_eq!((ctx.zoom_factor(), ctx.content_rect().size()), (zoom, egui::vec2(width, height)));
        let seen = desk.params.layout.seen();
        assert_eq!((seen.zoom, seen.size), (zoom, Some([width, height])));
    }
}

#[test]
fn everything_becomes_larger_and_smaller() {
    let mut desk = Desk::new();
    let zoom = |desk: &mut Desk, key: Key, times: usize| {
        for _ in 0..times {
            desk.harness.key_press_modifiers(Modifiers::COMMAND, key);
            desk.wait(0.05);
        }
        desk.harness.ctx.zoom_factor()
    };
    assert!((zoom(&mut desk, Key::ArrowUp, 3) - 1.3).abs() < 1e-3);
    // It comes back with the session.
    let mut other = Desk::new();
    other.params.deserialize_fields(&desk.params.serialize_fields());
    other.harness.state_mut().open();
    other.wait(0.1);
    assert_eq!(other.harness.ctx.zoom_factor(), desk.harness.ctx.zoom_factor());
    assert_eq!(zoom(&mut desk, Key::ArrowUp, 30), 3.0);
    assert_eq!(zoom(&mut desk, Key::ArrowDown, 40), 0.5);
}

#[test]
fn a_small_window_opens_its_panels_when_asked() {
    let mut desk = Desk::sized(0.5, 1.0);
    desk.open("Sound");
    assert!(desk.control("Level").is_some());
    desk.open("Sound");
    assert!(desk.control("Level").is_none());
}

#[test]
fn without_a_session_a_file_keeps_how_it_was_left() {
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join("not made yet").join("window.json");
    let mut desk = Desk::new();
    assert!(desk.params.layout.load(&path).is_ok(), "the first time there is none");
    desk.open("Sound");
    desk.params.layout.save(&path).expect("it can be written");
    let other = Desk::new();
    other.params.layout.load(&path).expect("it can be read");
    assert_eq!(other.params.layout.seen(), desk.params.layout.seen());
    assert_eq!(other.params.layout.seen().panel, 2);
    std::fs::write(&path, "{").expect("it can be written");
    let told = format!("{:#}", desk.params.layout.load(&path).expect_err("it is damaged"));
    assert!(told.contains("window.json") && !told.contains('\n'), "{told}");
    assert_eq!(other.params.layout.seen(), desk.params.layout.seen(), "and nothing is changed by it");
}
