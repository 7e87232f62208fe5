//! What a bundling command builds, as its arguments say.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

/// What cargo is asked for, and what of that decides which libraries are linked.
#[derive(Debug, PartialEq)]
pub struct Build {
    /// What is bundled.
    pub packages: Vec<String>,
    /// More arguments of cargo's, but for the platform.
    pub arguments: Vec<String>,
    /// None for that of this computer.
    pub platforms: Vec<String>,
    /// Arguments that choose features, as cargo has them.
    features: Vec<String>,
    /// The folder of the profile in the target folder.
    profile: String,
}

impl Build {
    /// Of a command and the arguments after its name, with the platform that cargo would take from the environment.
    pub fn of(command: &str, arguments: &[String], usual_platform: Option<String>) -> Result<Build> {
        let (packages, rest) = packages(command, arguments)?;
        let mut build = Build {
            packages,
            arguments: Vec::new(),
            platforms: Vec::new(),
            features: Vec::new(),
            profile: "debug".to_owned(),
        };
        let mut words = rest.iter();
        while let Some(word) = words.next() {
            let (name, value) = match word.split_once('=') {
                Some((name, value)) => (name, Some(value.to_owned())),
                None => (word.as_str(), None),
            };
            let mut value = || {
                let value = value.clone().or_else(|| words.next().cloned());
                value.with_context(|| format!("{name} names nothing"))
            };
            match name {
                "--no-default-features" | "--all-features" => build.features.push(word.clone()),
                "--features" | "-F" => build.features.extend(["--features".to_owned(), value()?]),
                // The last one counts, as it does for the framework.
                "--target" => build.platforms = vec![value()?],
                "--release" | "-r" => build.set_profile("release".to_owned()),
                "--profile" => build.set_profile(value()?),
                "--target-dir" => bail!(
                    "`{word}`: what is bundled is in cargo's usual target folder, or in that of CARGO_TARGET_DIR"
                ),
                _ => {
                    ensure!(!name.starts_with("-F"), "`{word}`: features are written `--features NAME`");
                    build.arguments.push(word.clone());
                }
            }
        }
        if command == "bundle-universal" {
            ensure!(
                build.platforms.is_empty(),
                "`--target`: bundle-universal is for both processors of macOS"
            );
            build.platforms.extend(["x86_64-apple-darwin", "aarch64-apple-darwin"].map(str::to_owned));
        }
        if build.platforms.is_empty() {
            build.platforms.extend(usual_platform);
        }
        Ok(build)
    }

    /// The same, with what the environment says.
    pub fn here(command: &str, arguments: &[String]) -> Result<Build> {
        let platform = std::env::var("CARGO_BUILD_TARGET").ok().filter(|platform| !platform.is_empty());
        Self::of(command, arguments, platform)
    }

    fn set_profile(&mut self, name: String) {
        if name == "dev" {
            // The usual one, whose folder has another name, which the framework does not know.
            return;
        }
        self.arguments.push(format!("--profile={name}"));
        self.profile = name;
    }

    /// Arguments with which the framework finds what is built for a platform.
    pub fn of_framework(&self, platform: Option<&String>) -> Vec<String> {
        let platform = platform.map(|platform| format!("--target={platform}"));
        self.arguments.iter().chain(&self.features).cloned().chain(platform).collect()
    }

    /// Builds the packages for a platform, in the folder that cargo works in.
    ///
    /// # Errors
    /// When that fails, or the libraries are elsewhere than the framework would take them from.
    pub fn run(&self, platform: Option<&String>, target: &Path) -> Result<()> {
        let packages = self.packages.iter().flat_map(|name| ["-p", name.as_str()]);
        let done = Command::new(cargo())
            .arg("build")
            .args(packages)
            .args(self.of_framework(platform))
            .arg("--message-format=json-render-diagnostics")
            .stderr(Stdio::inherit())
            .output()
            .context("cargo cannot be run")?;
        ensure!(done.status.success(), "{} cannot be built", self.packages.join(", "));
        self.find(&String::from_utf8_lossy(&done.stdout), &self.folder(platform, target))
    }

