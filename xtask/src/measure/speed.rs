//! How fast strings are: the benchmarks of `dsp`, as ratios within one run, and what threads gain when songs are rendered.

mod buzz;
mod sharing;
mod timed;

use std::process::Command;
use std::time::SystemTime;

use anyhow::{Context, Result, ensure};
use clap::Parser;

use super::features::callgrind_is_there;
use super::page;
use crate::repository::root;
use buzz::{Hands, SUSPECTS, Work};
use timed::Timed;

/// Where the table stands.
const PAGE: &str = "docs/speed.md";

/// Runs the benchmarks of the physics and makes a table of their ratios.
#[derive(Parser)]
#[command(
    name = "cargo xtask measure speed",
    after_help = "Examples:\n  cargo xtask measure speed            times everything and prints the table (a few minutes)\n  \
                  cargo xtask measure speed --write    puts it into docs/speed.md\n  \
                  cargo xtask measure speed --last     makes the table of the last round again\n  \
                  cargo xtask measure speed --songs    times only songs, by one thread and by several\n  \
                  cargo xtask measure speed --buzz     counts only the work of a chord that buzzes"
)]
struct Arguments {
    /// Put the table into docs/speed.md.
    #[arg(long)]
    write: bool,
    /// Do not run the benchmarks, take what their last round found. Songs and the chord that buzzes are measured anew.
    #[arg(long)]
    last: bool,
    /// Only time songs by one thread and by as many as there are processors, and put only that row into docs/speed.md.
    #[arg(long, conflicts_with = "last")]
    songs: bool,
    /// Only count what is solved, and instructions, of the chord that buzzes, and put only those rows into docs/speed.md.
    #[arg(long, conflicts_with_all = ["last", "songs"])]
    buzz: bool,
    /// Play so many samples of that chord, as callgrind is told to.
    #[arg(long, hide = true)]
    play_buzz: Option<usize>,
    /// What the left hand does meanwhile.
    #[arg(long, hide = true, value_enum, default_value_t = Hands::Fretted)]
    hands: Hands,
    /// Which of them are counted by themselves.
    #[arg(long, hide = true, value_delimiter = ',')]
    counted: Vec<usize>,
}

/// Rows of the table, each with how it begins there.
type Rows = Vec<(&'static str, String)>;

/// Runs the measurement.
pub fn run(arguments: Vec<String>) -> Result<()> {
    let Some(arguments) = super::parse::<Arguments>(arguments)? else { return Ok(()) };
    if let Some(samples) = arguments.play_buzz {
        return buzz::play(arguments.hands, samples, &arguments.counted);
    }
    let (songs, buzz) = (!arguments.buzz, !arguments.songs);
    if arguments.write {
        // What cannot be measured here would take the place of what was measured elsewhere.
        ensure!(
            !buzz || callgrind_is_there(),
            "--write: valgrind is not there, and it counts the instructions"
        );
        ensure!(!songs || sharing::processors() > 1, "--write: songs want several processors, here is 1");
        page::read(PAGE, &page::marks("speed"))?;
    }
    let marks = page::marks("speed");
    let table = if arguments.songs || arguments.buzz {
        page::read(PAGE, &marks)?
    } else {
        let mut found = Timed::default();
        if arguments.last {
            found.add_round(&timed::folder(), None)?;
        } else {
            let started = SystemTime::now();
            for round in 1..=ROUNDS {
                eprintln!("benchmarks: {round} of {ROUNDS}");
                benchmark()?;
                found.add_round(&timed::folder(), Some(started))?;
            }
        }
        timed(&found)?
    };
    let mut rows = if buzz { self::buzz()? } else { Rows::new() };
    if songs {
        rows.push(self::songs()?);
    }
    let table = with_rows(&table, &rows);
    println!("{table}");
    if arguments.write {
        page::write(PAGE, &marks, &table)?;
    }
    Ok(())
}

/// How often each benchmark is run, one after another of them all.
const ROUNDS: usize = 5;

/// Runs the benchmarks, each for as long as a round of several needs.
fn benchmark() -> Result<()> {
    let status = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["bench", "--package", "low-action-dsp", "--bench", "strings", "--"])
        .args(["--warm-up-time", "0.5", "--measurement-time", "1.5", "--noplot"])
        .current_dir(root())
        .status()
        .context("cargo cannot be run")?;
    ensure!(status.success(), "the benchmarks failed");
    Ok(())
}

/// Samples of one iteration.
const SAMPLES: f64 = 4800.0;

