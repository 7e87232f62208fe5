//! The door through which CLAP hosts come in.
//!
//! What the plugin framework leaves undone is done here, around its functions: events are put in their order
//! (`in_order`), what is said to players is heard (`heard`) and waits where there are no samples, there is something to play
//! into (`outputs`), what is set is kept whatever is added to it (`modulated`), hosts are told in order (`said`), also of states that
//! are refused (`refused`), what they ask of parameters wrongly is answered (`parameters`), the tail is known before anything sounds
//! (`tail`), and one that sleeps is woken (`wake`) when the editor is shown (`shown`), or anything has been set.

mod around;
mod heard;
mod in_order;
mod modulated;
mod outputs;
mod parameters;
mod refused;
mod said;
mod shown;
mod tail;
mod wake;

use std::ffi::{CStr, c_char, c_void};
use std::sync::atomic::Ordering;
use std::sync::{Arc, OnceLock};

use clap_sys::entry::clap_plugin_entry;
use clap_sys::events::{clap_input_events, clap_output_events};
use clap_sys::ext::audio_ports::{CLAP_EXT_AUDIO_PORTS, clap_plugin_audio_ports};
use clap_sys::ext::gui::CLAP_EXT_GUI;
use clap_sys::ext::params::CLAP_EXT_PARAMS;
use clap_sys::ext::state::CLAP_EXT_STATE;
use clap_sys::ext::tail::CLAP_EXT_TAIL;
use clap_sys::factory::plugin_factory::{CLAP_PLUGIN_FACTORY_ID, clap_plugin_factory};
use clap_sys::host::clap_host;
use clap_sys::plugin::{clap_plugin, clap_plugin_descriptor};
use clap_sys::process::{CLAP_PROCESS_CONTINUE, CLAP_PROCESS_ERROR, clap_process, clap_process_status};
use clap_sys::version::CLAP_VERSION;
use nice_plug::wrapper::clap::{PluginDescriptor, Wrapper};
use nice_plug::wrapper::setup_logger;

use super::LowAction;
use super::door::Door;
use super::waiting::Waiting;
use crate::engine::Engine;
use in_order::InOrder;
use modulated::{Apart, Modulated};
use outputs::Outputs;
use said::{Ends, Said};

/// The plugin as the host sees it, and as the framework does.
#[repr(C)]
struct Instance {
    /// The host's side: the framework's functions, but for some. It stands first, so that a pointer to it is one
    /// to the whole.
    outside: clap_plugin,
    inside: *const clap_plugin,
    host: *const clap_host,
    in_order: InOrder,
    /// What the host adds to parameters for the moment.
    modulated: Modulated,
    apart: Apart,
    ends: Ends,
    outputs: Outputs,
    /// What it shares with the plugin inside.
    door: Arc<Door>,
}

impl Instance {
    fn new(
        outside: clap_plugin,
        inside: *const clap_plugin,
        host: *const clap_host,
        modulated: Modulated,
        door: Arc<Door>,
    ) -> Self {
        let (in_order, apart, ends) = (InOrder::new(), Apart::new(), Ends::new());
        let outputs = Outputs::default();
        Self { outside, inside, host, in_order, modulated, apart, ends, outputs, door }
    }

    unsafe extern "C" fn activate(plugin: *const clap_plugin, rate: f64, least: u32, most: u32) -> bool {
        if plugin.is_null() {
            return false;
        }
        // SAFETY: the host gives back what `create_plugin` gave it, and does not process meanwhile.
        unsafe {
            let inside = (*plugin.cast::<Self>()).inside;
            let (Some(get), Some(activate)) = ((*inside).get_extension, (*inside).activate) else {
                return false;
            };
            let ports = get(inside, CLAP_EXT_AUDIO_PORTS.as_ptr()).cast::<clap_plugin_audio_ports>();
            let count = ports.as_ref().and_then(|ports| ports.count).map_or(0, |count| count(inside, false));
            let outputs = &mut (*plugin.cast::<Self>().cast_mut()).outputs;
            outputs.make_room(count as usize, most as usize);
            (*plugin.cast::<Self>().cast_mut()).ends.forget();
            activate(inside, rate, least, most)
        }
    }

