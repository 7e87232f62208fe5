//! What a host asks of parameters and tells them between blocks. The framework (nice-plug 0.4.2) panics asked for the one after the
//! last, or told of a message that has no bytes; and with what a parameter is set to it answers what is added for the moment, which
//! the host would keep.

use clap_sys::events::{clap_input_events, clap_output_events};
use clap_sys::ext::params::{clap_param_info, clap_plugin_params};
use clap_sys::id::clap_id;
use clap_sys::plugin::clap_plugin;
use nice_plug::wrapper::clap::Wrapper;

use super::Instance;
use super::around::Around;
use crate::plugin::LowAction;

static FUNCTIONS: Around<clap_plugin_params> = Around::new();

/// The extension for parameters, with these put right; nothing for nothing.
///
/// # Safety
/// It must be null or the framework's, whose functions are the same each time.
pub(super) unsafe fn around(extension: *const clap_plugin_params) -> *const clap_plugin_params {
    // SAFETY: as above.
    unsafe {
        FUNCTIONS.around(extension, |inner| clap_plugin_params {
            get_info: Some(get_info),
            get_value: Some(get_value),
            flush: Some(flush),
            ..*inner
        })
    }
}

unsafe extern "C" fn get_info(plugin: *const clap_plugin, index: u32, info: *mut clap_param_info) -> bool {
    let Some((count, get_info)) = FUNCTIONS.inner().and_then(|inner| inner.count.zip(inner.get_info)) else {
        return false;
    };
    // SAFETY: the host gives back what it was given, and room.
    unsafe { index < count(plugin) && get_info(plugin, index, info) }
}

unsafe extern "C" fn get_value(plugin: *const clap_plugin, id: clap_id, value: *mut f64) -> bool {
    let Some(inner) = FUNCTIONS.inner().and_then(|inner| inner.get_value) else { return false };
    // SAFETY: the host gives back what it was given, and room; the framework's own is behind it, and parameters live as long.
    unsafe {
        if !inner(plugin, id, value) {
            return false;
        }
        let wrapper = &*(*plugin).plugin_data.cast::<Wrapper<LowAction>>();
        if let Some((param, _)) = wrapper.param_ptr_to_hash.iter().find(|&(_, &hash)| hash == id) {
            let steps = param.step_count().unwrap_or(1) as f64;
            *value = f64::from(param.unmodulated_normalized_value()) * steps;
        }
    }
    true
}

unsafe extern "C" fn flush(
    plugin: *const clap_plugin,
    input: *const clap_input_events,
    output: *const clap_output_events,
) {
    let Some(inner) = FUNCTIONS.inner().and_then(|inner| inner.flush) else { return };
    if plugin.is_null() {
        return;
    }
    // SAFETY: the host gives back what it was given, and neither processes nor flushes meanwhile. Outside of blocks no time is too
    // late.
    unsafe {
        Instance::waiting(plugin).begin_call();
        let told = input.as_ref().is_some_and(|list| list.size.is_some_and(|size| size(list) > 0));
        let ((), said) = Instance::put_right(plugin, input, u32::MAX, |input| {
            (*plugin.cast::<Instance>().cast_mut()).apart.take_in_at_once();
            Instance::listened_to(plugin, output, |output| inner(plugin, input, output))
        });
        Instance::have_wait(plugin, input);
        if told || said {
            Instance::wake_to_change(plugin);
        }
    }
}
