//! A plucked string bouncing on frets and board, one panel per moment.

use anyhow::{Context, Result};
use low_action_dsp::{Scene, Simulation};
use low_action_figures::panel::{Area, Chart, GroundLook};
use low_action_figures::style::colour;
use low_action_figures::{Ground, Profile};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Made;
use super::running::{Repository, ground, listen};

/// Times of the panels after the string is let go, ms: one period of the open string and a little more.
const MOMENTS: [f64; 8] = [0.0, 1.5, 3.0, 3.9, 4.6, 6.5, 9.5, 12.3];

/// Earlier positions of the string shown behind each panel's own, and the time between them, ms.
const TRAIL: (usize, f64) = (3, 0.25);

/// Panels: columns and rows. Time runs down the columns.
const LAYOUT: (usize, usize) = (2, 4);

/// Size of the picture, px. The backend writes whole numbers; at four times the size at which the
/// picture is looked at, that does not show.
const SIZE: (u32, u32) = (3600, 3360);

/// Room above the panels for title and key, and below for the caption, px.
const HEAD: i32 = 260;
const FOOT: u32 = 220;

/// Room below the lowest panels for the labels of their axis, px.
const AXIS: u32 = 172;

/// Heights shown, mm.
const HEIGHTS: std::ops::Range<f64> = -4.3..5.4;

/// Size of ordinary text, px.
const TEXT: f64 = 54.0;

/// Half the width of a fret as drawn, m.
const FRET: f64 = 0.0011;

/// Radius of the mark of a contact, px, and how strong a past one is drawn.
const DOT: i32 = 18;
const PAST: f64 = 0.35;

/// The string at one moment.
struct Snapshot {
    /// Time after the release, ms.
    time: f64,
    /// Points of the string, (m from the nut, mm).
    string: Vec<(f64, f64)>,
    /// Points of the string a little earlier, latest first.
    trail: Vec<Vec<(f64, f64)>>,
    /// Where something pushes the string now, (m from the nut, mm).
    contacts: Vec<(f64, f64)>,
    /// Where something has pushed it since the trail began.
    past_contacts: Vec<(f64, f64)>,
}

/// Runs the scene and draws it.
pub fn make(repository: &Repository) -> Result<Made> {
    let scene = repository.scene("docs/figures/string_over_frets.toml")?;
    let ground = ground(&scene)?;
    let snapshots = snapshots(&scene)?;
    let mut picture = String::new();
    draw(&mut picture, &scene, &ground, &snapshots)?;
    Ok(Made { picture, section: None, sounds: vec![listen("string_over_frets", &scene)?] })
}

