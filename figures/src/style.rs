//! Colours, lines and sizes of all pictures.

use plotters::style::{RGBColor, ShapeStyle};

/// Width of a page, px. The backend writes whole numbers; at four times the size at which a picture is
/// looked at, that does not show.
pub const WIDTH: u32 = 3600;

/// Size of ordinary text, px.
pub const TEXT: f64 = 60.0;

/// Size of a page's title, px.
pub const TITLE: f64 = 84.0;

/// About how wide a character of ordinary text is, px: the mean of wide sans-serif faces (the backend makes
/// letters smaller than their nominal size by 1.24).
pub const CHARACTER: f64 = 0.56 * TEXT / 1.24;

/// Room between what stands beside each other, px.
pub const GAP: i32 = 80;

/// Colours that stay apart for every kind of colour vision: the set by Okabe and Ito (2008).
pub mod colour {
    use plotters::style::RGBColor;

    /// The string.
    pub const BLUE: RGBColor = RGBColor(0, 114, 178);
    /// Where something touches; a second string.
    pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
    /// Fingers.
    pub const GREEN: RGBColor = RGBColor(0, 158, 115);
    /// A fourth thing.
    pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
    /// A fifth thing.
    pub const SKY: RGBColor = RGBColor(86, 180, 233);
    /// A sixth thing.
    pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
    /// Board.
    pub const BOARD: RGBColor = RGBColor(231, 220, 200);
    /// Frets, nut and saddle.
    pub const METAL: RGBColor = RGBColor(110, 110, 110);
    /// Text and axes.
    pub const INK: RGBColor = RGBColor(40, 40, 40);
    /// Lines behind the picture.
    pub const FAINT: RGBColor = RGBColor(215, 215, 215);
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub colour: RGBColor,
    /// How much of the colour there is over white, 0 to 1.
    pub strength: f64,
    /// Its width, px.
    pub width: u32,
    /// Whether it is broken.
    pub dashed: bool,
}

impl Stroke {
    /// A full line of ordinary width.
    pub const fn new(colour: RGBColor) -> Stroke {
        Stroke { colour, strength: 1.0, width: 8, dashed: false }
    }

    /// A thin line, for what swings fast.
    pub const fn thin(colour: RGBColor) -> Stroke {
        Stroke { colour, strength: 1.0, width: 4, dashed: false }
    }

    /// The same, broken.
    pub const fn dashed(self) -> Stroke {
        Stroke { dashed: true, ..self }
    }

    /// The same with less colour.
    pub const fn faded(self, strength: f64) -> Stroke {
        Stroke { strength, ..self }
    }

    /// The same in another width, px.
    pub const fn wide(self, width: u32) -> Stroke {
        Stroke { width, ..self }
    }

    /// The colour mixed with white, so that lines that cross do not darken each other.
    pub fn tint(&self) -> RGBColor {
        let mix = |part: u8| (255.0 - self.strength * (255.0 - f64::from(part))).round() as u8;
        RGBColor(mix(self.colour.0), mix(self.colour.1), mix(self.colour.2))
    }

    pub(crate) fn shape(&self) -> ShapeStyle {
        ShapeStyle { color: self.tint().into(), filled: false, stroke_width: self.width }
    }

    pub(crate) fn filled(&self) -> ShapeStyle {
        ShapeStyle { filled: true, ..self.shape() }
    }
}
