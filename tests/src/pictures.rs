//! Pictures of the editor, drawn by software, beside those that are kept.

use std::fs::{self, File};
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use egui_kittest::wgpu::WgpuTestRenderer;

use crate::desk::Desk;

/// Has the pictures drawn anew instead of compared.
const DRAW_ANEW: &str = "UPDATE_SNAPSHOTS";

/// Steps of 255 by which a colour may be off, and pixels that may be off by more: edges differ a little from one version
/// of the driver to another.
const STEPS: u8 = 6;
const PIXELS: usize = 200;

/// Whether pictures can be drawn here. Where the whole project is checked they must be.
pub fn can_draw() -> bool {
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
            let off = seen.differs(&expected);
            if off > PIXELS {
                seen.write(&beside);
                panic!("{off} pixels of {name} are not as they were: compare {}", beside.display());
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

    /// How many pixels differ; all if the size does.
    fn differs(&self, other: &Self) -> usize {
        if self.size != other.size {
            return usize::MAX;
        }
        let off = |(one, other): (&[u8], &[u8])| one.iter().zip(other).any(|(a, b)| a.abs_diff(*b) > STEPS);
        self.pixels.chunks(4).zip(other.pixels.chunks(4)).filter(|pair| off(*pair)).count()
    }
}
