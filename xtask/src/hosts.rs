//! `cargo xtask hosts`: the VST3 bundle played by hosts that others wrote.
//!
//! DawDreamer and pedalboard (Python packages, pinned, in a virtual environment made under `target`) play a
//! clip through the bundle. The sound must be that of `low-action render --quality studio`, sample for sample, to 1e-4 of its size: pitch, onset
//! and level then agree far below what is heard. As a whole it may be late by the latency that the plugin tells, for which these
//! hosts do not make up. So that this can fail, the same hosts then play the clip with a note taken away, and that must not pass; and
//! the clip once more, which must, so that it was for the note.
//!
//! Where Python or the packages cannot be had the command says so and passes over them; under `CI=true`
//! that is a failure.

mod clip;
mod compare;
mod python;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use xtask::repository::root;

use crate::bundles;

use compare::{Comparison, Sound};

/// Hz, at which everything is played; a tick of the clip is a whole number of samples there.
const RATE: u32 = 48_000;
/// Length of what is compared, s: the clip, which is over after half of it, and its tail.
const SECONDS: u32 = 5;
/// Largest relative RMS difference from the rendering: 80 dB below the sound.
const TOLERANCE: f64 = 1e-4;

/// Hosts, by the name of their script.
const HOSTS: [&str; 2] = ["dawdreamer", "pedalboard"];

/// Runs the command.
pub fn run(arguments: &[String]) -> Result<()> {
    let hosts: Vec<&str> = match arguments {
        [] => HOSTS.to_vec(),
        named => named.iter().map(|name| known(name)).collect::<Result<_>>()?,
    };
    let folder = root().join("target/hosts");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let python = match python::environment(&folder) {
        Ok(python) => python,
        Err(error) if std::env::var("CI").as_deref() == Ok("true") => {
            return Err(error.context("the hosts cannot be had, and under CI=true they must"));
        }
        Err(error) => {
            eprintln!("passed over: the hosts cannot be had: {error:#}");
            return Ok(());
        }
    };
    let plugin = bundle()?;
    for (name, without) in CLIPS {
        fs::write(folder.join(name).with_extension("mid"), clip::midi(without))?;
    }
    // Both say that they render offline before they begin, and the plugin must have heard it.
    let rendered = render(&folder, "clip", "studio")?;
    for host in hosts {
        // Loading the plugin takes pedalboard half a minute, so one run plays all.
        let played = python.play(host, &plugin, &folder, &CLIPS.map(|(name, _)| name), RATE, SECONDS)?;
        for ((name, without), sound) in CLIPS.into_iter().zip(&played) {
            let comparison = compare::compare(&rendered, sound);
            println!("{host}, {name}: {comparison}");
            judge(&comparison, without.is_some()).with_context(|| format!("{host}, {name}"))?;
        }
    }
    Ok(())
}

/// What hosts play, in this order: files, and the key whose notes are taken away.
const CLIPS: [(&str, Option<u8>); 3] =
    [("clip", None), ("without_a_note", Some(clip::TAKEN_AWAY)), ("clip_again", None)];

/// Refuses a clip that is not played as it is rendered, and one that is although a note was taken away.
fn judge(comparison: &Comparison, lacks_a_note: bool) -> Result<()> {
    match (comparison.accept(TOLERANCE), lacks_a_note) {
        (Err(error), false) => Err(error.context("it is not what is rendered")),
        (Ok(()), true) => bail!("a note was taken away and nobody noticed"),
        _ => Ok(()),
    }
}

fn known(name: &str) -> Result<&'static str> {
    let found = HOSTS.into_iter().find(|host| *host == name);
    found.with_context(|| format!("unknown host {name:?}: there are {}", HOSTS.join(" and ")))
}

/// Builds the VST3 bundle.
fn bundle() -> Result<PathBuf> {
    bundles::make("bundle", &["low-action", "--release"].map(str::to_owned))?;
    Ok(bundles::folder()?.join("Low Action.vst3"))
}

/// Renders a clip with the command line.
fn render(folder: &Path, clip: &str, quality: &str) -> Result<Sound> {
    let (song, sound) = (folder.join(clip).with_extension("mid"), folder.join("rendered.wav"));
    let status = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(root())
        .args(["run", "--release", "--quiet", "-p", "low-action", "--", "render"])
        .arg(&song)
        .arg("--output")
        .arg(&sound)
        .args(["--quality", quality])
        .args(["--sample-rate", &RATE.to_string(), "--bit-depth", "32f", "--tail", &SECONDS.to_string()])
        .status()?;
    if !status.success() {
        bail!("low-action render ended with {status}");
    }
    Sound::from_wav(&sound, (RATE * SECONDS) as usize)
}
