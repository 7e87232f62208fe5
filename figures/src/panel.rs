//! A panel: one pair of axes, and layers drawn over each other on them.

use std::ops::Range;

use anyhow::{Result, bail};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::axis::Axis;
use crate::ground::{Ground, Profile};
use crate::key;
use crate::style::{CHARACTER, GAP, Stroke, TEXT, colour};

/// Part of a page.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// A pair of axes on it.
pub type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Radius of a mark, px.
pub const DOT: i32 = 16;

/// Height of a line of text, px.
pub const LINE: i32 = 80;

/// Room for the numbers and the label of an axis, px: beside and below a panel.
const BESIDE: u32 = 236;
const BELOW: u32 = 156;

/// Length of the marks of numbers below a panel, px.
const TICK: i32 = 16;

/// Half the width of a fret as drawn, as a part of the panel's width.
const FRET: f64 = 0.0016;

/// Something drawn on the axes, in their units.
#[derive(Debug, Clone)]
pub enum Layer {
    /// A line through points, in order.
    Line {
        /// The points.
        points: Vec<(f64, f64)>,
        /// How it is drawn.
        stroke: Stroke,
        /// What it is called in the key, if it stands there.
        name: String,
    },
    /// A mark at each point.
    Dots {
        /// The points.
        points: Vec<(f64, f64)>,
        /// Colour and strength.
        stroke: Stroke,
        /// What they are called in the key, if they stand there.
        name: String,
    },
    /// The area between two lines over the same places.
    Band {
        /// (place, lower, upper).
        points: Vec<(f64, f64, f64)>,
        /// Colour and strength.
        stroke: Stroke,
        /// What it is called in the key, if it stands there.
        name: String,
    },
    /// Board, frets, nut and saddle.
    Ground(Ground),
    /// Words in the panel, their left end half a character right of a point.
    Words {
        /// The point.
        at: (f64, f64),
        /// What they say.
        text: String,
    },
}

impl Layer {
    /// A line with its name in the key; with an empty name it does not stand there.
    pub fn line(name: impl Into<String>, stroke: Stroke, points: Vec<(f64, f64)>) -> Layer {
        Layer::Line { points, stroke, name: name.into() }
    }

    /// Marks with their name in the key.
    pub fn dots(name: impl Into<String>, stroke: Stroke, points: Vec<(f64, f64)>) -> Layer {
        Layer::Dots { points, stroke, name: name.into() }
    }

    /// Words at a point.
    pub fn words(at: (f64, f64), text: impl Into<String>) -> Layer {
        Layer::Words { at, text: text.into() }
    }

    /// The string and the fingers of a profile; fingers that touch nothing are fainter.
    pub fn profile(profile: &Profile, string: Stroke, finger: Stroke) -> Vec<Layer> {
        let mut layers = vec![Layer::line("", string, profile.string.clone())];
        for (&place, &touching) in profile.fingers.iter().zip(&profile.touching) {
            let strength = if touching { finger.strength } else { 0.5 * finger.strength };
            layers.push(Layer::dots("", finger.faded(strength), vec![place]));
        }
        layers
    }
}

/// A pair of axes with what is drawn on them.
#[derive(Debug, Clone)]
pub struct Panel {
    /// What it shows, above it.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, from behind to front.
    pub layers: Vec<Layer>,
}

