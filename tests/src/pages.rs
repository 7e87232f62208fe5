//! Sentences of the documentation that hold numbers which tests find.

use std::fs;
use std::path::Path;

/// A page of `docs` must have these words, however its lines are broken.
///
/// # Panics
/// When it has not.
pub fn must_say(page: &str, said: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(page);
    let text = fs::read_to_string(path).expect("a page of docs");
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains(said), "docs/{page} does not say: {said}");
}
