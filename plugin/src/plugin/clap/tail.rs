//! The tail, which the framework (nice-plug 0.4.2) knows only while something sounds, and forgets whenever processing starts.

use std::sync::OnceLock;

use clap_sys::ext::tail::clap_plugin_tail;
use clap_sys::plugin::clap_plugin;

use super::Instance;

/// The framework's function for tails, and ours around it: the same for all instances.
static FUNCTIONS: OnceLock<[clap_plugin_tail; 2]> = OnceLock::new();

/// The extension for tails, with those that are to come; nothing for nothing.
///
/// # Safety
/// It must be null or the framework's, whose functions are the same each time.
pub(super) unsafe fn around(extension: *const clap_plugin_tail) -> *const clap_plugin_tail {
    // SAFETY: as above.
    let Some(inner) = (unsafe { extension.as_ref() }) else { return std::ptr::null() };
    let [_, outer] = FUNCTIONS.get_or_init(|| [*inner, clap_plugin_tail { get: Some(get) }]);
    outer
}

unsafe extern "C" fn get(plugin: *const clap_plugin) -> u32 {
    let Some(inner) = FUNCTIONS.get().and_then(|[inner, _]| inner.get).filter(|_| !plugin.is_null()) else {
        return 0;
    };
    // SAFETY: the host gives back what it was given.
    unsafe { (*plugin.cast::<Instance>()).door.tail(inner(plugin)) }
}
