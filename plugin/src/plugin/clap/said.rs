//! What the host is told in a block, on its way out of the framework: what the editor sets comes by here as it is set.

use std::ffi::c_void;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE, clap_event_header, clap_event_param_value,
    clap_output_events,
};

use super::modulated::Modulated;

/// Where a block's events go.
pub(super) struct Said<'a> {
    host: &'a clap_output_events,
    modulated: &'a Modulated,
    any: bool,
}

impl<'a> Said<'a> {
    pub(super) fn new(host: &'a clap_output_events, modulated: &'a Modulated) -> Self {
        Self { host, modulated, any: false }
    }

    /// What the framework is given in place of the host's; good as long as this is.
    pub(super) fn list(&mut self) -> clap_output_events {
        clap_output_events { ctx: (&raw mut *self).cast::<c_void>(), try_push: Some(try_push) }
    }

    /// Whether anything was said.
    pub(super) fn any(&self) -> bool {
        self.any
    }

    /// Hands an event on to the host.
    ///
    /// # Safety
    /// It must be one.
    unsafe fn push(&self, event: *const clap_event_header) -> bool {
        // SAFETY: as above, and the list is the host's.
        self.host.try_push.is_some_and(|push| unsafe { push(self.host, event) })
    }
}

unsafe extern "C" fn try_push(list: *const clap_output_events, event: *const clap_event_header) -> bool {
    // SAFETY: only `list` makes such lists, of what outlives them; the framework gives events.
    unsafe {
        let said = &mut *(*list).ctx.cast::<Said>();
        said.any = true;
        if ((*event).space_id, (*event).type_) == (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE) {
            let set = &*event.cast::<clap_event_param_value>();
            said.modulated.set(set.param_id, set.value);
        }
        said.push(event)
    }
}
