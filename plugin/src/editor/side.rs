//! One string from the side: what a luthier looks at. Heights are magnified far more than lengths.

use egui::{Align2, Mesh, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use low_action_dsp::Setup;

use super::Given;
use super::handle::Handle;
use super::theme::{self, GAP, NEAR, TIGHT};
use crate::display::{POINTS, StringSeen};

/// What the side view remembers.
#[derive(Debug, Default)]
pub struct Side {}

/// Room left of the nut and right of the saddle, as the strings above have it, points.
const LEFT: f32 = 48.0;
const RIGHT: f32 = 32.0;
/// The highest and the lowest that is seen, m over the string at rest.
const TOP: f32 = 2.5e-3;
const BOTTOM: f32 = -4.5e-3;

/// Where things are.
#[derive(Debug, Clone, Copy)]
struct Sight {
    area: Rect,
    along: f32,
    lift: f32,
}

impl Sight {
    fn new(area: Rect, scale: f32) -> Self {
        let along = (area.width() - LEFT - RIGHT).max(1.0) / scale;
        Self { area, along, lift: area.height() / (TOP - BOTTOM) }
    }

    fn at(&self, place: f32, height: f32) -> Pos2 {
        pos2(self.area.left() + LEFT + place * self.along, self.area.top() + (TOP - height) * self.lift)
    }
}

impl Side {
    /// Draws a string, counted from 0.
    pub fn show(&mut self, ui: &mut Ui, given: &Given, string: usize) {
        let area = ui.max_rect();
        ui.painter().rect_filled(area, theme::ROUND, theme::SURFACE);
        let Some(setup) = given.plan.setup() else { return };
        let scale = setup.neck.scale_length as f32;
        let sight = Sight::new(area.shrink2(vec2(0.0, TIGHT)), scale);
        let painter = ui.painter_at(area);
        let seen = given.snapshot.strings().get(string);
        paint_neck(&painter, &sight, setup);
        if let Some(seen) = seen {
            paint_string(&painter, &sight, seen);
        } else {
            painter.line_segment([sight.at(0.0, 0.0), sight.at(scale, 0.0)], Stroke::new(1.5, theme::PLAIN));
        }
        show_handles(ui, given, &sight, setup);
        if let Some(seen) = seen {
            show_contact(ui, &sight, seen);
        }
        let name = setup.string.get(string).map_or("", |string| &string.name);
        painter.text(
            pos2(area.left() + GAP, sight.at(0.0, 0.0).y),
            Align2::LEFT_CENTER,
            name,
            theme::BODY_FONT,
            theme::TEXT,
        );
        let text = format!("from the side, heights magnified {:.0} times", sight.lift / sight.along);
        painter.text(
            area.right_bottom() - vec2(NEAR, NEAR),
            Align2::RIGHT_BOTTOM,
            text,
            theme::SMALL,
            theme::SOFT_TEXT,
        );
    }
}

/// Board and frets as the set-up has them.
fn paint_neck(painter: &Painter, sight: &Sight, setup: &Setup) {
    let neck = &setup.neck;
    let end = neck.board_end();
    let mut mesh = Mesh::default();
    const PIECES: u32 = 48;
    for piece in 0..=PIECES {
        let place = end * f64::from(piece) / f64::from(PIECES);
        let height = neck.crown_height(place) - neck.fret_height;
        let top = sight.at(place as f32, height as f32);
        mesh.colored_vertex(top, theme::BOARD[0]);
        mesh.colored_vertex(pos2(top.x, sight.area.bottom()), theme::BOARD[1]);
        if let Some(before) = piece.checked_sub(1) {
            let corner = 2 * before;
            mesh.add_triangle(corner, corner + 1, corner + 2);
            mesh.add_triangle(corner + 1, corner + 3, corner + 2);
        }
    }
    painter.add(Shape::mesh(mesh));
    if neck.fretless {
        return;
    }
    for (index, place) in neck.equal_places().into_iter().enumerate() {
        let worn: f64 = neck.worn.iter().filter(|(fret, _)| *fret == index + 1).map(|(_, wear)| wear).sum();
        let crown = neck.crown_height(place);
        let top = sight.at(place as f32, (crown - worn) as f32);
        let foot = sight.at(place as f32, (crown - neck.fret_height) as f32);
        let wire = Rect::from_min_max(pos2(top.x - 3.0, top.y), pos2(top.x + 3.0, foot.y.max(top.y + 2.0)));
        let round = egui::CornerRadius { nw: 3, ne: 3, sw: 0, se: 0 };
        painter.rect_filled(wire, round, theme::BRASS);
    }
}

/// The string as it is, the blur of where it has been, and the fingers on it.
fn paint_string(painter: &Painter, sight: &Sight, seen: &StringSeen) {
    let mut mesh = Mesh::default();
    for point in 0..POINTS {
        let place = seen.place(point);
        for height in [seen.highest[point], seen.lowest[point]] {
            mesh.colored_vertex(sight.at(place, height), theme::faint(theme::PLAIN, 0.2));
        }
        if let Some(before) = (point as u32).checked_sub(1) {
            let corner = 2 * before;
            mesh.add_triangle(corner, corner + 1, corner + 2);
            mesh.add_triangle(corner + 1, corner + 3, corner + 2);
        }
    }
    painter.add(Shape::mesh(mesh));
    let line = (0..POINTS).map(|point| sight.at(seen.place(point), seen.displacement[point]));
    painter.line(line.collect(), Stroke::new(1.5, theme::PLAIN));
    for finger in seen.fingers.iter().flatten() {
        let pad = sight.at(finger.position, finger.height);
        let tip = Rect::from_min_max(pos2(pad.x - 7.0, pad.y - 22.0), pos2(pad.x + 7.0, pad.y));
        painter.rect_filled(tip, 7.0, theme::faint(theme::FINGER, 0.85));
    }
}

/// What can be moved up and down: the board under fret 12, and its dip in the middle.
fn show_handles(ui: &mut Ui, given: &Given, sight: &Sight, setup: &Setup) {
    let neck = &setup.neck;
    let action = &given.params.setup.action;
    // A point down is so many metres; the action is a factor of the set-up's own.
    let metres = 1.0 / sight.lift;
    let own = neck.action as f32 / action.value().max(1e-3);
    let handle = Handle {
        param: action,
        name: "Action",
        hint: "Height of the strings over fret 12. Lower plays easily and buzzes, higher rings clean and loud.",
        growth: vec2(0.0, metres / own.max(1e-5)),
    };
    let text = format!("action {:.2} mm", 1e3 * neck.action);
    show_handle(ui, given, sight, setup, &handle, neck.equal_place(12.0), text);
    let handle = Handle {
        param: &given.params.setup.relief,
        name: "Relief",
        hint: "How far the neck bows away from the strings: room for the middle of their swing.",
        growth: vec2(0.0, 1e3 * metres),
    };
    let text = format!("relief {:.2} mm", 1e3 * neck.relief);
    show_handle(ui, given, sight, setup, &handle, neck.equal_place(5.5), text);
}

fn show_handle(
    ui: &mut Ui,
    given: &Given,
    sight: &Sight,
    setup: &Setup,
    handle: &Handle,
    place: f64,
    text: String,
) {
    let board = (setup.neck.crown_height(place) - setup.neck.fret_height) as f32;
    let at = sight.at(place as f32, board) + vec2(0.0, 14.0);
    let at = pos2(at.x, at.y.min(sight.area.bottom() - 12.0));
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
fn show_contact(ui: &mut Ui, sight: &Sight, seen: &StringSeen) {
    let response = ui.interact(sight.area, ui.scope_id().with("contacts"), egui::Sense::hover());
    let Some(at) = response.hover_pos() else { return };
    let away = |fret: &crate::display::FretSeen| (sight.at(fret.position, 0.0).x - at.x).abs();
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
