//! How fast strings are: the benchmarks of `dsp`, as ratios within one run, and what threads gain when songs are rendered.

mod buzz;
mod sharing;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::Parser;

use super::features::callgrind_is_there;
use super::page;
use crate::repository::root;

/// Where the table stands.
const PAGE: &str = "docs/speed.md";

/// Runs the benchmarks of the physics and makes a table of their ratios.
#[derive(Parser)]
#[command(
    name = "cargo xtask measure speed",
    after_help = "Examples:\n  cargo xtask measure speed            times everything and prints the table (a few minutes)\n  \
                  cargo xtask measure speed --write    puts it into docs/speed.md\n  \
                  cargo xtask measure speed --last     makes the table of the last run again\n  \
                  cargo xtask measure speed --songs    times only songs, by one thread and by several"
)]
struct Arguments {
    /// Put the table into docs/speed.md.
    #[arg(long)]
    write: bool,
    /// Do not run the benchmarks, take what the last run found.
    #[arg(long)]
    last: bool,
    /// Only time songs by one thread and by as many as there are processors, and put only that row into docs/speed.md.
    #[arg(long, conflicts_with = "last")]
    songs: bool,
    /// Play so many samples of the chord that buzzes, as callgrind is told to.
    #[arg(long, hide = true)]
    buzz: Option<usize>,
}

/// Runs the measurement.
pub fn run(arguments: Vec<String>) -> Result<()> {
    let Some(arguments) = super::parse::<Arguments>(arguments)? else { return Ok(()) };
    if let Some(samples) = arguments.buzz {
        return buzz::play(samples);
    }
    if arguments.songs {
        let row = songs()?;
        print!("{row}");
        if arguments.write {
            let marks = page::marks("speed");
            page::write(PAGE, &marks, &with_songs(&page::read(PAGE, &marks)?, &row))?;
        }
        return Ok(());
    }
    if !arguments.last {
        let status = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["bench", "--package", "low-action-dsp"])
            .current_dir(root())
            .status()
            .context("cargo cannot be run")?;
        ensure!(status.success(), "the benchmarks failed");
    }
    let table = table()?;
    println!("{table}");
    if arguments.write {
        page::write(PAGE, &page::marks("speed"), &table)?;
    }
    Ok(())
}

/// Median time of a benchmark's iterations in the last run, ns: neighbours on the machine move it less than the mean.
fn median(group: &str, name: &str) -> Result<f64> {
    let file = criterion_folder().join(group).join(name).join("new/estimates.json");
    let text = std::fs::read_to_string(&file)
        .with_context(|| format!("`{group}/{name}` has not been timed: {} cannot be read", file.display()))?;
    let estimates: serde_json::Value = serde_json::from_str(&text)?;
    let point = estimates["median"]["point_estimate"].as_f64();
    point.with_context(|| format!("{} has no median", file.display()))
}

fn criterion_folder() -> PathBuf {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| Path::new("target").into(), PathBuf::from);
    root().join(target).join("criterion")
}

/// Samples of one iteration.
const SAMPLES: f64 = 4800.0;

fn table() -> Result<String> {
    let mut text = String::from("| measure | found | aim |\n|---|--:|--:|\n");
    let mut row = |name: &str, found: String, aim: &str| text += &format!("| {name} | {found} | {aim} |\n");
    let chord = |name: &str| Ok::<_, anyhow::Error>(median("chord", name)? / SAMPLES);
    let real_time = |time: f64, rate: f64| format!("{:.1} × real time", 1e9 / (time * rate));
    row("six strings fretted and ringing, `live`, 48 kHz", real_time(chord("48 kHz")?, 48e3), "10 ×");
    for (rate, khz, aim) in [(48e3, "48 kHz", "10 ×, 350 ns"), (96e3, "96 kHz", "3.5 ×")] {
        let time = chord(&format!("{khz}, one step a sample"))?;
        let found = format!("{:.0} ns a string-sample, {}", time / 6.0, real_time(time, rate));
        row(&format!("… every string at {khz}"), found, aim);
    }
    let string = |name: &str| median("string", name);
    let (copy, bare, free) = (string("copy")?, string("bare")?, string("free")?);
    let fretted = string("fretted")?;
    let times = |a: f64, b: f64| format!("{:.2} ×", a / b);
    row("bare linear string, by hand", format!("{:.0} ns", bare / SAMPLES), "");
    row("… over a copy of its arrays and back", times(bare, copy), "reported");
    row("free string (`wide`, stiff, lossy, stretching) over the bare one", times(free, bare), "1.5 ×");
    row("fretted string (a finger and two frets) over the free one", times(fretted, free), "1.9 ×");
    let scalar = times(string("free, without vectors")?, free);
    row("free string without vectors over with", scalar, "4 ×");
    let scalar = times(string("fretted, without vectors")?, fretted);
    row("fretted string without vectors over with", scalar, "4 ×");
    let points = |count: &str| median("points", count);
    let growth = points("691")? / points("151")?;
    row("free string of 691 points over one of 151 (4.58 times as many)", format!("{growth:.2} ×"), "linear");
    row("six ringing strings over one", times(median("strings", "6")?, median("strings", "1")?), "6 ×");
    row(
        "six silent strings over one that rings",
        times(median("strings", "6 silent")?, median("strings", "1")?),
        "",
    );
    row(
        "100 frets that nothing touches over one",
        times(median("frets", "100")?, median("frets", "1")?),
        "1 ×",
    );
    let times = |work: &buzz::Work| format!("{:.1} ×", work.most / work.mean);
    let buzz = buzz::iterations()?;
    let found = format!("{} ({} and {:.2})", times(&buzz), buzz.most, buzz.mean);
    row("heavy buzzing chord: Newton iterations of the worst sample over the mean", found, "6 ×");
    let found = if callgrind_is_there() {
        let buzz = buzz::instructions()?;
        format!("{} ({:.0} and {:.0})", times(&buzz), buzz.most, buzz.mean)
    } else {
        "not counted: valgrind is not there".into()
    };
    row("… instructions", found, "6 ×");
    Ok(with_songs(&text, &songs()?))
}

/// The row of songs.
fn songs() -> Result<String> {
    let (name, found) = sharing::row()?;
    Ok(format!("| {name} | {found} |  |\n"))
}

/// A table with this row of songs at its end, instead of the one it may have.
fn with_songs(table: &str, row: &str) -> String {
    let others = table.lines().filter(|line| !line.contains(sharing::NAME));
    others.map(|line| format!("{line}\n")).collect::<String>() + row
}

#[cfg(test)]
mod tests {
    use super::{sharing, with_songs};

    #[test]
    fn the_row_of_songs_is_put_in_place_of_the_one_before() {
        let row = |found| format!("| {}, 2 threads over one | {found} |  |\n", sharing::NAME);
        let table = "| measure | found | aim |\n| free string | 1 | 2 |\n";
        let once = with_songs(table, &row("1.5"));
        assert_eq!(once, format!("{table}{}", row("1.5")));
        assert_eq!(with_songs(&once, &row("1.6")), format!("{table}{}", row("1.6")));
    }
}
