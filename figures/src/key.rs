//! The key of a panel: what its colours mean.

use anyhow::Result;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::panel::{Area, DOT, LINE, Layer, text};
use crate::style::{CHARACTER, GAP, Stroke};

/// What stands before a word of the key.
#[derive(Clone, Copy, PartialEq)]
enum Mark {
    Line,
    Dot,
    Area,
}

/// What stands in the key for a layer, if it is named.
fn entry(layer: &Layer) -> Option<(&str, &Stroke, Mark)> {
    match layer {
        Layer::Line { stroke, name, .. } if !name.is_empty() => Some((name, stroke, Mark::Line)),
        Layer::Dots { stroke, name, .. } if !name.is_empty() => Some((name, stroke, Mark::Dot)),
        Layer::Band { stroke, name, .. } if !name.is_empty() => Some((name, stroke, Mark::Area)),
        _ => None,
    }
}

/// Draws what the colours mean, in as many lines as it takes; returns their height.
pub fn draw(layers: &[Layer], area: &Area, top: i32, width: i32) -> Result<i32> {
    let (left, sample) = (GAP, 110);
    let (mut column, mut row) = (left, top);
    let mut lines = 0;
    for (name, stroke, mark) in layers.iter().filter_map(entry) {
        let length = sample + 24 + (name.chars().count() as f64 * CHARACTER) as i32;
        if lines == 0 {
            lines = 1;
        } else if column + length > width - 40 {
            (column, row, lines) = (left, row + LINE, lines + 1);
        }
        let middle = row + LINE / 2;
        match mark {
            Mark::Line if stroke.dashed => {
                for start in [0, 42, 84] {
                    let ends = [(column + start, middle), (column + start + 26, middle)];
                    area.draw(&PathElement::new(ends, stroke.shape()))?;
                }
            }
            Mark::Line => {
                let ends = [(column, middle), (column + sample, middle)];
                area.draw(&PathElement::new(ends, stroke.wide(stroke.width.max(6)).shape()))?;
            }
            Mark::Dot => {
                area.draw(&Circle::new((column + sample / 2, middle), DOT, stroke.filled()))?;
            }
            Mark::Area => {
                let corners = [(column, middle - 24), (column + sample, middle + 24)];
                area.draw(&Rectangle::new(corners, stroke.filled()))?;
            }
        }
        let style = text().pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(name, (column + sample + 24, middle), style))?;
        column += length + GAP;
    }
    Ok(lines * LINE)
}
