//! The host hears of a state that is refused; and one that is taken in is what is set, whatever is added to it (`modulated`).
//!
//! The framework (nice-plug 0.4.2) takes what the plugin has made empty as loaded. A host that believed it would save what is there
//! over a session of a newer program.

use clap_sys::ext::state::clap_plugin_state;
use clap_sys::plugin::clap_plugin;
use clap_sys::stream::clap_istream;

use super::Instance;
use super::around::Around;
use crate::plugin::state::taken_in;

static FUNCTIONS: Around<clap_plugin_state> = Around::new();

/// The extension for states, with refusals told; nothing for nothing.
///
/// # Safety
/// It must be null or the framework's, whose functions are the same each time.
pub(super) unsafe fn around(extension: *const clap_plugin_state) -> *const clap_plugin_state {
    // SAFETY: as above.
    unsafe { FUNCTIONS.around(extension, |inner| clap_plugin_state { load: Some(load), ..*inner }) }
}

unsafe extern "C" fn load(plugin: *const clap_plugin, stream: *const clap_istream) -> bool {
    let Some(inner) = FUNCTIONS.inner().and_then(|inner| inner.load) else { return false };
    // SAFETY: the host gives back what it was given, and a stream.
    unsafe {
        if plugin.is_null() {
            return false;
        }
        let modulated = &(*plugin.cast::<Instance>()).modulated;
        let (loaded, taken) = taken_in(|| modulated.without(|| inner(plugin, stream)));
        if loaded && taken {
            Instance::wake_to_change(plugin);
        }
        loaded && taken
    }
}