/// The table of what criterion found.
fn timed(found: &Timed) -> Result<String> {
    let mut text = String::from("| measure | found | aim |\n|---|--:|--:|\n");
    let mut row = |name: &str, found: String, aim: &str| text += &self::row(name, &found, aim);
    let chord = |name: &str| Ok::<_, anyhow::Error>(found.fastest("chord", name)? / SAMPLES);
    let real_time = |time: f64, rate: f64| format!("{:.1} × real time", 1e9 / (time * rate));
    row("six strings fretted and ringing, `live`, 48 kHz", real_time(chord("48 kHz")?, 48e3), "10 ×");
    for (rate, khz, aim) in [(48e3, "48 kHz", "10 ×, 350 ns"), (96e3, "96 kHz", "3.5 ×")] {
        let time = chord(&format!("{khz}, one step a sample"))?;
        let found = format!("{:.0} ns a string-sample, {}", time / 6.0, real_time(time, rate));
        row(&format!("… every string at {khz}"), found, aim);
    }
    let string = |name: &str| found.fastest("string", name);
    let (copy, bare) = (string("copy")?, string("bare")?);
    let (linear, stretching) = (string("linear by hand")?, string("by hand")?);
    let (free, fretted) = (string("free")?, string("fretted")?);
    let times = |a: f64, b: f64| format!("{:.2} ×", a / b);
    row("bare linear string, flexible and lossless, by hand", format!("{:.0} ns", bare / SAMPLES), "");
    row("… over a copy of its arrays and back", times(bare, copy), "reported");
    row(
        "linear string, as stiff and lossy as the free one, by hand, over the bare one",
        times(linear, bare),
        "",
    );
    row("string that stretches, too, by hand, over the bare one", times(stretching, bare), "");
    row("free string (`wide`, stiff, lossy, stretching) over the bare one", times(free, bare), "1.5 ×");
    row("… over the linear one that is as stiff and lossy", times(free, linear), "1.5 ×");
    row("… over the one by hand that stretches", times(free, stretching), "");
    row("fretted string (a finger and two frets) over the free one", times(fretted, free), "1.9 ×");
    let scalar = times(string("free, without vectors")?, free);
    row("free string without vectors over with", scalar, "4 ×");
    let scalar = times(string("fretted, without vectors")?, fretted);
    row("fretted string without vectors over with", scalar, "4 ×");
    // Each is measured by the points it moves.
    let [few, many] = ["48 kHz", "768 kHz"].map(|rate| -> Result<(f64, f64)> {
        Ok((found.elements("points", rate)? / SAMPLES, found.fastest("points", rate)?))
    });
    let ((few, short), (many, long)) = (few?, many?);
    let name = format!("free string of {many} points over one of {few} ({:.2} times as many)", many / few);
    row(&name, times(long, short), "linear");
    let strings = |name: &str| found.fastest("strings", name);
    row("six ringing strings over one", times(strings("6")?, strings("1")?), "6 ×");
    row("six silent strings over one that rings", times(strings("6 silent")?, strings("1")?), "");
    let frets = |name: &str| found.fastest("frets", name);
    row("100 frets that nothing touches over one", times(frets("100")?, frets("1")?), "1 ×");
    Ok(text)
}

fn row(name: &str, found: &str, aim: &str) -> String {
    format!("| {name} | {found} | {aim} |\n")
}

/// The rows of the chord that buzzes.
fn buzz() -> Result<Rows> {
    let mut rows = Rows::new();
    for (hands, systems, instructions) in [
        (Hands::Fretted, "heavy buzzing chord, fretted: linear systems", "… instructions, fretted"),
        (Hands::Open, "heavy buzzing chord, open strings: linear systems", "… instructions, open strings"),
    ] {
        let times = |work: &Work| format!("{:.1} ×", work.most / work.mean);
        let [all, later] = buzz::solved(hands)?;
        let name = format!("{systems} solved for contacts, the worst sample over the mean");
        let found = format!(
            "{} ({} and {:.2}; of iterations after a start {}, {} and {:.2})",
            times(&all),
            all.most,
            all.mean,
            times(&later),
            later.most,
            later.mean
        );
        rows.push((systems, row(&name, &found, "6 ×")));
        let found = if callgrind_is_there() {
            let work = buzz::instructions(hands)?;
            format!("{} ({:.0} and {:.0})", times(&work), work.most, work.mean)
        } else {
            "not counted: valgrind is not there".into()
        };
        let name = format!("{instructions}, the worst of the {SUSPECTS} likeliest samples");
        rows.push((instructions, row(&name, &found, "6 ×")));
    }
    Ok(rows)
}

/// The row of songs.
fn songs() -> Result<(&'static str, String)> {
    let (name, found) = sharing::row()?;
    Ok((sharing::NAME, row(&name, &found, "")))
}

/// A table with these rows in the places of those that begin like them, and at its end where there are none.
fn with_rows(table: &str, rows: &Rows) -> String {
    let mut lines: Vec<String> = table.lines().map(|line| format!("{line}\n")).collect();
    for (name, row) in rows {
        match lines.iter_mut().find(|line| line.starts_with(&format!("| {name}"))) {
            Some(line) => line.clone_from(row),
            None => lines.push(row.clone()),
        }
    }
    lines.concat()
}

#[cfg(test)]
mod tests {
    use super::{row, with_rows};

    #[test]
    fn rows_are_put_in_place_of_those_before() {
        let songs = |found| vec![("songs", row("songs, 2 threads over one", found, ""))];
        let table = "| measure | found | aim |\n| free string | 1 | 2 |\n";
        let once = with_rows(table, &songs("1.5"));
        assert_eq!(once, format!("{table}| songs, 2 threads over one | 1.5 |  |\n"));
        assert_eq!(with_rows(&once, &songs("1.6")), once.replace("1.5", "1.6"));
        let free = vec![("free string", row("free string, now", "3", "4"))];
        assert_eq!(with_rows(&once, &free), once.replace("string | 1 | 2", "string, now | 3 | 4"));
    }
}
