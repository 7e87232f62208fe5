//! A page: a title, rows of panels, and a caption that says what was computed.

use anyhow::Result;
use plotters::prelude::*;

use crate::panel::{LINE, Panel, text};
use crate::style::{CHARACTER, GAP, TITLE, WIDTH, colour};

/// A page of panels.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// What it shows.
    pub title: String,
    /// What was computed: parameters and everything needed to read the panels.
    pub caption: String,
    rows: Vec<(u32, Vec<Panel>)>,
}

/// Room above the panels for the title, px.
const HEAD: u32 = 170;

impl Sheet {
    /// An empty page.
    pub fn new(title: impl Into<String>, caption: impl Into<String>) -> Sheet {
        Sheet { title: title.into(), caption: caption.into(), rows: Vec::new() }
    }

    /// The same with one more row of panels below, of a height in px.
    pub fn row(mut self, height: u32, panels: Vec<Panel>) -> Sheet {
        self.rows.push((height, panels));
        self
    }

    /// The page as SVG.
    ///
    /// # Errors
    /// When the drawing library refuses a shape.
    pub fn draw(&self) -> Result<String> {
        let caption = wrap(&joined(&self.caption), (f64::from(WIDTH as i32 - 2 * GAP) / CHARACTER) as usize);
        let foot = (caption.len() as i32 * LINE + 60) as u32;
        let panels: u32 = self.rows.iter().map(|(height, _)| height + GAP as u32 / 2).sum();
        let mut picture = String::new();
        {
            let root =
                SVGBackend::with_string(&mut picture, (WIDTH, HEAD + panels + foot)).into_drawing_area();
            root.fill(&WHITE)?;
            let title = ("sans-serif", TITLE).into_font().color(&colour::INK);
            root.draw(&Text::new(self.title.as_str(), (GAP, 44), title))?;
            let mut top = HEAD;
            for (height, panels) in &self.rows {
                let width = WIDTH / panels.len().max(1) as u32;
                for (column, panel) in (0..).zip(panels) {
                    let corner = ((column * width) as i32, top as i32);
                    panel.draw(&root.clone().shrink(corner, (width, *height)))?;
                }
                top += height + GAP as u32 / 2;
            }
            for (line, words) in (0..).zip(&caption) {
                root.draw(&Text::new(words.as_str(), (GAP, top as i32 + line * LINE), text()))?;
            }
            root.present()?;
        }
        Ok(picture)
    }
}

/// Units that stand behind a number.
const UNITS: [&str; 18] = [
    "m", "mm", "µm", "s", "ms", "Hz", "kHz", "N", "mN", "g", "mg", "g/m", "GPa", "J", "/s", "m²/s", "m/s",
    "s/m",
];

/// The text with spaces that do not break between numbers and their units, and beside signs of equality.
fn joined(text: &str) -> String {
    let mut joined = String::new();
    let mut before = "";
    for word in text.split([' ', '\n']).filter(|word| !word.is_empty()) {
        let is_number = before.ends_with(|c: char| c.is_numeric());
        let is_unit = UNITS.contains(&word.trim_end_matches([',', '.', ';', ':', ')']));
        // (A unit may be of two words.)
        let belongs = is_unit && (is_number || UNITS.contains(&before)) || word == "=" || before == "=";
        if !before.is_empty() {
            joined.push(if belongs { '\u{a0}' } else { ' ' });
        }
        joined.push_str(word);
        before = word;
    }
    joined
}

/// Breaks a text into lines of at most so many characters, but not at spaces that do not break.
fn wrap(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split([' ', '\n']).filter(|word| !word.is_empty()) {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::panel::Layer;
    use crate::style::{Stroke, colour};

    #[test]
    fn text_is_broken_between_words() {
        assert_eq!(wrap("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrap("one K\u{a0}= 2", 5), ["one", "K\u{a0}= 2"]);
        assert!(wrap("", 7).is_empty());
    }

    #[test]
    fn a_number_keeps_its_unit() {
        for (text, expected) in [
            ("E = 200 GPa, r = 0.43 mm.", "E_=_200_GPa, r_=_0.43_mm."),
            ("σ₁ = 1.25·10⁻⁴ m²/s at 44.1 kHz", "σ₁_=_1.25·10⁻⁴_m²/s at 44.1_kHz"),
            ("hand 0.3 N s/m, (10 s) 12 frets, as m is", "hand 0.3_N_s/m, (10_s) 12 frets, as m is"),
        ] {
            assert_eq!(joined(text).replace('\u{a0}', "_"), expected);
        }
    }

    #[test]
    fn a_line_that_leaves_its_panel_is_no_plateau() {
        let line = |points| Layer::line("line", Stroke::new(colour::BLUE), points);
        let drawn = |y: Axis, points| {
            let panel = Panel::new("panel", Axis::linear("x, m", 0.0..1.0), y).with(line(points));
            Sheet::new("title", "caption").row(900, vec![panel]).draw()
        };
        let y = || Axis::linear("y, J", 0.0..1.0);
        assert!(drawn(y(), vec![(0.0, 0.0), (0.5, 1.0), (2.0, 7.0)]).is_ok());
        let error = drawn(y(), vec![(0.0, 0.0), (0.5, 1.5)]).unwrap_err().to_string();
        let all = ["\"line\"", "\"panel\"", "1.5", "0.0..1.0"].iter().all(|word| error.contains(word));
        assert!(all && error.lines().count() == 1, "{error}");
        assert!(drawn(y().cut(), vec![(0.0, 0.0), (0.5, 1.5)]).is_ok());
    }

    #[test]
    fn a_dot_that_would_not_be_seen_is_refused() {
        let drawn = |x: Axis, y: Axis, place| {
            let dots = Layer::dots("dot", Stroke::new(colour::BLUE), vec![(0.5, 0.5), place]);
            Sheet::new("title", "caption").row(900, vec![Panel::new("panel", x, y).with(dots)]).draw()
        };
        let x = || Axis::linear("x, m", 0.0..1.0);
        let y = || Axis::log("y, J", 1e-3..1.0);
        assert!(drawn(x(), y(), (1.0, 1e-3)).is_ok());
        for place in [(2.0, 0.5), (0.5, 2.0), (0.5, 0.0), (0.5, f64::NAN)] {
            let error = drawn(x(), y(), place).unwrap_err().to_string();
            assert!(error.contains("\"dot\"") && error.contains("must be"), "{error}");
            assert!(drawn(x().cut(), y().cut(), place).is_ok(), "{place:?}");
        }
        assert!(drawn(x().cut(), y(), (0.5, 2.0)).is_err());
    }

    #[test]
    fn a_page_is_svg_with_its_words_escaped() {
        let panel = Panel::new("a < b & c", Axis::linear("x, m", 0.0..1.0), Axis::log("y, J", 1e-3..1.0))
            .with(Layer::line("line", Stroke::new(colour::BLUE), vec![(0.0, 0.0), (0.5, 1e9), (2.0, 0.1)]));
        let picture = Sheet::new("title", "caption").row(900, vec![panel]).draw().unwrap();
        assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
        assert!(picture.contains("a &lt; b &amp; c"), "{picture}");
        assert!(picture.contains("caption") && picture.contains("10⁻³"));
    }
}
