//! Where things are in the picture of the strings.

use egui::{Rect, pos2};
use low_action_dsp::Setup;

use crate::editor::theme::{LEFT, RIGHT};

/// Room over the board for handles and under it for numbers, points.
const OVER: f32 = 32.0;
const UNDER: f32 = 24.0;
/// Widest that strings lie apart, points, and in large windows as a part of their width.
const WIDEST: f32 = 56.0;
const WIDEST_PART: f32 = 0.05;
/// How much of the distance between two strings a millimetre of motion takes.
const LIFT: f32 = 0.3;

/// Where things are.
#[derive(Debug, Clone, Copy)]
pub struct Sight {
    /// All of the picture.
    pub area: Rect,
    /// Of the nut, points.
    nut: f32,
    /// Points a metre along the strings.
    pub along: f32,
    /// Points a metre of motion.
    pub lift: f32,
    first: f32,
    /// Between two strings, points.
    pub spacing: f32,
    count: usize,
}

impl Sight {
    /// A picture of a set-up's strings that fills `area`.
    pub fn new(area: Rect, setup: &Setup) -> Self {
        let count = setup.string.len().max(1);
        let along = (area.width() - LEFT - RIGHT).max(1.0) / setup.neck.scale_length as f32;
        // The board goes on for half a spacing beyond the outer strings.
        let widest = WIDEST.max(WIDEST_PART * area.width());
        let spacing = ((area.height() - OVER - UNDER).max(1.0) / count as f32).min(widest);
        let left_over = (area.height() - OVER - UNDER - spacing * count as f32).max(0.0);
        let first = (area.top() + OVER + 0.5 * (left_over + spacing)).round();
        Self { area, nut: area.left() + LEFT, along, lift: 1e3 * LIFT * spacing, first, spacing, count }
    }

    /// How much farther a string moves in the picture than things along it are drawn.
    pub fn magnification(&self) -> f32 {
        self.lift / self.along
    }

    /// A place (m from the nut) in the picture.
    pub fn x(&self, place: f32) -> f32 {
        self.nut + place * self.along
    }

    /// The place (m from the nut) of a point of the picture.
    pub fn place(&self, x: f32) -> f32 {
        (x - self.nut) / self.along
    }

    /// Where a string rests.
    pub fn y(&self, string: usize) -> f32 {
        self.first + string as f32 * self.spacing
    }

    /// The string nearest to a height.
    pub fn nearest(&self, y: f32) -> usize {
        let along = ((y - self.first) / self.spacing).round().max(0.0);
        (along as usize).min(self.count - 1)
    }

    /// The string that a height is over: none above the board and below it.
    pub fn over(&self, y: f32) -> Option<usize> {
        let string = self.nearest(y);
        ((y - self.y(string)).abs() <= 0.5 * self.spacing).then_some(string)
    }

    /// From over the first string to under the last: what a board is wide.
    pub fn board(&self, from: f32, to: f32) -> Rect {
        let margin = 0.5 * self.spacing;
        let (top, bottom) = (self.first - margin, self.y(self.count - 1) + margin);
        Rect::from_min_max(pos2(self.x(from), top), pos2(self.x(to), bottom))
    }
}
