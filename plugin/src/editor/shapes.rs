//! Shapes that egui has no words for.

use egui::text::{LayoutJob, TextWrapping};
use egui::{Align2, Color32, FontId, Mesh, Painter, Pos2, Shape};

/// Paints a line of text beside or around a point, and no more of it than `width` has room for, points.
pub fn fit_text(
    painter: &Painter,
    (at, anchor): (Pos2, Align2),
    text: &str,
    (font, colour): (FontId, Color32),
    width: f32,
) {
    let mut job = LayoutJob::simple_singleline(text.into(), font, colour);
    job.wrap = TextWrapping::truncate_at_width(width);
    let galley = painter.layout_job(job);
    painter.galley(anchor.anchor_size(at, galley.size()).min, galley, colour);
}

/// A band between pairs of points, each with its colour: one colour may pass over into another across it.
pub fn band(pairs: impl Iterator<Item = [(Pos2, Color32); 2]>) -> Shape {
    let mut mesh = Mesh::default();
    for (pair, ends) in pairs.enumerate() {
        for (point, colour) in ends {
            mesh.colored_vertex(point, colour);
        }
        if let Some(before) = (pair as u32).checked_sub(1) {
            let corner = 2 * before;
            mesh.add_triangle(corner, corner + 1, corner + 2);
            mesh.add_triangle(corner + 1, corner + 3, corner + 2);
        }
    }
    Shape::mesh(mesh)
}
