//! One string from the side: what a luthier looks at. Heights are magnified far more than lengths.

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use low_action_dsp::Setup;
use low_action_dsp::neck::Neck;

use super::Given;
use super::control::Handle;
use super::shapes::{band, fit_text};
use super::theme::{self, GAP, LEFT, NEAR, RIGHT, TIGHT};
use crate::display::{POINTS, StringSeen};

/// The highest and the lowest that is seen, m over the string at rest. Where the board lies farther down, so is the lowest, with
/// so much of the board.
const TOP: f32 = 2.5e-3;
const BOTTOM: f32 = -4.5e-3;
const BOARD: f32 = 0.5e-3;

/// Pieces of what is curved.
const PIECES: u32 = 48;

/// Where things are.
#[derive(Debug, Clone, Copy)]
struct Profile {
    area: Rect,
    along: f32,
    lift: f32,
}

impl Profile {
    /// A picture that fills `area` of strings over a neck as it comes: what a luthier does to that moves in it.
    fn new(area: Rect, own: &Neck) -> Self {
        let along = (area.width() - LEFT - RIGHT).max(1.0) / own.scale_length as f32;
        let board = |piece| own.board_line(own.board_end() * f64::from(piece) / f64::from(PIECES)) as f32;
        let bottom = (0..=PIECES).map(|piece| board(piece) - BOARD).fold(BOTTOM, f32::min);
        Self { area, along, lift: area.height() / (TOP - bottom) }
    }

    fn at(&self, place: f32, height: f32) -> Pos2 {
        pos2(self.area.left() + LEFT + place * self.along, self.area.top() + (TOP - height) * self.lift)
    }
}

/// Draws a string, counted from 0.
pub fn show(ui: &mut Ui, given: &Given, string: usize) {
    let area = ui.max_rect();
    ui.painter().rect_filled(area, theme::ROUND, theme::SURFACE);
    let Some(setup) = given.plan.setup() else { return };
    let scale = setup.neck.scale_length as f32;
    let own = &given.plan.own().unwrap_or(setup).neck;
    let profile = Profile::new(area.shrink2(vec2(0.0, TIGHT)), own);
    let painter = ui.painter_at(area);
    let seen = given.snapshot.strings().get(string);
    paint_neck(&painter, &profile, setup);
    if let Some(seen) = seen {
        paint_string(&painter, &profile, seen);
    } else {
        painter.line_segment([profile.at(0.0, 0.0), profile.at(scale, 0.0)], Stroke::new(1.5, theme::PLAIN));
    }
    let name = setup.string.get(string).map_or("", |string| &string.name);
    let response = ui.interact(area, ui.scope_id().with("contacts"), egui::Sense::hover());
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Side view");
        info.current_text_value = Some(name.to_owned());
        info
    });
    if let Some(seen) = seen {
        show_contact(response, &profile, seen);
    }
    show_handles(ui, given, &profile, setup);
    let place = (pos2(area.left() + GAP, profile.at(0.0, 0.0).y), Align2::LEFT_CENTER);
    fit_text(&painter, place, name, (theme::BODY_FONT, theme::TEXT), LEFT - GAP);
    let text = format!("from the side, heights magnified {:.0} times", profile.lift / profile.along);
    painter.text(
        area.right_top() + vec2(-NEAR, NEAR),
        Align2::RIGHT_TOP,
        text,
        theme::SMALL,
        theme::SOFT_TEXT,
    );
}

/// Board and frets as the set-up has them.
fn paint_neck(painter: &Painter, profile: &Profile, setup: &Setup) {
    let neck = &setup.neck;
    let end = neck.board_end();
    let board = |place: f64| neck.board_line(place) as f32;
    paint_ground(painter, profile, [0.0, end], board, theme::BOARD);
    if let Some(bridge) = setup.bridge {
        let saddle = neck.scale_length;
        let curve = |place: f64| bridge.height(saddle - place) as f32;
        paint_ground(
            painter,
            profile,
            [saddle - bridge.length, saddle],
            curve,
            [theme::BONE, theme::BODY[0]],
        );
    }
    if neck.fretless {
        return;
    }
    for [place, crown] in neck.crowns(&neck.equal_places()) {
        let top = profile.at(place as f32, crown as f32);
        let foot = profile.at(place as f32, board(place));
        let wire = Rect::from_min_max(pos2(top.x - 3.0, top.y), pos2(top.x + 3.0, foot.y.max(top.y + 2.0)));
        let round = egui::CornerRadius { nw: 3, ne: 3, sw: 0, se: 0 };
        painter.rect_filled(wire, round, theme::BRASS);
    }
}

/// Fills what lies under a curve (m over m from the nut).
fn paint_ground(
    painter: &Painter,
    profile: &Profile,
    [from, to]: [f64; 2],
    curve: impl Fn(f64) -> f32,
    [above, below]: [egui::Color32; 2],
) {
    painter.add(band((0..=PIECES).map(|piece| {
        let place = from + (to - from) * f64::from(piece) / f64::from(PIECES);
        let top = profile.at(place as f32, curve(place));
        [(top, above), (pos2(top.x, profile.area.bottom()), below)]
    })));
}

