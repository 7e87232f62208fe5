//! The user that a test is: without set-ups of their own, whatever the developer has installed.

use std::ffi::c_int;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use low_action::setups::FOLDER_VARIABLE;

static FOLDER: OnceLock<PathBuf> = OnceLock::new();

unsafe extern "C" {
    /// Of the C library: has a function called when the program ends.
    safe fn atexit(function: extern "C" fn()) -> c_int;
}

/// The folder of the set-ups of this test program's user, empty at first and gone when the program ends. To be called
/// before any of the plugin is made, and it is wherever a host or a desk is.
pub fn isolate() -> &'static Path {
    FOLDER.get_or_init(|| {
        // (What a static owns is never dropped.)
        let folder = tempfile::tempdir().expect("there is room").keep();
        atexit(clear_up);
        // SAFETY: Rust's readers of the environment take turns with this. Others are drivers that draw, which are first
        // asked for after this.
        unsafe { std::env::set_var(FOLDER_VARIABLE, &folder) };
        folder
    })
}

extern "C" fn clear_up() {
    if let Some(folder) = FOLDER.get() {
        std::fs::remove_dir_all(folder).ok();
    }
}
