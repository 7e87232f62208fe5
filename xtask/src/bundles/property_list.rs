//! What macOS is told of a bundle. The framework gives all of them its own name and the version 1.0.0.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// The plugin's own identifier, under which hosts know the CLAP, too.
const IDENTIFIER: &str = "io.github.low-action.low-action";
/// Kinds of bundles.
const KINDS: [&str; 2] = ["clap", "vst3"];

/// Tells macOS what the bundles in a folder are, and signs them anew.
///
/// # Errors
/// When one cannot be written or signed.
pub fn tell(folder: &Path) -> Result<()> {
    for (bundle, kind) in bundles(folder)? {
        let name = bundle.file_stem().unwrap_or_default().to_string_lossy();
        let path = bundle.join("Contents/Info.plist");
        let text = text(&name, kind, env!("CARGO_PKG_VERSION"));
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
        sign(&bundle)?;
    }
    Ok(())
}

/// Those that are of macOS.
fn bundles(folder: &Path) -> Result<Vec<(PathBuf, &'static str)>> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut found = Vec::new();
    for entry in entries {
        let path = entry?.path();
        let kind = KINDS.into_iter().find(|kind| path.extension().is_some_and(|ending| ending == *kind));
        found.extend(kind.filter(|_| path.join("Contents/Info.plist").is_file()).map(|kind| (path, kind)));
    }
    Ok(found)
}

/// Signs a bundle for this computer, as the framework has done before it was changed. Other systems cannot.
fn sign(bundle: &Path) -> Result<()> {
    if !cfg!(target_os = "macos") {
        eprintln!("{} is not signed: only macOS can", bundle.display());
        return Ok(());
    }
    let status = Command::new("codesign").args(["-f", "-s", "-"]).arg(bundle).status();
    let status = status.context("codesign cannot be run")?;
    ensure!(status.success(), "codesign failed: {} is not signed", bundle.display());
    Ok(())
}

fn text(name: &str, kind: &str, version: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE plist PUBLIC "-//Apple//DTD PLIST 1.0//EN" "http://www.apple.com/DTDs/PropertyList-1.0.dtd">
<plist version="1.0">
  <dict>
    <key>CFBundleExecutable</key>
    <string>{name}</string>
    <key>CFBundleIdentifier</key>
    <string>{IDENTIFIER}.{kind}</string>
    <key>CFBundleName</key>
    <string>{name}</string>
    <key>CFBundleDisplayName</key>
    <string>{name}</string>
    <key>CFBundlePackageType</key>
    <string>BNDL</string>
    <key>CFBundleSignature</key>
    <string>????</string>
    <key>CFBundleShortVersionString</key>
    <string>{version}</string>
    <key>CFBundleVersion</key>
    <string>{version}</string>
    <key>NSHighResolutionCapable</key>
    <true/>
  </dict>
</plist>
"#
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys and what they are, in their order.
    fn entries(text: &str) -> Vec<(&str, &str)> {
        let keys = text.split("<key>").skip(1);
        keys.filter_map(|entry| {
            let (key, rest) = entry.split_once("</key>")?;
            Some((key, rest.trim().strip_prefix("<string>").unwrap_or(rest).split('<').next()?.trim()))
        })
        .collect()
    }

    #[test]
    fn bundles_have_our_name_and_version() {
        let text = text("Low Action", "vst3", "1.2.3");
        let entries = entries(&text);
        for (key, expected) in [
            ("CFBundleExecutable", "Low Action"),
            ("CFBundleIdentifier", "io.github.low-action.low-action.vst3"),
            ("CFBundlePackageType", "BNDL"),
            ("CFBundleShortVersionString", "1.2.3"),
            ("CFBundleVersion", "1.2.3"),
        ] {
            assert!(entries.contains(&(key, expected)), "{key}: {entries:?}");
        }
    }

    #[test]
    fn only_what_macos_reads_is_told() {
        let folder = std::env::temp_dir().join(format!("low-action-bundles-{}", std::process::id()));
        for inside in ["Low Action.vst3/Contents", "Other.vst3/Contents/x86_64-linux", "Low Action.component"]
        {
            fs::create_dir_all(folder.join(inside)).expect("it can be made");
        }
        fs::write(folder.join("Low Action.vst3/Contents/Info.plist"), "1.0.0").expect("it can be written");
        fs::write(folder.join("Low Action.clap"), "a library").expect("it can be written");
        let found = bundles(&folder).expect("it is there");
        assert_eq!(found, [(folder.join("Low Action.vst3"), "vst3")]);
        if !cfg!(target_os = "macos") {
            tell(&folder).expect("it can be written");
            let written = fs::read_to_string(folder.join("Low Action.vst3/Contents/Info.plist"));
            let written = written.expect("it is there");
            assert_eq!(written, text("Low Action", "vst3", env!("CARGO_PKG_VERSION")));
        }
        fs::remove_dir_all(&folder).expect("it is there");
    }
}