/// The string as it is, the blur of where it has been, and the fingers on it.
fn paint_string(painter: &Painter, profile: &Profile, seen: &StringSeen) {
    let colour = theme::faint(theme::PLAIN, 0.2);
    painter.add(band((0..POINTS).map(|point| {
        let at = |height| (profile.at(seen.place(point), height), colour);
        [at(seen.highest[point]), at(seen.lowest[point])]
    })));
    let line = (0..POINTS).map(|point| profile.at(seen.place(point), seen.displacement[point]));
    painter.line(line.collect(), Stroke::new(1.5, theme::PLAIN));
    for finger in seen.fingers.iter().flatten() {
        let pad = profile.at(finger.position, finger.height);
        let tip = Rect::from_min_max(pos2(pad.x - 7.0, pad.y - 22.0), pos2(pad.x + 7.0, pad.y));
        painter.rect_filled(tip, 7.0, theme::faint(theme::FINGER, 0.85));
    }
}

/// What can be moved up and down: the board under fret 12, and its dip in the middle.
fn show_handles(ui: &mut Ui, given: &Given, profile: &Profile, setup: &Setup) {
    let neck = &setup.neck;
    let action = &given.params.setup.action;
    // A point down is so many metres; the action is a factor of the set-up's own.
    let metres = 1.0 / profile.lift;
    let own = &given.plan.own().unwrap_or(setup).neck;
    let height = own.action.max(1e-5);
    let growth = vec2(0.0, metres / height as f32);
    let handle = Handle { param: action, growth, reach: [0.0, Neck::HIGHEST_ACTION / height] };
    let text = format!("action {:.2} mm", 1e3 * neck.action);
    show_handle(ui, given, profile, setup, &handle, neck.equal_place(12.0), text);
    let reach = [0.0, neck.most_relief()].map(|end| 1e3 * (end - own.relief));
    let handle = Handle { param: &given.params.setup.relief, growth: vec2(0.0, 1e3 * metres), reach };
    let text = format!("relief {:.2} mm", 1e3 * neck.relief);
    show_handle(ui, given, profile, setup, &handle, neck.equal_place(5.5), text);
}

fn show_handle(
    ui: &mut Ui,
    given: &Given,
    profile: &Profile,
    setup: &Setup,
    handle: &Handle,
    place: f64,
    text: String,
) {
    let board = setup.neck.board_line(place) as f32;
    let at = profile.at(place as f32, board) + vec2(0.0, 14.0);
    let at = pos2(at.x, at.y.min(profile.area.bottom() - 12.0));
    let area = Rect::from_center_size(at, vec2(24.0, 20.0));
    let response = handle.show(ui, given, area).on_hover_and_drag_cursor(egui::CursorIcon::ResizeVertical);
    let taken = response.dragged() || response.hovered() || response.has_focus();
    let colour = if taken { theme::ACCENT } else { theme::SOFT_TEXT };
    let painter = ui.painter();
    for side in [-1.0, 1.0] {
        let tip = at + vec2(0.0, side * 7.0);
        let base = at + vec2(0.0, side * 2.0);
        let corners = vec![tip, base + vec2(5.0, 0.0), base - vec2(5.0, 0.0)];
        painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
    }
    painter.text(at + vec2(12.0, 0.0), Align2::LEFT_CENTER, text, theme::SMALL, colour);
}

/// How near the mouse must be to a fret to read it, points.
const NEAR_FRET: f32 = 10.0;

/// Depth and force of the contact under the mouse.
fn show_contact(response: egui::Response, profile: &Profile, seen: &StringSeen) {
    let Some(at) = response.hover_pos() else { return };
    let away = |fret: &crate::display::FretSeen| (profile.at(fret.position, 0.0).x - at.x).abs();
    let nearest = seen.frets().iter().enumerate().min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
    let Some((index, fret)) = nearest.filter(|(_, fret)| away(fret) < NEAR_FRET) else { return };
    let depth = if fret.penetration > 0.0 {
        format!("pressed in by {:.2} µm", 1e6 * fret.penetration)
    } else {
        format!("{:.2} mm free", -1e3 * fret.penetration)
    };
    let text = format!("Fret {}: {depth}\n{:.2} N now, {:.2} N at most", index + 1, fret.force, fret.hit);
    response.on_hover_text_at_pointer(text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setups::SHIPPED;

    #[test]
    fn every_board_and_all_its_frets_are_in_the_picture() {
        let area = Rect::from_min_max(pos2(0.0, 500.0), pos2(1000.0, 640.0));
        for name in SHIPPED {
            let neck = Setup::shipped(name).expect("it comes with the program").neck;
            let profile = Profile::new(area, &neck);
            let board = (0..=100).map(|part| neck.board_end() * f64::from(part) / 100.0);
            let board = board.map(|place| [place, neck.board_line(place)]);
            for [place, height] in board.chain(neck.crowns(&neck.equal_places())) {
                let at = profile.at(place as f32, height as f32);
                assert!(area.shrink(2.0).contains(at), "{name}: {at} at {place} m");
            }
        }
    }
}
