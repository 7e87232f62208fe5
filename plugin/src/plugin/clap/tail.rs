//! The tail, which the framework (nice-plug 0.4.2) knows only while something sounds, and forgets whenever processing starts.

use clap_sys::ext::tail::clap_plugin_tail;
use clap_sys::plugin::clap_plugin;

use super::Instance;
use super::around::Around;

static FUNCTIONS: Around<clap_plugin_tail> = Around::new();

/// The extension for tails, with those that are to come; nothing for nothing.
///
/// # Safety
/// It must be null or the framework's, whose functions are the same each time.
pub(super) unsafe fn around(extension: *const clap_plugin_tail) -> *const clap_plugin_tail {
    // SAFETY: as above.
    unsafe { FUNCTIONS.around(extension, |_| clap_plugin_tail { get: Some(get) }) }
}

unsafe extern "C" fn get(plugin: *const clap_plugin) -> u32 {
    let Some(inner) = FUNCTIONS.inner().and_then(|inner| inner.get).filter(|_| !plugin.is_null()) else {
        return 0;
    };
    // SAFETY: the host gives back what it was given.
    unsafe { (*plugin.cast::<Instance>()).door.tail(inner(plugin)) }
}