impl Panel {
    /// Empty axes.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Panel {
        Panel { title: title.into(), x, y, layers: Vec::new() }
    }

    /// The same with one more layer on top.
    pub fn with(mut self, layer: Layer) -> Panel {
        self.layers.push(layer);
        self
    }

    /// The same with more layers on top.
    pub fn with_all(mut self, layers: impl IntoIterator<Item = Layer>) -> Panel {
        self.layers.extend(layers);
        self
    }

    /// Draws it into part of a page.
    ///
    /// # Errors
    /// When a line would be drawn where it is not: beyond the vertical range, unless that is [cut](Axis::cut); or a dot not
    /// at all, since it lies beyond one of the ranges that are not.
    pub(crate) fn draw(&self, area: &Area) -> Result<()> {
        self.layers.iter().try_for_each(|layer| self.check(layer))?;
        let (width, height) = area.dim_in_pixel();
        let mut top = 0;
        if !self.title.is_empty() {
            area.draw(&Text::new(self.title.as_str(), (GAP, 8), bold()))?;
            top += LINE;
        }
        top += key::draw(&self.layers, area, top, width as i32)?;
        let below = if self.x.bare { 40 } else { BELOW };
        let chart_area = area.clone().shrink((0, top), (width, height - top as u32));
        let (across, up) = (self.x.span(), self.y.span());
        let mut chart = ChartBuilder::on(&chart_area)
            .margin_top(28)
            .margin_left(24)
            .margin_right(64)
            .margin_bottom(12)
            .x_label_area_size(below)
            .y_label_area_size(BESIDE)
            .build_cartesian_2d(across, up)?;
        self.draw_axes(&mut chart)?;
        for layer in &self.layers {
            self.draw_layer(&mut chart, layer)?;
        }
        Ok(())
    }

    /// Refuses what would not be seen where it is.
    fn check(&self, layer: &Layer) -> Result<()> {
        let refuse = |what: &str, name: &str, at: &(f64, f64), axis: &Axis| {
            let (title, label, range) = (&self.title, &axis.label, &axis.range);
            bail!("the {what} {name:?} of {title:?} at {at:?}: {label} must be {range:?}")
        };
        match layer {
            Layer::Line { points, name, .. } => {
                let beyond = points.iter().find(|(x, y)| self.x.shows(*x) && self.y.hides(*y));
                beyond.map_or(Ok(()), |at| refuse("line", name, at, &self.y))
            }
            Layer::Dots { points, name, .. } => {
                let beyond = |axis: &Axis, value: f64| !axis.cut && !axis.shows(value);
                for at in points {
                    if beyond(&self.x, at.0) {
                        return refuse("dot", name, at, &self.x);
                    }
                    if beyond(&self.y, at.1) {
                        return refuse("dot", name, at, &self.y);
                    }
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn draw_axes(&self, chart: &mut Chart) -> Result<()> {
        let (place_label, height_label) = (|x: &f64| self.x.number(*x), |y: &f64| self.y.number(*y));
        let mut mesh = chart.configure_mesh();
        mesh.disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(colour::FAINT.stroke_width(2))
            .axis_style(colour::INK.stroke_width(2))
            .x_labels(self.x.ticks)
            .y_labels(self.y.ticks)
            // So far below the axis that the first number is clear of the lowest one beside it.
            .set_tick_mark_size(LabelAreaPosition::Bottom, TICK)
            .x_label_formatter(&place_label)
            .y_label_formatter(&height_label)
            .label_style(text())
            .axis_desc_style(text());
        if !self.x.bare {
            mesh.x_desc(self.x.label());
        }
        mesh.y_desc(self.y.label());
        mesh.draw()?;
        Ok(())
    }

    /// Points as drawn: those within the horizontal range, at their places.
    fn places(&self, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let seen = points.iter().filter(|(x, _)| self.x.shows(*x));
        seen.map(|&(x, y)| (self.x.place(x), self.y.place(y))).collect()
    }

    fn draw_layer(&self, chart: &mut Chart, layer: &Layer) -> Result<()> {
        match layer {
            Layer::Line { points, stroke, .. } if stroke.dashed => {
                let points = self.places(points);
                chart.draw_series(DashedLineSeries::new(points, 26, 16, stroke.shape()))?;
            }
            Layer::Line { points, stroke, .. } => {
                chart.draw_series(LineSeries::new(self.places(points), stroke.shape()))?;
            }
            Layer::Dots { points, stroke, .. } => {
                let dot = |place| Circle::new(place, DOT, stroke.filled());
                let seen = points.iter().filter(|(_, y)| self.y.shows(*y));
                let seen: Vec<_> = seen.copied().collect();
                chart.draw_series(self.places(&seen).into_iter().map(dot))?;
            }
            Layer::Band { points, stroke, .. } => {
                let upper = points.iter().map(|&(x, _, high)| (x, high));
                let lower = points.iter().rev().map(|&(x, low, _)| (x, low));
                let outline: Vec<_> = upper.chain(lower).collect();
                let outline = self.places(&outline);
                chart.draw_series(std::iter::once(Polygon::new(outline, stroke.filled())))?;
            }
            Layer::Ground(ground) => self.draw_ground(chart, ground)?,
            Layer::Words { at, text: words } => {
                let style = text().pos(Pos::new(HPos::Left, VPos::Center));
                let at = (self.x.place(at.0), self.y.place(at.1));
                let words =
                    EmptyElement::at(at) + Text::new(words.clone(), ((0.5 * CHARACTER) as i32, 0), style);
                chart.draw_series(std::iter::once(words))?;
            }
        }
        Ok(())
    }

    fn draw_ground(&self, chart: &mut Chart, ground: &Ground) -> Result<()> {
        let across = self.x.range.clone();
        let half = FRET * (across.end - across.start);
        let place = |(x, y): (f64, f64)| (self.x.place(x), self.y.place(y));
        GroundLook { across, bottom: self.y.range.start, half }.draw(chart, ground, place)
    }
}

/// How a ground is drawn, in the units of its axes.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundLook {
    /// The places that are seen.
    pub across: Range<f64>,
    /// The height down to which the board is filled.
    pub bottom: f64,
    /// Half the width of a fret.
    pub half: f64,
}

impl GroundLook {
    /// Draws board, frets, nut and saddle; `place` is where a point lies on the chart.
    ///
    /// # Errors
    /// When the chart cannot be drawn on.
    pub fn draw(
        &self,
        chart: &mut Chart,
        ground: &Ground,
        place: impl Fn((f64, f64)) -> (f64, f64),
    ) -> Result<()> {
        let GroundLook { across, bottom, half } = self;
        if let (Some(first), Some(last)) = (ground.board.first(), ground.board.last()) {
            // Cut where the panel ends, at the height the board has there.
            let mut outline: Vec<_> = [across.start, across.end]
                .into_iter()
                .filter_map(|x| ground.board_at(x).map(|height| (x, height)))
                .collect();
            let seen = ground.board.iter().filter(|point| across.contains(&point.0));
            outline.extend(seen.copied());
            outline.sort_by(|a, b| a.0.total_cmp(&b.0));
            outline.extend([(last.0, *bottom), (first.0, *bottom)]);
            let outline: Vec<_> = outline.into_iter().map(&place).collect();
            chart.draw_series(std::iter::once(Polygon::new(outline, colour::BOARD.filled())))?;
        }
        let crowns = ground.crowns.iter().filter(|crown| across.contains(&crown.0));
        chart.draw_series(crowns.map(|&(x, crown)| {
            let foot = ground.board_at(x).unwrap_or(*bottom);
            let corners = [place((x - half, crown)), place((x + half, foot))];
            Rectangle::new(corners, colour::METAL.filled())
        }))?;
        // Nut and saddle hold the string: a triangle under each end, 32 px wide and high.
        for end in [0.0, ground.length] {
            if (across.start..=across.end).contains(&end) {
                let support = EmptyElement::at(place((end, 0.0)))
                    + Polygon::new([(0, 0), (-16, 32), (16, 32)], colour::METAL.filled());
                chart.draw_series(std::iter::once(support))?;
            }
        }
        Ok(())
    }
}

/// Ordinary text.
pub(crate) fn text() -> TextStyle<'static> {
    ("sans-serif", TEXT).into_font().color(&colour::INK)
}

/// The title of a panel.
fn bold() -> TextStyle<'static> {
    ("sans-serif", TEXT).into_font().style(FontStyle::Bold).color(&colour::INK)
}
