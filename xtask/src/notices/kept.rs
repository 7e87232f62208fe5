//! Texts of licences for packages that ship none, each under the licence that is taken of those it offers and with whose it is,
//! as its repository says or, where that says nothing, its own description.

/// Texts by the names that SPDX gives licences. What all have in common with ours is read from there.
const TEXTS: [(&str, &str); 5] = [
    ("Apache-2.0", include_str!("../../../LICENSE-APACHE")),
    ("BSL-1.0", include_str!("BSL-1.0.txt")),
    ("ISC", include_str!("ISC.txt")),
    ("MIT", include_str!("../../../LICENSE-MIT")),
    ("Unlicense", include_str!("Unlicense.txt")),
];

/// Packages under one licence of the same holders.
struct Kept {
    licence: &'static str,
    /// Whose they are, and since when where that is said.
    holders: &'static str,
    packages: &'static [&'static str],
}

/// Packages that ship no text, on any platform.
const KEPT: &[Kept] = &[
    Kept { licence: "Apache-2.0", holders: "The AccessKit contributors", packages: &["accesskit"] },
    Kept { licence: "Apache-2.0", holders: "Micah Johnston", packages: &["com-scrape-types"] },
    Kept { licence: "Apache-2.0", holders: "mitchmindtree", packages: &["dasp_sample"] },
    Kept {
        licence: "Apache-2.0",
        holders: "Emil Ernerfeldt, Andreas Reich and contributors",
        packages: &["ecolor", "egui", "egui_glow", "emath", "epaint"],
    },
    Kept { licence: "Apache-2.0", holders: "Philip Degarmo", packages: &["profiling"] },
    Kept { licence: "BSL-1.0", holders: "Douman", packages: &["clipboard-win"] },
    Kept {
        licence: "ISC",
        holders: "2022-2024 Robbert van der Helm; Billy Messenger",
        packages: &["nice-plug", "nice-plug-core", "nice-plug-derive", "nice-plug-egui"],
    },
    Kept { licence: "MIT", holders: "2021 Michael Lamparski; 2018 Pavel Potoček", packages: &["npyz"] },
    Kept { licence: "MIT", holders: "Sarah Quiñones", packages: &["pulp-wasm-simd-flag"] },
    Kept { licence: "MIT", holders: "Steven Sheldon", packages: &["dispatch"] },
    Kept {
        licence: "MIT",
        holders: "Mads Marquart, Steven Sheldon, Mary and contributors",
        packages: &[
            "block2",
            "dispatch2",
            "objc-sys",
            "objc2",
            "objc2-app-kit",
            "objc2-audio-toolbox",
            "objc2-core-audio",
            "objc2-core-audio-types",
            "objc2-core-data",
            "objc2-core-foundation",
            "objc2-core-graphics",
            "objc2-core-image",
            "objc2-encode",
            "objc2-foundation",
            "objc2-io-surface",
            "objc2-metal",
            "objc2-open-gl",
            "objc2-quartz-core",
        ],
    },
    Kept { licence: "Unlicense", holders: "negamartin", packages: &["midly"] },
];

/// The text for a package that offers some licences, as its description writes them; none where nobody has looked what it
/// offers, or it offers another now.
pub fn text(package: &str, offered: &str) -> Option<String> {
    let kept = KEPT.iter().find(|kept| kept.packages.contains(&package))?;
    offered.split(" OR ").find(|one| *one == kept.licence)?;
    let (_, text) = TEXTS.iter().find(|(name, _)| *name == kept.licence)?;
    Some(format!("{}\n\nCopyright (c) {}\n\n{}", kept.licence, kept.holders, without_holders(text)))
}

/// A text that may begin with its title and whose it is, without both.
fn without_holders(text: &str) -> &str {
    let mut paragraphs = text.splitn(3, "\n\n");
    match (paragraphs.next(), paragraphs.next(), paragraphs.next()) {
        (Some(_), Some(holders), Some(rest)) if holders.starts_with("Copyright (c) ") => rest,
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::{KEPT, TEXTS, text};

    #[test]
    fn texts_say_whose_they_are_and_not_that_they_are_ours() {
        let mit = text("npyz", "MIT").expect("it is kept");
        assert!(
            mit.starts_with(
                "MIT\n\nCopyright (c) 2021 Michael Lamparski; 2018 Pavel Potoček\n\nPermission is"
            )
        );
        assert!(mit.contains("WITHOUT WARRANTY") && !mit.contains("Low Action"), "{mit}");
        let apache = text("egui", "MIT OR Apache-2.0").expect("it is kept");
        assert!(apache.contains("END OF TERMS AND CONDITIONS") && !apache.contains("Low Action"), "{apache}");
    }

    #[test]
    fn nothing_is_taken_for_granted() {
        assert_eq!(text("npyz", "GPL-3.0"), None);
        assert_eq!(text("egui", "MIT AND Apache-2.0"), None);
        assert_eq!(text("nobody-knows", "MIT"), None);
    }

    #[test]
    fn each_package_is_kept_once_under_a_licence_with_a_text() {
        let mut packages: Vec<_> = KEPT.iter().flat_map(|kept| kept.packages).collect();
        let count = packages.len();
        packages.sort_unstable();
        packages.dedup();
        assert_eq!(packages.len(), count);
        assert!(KEPT.iter().all(|kept| TEXTS.iter().any(|(name, _)| *name == kept.licence)));
    }
}
