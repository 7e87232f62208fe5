//! Shapes that egui has no words for.

use egui::{Color32, Mesh, Pos2, Shape};

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
