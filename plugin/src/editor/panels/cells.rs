//! Columns of cells, in groups with a title.

use egui::{Align2, Rect, Ui, pos2, vec2};

use crate::editor::control::HEIGHT;
use crate::editor::theme::{self, GAP, TIGHT};

/// Height of a title, points.
const TITLE: f32 = 16.0;

/// Height of a panel with so many rows, points.
pub(super) fn height(rows: usize) -> f32 {
    TITLE + rows as f32 * (HEIGHT + TIGHT) - TIGHT
}

/// Where the next control of a panel goes.
pub(super) struct Cells {
    area: Rect,
    columns: usize,
    rows: usize,
    /// First column of the group.
    first: usize,
    /// Columns of the group.
    wide: usize,
    taken: usize,
}

impl Cells {
    /// Of a panel with so many columns.
    pub fn new(area: Rect, columns: usize) -> Self {
        let rows = ((area.height() - TITLE + TIGHT) / (HEIGHT + TIGHT)).floor().max(1.0) as usize;
        Self { area, columns, rows, first: 0, wide: 0, taken: 0 }
    }

    /// Begins a group of so many columns, beside the one before.
    pub fn group(&mut self, ui: &Ui, title: &str, columns: usize) {
        (self.first, self.wide, self.taken) = (self.first + self.wide, columns, 0);
        let place = pos2(self.left(self.first), self.area.top());
        ui.painter().text(place, Align2::LEFT_TOP, title, theme::SMALL, theme::ACCENT);
    }

    /// The next cell of the group: down its columns, one after the other.
    pub fn next(&mut self) -> Rect {
        let (column, row) = (self.taken / self.rows, self.taken % self.rows);
        self.taken += 1;
        let top = self.area.top() + TITLE + row as f32 * (HEIGHT + TIGHT);
        Rect::from_min_size(pos2(self.left(self.first + column), top), vec2(self.width(), HEIGHT))
    }

    /// What is left of the group under the cells that are taken, across all its columns.
    pub fn rest(&self) -> Rect {
        let top = self.area.top() + TITLE + self.taken as f32 * (HEIGHT + TIGHT);
        let right = self.left(self.first + self.wide) - GAP;
        Rect::from_min_max(pos2(self.left(self.first), top), pos2(right, self.area.bottom()))
    }

    fn left(&self, column: usize) -> f32 {
        self.area.left() + column as f32 * (self.width() + GAP)
    }

    fn width(&self) -> f32 {
        let columns = self.columns as f32;
        ((self.area.width() + GAP) / columns - GAP).floor()
    }
}