    /// Where the framework takes libraries from.
    fn folder(&self, platform: Option<&String>, target: &Path) -> PathBuf {
        let target = platform.map_or(target.to_owned(), |platform| target.join(platform));
        target.join(&self.profile)
    }

    /// Finds the libraries in the folder, as cargo tells of them: others there are older.
    fn find(&self, told: &str, folder: &Path) -> Result<()> {
        let artifacts = told.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
        let built: Vec<PathBuf> = artifacts
            .filter(|artifact| artifact["reason"] == "compiler-artifact")
            .filter(|artifact| {
                let mut kinds = artifact["target"]["kind"].as_array().into_iter().flatten();
                kinds.any(|kind| kind == "cdylib")
            })
            .flat_map(|artifact| artifact["filenames"].as_array().cloned().unwrap_or_default())
            .filter_map(|name| name.as_str().map(PathBuf::from))
            .collect();
        for package in &self.packages {
            let stem = package.replace('-', "_");
            let mut own = built.iter().filter(|path| {
                let found = path.file_stem().unwrap_or_default().to_string_lossy();
                found.strip_prefix("lib").unwrap_or(&found) == stem
            });
            let is_there = own.clone().any(|path| path.parent() == Some(folder));
            let instead = own.next().map_or("nowhere".into(), |path| path.display().to_string());
            ensure!(
                is_there,
                "{package} is built {instead}: to be bundled it must be in {}",
                folder.display()
            );
        }
        Ok(())
    }

    /// What cargo knows of the packages. (It chooses features for the whole workspace, and tests want the editor: what is
    /// built without that is said to have a few libraries too many.)
    pub fn metadata(&self) -> Result<Value> {
        self.metadata_with(&[])
    }

    /// The same with more arguments.
    ///
    /// # Errors
    /// When cargo cannot say it.
    pub fn metadata_with(&self, more: &[&str]) -> Result<Value> {
        let mut platforms = self.platforms.clone();
        if platforms.is_empty() {
            platforms.push(host()?);
        }
        let words = ["metadata", "--format-version", "1", "--locked"].into_iter().chain(more.iter().copied());
        let words = words.map(str::to_owned);
        let platforms = platforms.into_iter().flat_map(|name| ["--filter-platform".to_owned(), name]);
        let out = output(&cargo(), words.chain(platforms).chain(self.features.iter().cloned()))?;
        Ok(serde_json::from_slice(&out)?)
    }
}

/// The packages that are named before all else, and the arguments after them.
fn packages<'a>(command: &str, arguments: &'a [String]) -> Result<(Vec<String>, &'a [String])> {
    let mut packages = Vec::new();
    let mut rest = arguments;
    while let [flag, name, after @ ..] = rest
        && flag == "-p"
    {
        packages.push(name.clone());
        rest = after;
    }
    if packages.is_empty()
        && let [name, after @ ..] = rest
        && !name.starts_with('-')
    {
        packages.push(name.clone());
        rest = after;
    }
    ensure!(!packages.is_empty(), "no package is named: `cargo xtask {command} low-action --release`");
    Ok((packages, rest))
}

/// The platform of this computer.
pub fn host() -> Result<String> {
    let version = String::from_utf8(output("rustc", ["-vV".to_owned()])?)?;
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    Ok(host.context("rustc names no host")?.to_owned())
}

fn cargo() -> String {
    std::env::var("CARGO").unwrap_or_else(|_| "cargo".into())
}

