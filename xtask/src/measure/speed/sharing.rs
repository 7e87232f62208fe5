//! How much sooner `low-action render` is done where threads share the strings.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, ensure};

use crate::repository::root;

/// What is rendered, and as what it is meant to be heard (`docs/gestures.md`).
const PIECES: [(&str, &[&str]); 5] = [
    ("fingerpicking", &["--instrument", "classical"]),
    ("strumming", &["--instrument", "steel"]),
    ("bass_line", &["--instrument", "bass"]),
    ("fast_run", &[]),
    ("midi_guitar", &["--input", "strings"]),
];

/// How often each is rendered; the fastest counts. In rounds, so that whatever else the machine does for a while does not fall
/// on one piece alone.
const ROUNDS: usize = 3;

/// The name of the row, whatever the number of threads.
pub const NAME: &str = "songs of `docs/pieces` by `low-action render`";

/// Processors that can share strings, and no more than threads that can.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from).min(64)
}

/// The row of the table: its name, and how many times as soon as by one thread the pieces are done by as many as there are
/// processors.
pub fn row() -> Result<(String, String)> {
    let threads = processors();
    if threads == 1 {
        return Ok((format!("{NAME}, several threads over one"), "not timed: one processor".into()));
    }
    let program = build()?;
    let folder = root().join("target").join("measure");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let mut fastest = [[f64::INFINITY; 2]; PIECES.len()];
    for round in 1..=ROUNDS {
        eprintln!("songs: {round} of {ROUNDS}");
        for ((name, options), fastest) in PIECES.iter().zip(&mut fastest) {
            let song = root().join("docs/pieces").join(name).with_extension("mid");
            let sounds = ["one.wav", "shared.wav"].map(|name| folder.join(name));
            for ((threads, sound), fastest) in [1, threads].into_iter().zip(&sounds).zip(fastest) {
                *fastest = fastest.min(render(&program, &song, options, threads, sound)?);
            }
            let [one, shared] = sounds.map(fs::read);
            ensure!(one? == shared?, "{name} sounds another way by {threads} threads than by one");
        }
    }
    let gains = fastest.map(|[one, shared]| one / shared);
    Ok((format!("{NAME}, {threads} threads over one"), found(&gains)))
}

/// The least and the most that is gained.
fn found(gains: &[f64]) -> String {
    let least = gains.iter().copied().fold(f64::INFINITY, f64::min);
    let most = gains.iter().copied().fold(0.0, f64::max);
    format!("{least:.1} to {most:.1} × as soon")
}

/// Builds the program as it is delivered, and returns where it is.
fn build() -> Result<PathBuf> {
    let out = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["build", "--release", "--package", "low-action", "--message-format=json-render-diagnostics"])
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .context("cargo cannot be run")?;
    ensure!(out.status.success(), "low-action cannot be built");
    let text = String::from_utf8_lossy(&out.stdout);
    let messages = text.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let mut programs = messages.filter_map(|message| message["executable"].as_str().map(PathBuf::from));
    programs.next_back().context("cargo does not say where low-action is")
}

/// Renders a song; how long that took, s.
fn render(program: &Path, song: &Path, options: &[&str], threads: usize, sound: &Path) -> Result<f64> {
    let started = Instant::now();
    let out = Command::new(program)
        .arg("render")
        .arg(song)
        .args(options)
        .args(["--threads", &threads.to_string(), "--output"].map(OsStr::new))
        .arg(sound)
        .output()
        .context("low-action cannot be run")?;
    let taken = started.elapsed().as_secs_f64();
    ensure!(out.status.success(), "low-action render: {}", String::from_utf8_lossy(&out.stderr).trim());
    Ok(taken)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{PIECES, found};
    use crate::repository::root;

    #[test]
    fn every_piece_is_timed() {
        let there: BTreeSet<String> = std::fs::read_dir(root().join("docs/pieces"))
            .expect("the folder is there")
            .map(|entry| entry.expect("it can be listed").file_name().into_string().expect("it is text"))
            .collect();
        let timed: BTreeSet<String> = PIECES.iter().map(|(name, _)| format!("{name}.mid")).collect();
        assert_eq!(timed, there);
    }

    #[test]
    fn the_least_and_the_most_are_told() {
        assert_eq!(found(&[1.62, 1.41, 1.84]), "1.4 to 1.8 × as soon");
    }
}
