//! The fingers on the strings, where they press.

use egui::{Painter, Rect, Stroke, StrokeKind, pos2, vec2};

use super::Sight;
use crate::display::{FingerSeen, Snapshot};
use crate::editor::theme;

/// Width of a fingertip along the string, m.
const TIP: f32 = 0.012;
/// The force at which a finger is drawn at its strongest, N; a fretting finger presses with about so much.
const FIRM: f32 = 5.0;

/// Paints all fingers.
pub(super) fn paint(painter: &Painter, sight: &Sight, snapshot: &Snapshot) {
    for (index, string) in snapshot.strings().iter().enumerate() {
        for finger in string.fingers.iter().flatten() {
            paint_finger(painter, sight, finger, sight.y(index));
        }
    }
}

fn paint_finger(painter: &Painter, sight: &Sight, finger: &FingerSeen, y: f32) {
    let strength = (finger.force.max(0.0) / FIRM).sqrt().min(1.0);
    let width = (TIP * sight.along).max(8.0).min(0.6 * sight.spacing);
    let height = 0.36 * sight.spacing;
    let middle = pos2(sight.x(finger.position), y);
    let tip = Rect::from_center_size(middle, vec2(width, height));
    let radius = 0.5 * width.min(height);
    painter.rect_filled(tip, radius, theme::faint(theme::FINGER, 0.15 + 0.75 * strength));
    let edge = Stroke::new(1.0, theme::faint(theme::FINGER, 0.6 + 0.4 * strength));
    painter.rect_stroke(tip, radius, edge, StrokeKind::Inside);
}
