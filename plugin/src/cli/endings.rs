//! Endings of names, which promise a form: what is not written in that form must not be called so.

use std::path::Path;

use super::names::shown;
use super::{Failure, Outcome};

/// A form in which results are written, and the endings of others, which players, readers and viewers go by.
#[derive(Debug)]
pub(super) struct Form {
    name: &'static str,
    others: &'static [&'static str],
}

/// Sound.
pub(super) const WAV: Form = Form {
    name: "WAV",
    others: &[
        "aac", "aif", "aifc", "aiff", "au", "caf", "flac", "m4a", "mp3", "ogg", "opus", "csv", "json", "npy",
        "npz", "svg", "png", "pdf",
    ],
};
/// Traces.
pub(super) const NPZ: Form = Form {
    name: "NPZ",
    others: &["npy", "csv", "tsv", "txt", "json", "h5", "hdf5", "mat", "parquet", "wav", "svg", "png", "pdf"],
};
/// Pictures.
pub(super) const SVG: Form = Form {
    name: "SVG",
    others: &[
        "png", "pdf", "jpg", "jpeg", "gif", "bmp", "tif", "tiff", "webp", "eps", "ps", "svgz", "html", "wav",
        "npz", "npy",
    ],
};

/// Labels.
pub(super) const JSON: Form = Form {
    name: "JSON",
    others: &["csv", "tsv", "txt", "xml", "yaml", "yml", "jams", "npy", "npz", "wav", "svg", "png", "pdf"],
};
/// Songs and descriptions, which are read and never written: a slip of the pen is not to cost one.
const READ: [&str; 5] = ["mid", "midi", "rmi", "kar", "toml"];

/// Refuses a name, given by an option, that promises another form.
pub(super) fn refuse_others(option: &str, path: &Path, form: &Form) -> Outcome {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    if form.others.iter().chain(&READ).all(|other| ending != *other) {
        return Ok(());
    }
    let (path, Form { name, .. }) = (shown(path), form);
    Err(Failure::Usage(format!(
        "{option} {path} is refused: low-action writes {name} there, so it must not end in .{}",
        ending.display()
    )))
}
