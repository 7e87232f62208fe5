//! Bundles of the plugin, with the notices of what is in them beside them.

mod build;
mod property_list;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::Value;
use xtask::{files, repository};

#[cfg(test)]
pub use build::host;
pub use build::{Build, output};

use crate::notices;

/// Builds, has the plugin framework, which reads `bundler.toml`, lay the bundles out, and puts the notices of what is in them
/// beside them.
pub fn make(command: &str, arguments: &[String]) -> Result<()> {
    // The framework reads its file where it works; by itself it would work in the outermost folder that looks like cargo's.
    let root = repository::root();
    std::env::set_current_dir(&root).with_context(|| format!("cannot work in {}", root.display()))?;
    // What cannot be handed on is not built.
    let build = Build::here(command, arguments)?;
    let metadata = build.metadata()?;
    let text = notices::notices(&metadata)?;
    let target = target(&metadata)?;
    let is_universal = build.platforms.len() > 1;
    if build.platforms.is_empty() {
        build.run(None, &target)?;
    }
    for platform in &build.platforms {
        build.run(Some(platform), &target)?;
    }
    let platform = build.platforms.first().filter(|_| !is_universal);
    for package in &build.packages {
        nice_plug_xtask::bundle(&target, package, &build.of_framework(platform), is_universal)?;
    }
    let folder = folder_of(&metadata)?;
    let for_macos = match platform {
        Some(platform) => platform.ends_with("-apple-darwin"),
        None => cfg!(target_os = "macos"),
    };
    if for_macos {
        property_list::tell(&folder)?;
    }
    notices::write(text, &folder)
}

/// Writes the notices of what is linked with some features to a file, for a program that is handed on by itself.
pub fn write_notices(arguments: &[String]) -> Result<()> {
    let file = arguments.last().filter(|file| !file.starts_with('-'));
    let (file, options) = file
        .zip(arguments.get(..arguments.len().saturating_sub(1)))
        .context("no file is named: `cargo xtask notices --features standalone THIRD-PARTY.txt`")?;
    let words: Vec<String> = [notices::BUNDLED.to_owned()].into_iter().chain(options.to_vec()).collect();
    let text = notices::notices(&Build::here("notices", &words)?.metadata()?)?;
    files::write(Path::new(file), text)
}

/// The folder of the bundles: in cargo's target folder, wherever that has been put.
pub fn folder() -> Result<PathBuf> {
    folder_of(&Build::here("bundle", &[notices::BUNDLED.to_owned()])?.metadata()?)
}

fn target(metadata: &Value) -> Result<PathBuf> {
    Ok(metadata["target_directory"].as_str().context("cargo names no target folder")?.into())
}

fn folder_of(metadata: &Value) -> Result<PathBuf> {
    Ok(target(metadata)?.join("bundled"))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::json;

    use super::{folder_of, write_notices};

    #[test]
    fn bundles_are_where_cargo_builds() {
        let metadata = json!({ "target_directory": "/elsewhere" });
        let folder = folder_of(&metadata).expect("it is named");
        assert_eq!(folder, Path::new("/elsewhere/bundled"));
        assert!(folder_of(&json!({})).is_err());
    }

    /// The stand-alone program is linked with what opens devices, too.
    #[test]
    fn notices_of_a_program_are_written_to_a_file() {
        let file = std::env::temp_dir().join(format!("low-action-notices-{}.txt", std::process::id()));
        let written = |options: &[&str]| {
            let name = file.to_str().expect("it can be written");
            let words: Vec<String> = options.iter().chain(&[name]).map(|&word| word.to_owned()).collect();
            write_notices(&words).expect("it can be written");
            std::fs::read_to_string(&file).expect("it is there")
        };
        let [plugin, program] = [written(&[]), written(&["--features", "low-action/standalone"])];
        assert!(plugin.contains("\nhound ") && !plugin.contains("\ncpal "));
        assert!(program.contains("\nhound ") && program.contains("\ncpal "));
        std::fs::remove_file(&file).expect("it is there");
        for words in [&[][..], &["--all-features"], &["--features", "standalone"]] {
            let words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
            assert!(write_notices(&words).is_err(), "{words:?}");
        }
    }
}