    unsafe extern "C" fn process(
        plugin: *const clap_plugin,
        process: *const clap_process,
    ) -> clap_process_status {
        if plugin.is_null() || process.is_null() {
            return CLAP_PROCESS_ERROR;
        }
        // SAFETY: the host gives back what `create_plugin` gave it, and processes one block at a time.
        unsafe {
            let inside = (*plugin.cast::<Self>()).inside;
            let Some(next) = (*inside).process else { return CLAP_PROCESS_ERROR };
            let last = (*process).frames_count.saturating_sub(1);
            let waiting = Self::waiting(plugin);
            waiting.begin_call();
            let said = Self::put_right(plugin, (*process).in_events, last, |in_events| {
                Self::listened_to(plugin, (*process).out_events, |out_events| {
                    let process = clap_process { in_events, out_events, ..*process };
                    let outputs = &mut (*plugin.cast::<Self>().cast_mut()).outputs;
                    let done = outputs.within(&process, |process| next(inside, process));
                    done.unwrap_or(CLAP_PROCESS_ERROR)
                })
                .0
            });
            Self::have_wait(plugin, (*process).in_events);
            // The host is to go on where anything waits to be played.
            if said == CLAP_PROCESS_ERROR || waiting.is_empty() { said } else { CLAP_PROCESS_CONTINUE }
        }
    }

    /// What waits until something can be played.
    ///
    /// # Safety
    /// The plugin must be what `create_plugin` gave the host.
    unsafe fn waiting<'a>(plugin: *const clap_plugin) -> &'a Waiting {
        // SAFETY: as above, and the host keeps it for as long as it calls.
        let instance = unsafe { &*plugin.cast::<Self>() };
        &instance.door.waiting
    }

    /// A call of the host's ends, and what it has brought for players waits if nothing was played.
    ///
    /// # Safety
    /// The plugin must be what `create_plugin` gave the host, and the events null or a host's.
    unsafe fn have_wait(plugin: *const clap_plugin, events: *const clap_input_events) {
        // SAFETY: as above.
        unsafe {
            let modulated = &(*plugin.cast::<Self>()).modulated;
            Self::waiting(plugin).end_call(|keep| heard::each(events, modulated, keep));
        }
    }

    /// Does something of which a host hears, with an eye on what is said; and whether anything was.
    ///
    /// # Safety
    /// The plugin must be what `create_plugin` gave the host, the events null or a host's, and this done by one at a time.
    unsafe fn listened_to<T>(
        plugin: *const clap_plugin,
        events: *const clap_output_events,
        say: impl FnOnce(*const clap_output_events) -> T,
    ) -> (T, bool) {
        // SAFETY: as above.
        let Some(host) = (unsafe { events.as_ref() }) else { return (say(events), false) };
        // SAFETY: as above.
        let (modulated, brought, ends) = unsafe {
            let instance = plugin.cast::<Self>().cast_mut();
            (&(*instance).modulated, &(*instance).apart, &mut (*instance).ends)
        };
        let mut said = Said::new(host, modulated, brought, ends);
        let done = say(&said.list());
        (done, said.end())
    }

    /// Does something with a host's events, put right where they are not.
    ///
    /// # Safety
    /// The plugin must be what `create_plugin` gave the host, the events null or a host's, and this done by one at a time.
    unsafe fn put_right<T>(
        plugin: *const clap_plugin,
        events: *const clap_input_events,
        last: u32,
        take: impl FnOnce(*const clap_input_events) -> T,
    ) -> T {
        // SAFETY: as above.
        unsafe {
            let Some(mut list) = events.as_ref() else { return take(events) };
            let instance = plugin.cast::<Self>().cast_mut();
            let right;
            if !in_order::is_right(list, last) {
                right = InOrder::put_right(&raw mut (*instance).in_order, list, last);
                list = &right;
            }
            let apart = Apart::put(&raw mut (*instance).apart, list, &(*instance).modulated);
            take(apart.as_ref().unwrap_or(list))
        }
    }

    /// Whether the host knows of windows. The framework believes that every one does that asks for one.
    ///
    /// # Safety
    /// As above.
    unsafe fn knows_windows(plugin: *const clap_plugin) -> bool {
        // SAFETY: the host outlives its plugins.
        unsafe {
            let host = (*plugin.cast::<Self>()).host;
            let get = host.as_ref().and_then(|host| host.get_extension);
            get.is_some_and(|get| !get(host, CLAP_EXT_GUI.as_ptr()).is_null())
        }
    }

