//! What the licences of the libraries inside a bundle ask to be handed on with it: their names and texts, in one file.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

/// Name of the file, beside the bundles.
const FILE: &str = "THIRD-PARTY.txt";

/// What is bundled.
const BUNDLED: &str = "low-action";

/// How names of files begin that hold a licence, in any case; fonts have theirs one folder down.
const BEGINNINGS: [&str; 7] = ["license", "licence", "copying", "copyright", "notice", "ofl", "ufl"];

/// Writes the notices of everything that is linked into the plugin, beside its bundles.
pub fn write() -> Result<()> {
    let metadata = metadata()?;
    let path = bundles_of(&metadata)?.join(FILE);
    let text = notices(&metadata)?;
    fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
    eprintln!("Created '{}'", path.display());
    Ok(())
}

/// The folder of the bundles: in cargo's target folder, wherever that has been put.
pub fn bundles() -> Result<PathBuf> {
    bundles_of(&metadata()?)
}

fn bundles_of(metadata: &Value) -> Result<PathBuf> {
    let folder = metadata["target_directory"].as_str().context("cargo names no target folder")?;
    Ok(Path::new(folder).join("bundled"))
}

/// What cargo knows of the packages, for this platform.
fn metadata() -> Result<Value> {
    let run = |program: &str, arguments: &[&str]| -> Result<Vec<u8>> {
        let done = Command::new(program).args(arguments).output();
        let done = done.with_context(|| format!("{program} cannot be run"))?;
        ensure!(done.status.success(), "{program} failed: {}", String::from_utf8_lossy(&done.stderr));
        Ok(done.stdout)
    };
    let version = String::from_utf8(run("rustc", &["-vV"])?)?;
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).context("rustc names no host")?;
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let out = run(&cargo, &["metadata", "--format-version", "1", "--locked", "--filter-platform", host])?;
    Ok(serde_json::from_slice(&out)?)
}

/// A list of the libraries, then each text once, under the names of those that come with it.
fn notices(metadata: &Value) -> Result<String> {
    let linked = linked(metadata)?;
    let word = |package: &Value, key: &str| package[key].as_str().unwrap_or_default().to_owned();
    let mut list = Vec::new();
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in metadata["packages"].as_array().context("cargo lists no packages")? {
        // What is ours has no source of its own.
        if !linked.contains(&word(package, "id")) || package["source"].is_null() {
            continue;
        }
        let name = format!("{} {}", word(package, "name"), word(package, "version"));
        list.push(format!("{name}: {}, {}\n", word(package, "license"), word(package, "repository")));
        let manifest = PathBuf::from(word(package, "manifest_path"));
        for text in licences(manifest.parent().context("a package without a folder")?)? {
            let names = texts.entry(text).or_default();
            if names.last() != Some(&name) {
                names.push(name.clone());
            }
        }
    }
    list.sort();
    let mut text = format!(
        "Low Action is licensed under MIT OR Apache-2.0. It holds these libraries, each under its own licence:\n\n{}",
        list.concat()
    );
    for (licence, names) in texts {
        text += &format!("\n{}\n{}:\n\n{}\n", "=".repeat(80), names.join(", "), licence.trim());
    }
    Ok(text)
}

/// Identifiers of all packages that the plugin is linked with; not those of its tests and its build.
fn linked(metadata: &Value) -> Result<BTreeSet<String>> {
    let nodes = metadata["resolve"]["nodes"].as_array().context("cargo resolves nothing")?;
    let packages = metadata["packages"].as_array().context("cargo lists no packages")?;
    let plugin =
        packages.iter().find(|package| package["name"] == BUNDLED).context("the plugin is not there")?;
    let mut found = BTreeSet::new();
    let mut open = vec![plugin["id"].as_str().unwrap_or_default().to_owned()];
    while let Some(id) = open.pop() {
        if !found.insert(id.clone()) {
            continue;
        }
        let node =
            nodes.iter().find(|node| node["id"] == id.as_str()).context("a package is not resolved")?;
        for dependency in node["deps"].as_array().into_iter().flatten() {
            let mut kinds = dependency["dep_kinds"].as_array().into_iter().flatten();
            if kinds.any(|kind| kind["kind"].is_null()) {
                open.push(dependency["pkg"].as_str().unwrap_or_default().to_owned());
            }
        }
    }
    Ok(found)
}

/// The texts of licences in a folder and those directly below.
fn licences(folder: &Path) -> Result<Vec<String>> {
    let entries = |folder: &Path| -> Result<Vec<PathBuf>> {
        let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
        let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?;
        paths.sort();
        Ok(paths)
    };
    let mut files = Vec::new();
    for path in entries(folder)? {
        if path.is_dir() { files.extend(entries(&path)?) } else { files.push(path) }
    }
    let is_licence = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        path.is_file()
            && !name.ends_with(".rs")
            && BEGINNINGS.iter().any(|beginning| name.starts_with(beginning))
    };
    files.retain(is_licence);
    // What is no text is none that can be read.
    Ok(files.iter().filter_map(|path| fs::read_to_string(path).ok()).collect())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::json;

    use super::{bundles_of, metadata, notices};

    #[test]
    fn bundles_are_where_cargo_builds() {
        let metadata = json!({ "target_directory": "/elsewhere" });
        let folder = bundles_of(&metadata).expect("it is named");
        assert_eq!(folder, Path::new("/elsewhere/bundled"));
        assert!(bundles_of(&json!({})).is_err());
    }

    /// Fonts and sound files are under licences that ask for their texts.
    #[test]
    fn what_is_linked_is_named_with_its_licence() {
        let text = notices(&metadata().expect("cargo is there")).expect("all packages are there");
        for words in ["\nhound ", "\nnice-plug ", "\negui ", "SIL OPEN FONT LICENSE", "Apache License"] {
            assert!(text.contains(words), "{words} is missing");
        }
        assert!(!text.contains("\nproptest "), "what only tests use is not bundled");
    }
}
