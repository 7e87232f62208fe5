//! The events of a block in their order.
//!
//! CLAP promises that the events of a block come in the order of their times, and that those lie within the
//! block. The plugin framework relies on it: `handle_input_event` of nice-plug 0.4.2
//! (`wrapper/clap/wrapper.rs`) subtracts times without looking, and `process` there cuts the block at whatever
//! time an event has. Events of a host that does not keep the promise are put right here, before the framework
//! sees them: in their order, and none later than the last sample. Those of all others pass untouched.

use std::ffi::c_void;
use std::mem::size_of;

use clap_sys::events::{clap_event_header, clap_input_events};
use nice_plug::prelude::Plugin;

use crate::plugin::LowAction;

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
pub(super) struct InOrder {
    entries: Vec<Entry>,
    /// Copies of events that came too late, with another time.
    moved: Vec<[u64; ROOM]>,
}

impl InOrder {
    pub(super) fn new() -> Self {
        Self { entries: Vec::with_capacity(MOST_EVENTS), moved: Vec::with_capacity(MOST_MOVED) }
    }

    /// The events of a block, put right; good until the next block's. Nothing is allocated.
    ///
    /// # Safety
    /// The list must be a host's, with all its functions, and `this` must live as long as what is given back.
    pub(super) unsafe fn put_right(
        this: *mut Self,
        list: &clap_input_events,
        last: u32,
    ) -> clap_input_events {
        // SAFETY: as above.
        unsafe { (*this).take(list, last) };
        clap_input_events { ctx: this.cast::<c_void>(), size: Some(Self::size), get: Some(Self::get) }
    }

    /// Takes the events of a block in.
    ///
    /// # Safety
    /// As above.
    unsafe fn take(&mut self, list: &clap_input_events, last: u32) {
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
        // SAFETY: only `put_right` makes such lists, of what outlives them.
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
pub(super) unsafe fn is_right(list: &clap_input_events, last: u32) -> bool {
    let mut latest = 0;
    // SAFETY: as above; hosts give pointers to events, or none.
    unsafe { events(list) }.filter_map(|event| unsafe { event.as_ref() }).all(|header| {
        let right = (latest..=last).contains(&header.time);
        latest = header.time;
        right
    })
}
