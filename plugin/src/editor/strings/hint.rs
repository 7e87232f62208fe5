//! What the mouse would do, in words beside it.

use egui::{Align2, Pos2, Rect, Stroke, Ui, Vec2, pos2, vec2};
use low_action_dsp::Setup;

use super::Sight;
use super::play::{on_string, over_board};
use crate::editor::theme;

/// How far words are from the mouse, and what is free around them, points.
const AWAY: f32 = 10.0;
const MARGIN: Vec2 = vec2(6.0, 3.0);

/// Says it.
pub(super) fn show(ui: &Ui, at: Pos2, sight: &Sight, setup: &Setup) {
    let place = sight.place(at.x);
    let scale = setup.neck.scale_length as f32;
    if !(0.0..scale).contains(&place) {
        return;
    }
    let string = &setup.string[sight.nearest(at.y)];
    let stops = on_string(at, sight) && over_board(place, setup);
    let text = if stops {
        let frets = setup.neck.equal_places();
        let before = frets.partition_point(|fret| (*fret as f32) < place);
        match (before + 1).min(frets.len()) {
            0 => string.name.clone(),
            fret => format!("{}, fret {fret}", string.name),
        }
    } else {
        format!("{:.0} mm from the saddle", 1e3 * (scale - place))
    };
    let painter = ui.painter();
    let colour = if stops { theme::FINGER } else { theme::PLUCK };
    painter.circle_stroke(pos2(at.x, at.y), 4.0, Stroke::new(1.0, colour));
    let galley = painter.layout_no_wrap(text, theme::SMALL, theme::TEXT);
    let rect = beside(at, galley.size(), sight.area.right());
    painter.rect_filled(rect.expand2(MARGIN), 4.0, theme::faint(theme::GROUND, 0.85));
    painter.galley(rect.min, galley, theme::TEXT);
}

/// Where words of a size go beside the mouse: to the right, or, if they would go past the right edge, to the left.
fn beside(at: Pos2, size: Vec2, right: f32) -> Rect {
    let to_the_right = Align2::LEFT_BOTTOM.anchor_size(at + vec2(AWAY, -AWAY), size);
    match to_the_right.right() + MARGIN.x <= right {
        true => to_the_right,
        false => Align2::RIGHT_BOTTOM.anchor_size(at - vec2(AWAY, AWAY), size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_do_not_go_past_the_right_edge() {
        let (size, right) = (vec2(120.0, 14.0), 1000.0);
        for x in 0..=1000 {
            let at = pos2(x as f32, 200.0);
            let place = beside(at, size, right);
            assert!(place.right() + MARGIN.x <= right, "{place} at {x}");
            assert!(!place.expand2(MARGIN).contains(at), "{place} at {x} lies over the mouse");
            assert_eq!(place.left() > at.x, x <= 864, "{place} at {x}");
        }
    }
}
