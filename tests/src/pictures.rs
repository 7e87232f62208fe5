//! Pictures of the editor, drawn by software, beside those that are kept.

use std::fs::{self, File};
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use egui_kittest::wgpu::WgpuTestRenderer;

use crate::desk::Desk;
use crate::user::isolate;

/// Has the pictures drawn anew instead of compared.
const DRAW_ANEW: &str = "UPDATE_SNAPSHOTS";

/// Steps of 255 by which a colour may be off, and pixels that may be off by more: edges differ a little from one version
/// of the driver to another.
const STEPS: u8 = 6;
const PIXELS: usize = 200;
/// Pixels a side of the smallest square that may not be off all over, however few are. What drivers draw differently are
/// slopes: edges fade out over one pixel, and a line as thin as one pixel is nothing but two edges, two pixels across. No
/// square of three has its nine middles in a strip so narrow. What has come, gone or moved is wider, such as the lit line
/// of a control, 37 pixels by 4.
const SIDE: usize = 3;
/// Pixels that may be off within a window of such a width and height, wherever it is put: as many as a line across all of it
/// has, two pixels thick. The strokes of letters are as thin, but lie close together: the shortest word has more.
const WINDOW: [usize; 2] = [24, 12];
const IN_WINDOW: usize = 2 * WINDOW[0];

/// Whether pictures can be drawn here. Where the whole project is checked they must be.
pub fn can_draw() -> bool {
    isolate();
    let can = std::panic::catch_unwind(WgpuTestRenderer::new).is_ok();
    assert!(
        can || std::env::var("CI").as_deref() != Ok("true"),
        "there is no Vulkan driver, and under CI=true there must be"
    );
    if !can {
        eprintln!("passed over: there is no Vulkan driver");
    }
    can
}

/// What is seen at a desk must be the picture of that name; what was seen instead is left beside it.
pub fn assert_looks(desk: &mut Desk, name: &str) {
    let image = desk.harness.render().expect("it can be drawn");
    let seen = Picture { size: [image.width(), image.height()], pixels: image.into_raw() };
    let kept = path(name);
    if std::env::var_os(DRAW_ANEW).is_some() {
        return seen.write(&kept);
    }
    let beside = kept.with_extension("new.png");
    match Picture::read(&kept) {
        None => {
            seen.write(&beside);
            panic!("there is no picture {}: with {DRAW_ANEW}=1 it is drawn", kept.display());
        }
        Some(expected) => {
            if let Some(fault) = seen.fault(&expected) {
                seen.write(&beside);
                panic!("{name} is not as it was, {fault}: compare {}", beside.display());
            }
            fs::remove_file(beside).ok();
        }
    }
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots").join(name).with_extension("png")
}

/// Red, green, blue and opacity of every pixel.
struct Picture {
    size: [u32; 2],
    pixels: Vec<u8>,
}

impl Picture {
    fn read(path: &Path) -> Option<Self> {
        let mut reader = png::Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
        let mut pixels = vec![0; reader.output_buffer_size()?];
        let info = reader.next_frame(&mut pixels).ok()?;
        Some(Self { size: [info.width, info.height], pixels })
    }

    fn write(&self, path: &Path) {
        let file = File::create(path).expect("the picture can be written");
        let mut encoder = png::Encoder::new(BufWriter::new(file), self.size[0], self.size[1]);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_compression(png::Compression::High);
        let mut writer = encoder.write_header().expect("the picture can be written");
        writer.write_image_data(&self.pixels).expect("the picture can be written");
    }