fn draw(picture: &mut String, scene: &Scene, ground: &Ground, snapshots: &[Snapshot]) -> Result<()> {
    let root = SVGBackend::with_string(picture, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (columns, rows) = LAYOUT;
    let width = SIZE.0 / columns as u32;
    let height = (SIZE.1 - HEAD as u32 - FOOT - AXIS) / rows as u32;
    let mut magnification = 0.0;
    for (place, snapshot) in snapshots.iter().enumerate() {
        let (column, row) = ((place / rows) as u32, (place % rows) as u32);
        let lowest = row + 1 == rows as u32;
        let corner = ((column * width) as i32, HEAD + (row * height) as i32);
        let panel = root.clone().shrink(corner, (width, if lowest { height + AXIS } else { height }));
        magnification = draw_panel(&panel, scene, ground, snapshot, (column == 0, lowest))?;
    }
    draw_key(&root, magnification)?;
    draw_caption(&root, scene)?;
    root.present()?;
    Ok(())
}

/// Steps the scene to each moment.
fn snapshots(scene: &Scene) -> Result<Vec<Snapshot>> {
    let pluck = scene.pluck.first().context("the scene needs a pluck")?;
    let release = pluck.start + pluck.duration;
    let sample_at = |time: f64| (time * scene.sample_rate).round() as u64;
    let mut simulation = Simulation::new(scene)?;
    let mut shown = Vec::new();
    for moment in MOMENTS {
        let (mut trail, mut past_contacts) = (Vec::new(), Vec::new());
        for earlier in (0..=TRAIL.0).rev() {
            let time = release + 1e-3 * (moment - earlier as f64 * TRAIL.1);
            while simulation.steps() < sample_at(time) {
                simulation.step();
                if !trail.is_empty() {
                    past_contacts.extend(contacts(&simulation));
                }
            }
            trail.insert(0, Profile::of(simulation.string(0)).string);
        }
        let string = trail.remove(0);
        let contacts = contacts(&simulation);
        past_contacts.sort_by(|a, b| a.0.total_cmp(&b.0));
        past_contacts.dedup();
        past_contacts.retain(|past| !contacts.contains(past));
        shown.push(Snapshot { time: moment, string, trail, contacts, past_contacts });
    }
    Ok(shown)
}

/// Where board or frets push the string.
fn contacts(simulation: &Simulation) -> Vec<(f64, f64)> {
    let string = simulation.string(0);
    let pushing = string.scratch.forces().filter(|(_, force)| *force > 0.0);
    pushing
        .filter_map(|(index, _)| string.model.contacts.get(index))
        .map(|contact| (contact.place, 1e3 * contact.height))
        .collect()
}

/// Draws one moment; returns how many times heights are magnified over lengths.
fn draw_panel(
    area: &Area,
    scene: &Scene,
    ground: &Ground,
    snapshot: &Snapshot,
    (leftmost, lowest): (bool, bool),
) -> Result<f64> {
    let length = scene.string[0].length;
    let margin = 0.012;
    let mut chart = ChartBuilder::on(area)
        .margin_top(28)
        .margin_bottom(28)
        .margin_left(40)
        .margin_right(64)
        .x_label_area_size(if lowest { AXIS } else { 0 })
        .y_label_area_size(190)
        .build_cartesian_2d(-margin..length + margin, HEIGHTS)?;
    let text = ("sans-serif", TEXT).into_font().color(&colour::INK);
    let place_label = |place: &f64| if lowest { format!("{place:.1}") } else { String::new() };
    let height_label = |height: &f64| format!("{height:.0}").replace('-', "−");
    let mut mesh = chart.configure_mesh();
    mesh.disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(colour::FAINT.stroke_width(2))
        .axis_style(colour::INK.stroke_width(2))
        .y_labels(5)
        .y_label_formatter(&height_label)
        .x_labels(7)
        .x_label_formatter(&place_label)
        .label_style(text.clone())
        .axis_desc_style(text.clone());
    if lowest {
        mesh.x_desc("place, m from the nut");
    }
    if leftmost {
        mesh.y_desc("height, mm");
    }
    mesh.draw()?;
    let look = GroundLook { across: -margin..length + margin, bottom: HEIGHTS.start, half: FRET };
    look.draw(&mut chart, ground, |point| point)?;
    let dot =
        |place: &(f64, f64), strength| Circle::new(*place, DOT, colour::VERMILION.mix(strength).filled());
    chart.draw_series(snapshot.past_contacts.iter().map(|place| dot(place, PAST)))?;
    for (age, trail) in snapshot.trail.iter().enumerate().rev() {
        let strength = 0.38 * (1.0 - age as f64 / (TRAIL.0 as f64 + 0.5));
        chart.draw_series(LineSeries::new(trail.clone(), colour::BLUE.mix(strength).stroke_width(6)))?;
    }
    chart.draw_series(LineSeries::new(snapshot.string.clone(), colour::BLUE.stroke_width(10)))?;
    chart.draw_series(snapshot.contacts.iter().map(|place| dot(place, 1.0)))?;
    let corner = text.pos(Pos::new(HPos::Right, VPos::Top));
    chart.draw_series(std::iter::once(Text::new(
        format!("{:.1} ms", snapshot.time),
        (length, HEIGHTS.end - 0.2),
        corner,
    )))?;
    Ok(magnification(&chart))
}

/// How many times heights are magnified over lengths.
fn magnification(chart: &Chart) -> f64 {
    let (across, down) = chart.plotting_area().dim_in_pixel();
    let range = chart.x_range();
    let per_metre = f64::from(across) / (range.end - range.start);
    f64::from(down) / (1e-3 * (HEIGHTS.end - HEIGHTS.start)) / per_metre
}

/// Title and what the colours mean.
fn draw_key(area: &Area, magnification: f64) -> Result<()> {
    let title = ("sans-serif", 80.0).into_font().color(&colour::INK);
    area.draw(&Text::new("A plucked string slaps the frets", (80, 44), title))?;
    let text = ("sans-serif", TEXT).into_font().color(&colour::INK);
    let text = text.pos(Pos::new(HPos::Left, VPos::Center));
    let row = 200;
    let write = |words: String, column: i32| area.draw(&Text::new(words, (column, row), text.clone()));
    let window = TRAIL.0 as f64 * TRAIL.1;
    for line in 0..3 {
        let strength = [0.2, 0.38, 1.0][line as usize];
        let at = row + 16 - 16 * line;
        let style = colour::BLUE.mix(strength).stroke_width(if line == 2 { 10 } else { 6 });
        area.draw(&PathElement::new([(84, at), (184, at)], style))?;
    }
    write(format!("string, and its last {window} ms"), 212)?;
    area.draw(&Circle::new((1060, row), DOT, colour::VERMILION.filled()))?;
    write("touching now,".into(), 1096)?;
    area.draw(&Circle::new((1500, row), DOT, colour::VERMILION.mix(PAST).filled()))?;
    write("in that time".into(), 1536)?;
    area.draw(&Rectangle::new([(1960, row - 28), (1972, row + 28)], colour::METAL.filled()))?;
    write("fret".into(), 2000)?;
    area.draw(&Rectangle::new([(2170, row - 24), (2250, row + 24)], colour::BOARD.filled()))?;
    write("board".into(), 2278)?;
    write(format!("heights magnified {magnification:.0} times"), 2660)?;
    Ok(())
}

/// The scene in two lines.
fn draw_caption(area: &Area, scene: &Scene) -> Result<()> {
    let (string, pluck) = (&scene.string[0], &scene.pluck[0]);
    let lines = [
        format!(
            "Low E of an electric guitar: {} m, {:.2} g/m, {} N, core {:.2} mm thick and {:.0} GPa. Pulled up with {} N, \
             {:.0} cm from the saddle,",
            string.length,
            1e3 * string.linear_density,
            string.tension.at(0.0),
            2e3 * string.core_radius,
            1e-9 * string.youngs_modulus,
            pluck.force,
            1e2 * (string.length - pluck.position),
        ),
        format!("and let go at 0 ms. Computed at {} kHz.", 1e-3 * scene.sample_rate),
    ];
    let top = (SIZE.1 - FOOT) as i32;
    let text = ("sans-serif", TEXT).into_font().color(&colour::INK);
    for (line, row) in lines.iter().zip([top + 28, top + 108]) {
        area.draw(&Text::new(line.as_str(), (84, row), text.clone()))?;
    }
    Ok(())
}
