//! What the licences of the libraries inside a bundle ask to be handed on with it: their names and texts, in one file.

mod kept;
mod rust;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde_json::Value;
use xtask::files;

/// Name of the file, beside the bundles.
const FILE: &str = "THIRD-PARTY.txt";

/// What is bundled.
pub const BUNDLED: &str = "low-action";

/// Our own licences.
const OURS: [&str; 2] = [include_str!("../../LICENSE-MIT"), include_str!("../../LICENSE-APACHE")];

/// What stands in names of files that hold a licence, in any case, and how others begin; fonts have theirs one folder down.
const WITHIN: [&str; 4] = ["license", "licence", "copying", "copyright"];
const BEGINNINGS: [&str; 3] = ["notice", "ofl", "ufl"];

/// Files of fonts. What is written beside one, under its name, is whose it is.
const FONTS: [&str; 2] = ["ttf", "otf"];

/// Writes the notices of everything that is linked into the plugin, beside its bundles.
pub fn write(text: String, folder: &Path) -> Result<()> {
    let path = folder.join(FILE);
    files::write(&path, text)?;
    eprintln!("Created '{}'", path.display());
    Ok(())
}

/// A list of the libraries, with Rust's own, then each text once, under the names of those that come with it, and ours.
///
/// # Errors
/// When one of them ships no text, and none is kept for it.
pub fn notices(metadata: &Value) -> Result<String> {
    list(metadata, &rust::library()?)
}