/// What a program writes.
pub fn output(program: &str, arguments: impl IntoIterator<Item = String>) -> Result<Vec<u8>> {
    let done = Command::new(program).args(arguments).output();
    let done = done.with_context(|| format!("{program} cannot be run"))?;
    ensure!(done.status.success(), "{program} failed: {}", String::from_utf8_lossy(&done.stderr));
    Ok(done.stdout)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(command: &str, line: &str, usual: Option<&str>) -> Result<Build> {
        let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        Build::of(command, &words, usual.map(str::to_owned))
    }

    #[test]
    fn platform_and_features_are_those_that_are_built() {
        for (command, line, usual, platforms, features, folder, arguments) in [
            ("bundle", "low-action", None, "", "", "debug", ""),
            ("bundle", "low-action --release", None, "", "", "release", "--profile=release"),
            ("bundle", "low-action -r -v", None, "", "", "release", "--profile=release -v"),
            ("bundle", "low-action --profile slow", None, "", "", "slow", "--profile=slow"),
            ("bundle", "low-action --profile dev", None, "", "", "debug", ""),
            ("bundle", "-p low-action --profile=slow", None, "", "", "slow", "--profile=slow"),
            ("bundle", "low-action --target=one --target two", None, "two", "", "two/debug", ""),
            ("bundle", "low-action", Some("three"), "three", "", "three/debug", ""),
            ("bundle", "low-action --target one", Some("three"), "one", "", "one/debug", ""),
            (
                "bundle",
                "low-action --no-default-features -F a --features=b",
                None,
                "",
                "--no-default-features --features a --features b",
                "debug",
                "",
            ),
            (
                "bundle-universal",
                "low-action --all-features",
                Some("three"),
                "x86_64-apple-darwin aarch64-apple-darwin",
                "--all-features",
                "x86_64-apple-darwin/debug",
                "",
            ),
        ] {
            let build = of(command, line, usual).expect(line);
            assert_eq!(build.packages, ["low-action"], "{line}");
            assert_eq!(build.platforms.join(" "), platforms, "{line}");
            assert_eq!(build.features.join(" "), features, "{line}");
            assert_eq!(build.arguments.join(" "), arguments, "{line}");
            let platform = build.platforms.first();
            let found = build.folder(platform, Path::new("/target"));
            assert_eq!(found, Path::new("/target").join(folder), "{line}");
            let framework = build.of_framework(platform).join(" ");
            assert!(platform.is_none_or(|name| framework.ends_with(&format!("--target={name}"))), "{line}");
        }
        for (command, line, told) in [
            ("bundle", "low-action --target", "--target names nothing"),
            ("bundle", "low-action -Fa", "features are written"),
            ("bundle", "low-action --target-dir elsewhere", "CARGO_TARGET_DIR"),
            ("bundle", "low-action --target-dir=elsewhere", "CARGO_TARGET_DIR"),
            ("bundle", "--release", "no package is named"),
            ("bundle-universal", "low-action --target one", "both processors"),
        ] {
            let refused = of(command, line, None).expect_err(line).to_string();
            assert!(refused.contains(told), "{line}: {refused}");
        }
    }

    #[test]
    fn only_what_was_built_is_bundled() {
        let build = of("bundle", "low-action --release", None).expect("it can be read");
        let told = |folder: &str, kind: &str| {
            format!(
                "{{\"reason\":\"compiler-artifact\",\"target\":{{\"kind\":[\"{kind}\",\"rlib\"]}},\
                 \"filenames\":[\"{folder}/liblow_action.so\",\"{folder}/liblow_action.rlib\"]}}\nno more\n"
            )
        };
        let folder = Path::new("/target/release");
        assert!(build.find(&told("/target/release", "cdylib"), folder).is_ok());
        let refused =
            build.find(&told("/target/quick", "cdylib"), folder).expect_err("it is older").to_string();
        assert_eq!(
            refused,
            "low-action is built /target/quick/liblow_action.so: to be bundled it must be in /target/release"
        );
        assert!(build.find(&told("/target/release", "lib"), folder).is_err());
        assert!(build.find("", folder).is_err());
    }
}
