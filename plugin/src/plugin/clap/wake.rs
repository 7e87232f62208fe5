//! A host that has stopped is asked to go on, which the framework (nice-plug 0.4.2) never does.

use clap_sys::plugin::clap_plugin;

use super::Instance;

impl Instance {
    /// Asks the host to go on, or to begin again.
    ///
    /// # Safety
    /// The plugin must be what `create_plugin` gave the host.
    pub(super) unsafe fn wake(plugin: *const clap_plugin) -> bool {
        // SAFETY: as above; the host outlives its plugins, and this may be asked on any thread.
        unsafe {
            if let Some(host) = (*plugin.cast::<Self>()).host.as_ref()
                && let Some(request) = host.request_process
            {
                request(host);
            }
        }
        true
    }

    /// Asks the host to go on if it has stopped: what was set is to be there before the next note.
    ///
    /// # Safety
    /// As above.
    pub(super) unsafe fn wake_to_change(plugin: *const clap_plugin) {
        // SAFETY: as above.
        unsafe {
            if (*plugin.cast::<Self>()).door.is_active() {
                Self::wake(plugin);
            }
        }
    }
}
