//! Python hosts in an environment of their own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use super::compare::Sound;
use crate::bundles::output;

/// The packages, each at one version.
const REQUIREMENTS: &str = include_str!("requirements.txt");

/// A Python with the hosts installed.
pub(super) struct Python {
    program: PathBuf,
}

/// Makes the environment under a folder, or finds it there.
pub(super) fn environment(folder: &Path) -> Result<Python> {
    let environment = folder.join("venv");
    let program = environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let stamp = environment.join("installed.txt");
    let system = if cfg!(windows) { "python" } else { "python3" };
    let version = String::from_utf8_lossy(&output(system, ["--version".to_owned()])?).into_owned();
    let contents = contents(&version);
    if is_made_of(&stamp, &contents) {
        return Ok(Python { program });
    }
    checked(Command::new(system).args(["-m", "venv", "--clear"]).arg(&environment))?;
    let list = folder.join("requirements.txt");
    fs::write(&list, REQUIREMENTS)?;
    checked(
        Command::new(&program)
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"])
            .arg(&list),
    )?;
    fs::write(&stamp, contents)?;
    Ok(Python { program })
}

/// What an environment is made of. It runs the system's Python, and what is installed is for one version of that.
fn contents(version: &str) -> String {
    format!("{}\n{REQUIREMENTS}", version.trim())
}

/// Whether one has been made of that, as it says itself.
fn is_made_of(stamp: &Path, contents: &str) -> bool {
    fs::read_to_string(stamp).is_ok_and(|installed| installed == contents)
}

impl Python {
    /// Has a host play clips of a folder through the plugin, one after the other.
    pub(super) fn play(
        &self,
        host: &str,
        plugin: &Path,
        folder: &Path,
        clips: &[&str],
        rate: u32,
        seconds: u32,
    ) -> Result<Vec<Sound>> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/hosts").join(format!("{host}_host.py"));
        let mut command = Command::new(&self.program);
        command.arg(script).arg(plugin).args([rate.to_string(), seconds.to_string()]);
        let sound = |clip: &str| folder.join(format!("{host}_{clip}.f32"));
        for clip in clips {
            // What an earlier run left must not be taken for this one's.
            fs::remove_file(sound(clip)).ok();
            command.arg(folder.join(clip).with_extension("mid")).arg(sound(clip));
        }
        checked(&mut command)?;
        clips.iter().map(|clip| Sound::from_raw(&sound(clip), (rate * seconds) as usize)).collect()
    }
}

/// Runs a command that must succeed.
fn checked(command: &mut Command) -> Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command.status().with_context(|| format!("cannot run {name}"))?;
    if !status.success() {
        bail!("{name} ended with {status}");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_python_makes_another_environment() {
        let stamp = std::env::temp_dir().join(format!("low-action-python-{}.txt", std::process::id()));
        let made_of = contents("Python 3.11.2\n");
        assert!(!is_made_of(&stamp, &made_of), "there is none");
        fs::write(&stamp, &made_of).expect("it can be written");
        assert!(is_made_of(&stamp, &contents("Python 3.11.2")));
        assert!(!is_made_of(&stamp, &contents("Python 3.13.1")));
        fs::write(&stamp, REQUIREMENTS).expect("it can be written");
        assert!(!is_made_of(&stamp, &made_of), "it does not say of which");
        fs::remove_file(&stamp).expect("it is there");
    }
}