    unsafe extern "C" fn get_extension(plugin: *const clap_plugin, id: *const c_char) -> *const c_void {
        if plugin.is_null() || id.is_null() {
            return std::ptr::null();
        }
        // SAFETY: the host gives back what `create_plugin` gave it; it names extensions by strings that end in zero.
        unsafe {
            let inside = (*plugin.cast::<Self>()).inside;
            let Some(get) = (*inside).get_extension else { return std::ptr::null() };
            let extension = get(inside, id);
            match CStr::from_ptr(id) {
                id if id == CLAP_EXT_GUI && Self::knows_windows(plugin) => {
                    shown::around(extension.cast()).cast()
                }
                id if id == CLAP_EXT_GUI => std::ptr::null(),
                id if id == CLAP_EXT_PARAMS => parameters::around(extension.cast()).cast(),
                id if id == CLAP_EXT_STATE => refused::around(extension.cast()).cast(),
                id if id == CLAP_EXT_TAIL => tail::around(extension.cast()).cast(),
                _ => extension,
            }
        }
    }

    unsafe extern "C" fn destroy(plugin: *const clap_plugin) {
        if plugin.is_null() {
            return;
        }
        // SAFETY: the host gives back what `create_plugin` gave it, for the last time.
        unsafe {
            let instance = Box::from_raw(plugin.cast::<Self>().cast_mut());
            if let Some(destroy) = (*instance.inside).destroy {
                destroy(instance.inside);
            }
        }
    }
}

fn descriptor() -> &'static PluginDescriptor {
    static DESCRIPTOR: OnceLock<PluginDescriptor> = OnceLock::new();
    DESCRIPTOR.get_or_init(PluginDescriptor::for_plugin::<LowAction>)
}

unsafe extern "C" fn plugin_count(_factory: *const clap_plugin_factory) -> u32 {
    1
}

unsafe extern "C" fn plugin_descriptor(
    _factory: *const clap_plugin_factory,
    index: u32,
) -> *const clap_plugin_descriptor {
    if index == 0 { descriptor().clap_plugin_descriptor() } else { std::ptr::null() }
}

unsafe extern "C" fn create_plugin(
    _factory: *const clap_plugin_factory,
    host: *const clap_host,
    id: *const c_char,
) -> *const clap_plugin {
    // SAFETY: a host names the plugin by a string that ends in zero.
    if host.is_null() || id.is_null() || unsafe { CStr::from_ptr(id) } != descriptor().clap_id() {
        return std::ptr::null();
    }
    // SAFETY: the host outlives its plugins.
    let (wrapper, door) = Door::shared_with(|| unsafe { Wrapper::<LowAction>::new(host) });
    // It is always the same. The framework would have it 0 until somebody said otherwise, and then ask for a restart.
    wrapper.current_latency.store(Engine::LATENCY, Ordering::Relaxed);
    let modulated = Modulated::of(&wrapper);
    // The framework takes its reference back in `destroy`.
    // SAFETY: it has just been made.
    let inside = unsafe { (*Arc::into_raw(wrapper)).clap_plugin.as_ptr() };
    // SAFETY: as above. All functions find their way by `plugin_data`, so that they can be called with either.
    let outside = clap_plugin {
        activate: Some(Instance::activate),
        process: Some(Instance::process),
        get_extension: Some(Instance::get_extension),
        destroy: Some(Instance::destroy),
        ..unsafe { *inside }
    };
    Box::into_raw(Box::new(Instance::new(outside, inside, host, modulated, door))).cast()
}

static FACTORY: clap_plugin_factory = clap_plugin_factory {
    get_plugin_count: Some(plugin_count),
    get_plugin_descriptor: Some(plugin_descriptor),
    create_plugin: Some(create_plugin),
};

unsafe extern "C" fn init(_path: *const c_char) -> bool {
    setup_logger::<LowAction>();
    true
}

unsafe extern "C" fn deinit() {}

unsafe extern "C" fn factory(id: *const c_char) -> *const c_void {
    // SAFETY: a host names the factory by a string that ends in zero.
    if id.is_null() || unsafe { CStr::from_ptr(id) } != CLAP_PLUGIN_FACTORY_ID {
        return std::ptr::null();
    }
    (&raw const FACTORY).cast()
}

/// Where CLAP hosts begin.
// SAFETY: no other symbol of that name is exported.
#[unsafe(no_mangle)]
#[used]
pub static clap_entry: clap_plugin_entry = clap_plugin_entry {
    clap_version: CLAP_VERSION,
    init: Some(init),
    deinit: Some(deinit),
    get_factory: Some(factory),
};
