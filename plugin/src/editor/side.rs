//! One string from the side: what a luthier looks at. Heights are magnified far more than lengths.

use egui::{Align2, Mesh, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use low_action_dsp::Setup;

use super::Given;
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
