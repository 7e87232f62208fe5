//! Whose Rust's own library is, which is in everything that is linked.

use std::path::Path;

use anyhow::Result;

use crate::bundles::output;

/// Where a toolchain keeps it, below its root.
const PLACE: &str = "share/doc/rust/COPYRIGHT-library.html";

/// A line for the list, and the text of the licences.
pub struct Library {
    pub name: String,
    pub text: String,
}

/// The library of the Rust that builds. Not every distribution of Rust has the text, which is then named.
///
/// # Errors
/// When the toolchain cannot be asked.
pub fn library() -> Result<Library> {
    let say = |words: &[&str]| -> Result<String> {
        let said = output("rustc", words.iter().map(|&word| word.to_owned()))?;
        Ok(String::from_utf8(said)?.trim().to_owned())
    };
    let version = say(&["--version"])?;
    let number = version.split_whitespace().nth(1).unwrap_or_default();
    let path = Path::new(&say(&["--print", "sysroot"])?).join(PLACE);
    let text = match std::fs::read_to_string(&path) {
        Ok(page) => plain(&page),
        Err(_) => {
            eprintln!("warning: {} is not there: the notices name it in its place", path.display());
            absent(number)
        }
    };
    Ok(Library { name: format!("std {number}"), text })
}

/// What stands in place of the text.
fn absent(number: &str) -> String {
    format!(
        "MIT OR Apache-2.0\n\nCopyright (c) The Rust Project Developers (see https://thanks.rust-lang.org)\n\nBoth texts are in \
         this file. Those of the libraries in it are in {PLACE} of the toolchain of Rust {number} from https://rust-lang.org."
    )
}

/// A page without what has it drawn.
fn plain(page: &str) -> String {
    let mut text = String::new();
    for part in page.split_once("<body>").map_or(page, |(_, body)| body).split('<') {
        // Before the first of these there is none.
        text += part.split_once('>').map_or(part, |(_, after)| after);
    }
    for (written, meant) in [
        ("&#34;", "\""),
        ("&#39;", "'"),
        ("&#60;", "<"),
        ("&#62;", ">"),
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&amp;", "&"),
    ] {
        text = text.replace(written, meant);
    }
    let mut lines = Vec::new();
    for line in text.lines().map(str::trim_end) {
        // One empty line is enough.
        if !line.is_empty() || lines.last().is_some_and(|last: &&str| !last.is_empty()) {
            lines.push(line);
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_becomes_its_words() {
        let page = "<html><title>T</title>\n<body>\n\n\n<p class=\"a\">One &#34;word&#34;</p>\n  \n\n<pre>&#60;a&#62; &amp; b</pre>";
        assert_eq!(plain(page), "One \"word\"\n\n<a> & b");
    }

    #[test]
    fn a_text_that_is_not_there_is_named() {
        let text = absent("1.2.3");
        assert!(
            text.contains("The Rust Project Developers") && text.contains(PLACE) && text.contains("1.2.3"),
            "{text}"
        );
    }
}
