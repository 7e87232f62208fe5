//! The computer's keys where they play: each on its string, where the finger goes that it stands for.

use egui::{Align2, Painter, Rect, pos2, vec2};
use low_action_dsp::Setup;

use super::Sight;
use crate::editor::keys::{finger_place, keys_on_strings};
use crate::editor::theme;
use crate::plugin::layout::Keyboard;

/// Side of a key, points.
const SIDE: f32 = 14.0;

/// Paints those that there is room for.
pub(super) fn paint(painter: &Painter, sight: &Sight, setup: &Setup, keyboard: Keyboard) {
    if sight.spacing < SIDE {
        return;
    }
    // Where the frets are narrower than a key, the next ones are left out.
    let mut last = (usize::MAX, f32::MIN);
    for (key, string, fret) in keys_on_strings(keyboard, setup) {
        let x = sight.x(finger_place(setup, fret) as f32);
        if last.0 == string && x - last.1 < SIDE {
            continue;
        }
        last = (string, x);
        let cap = Rect::from_center_size(pos2(x, sight.y(string)), vec2(SIDE, SIDE));
        painter.rect_filled(cap, 3.0, theme::faint(theme::GROUND, 0.8));
        painter.text(cap.center(), Align2::CENTER_CENTER, key.name(), theme::SMALL, theme::TEXT);
    }
}