fn list(metadata: &Value, library: &rust::Library) -> Result<String> {
    let linked = linked(metadata)?;
    let word = |package: &Value, key: &str| package[key].as_str().unwrap_or_default().to_owned();
    let mut list = vec![format!("{}: MIT OR Apache-2.0, https://github.com/rust-lang/rust\n", library.name)];
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    texts.insert(library.text.clone(), vec![library.name.clone()]);
    for text in OURS {
        texts.entry(text.to_owned()).or_default().push("Low Action".to_owned());
    }
    for package in metadata["packages"].as_array().context("cargo lists no packages")? {
        // What is ours has no source of its own.
        if !linked.contains(&word(package, "id")) || package["source"].is_null() {
            continue;
        }
        let name = format!("{} {}", word(package, "name"), word(package, "version"));
        list.push(format!("{name}: {}, {}\n", word(package, "license"), word(package, "repository")));
        let manifest = PathBuf::from(word(package, "manifest_path"));
        let mut shipped = licences(manifest.parent().context("a package without a folder")?)?;
        if shipped.is_empty() {
            let (package, licence) = (word(package, "name"), word(package, "license"));
            shipped.extend(kept::text(&package, &licence));
            ensure!(
                !shipped.is_empty(),
                "{name} ships no text of its licence, {licence}: say in xtask/src/notices/kept.rs whose it is"
            );
        }
        for text in shipped {
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
    files.retain(|path| path.is_file() && is_licence(path));
    // What is no text is none that can be read.
    let texts = files.iter().filter_map(|path| fs::read_to_string(path).ok());
    Ok(texts.filter(|text| !text.trim().is_empty()).collect())
}

/// Whether a file holds a licence, by its name.
fn is_licence(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let is_named = WITHIN.iter().any(|words| name.contains(words))
        || BEGINNINGS.iter().any(|beginning| name.starts_with(beginning));
    let is_of_font = name.ends_with(".txt") && FONTS.iter().any(|font| path.with_extension(font).is_file());
    !name.ends_with(".rs") && (is_named || is_of_font)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use serde_json::json;

    use super::rust::Library;
    use super::{is_licence, list, notices};
    use crate::bundles::{Build, host};

    /// Names in the list, and in the lines above texts.
    fn named(text: &str) -> (Vec<&str>, Vec<&str>) {
        let line = "=".repeat(80);
        let mut parts = text.split(&line);
        let list =
            parts.next().expect("there is a list").lines().skip(2).filter_map(|line| line.split_once(": "));
        let list = list.map(|(name, _)| name).collect();
        let above = parts.filter_map(|part| part.trim_start().split_once(":\n"));
        (list, above.flat_map(|(names, _)| names.split(", ")).collect())
    }

    fn rust() -> Library {
        Library { name: "std 1.2.3".into(), text: "As Rust likes.".into() }
    }

    /// What cargo knows of a platform, without the network where that may be: crates of others' need not be here. That of this
    /// computer must, and under CI=true all.
    fn known(platform: &str) -> Option<serde_json::Value> {
        let words = ["low-action", "--target", platform, "--all-features"].map(str::to_owned);
        let build = Build::of("bundle", &words, None).expect("it can be read");
        let is_needed =
            std::env::var("CI").is_ok_and(|ci| ci == "true") || host().is_ok_and(|host| host == platform);
        match build.metadata_with(if is_needed { &[] } else { &["--offline"] }) {
            Ok(metadata) => Some(metadata),
            Err(error) if is_needed => panic!("{error:#}"),
            Err(_) => {
                println!("passed over: libraries of {platform} are not here, and are not got for this");
                None
            }
        }
    }

    /// Fonts and sound files are under licences that ask for their texts, and most others are.
    #[test]
    fn what_is_linked_stands_above_the_text_of_its_licence() {
        for platform in [
            "x86_64-unknown-linux-gnu",
            "aarch64-unknown-linux-gnu",
            "x86_64-pc-windows-msvc",
            "x86_64-apple-darwin",
            "aarch64-apple-darwin",
        ] {
            let Some(metadata) = known(platform) else { continue };
            let text = notices(&metadata).expect("there is a text for each");
            let (list, above) = named(&text);
            assert!(list.len() > 200, "{} on {platform}", list.len());
            for name in &list {
                assert!(above.contains(name), "{name} has no text on {platform}");
            }
            for name in ["hound ", "nice-plug ", "egui ", "std "] {
                assert!(
                    list.iter().any(|listed| listed.starts_with(name)),
                    "{name} is missing on {platform}"
                );
            }
            assert_eq!(above.iter().filter(|&&name| name == "Low Action").count(), 2, "both of ours");
            for words in [
                "SIL OPEN FONT LICENSE",
                "Apache License",
                "Robbert van der Helm",
                // Fonts of the editor.
                "Source Foundry Authors",
                "BITSTREAM VERA LICENSE",
                "John Slegers",
                "The Rust Project Developers",
            ] {
                assert!(text.contains(words), "{words} is missing on {platform}");
            }
            assert!(!text.contains("\nproptest "), "what only tests use is not bundled");
        }
    }

    #[test]
    fn licences_are_known_by_their_files() {
        let folder = std::env::temp_dir().join(format!("low-action-licences-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("it can be made");
        fs::write(folder.join("Hack.ttf"), "a font").expect("it can be written");
        for (name, expected) in [
            ("LICENSE", true),
            ("UNLICENSE", true),
            ("emoji-mit-license.txt", true),
            ("OFL.txt", true),
            ("Hack.txt", true),
            ("Other.txt", false),
            ("license.rs", false),
        ] {
            assert_eq!(is_licence(&folder.join(name)), expected, "{name}");
        }
        fs::remove_dir_all(&folder).expect("it is there");
    }

    #[test]
    fn a_library_without_a_text_is_refused() {
        let folder = std::env::temp_dir().join(format!("low-action-notices-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("it can be made");
        let package = |name: &str, source| {
            json!({
                "name": name, "id": name, "source": source, "version": "1.0.0", "license": "MIT",
                "repository": "", "manifest_path": folder.join("Cargo.toml"),
            })
        };
        let metadata = json!({
            "packages": [package("low-action", json!(null)), package("nobody", json!("registry"))],
            "resolve": { "nodes": [
                { "id": "low-action", "deps": [{ "pkg": "nobody", "dep_kinds": [{ "kind": null }] }] },
                { "id": "nobody", "deps": [] },
            ] },
        });
        let refused = list(&metadata, &rust()).expect_err("it has no text").to_string();
        assert!(refused.contains("nobody 1.0.0") && refused.contains("MIT"), "{refused}");
        // An empty file is no text.
        fs::write(folder.join("LICENSE"), "\n").expect("it can be written");
        assert!(list(&metadata, &rust()).is_err());
        fs::write(folder.join("LICENSE"), "As you like.").expect("it can be written");
        let text = list(&metadata, &rust()).expect("there is one now");
        let (list, mut above) = named(&text);
        above.sort_unstable();
        assert_eq!(list, ["nobody 1.0.0", "std 1.2.3"]);
        assert_eq!(above, ["Low Action", "Low Action", "nobody 1.0.0", "std 1.2.3"]);
        fs::remove_dir_all(&folder).expect("it is there");
    }
}
