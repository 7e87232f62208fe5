//! The door through which CLAP hosts come in.
//!
//! CLAP promises that the events of a block come in the order of their times, and that those lie within the
//! block. The plugin framework relies on it: `handle_input_event` of nice-plug 0.4.2
//! (`wrapper/clap/wrapper.rs`) subtracts times without looking, and `process` there cuts the block at whatever
//! time an event has. Events of a host that does not keep the promise are put right here, before the framework
//! sees them: in their order, and none later than the last sample. Those of all others pass untouched.

use std::ffi::{CStr, c_char, c_void};
use std::mem::size_of;
use std::sync::{Arc, OnceLock};

use clap_sys::entry::clap_plugin_entry;
use clap_sys::events::{clap_event_header, clap_input_events};
use clap_sys::factory::plugin_factory::{CLAP_PLUGIN_FACTORY_ID, clap_plugin_factory};
use clap_sys::host::clap_host;
use clap_sys::plugin::{clap_plugin, clap_plugin_descriptor};
use clap_sys::process::{CLAP_PROCESS_ERROR, clap_process, clap_process_status};
use clap_sys::version::CLAP_VERSION;
use nice_plug::prelude::Plugin;
use nice_plug::wrapper::clap::{PluginDescriptor, Wrapper};
use nice_plug::wrapper::setup_logger;

use super::LowAction;

/// Events of one block that can be put in order; a wrong block's events beyond are dropped.
const MOST_EVENTS: usize = LowAction::INPUT_EVENT_CAPACITY;
/// Events of one block that can be given another time, and room for the largest kind there is.
const MOST_MOVED: usize = 1024;
const ROOM: usize = 16;

/// An event, and where it belongs: at which sample, and there after which others.
#[derive(Clone, Copy)]
struct Entry {
    time: u32,
    place: u32,
    event: *const clap_event_header,
}

/// A block's events, put right.
struct Order {
    entries: Vec<Entry>,
    /// Copies of events that came too late, with another time.
    moved: Vec<[u64; ROOM]>,
}

impl Order {
    fn new() -> Self {
        Self { entries: Vec::with_capacity(MOST_EVENTS), moved: Vec::with_capacity(MOST_MOVED) }
    }

    /// Takes the events of a block in. Nothing is allocated.
    ///
    /// # Safety
    /// The list must be a host's, with all its functions.
    unsafe fn put_right(&mut self, list: &clap_input_events, last: u32) {
        self.entries.clear();
        self.moved.clear();
        // SAFETY: as above.
        for (place, event) in unsafe { events(list) }.enumerate().take(MOST_EVENTS) {
            // SAFETY: hosts give pointers to events, or none.
            let Some(header) = (unsafe { event.as_ref() }) else { continue };
            let mut entry = Entry { time: header.time.min(last), place: place as u32, event };
            if header.time > last {
                let size = header.size as usize;
                if self.moved.len() == MOST_MOVED
                    || !(size_of::<clap_event_header>()..=8 * ROOM).contains(&size)
                {
                    continue;
                }
                let mut copy = [0_u64; ROOM];
                // SAFETY: the event has as many bytes as it says, and the room is large enough. It is
                // aligned for every event.
                unsafe {
                    std::ptr::copy_nonoverlapping(event.cast::<u8>(), copy.as_mut_ptr().cast(), size);
                    (*copy.as_mut_ptr().cast::<clap_event_header>()).time = last;
                }
                // Within the capacity, so that those already there stay where they are.
                self.moved.push(copy);
                if let Some(copy) = self.moved.last() {
                    entry.event = copy.as_ptr().cast();
                }
            }
            self.entries.push(entry);
        }
        self.entries.sort_unstable_by_key(|entry| (entry.time, entry.place));
    }

    unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
        // SAFETY: only `process` makes such lists, of an order that outlives them.
        unsafe { (*(*list).ctx.cast::<Self>()).entries.len() as u32 }
    }

    unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
        // SAFETY: as above.
        let order = unsafe { &*(*list).ctx.cast::<Self>() };
        order.entries.get(index as usize).map_or(std::ptr::null(), |entry| entry.event)
    }
}

/// The events of a host's list, one after the other.
///
/// # Safety
/// The list must be a host's.
unsafe fn events(list: &clap_input_events) -> impl Iterator<Item = *const clap_event_header> {
    // SAFETY: as above.
    let count = list.size.map_or(0, |size| unsafe { size(list) });
    // SAFETY: as above, and the index is below the count.
    (0..count).filter_map(move |index| list.get.map(|get| unsafe { get(list, index) }))
}

/// Whether the events of a block are in order and none comes after its last sample.
///
/// # Safety
/// The list must be a host's.
unsafe fn is_right(list: &clap_input_events, last: u32) -> bool {
    let mut latest = 0;
    // SAFETY: as above; hosts give pointers to events, or none.
    unsafe { events(list) }.filter_map(|event| unsafe { event.as_ref() }).all(|header| {
        let right = (latest..=last).contains(&header.time);
        latest = header.time;
        right
    })
}

/// The plugin as the host sees it, and as the framework does.
#[repr(C)]
struct Instance {
    /// The host's side: the framework's functions, but for two. It stands first, so that a pointer to it is one
    /// to the whole.
    outside: clap_plugin,
    inside: *const clap_plugin,
    order: Order,
}

impl Instance {
    unsafe extern "C" fn process(
        plugin: *const clap_plugin,
        process: *const clap_process,
    ) -> clap_process_status {
        if plugin.is_null() || process.is_null() {
            return CLAP_PROCESS_ERROR;
        }
        let instance = plugin.cast::<Self>().cast_mut();
        // SAFETY: the host gives back what `create_plugin` gave it, and processes one block at a time.
        unsafe {
            let inside = (*instance).inside;
            let Some(next) = (*inside).process else { return CLAP_PROCESS_ERROR };
            let last = (*process).frames_count.saturating_sub(1);
            match (*process).in_events.as_ref() {
                Some(list) if !is_right(list, last) => {
                    let order = &raw mut (*instance).order;
                    (*order).put_right(list, last);
                    let list = clap_input_events {
                        ctx: order.cast::<c_void>(),
                        size: Some(Order::size),
                        get: Some(Order::get),
                    };
                    next(inside, &clap_process { in_events: &list, ..*process })
                }
                _ => next(inside, process),
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
    // The framework takes its reference back in `destroy`.
    // SAFETY: it has just been made.
    let inside = unsafe { (*Arc::into_raw(Wrapper::<LowAction>::new(host))).clap_plugin.as_ptr() };
    // SAFETY: as above. All functions find their way by `plugin_data`, so that they can be called with either.
    let outside = clap_plugin {
        process: Some(Instance::process),
        destroy: Some(Instance::destroy),
        ..unsafe { *inside }
    };
    Box::into_raw(Box::new(Instance { outside, inside, order: Order::new() })).cast()
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
