//! The fretboard and what is beyond it: what does not move.

use egui::{Align2, Color32, Painter, Rect, Stroke, pos2, vec2};
use low_action_dsp::Setup;
use low_action_dsp::setup::Pickup;

use super::Sight;
use crate::editor::shapes::band;
use crate::editor::theme;

/// Frets with a dot, and those with two.
const DOTS: [usize; 8] = [3, 5, 7, 9, 15, 17, 19, 21];
const DOUBLE: [usize; 3] = [12, 24, 36];

/// Paints body, board, frets, dots, nut, saddle and pickup.
pub(super) fn paint(painter: &Painter, sight: &Sight, setup: &Setup) {
    let neck = &setup.neck;
    let (scale, end) = (neck.scale_length as f32, neck.board_end() as f32);
    let whole = sight.board(0.0, scale);
    shade(painter, whole.with_max_x(sight.area.right()), theme::BODY);
    paint_pickup(painter, sight, setup);
    let board = sight.board(0.0, end);
    shade(painter, board, theme::BOARD);
    paint_grain(painter, board);
    let frets: Vec<f32> = neck.equal_places().iter().map(|place| sight.x(*place as f32)).collect();
    let between = |fret: usize| {
        let before = fret.checked_sub(2).map_or(sight.x(0.0), |index| frets[index]);
        0.5 * (before + frets[fret - 1])
    };
    let dot = |x: f32, y: f32| {
        painter.circle_filled(pos2(x, y), 0.11 * sight.spacing, theme::faint(theme::BONE, 0.55));
    };
    for fret in 1..=frets.len() {
        // Between strings, where that can be: on both sides of the middle ones.
        let count = setup.string.len();
        let half = if count.is_multiple_of(2) { 0.0 } else { 0.5 };
        let away = (((count / 4).max(1) as f32 - half) * sight.spacing).min(0.25 * board.height());
        let middle = board.center().y;
        if DOUBLE.contains(&fret) {
            dot(between(fret), middle - away);
            dot(between(fret), middle + away);
        } else if DOTS.contains(&fret) {
            dot(between(fret), middle);
        }
        let width = 2.0 * (frets[fret - 1] - between(fret));
        if (DOTS.contains(&fret) || DOUBLE.contains(&fret)) && width > theme::SMALL.size {
            let place = pos2(between(fret), board.bottom() + 3.0 * theme::TIGHT);
            painter.text(place, Align2::CENTER_CENTER, fret, theme::SMALL, theme::SOFT_TEXT);
        }
    }
    let fret_colour = if neck.fretless { theme::faint(theme::BONE, 0.25) } else { theme::BRASS };
    for &x in &frets {
        painter.vline(x, board.y_range(), Stroke::new(if neck.fretless { 1.0 } else { 2.5 }, fret_colour));
        if !neck.fretless {
            painter.vline(x - 0.5, board.y_range(), Stroke::new(1.0, theme::BRASS_LIGHT));
        }
    }
    let post = |x: f32, width: f32, colour: Color32| {
        let rect = Rect::from_center_size(pos2(x, board.center().y), vec2(width, board.height()));
        painter.rect_filled(rect, 2.0, colour);
    };
    post(sight.x(0.0) - 2.0, 5.0, theme::BONE);
    post(sight.x(scale) + 3.0, 6.0, theme::STEEL);
}

/// The coil, where it hears.
fn paint_pickup(painter: &Painter, sight: &Sight, setup: &Setup) {
    let Pickup::Magnetic { position, aperture, .. } = setup.pickup else { return };
    let middle = setup.neck.scale_length as f32 - position as f32;
    let half = 0.5 * (aperture as f32).max(0.012);
    let coil = sight.board(middle - half, middle + half).shrink2(vec2(0.0, 0.1 * sight.spacing));
    painter.rect_filled(coil, 6.0, theme::GROUND);
    painter.rect_stroke(coil, 6.0, Stroke::new(1.0, theme::LINE), egui::StrokeKind::Inside);
    for string in 0..setup.string.len() {
        let radius = (0.22 * coil.width()).min(0.14 * sight.spacing);
        painter.circle_filled(
            pos2(coil.center().x, sight.y(string)),
            radius,
            theme::faint(theme::STEEL, 0.6),
        );
    }
}

/// Fills with one colour above that becomes another below.
fn shade(painter: &Painter, rect: Rect, [above, below]: [Color32; 2]) {
    let sides = [[rect.left_top(), rect.left_bottom()], [rect.right_top(), rect.right_bottom()]];
    painter.add(band(sides.into_iter().map(|[top, bottom]| [(top, above), (bottom, below)])));
}

/// Faint lines along the wood, always the same.
fn paint_grain(painter: &Painter, board: Rect) {
    let mut chance: u32 = 9;
    let mut next = || {
        // Numerical Recipes' generator: any would do.
        chance = chance.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (chance >> 8) as f32 / (1 << 24) as f32
    };
    for _ in 0..(board.height() / 5.0) as usize {
        let y = board.top() + next() * board.height();
        let left = board.left() + next() * 0.7 * board.width();
        let right = (left + (0.1 + 0.5 * next()) * board.width()).min(board.right());
        painter.hline(left..=right, y, Stroke::new(1.0, theme::faint(theme::GRAIN, 0.2 + 0.5 * next())));
    }
}
