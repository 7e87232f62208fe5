//! Promise: the editor looks as it should. Pictures of it, drawn by software, are those in `snapshots`.
//!
//! `UPDATE_SNAPSHOTS=1 cargo test -p low-action-tests --features pictures --test editor_pictures` draws them anew.
#![cfg(feature = "pictures")]

use egui::{Event, Key, Modifiers, pos2};
use low_action::performance::PlayerEvent;
use low_action::plugin::layout::{KeyMap, Keyboard};
use low_action_tests::desk::Desk;
use low_action_tests::pictures::{assert_looks, can_draw};

fn chord(desk: &mut Desk) {
    for key in [40, 47, 52, 56, 59, 64] {
        desk.play(PlayerEvent::NoteOn { channel: 0, key, velocity: 1.0 });
    }
    desk.wait(0.1);
}

/// A picture of the editor in a window of so many times the usual size, with so many pixels a point, after something
/// has happened to it.
fn picture(name: &str, times: f32, pixels: f32, happen: impl FnOnce(&mut Desk)) {
    if can_draw() {
        let mut desk = Desk::sized(times, pixels);
        desk.wait(0.05);
        happen(&mut desk);
        assert_looks(&mut desk, name);
    }
}

#[test]
fn at_rest() {
    picture("rest", 1.0, 1.0, |_| {});
}

#[test]
fn a_chord() {
    picture("chord", 1.0, 1.0, chord);
}

#[test]
fn a_chord_finely() {
    picture("chord_fine", 1.0, 2.0, chord);
}

#[test]
fn a_small_window() {
    picture("small", 0.5, 1.0, chord);
}

#[test]
fn the_panels() {
    let panels = [
        ("Luthier", "luthier", 1.0),
        ("Sound", "sound", 1.0),
        ("Engine", "engine", 1.0),
        ("Engine", "engine_fine", 2.0),
    ];
    for (tab, name, pixels) in panels {
        picture(name, 1.0, pixels, |desk| {
            desk.open(tab);
            desk.point(pos2(800.0, 24.0));
            chord(desk);
            if tab == "Engine" {
                // Numbers are shown smoothed, and have then come to what they are of.
                desk.wait(1.0);
            }
        });
    }
}

#[test]
fn the_list_of_instruments() {
    picture("instruments", 1.0, 1.0, |desk| {
        desk.click(desk.named("Electric"));
        desk.wait(0.2);
    });
}

#[test]
fn a_panel_of_a_small_window() {
    picture("small_panel", 0.5, 1.0, |desk| desk.open("Sound"));
}

#[test]
fn what_a_small_window_has_no_room_for() {
    picture("small_more", 0.5, 1.0, |desk| {
        desk.meters.see_load(0.95, true);
        desk.click(desk.named("›"));
        desk.click(desk.named("More"));
        desk.point(pos2(48.0, 24.0));
        desk.wait(0.2);
    });
}

#[test]
fn the_keys_of_the_computer() {
    if can_draw() {
        let mut desk = Desk::alone();
        desk.params.layout.set_keys(Keyboard { map: KeyMap::Frets, ..Keyboard::default() });
        desk.open("Player");
        for key in [Key::W, Key::F] {
            let (repeat, modifiers) = (false, Modifiers::NONE);
            desk.harness.event(Event::Key { key, physical_key: None, pressed: true, repeat, modifiers });
        }
        desk.wait(0.1);
        assert_looks(&mut desk, "keys");
    }
}
