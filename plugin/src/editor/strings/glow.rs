//! What fades: the light where a string hits a fret or the board, and the rings where it was plucked.

use egui::{Color32, Mesh, Painter, Pos2, Shape, Stroke, Ui, pos2};

use super::Sight;
use crate::display::{POINTS, Snapshot};
use crate::editor::{Given, theme};

/// How long a flash takes to fall to a third, s.
const FADING: f32 = 0.09;
/// Forces of the faintest flash and of the brightest, N.
const FAINTEST: f32 = 0.02;
const BRIGHTEST: f32 = 10.0;
/// How long the ring of a pluck is seen, s.
const RING: f32 = 0.45;
/// Force of a pluck that makes the largest ring, N.
const HARDEST: f32 = 3.0;

/// Lights that fade.
#[derive(Debug, Default)]
pub(super) struct Glow {
    /// Brightness, 0 to 1, at each fret of each string, and at each point of the board under it.
    frets: Vec<Vec<f32>>,
    board: Vec<Vec<f32>>,
    rings: Vec<Ring>,
}

/// The ring of a pluck.
#[derive(Debug, Clone, Copy)]
struct Ring {
    string: usize,
    place: f32,
    size: f32,
    age: f32,
}

impl Glow {
    /// Fades, and lights up what is new.
    pub fn follow(&mut self, ui: &Ui, given: &Given) {
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        let part = (-seconds / FADING).exp();
        let lights = self.frets.iter_mut().chain(&mut self.board).flatten();
        let mut alight = false;
        for light in lights {
            *light *= part;
            alight |= *light > 0.01;
        }
        self.rings.iter_mut().for_each(|ring| ring.age += seconds);
        self.rings.retain(|ring| ring.age < RING);
        if given.fresh {
            self.light_up(given.snapshot);
        }
        if alight || !self.rings.is_empty() {
            ui.ctx().request_repaint();
        }
    }

    fn light_up(&mut self, snapshot: &Snapshot) {
        let count = snapshot.strings().len();
        self.frets.resize(count, Vec::new());
        self.board.resize(count, vec![0.0; POINTS]);
        for (index, string) in snapshot.strings().iter().enumerate() {
            let lights = &mut self.frets[index];
            lights.resize(string.frets().len(), 0.0);
            for (light, fret) in lights.iter_mut().zip(string.frets()) {
                // What presses all the time does not flash.
                *light = light.max(brightness(fret.hit - fret.force));
            }
            let board = string.board_hit.iter().zip(&string.board_force);
            for (light, (hit, force)) in self.board[index].iter_mut().zip(board) {
                *light = light.max(brightness(hit - force));
            }
            if let Some(pluck) = string.pluck {
                let size = (pluck.force.abs() / HARDEST).sqrt().clamp(0.2, 1.0);
                self.rings.push(Ring { string: index, place: pluck.position, size, age: 0.0 });
            }
        }
    }

    /// Paints the flashes.
    pub fn paint(&self, painter: &Painter, sight: &Sight, snapshot: &Snapshot) {
        let radius = 0.5 * sight.spacing;
        for (index, string) in snapshot.strings().iter().enumerate() {
            let y = sight.y(index);
            let (Some(frets), Some(board)) = (self.frets.get(index), self.board.get(index)) else { continue };
            for (fret, &light) in string.frets().iter().zip(frets) {
                halo(painter, pos2(sight.x(fret.position), y), radius, light);
            }
            for (point, &light) in board.iter().enumerate() {
                halo(painter, pos2(sight.x(string.place(point)), y), 0.5 * radius, 0.5 * light);
            }
        }
    }

    /// Paints the rings of plucks.
    pub fn paint_plucks(&self, painter: &Painter, sight: &Sight) {
        for ring in &self.rings {
            let part = ring.age / RING;
            let radius = (0.15 + 0.45 * part.sqrt()) * ring.size * sight.spacing;
            let middle = pos2(sight.x(ring.place), sight.y(ring.string));
            let colour = theme::faint(theme::PLUCK, 1.0 - part);
            painter.circle_stroke(middle, radius, Stroke::new(2.0, colour));
        }
    }
}

/// How bright a force flashes, 0 to 1: by its logarithm, as ears hear it.
fn brightness(force: f32) -> f32 {
    if force <= FAINTEST {
        return 0.0;
    }
    (force / FAINTEST).ln() / (BRIGHTEST / FAINTEST).ln()
}

/// A light that falls off to its rim.
fn halo(painter: &Painter, middle: Pos2, radius: f32, light: f32) {
    const RIM: usize = 20;
    if light < 0.02 {
        return;
    }
    let mut mesh = Mesh::default();
    // Adds to what is under it.
    let inner = theme::faint(theme::FLASH, light.min(1.0)).additive();
    mesh.colored_vertex(middle, inner);
    for step in 0..RIM {
        let angle = std::f32::consts::TAU * step as f32 / RIM as f32;
        let rim = middle + radius * egui::vec2(angle.cos(), angle.sin());
        mesh.colored_vertex(rim, Color32::TRANSPARENT);
        mesh.add_triangle(0, 1 + step as u32, 1 + ((step + 1) % RIM) as u32);
    }
    painter.add(Shape::mesh(mesh));
}

#[cfg(test)]
mod tests {
    use super::Glow;
    use crate::display::{POINTS, Snapshot, StringSeen};

    /// Fingers press strings on the board for as long as a note is held.
    #[test]
    fn only_what_hits_the_board_flashes() {
        let mut string = StringSeen::default();
        (string.board_force[40], string.board_hit[40]) = (6.0, 6.01);
        (string.board_force[90], string.board_hit[90]) = (0.0, 6.0);
        let mut glow = Glow::default();
        glow.light_up(&Snapshot::of(vec![string]));
        let lit: Vec<usize> = (0..POINTS).filter(|&point| glow.board[0][point] > 0.0).collect();
        assert_eq!(lit, [90]);
    }
}
