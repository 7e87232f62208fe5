//! Bundles of the plugin, with the notices of what is in them beside them.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::notices;

/// Hands a bundling command to the plugin framework, which reads `bundler.toml`; then puts the notices of what is in the
/// bundles beside them.
pub fn make(command: &str, arguments: &[String]) -> Result<()> {
    // What cannot be handed on is not built.
    let metadata = Build::of(command, arguments)?.metadata()?;
    let text = notices::notices(&metadata)?;
    let words = std::iter::once(command.to_owned()).chain(arguments.iter().cloned());
    nice_plug_xtask::main_with_args("cargo xtask", words)?;
    notices::write(text, &folder_of(&metadata)?)
}

/// The folder of the bundles: in cargo's target folder, wherever that has been put.
pub fn folder() -> Result<PathBuf> {
    folder_of(&Build::of("bundle", &[])?.metadata()?)
}

fn folder_of(metadata: &Value) -> Result<PathBuf> {
    let folder = metadata["target_directory"].as_str().context("cargo names no target folder")?;
    Ok(Path::new(folder).join("bundled"))
}

/// What of the arguments of a bundling command decides which libraries are linked.
#[derive(Debug, PartialEq)]
pub struct Build {
    /// None for that of this computer.
    platforms: Vec<String>,
    /// Arguments that choose features, as cargo has them.
    features: Vec<String>,
}

impl Build {
    /// Of a command and the arguments after its name.
    pub fn of(command: &str, arguments: &[String]) -> Result<Build> {
        let mut build = Build { platforms: Vec::new(), features: Vec::new() };
        if command == "bundle-universal" {
            build.platforms.extend(["x86_64-apple-darwin", "aarch64-apple-darwin"].map(str::to_owned));
        }
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            let (name, value) = match word.split_once('=') {
                Some((name, value)) => (name, Some(value.to_owned())),
                None => (word.as_str(), None),
            };
            match name {
                "--no-default-features" | "--all-features" => build.features.push(word.clone()),
                "--features" | "-F" | "--target" => {
                    let value = value.or_else(|| words.next().cloned());
                    let value = value.with_context(|| format!("{name} names nothing"))?;
                    match name {
                        // The last one counts, as it does for the framework.
                        "--target" => build.platforms = vec![value],
                        _ => build.features.extend(["--features".to_owned(), value]),
                    }
                }
                _ => ensure!(!name.starts_with("-F"), "`{word}`: features are written `--features NAME`"),
            }
        }
        Ok(build)
    }

    /// What cargo knows of the packages. (It chooses features for the whole workspace, and tests want the editor: what is
    /// built without that is said to have a few libraries too many.)
    pub fn metadata(&self) -> Result<Value> {
        let mut platforms = self.platforms.clone();
        if platforms.is_empty() {
            let version = String::from_utf8(run("rustc", ["-vV".to_owned()])?)?;
            let host = version.lines().find_map(|line| line.strip_prefix("host: "));
            platforms.push(host.context("rustc names no host")?.to_owned());
        }
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        let words = ["metadata", "--format-version", "1", "--locked"].map(str::to_owned).into_iter();
        let platforms = platforms.into_iter().flat_map(|name| ["--filter-platform".to_owned(), name]);
        let out = run(&cargo, words.chain(platforms).chain(self.features.iter().cloned()))?;
        Ok(serde_json::from_slice(&out)?)
    }
}

/// What a program writes.
fn run(program: &str, arguments: impl IntoIterator<Item = String>) -> Result<Vec<u8>> {
    let done = Command::new(program).args(arguments).output();
    let done = done.with_context(|| format!("{program} cannot be run"))?;
    ensure!(done.status.success(), "{program} failed: {}", String::from_utf8_lossy(&done.stderr));
    Ok(done.stdout)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::json;

    use super::{Build, folder_of};

    #[test]
    fn bundles_are_where_cargo_builds() {
        let metadata = json!({ "target_directory": "/elsewhere" });
        let folder = folder_of(&metadata).expect("it is named");
        assert_eq!(folder, Path::new("/elsewhere/bundled"));
        assert!(folder_of(&json!({})).is_err());
    }

    #[test]
    fn platform_and_features_are_those_that_are_built() {
        let of = |command: &str, line: &str| {
            let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
            Build::of(command, &words)
                .map(|Build { platforms, features }| (platforms.join(" "), features.join(" ")))
        };
        let is = |found: anyhow::Result<(String, String)>, platforms: &str, features: &str| {
            assert_eq!(found.expect("it can be read"), (platforms.into(), features.into()));
        };
        is(of("bundle", "low-action --release"), "", "");
        is(of("bundle", "low-action --target=one --target two"), "two", "");
        is(
            of("bundle", "low-action --no-default-features -F a --features=b"),
            "",
            "--no-default-features --features a --features b",
        );
        is(
            of("bundle-universal", "low-action --all-features"),
            "x86_64-apple-darwin aarch64-apple-darwin",
            "--all-features",
        );
        assert!(of("bundle", "low-action --target").is_err());
        assert!(of("bundle", "low-action -Fa").is_err());
    }
}