    /// Where it is not as another, if it is further off than a driver may be.
    fn fault(&self, other: &Self) -> Option<String> {
        if self.size != other.size {
            return Some(format!("{:?} pixels instead of {:?}", self.size, other.size));
        }
        let is_off =
            |(one, other): (&[u8], &[u8])| one.iter().zip(other).any(|(a, b)| a.abs_diff(*b) > STEPS);
        let off: Vec<bool> = self.pixels.chunks(4).zip(other.pixels.chunks(4)).map(is_off).collect();
        let count = off.iter().filter(|&&off| off).count();
        if count > PIXELS {
            return Some(format!("{count} pixels off where at most {PIXELS} may be"));
        }
        let [width, height] = self.size.map(|size| size as usize);
        if let Some([x, y]) = crowded(&off, width) {
            let [across, down] = WINDOW;
            return Some(format!("more than {IN_WINDOW} pixels off in {across} by {down} at {x}, {y}"));
        }
        let corners = (0..(height + 1).saturating_sub(SIDE))
            .flat_map(|y| (0..(width + 1).saturating_sub(SIDE)).map(move |x| (x, y)));
        let all_off = |&(x, y): &(usize, usize)| {
            (y..y + SIDE).all(|y| off[y * width + x..][..SIDE].iter().all(|&off| off))
        };
        let (x, y) = corners.into_iter().find(all_off)?;
        Some(format!("{SIDE} by {SIDE} pixels off all over at {x}, {y}"))
    }
}

/// The corner of a window in which too many pixels of a picture are off, if there is one.
fn crowded(off: &[bool], width: usize) -> Option<[usize; 2]> {
    let numbers = off.iter().enumerate().filter(|(_, off)| **off);
    let places: Vec<[usize; 2]> = numbers.map(|(n, _)| [n % width, n / width]).collect();
    // One that has the most can be moved right and down until pixels that are off stand at its left and at its top.
    let mut corners = places.iter().flat_map(|[x, _]| places.iter().map(move |[_, y]| [*x, *y]));
    let inside = |at: usize, from: usize, size: usize| (from..from + size).contains(&at);
    corners.find(|&[left, top]| {
        let within = |[x, y]: &&[usize; 2]| inside(*x, left, WINDOW[0]) && inside(*y, top, WINDOW[1]);
        places.iter().filter(within).count() > IN_WINDOW
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey ground with a brighter rectangle: left, top, width, height.
    fn rectangle(rectangle: [u32; 4]) -> Picture {
        rectangles(&[rectangle])
    }

    /// The same with several.
    fn rectangles(rectangles: &[[u32; 4]]) -> Picture {
        let size = [200, 40];
        let inside = |n: u32| {
            let (x, y) = (n % size[0], n / size[0]);
            rectangles.iter().any(|&[left, top, width, height]| {
                (left..left + width).contains(&x) && (top..top + height).contains(&y)
            })
        };
        let pixels = (0..size[0] * size[1]).flat_map(|n| [if inside(n) { 200 } else { 50 }; 4]).collect();
        Picture { size, pixels }
    }

    #[test]
    fn a_lit_line_that_is_gone_is_seen_and_an_edge_that_has_moved_is_not() {
        let nothing = rectangle([0; 4]);
        assert_eq!(nothing.fault(&nothing), None);
        for gone in [[20, 10, 37, 4], [197, 37, 3, 3], [0, 0, 3, 3]] {
            assert!(nothing.fault(&rectangle(gone)).is_some(), "{gone:?}");
        }
        // A line across all of it, one pixel thick with its edges.
        assert_eq!(nothing.fault(&rectangle([10, 20, 100, 2])), None);
        assert!(nothing.fault(&rectangle([10, 20, 101, 2])).is_some(), "too many");
    }

    /// Strokes as those of a word in the smallest letters, nowhere three pixels thick.
    #[test]
    fn a_word_erased_is_seen() {
        let upright = |x: u32| [x, 20, 1, 8];
        let word = [30, 34, 37, 41, 44, 46].map(upright);
        assert_eq!(word.len() * 8, IN_WINDOW);
        let nothing = rectangle([0; 4]);
        assert_eq!(nothing.fault(&rectangles(&word)), None, "as much as a line");
        let foot = [[47, 27, 3, 1]];
        assert!(nothing.fault(&rectangles(&[&word[..], &foot].concat())).is_some());
    }
}
