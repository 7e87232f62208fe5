//! The events of a block in their order.
//!
//! CLAP promises that the events of a block come in the order of their times, and that those lie within the
//! block. The plugin framework relies on it: `handle_input_event` of nice-plug 0.4.2
//! (`wrapper/clap/wrapper.rs`) subtracts times without looking, and `process` there cuts the block at whatever
//! time an event has. And it stops at a system-exclusive message that has no bytes. Events of a host that does not keep
//! the promise are put right here, before the framework sees them: in their order, none later than the last sample, and
//! without such messages. Those of all others pass untouched.

use std::ffi::c_void;
use std::mem::size_of;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI_SYSEX, clap_event_header, clap_event_midi_sysex,
    clap_input_events,
};
use nice_plug::prelude::Plugin;

use crate::plugin::LowAction;

/// Events of one block that can be put in order; a wrong block's events beyond are dropped.
pub(super) const MOST_EVENTS: usize = LowAction::INPUT_EVENT_CAPACITY;
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
            // SAFETY: as above.
            if unsafe { is_empty(header) } {
                continue;
            }
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
pub(super) unsafe fn events(list: &clap_input_events) -> impl Iterator<Item = *const clap_event_header> {
    // SAFETY: as above.
    let count = list.size.map_or(0, |size| unsafe { size(list) });
    // SAFETY: as above, and the index is below the count.
    (0..count).filter_map(move |index| list.get.map(|get| unsafe { get(list, index) }))
}

/// Whether an event is a message whose bytes are nowhere.
///
/// # Safety
/// It must be as large as it says.
unsafe fn is_empty(event: &clap_event_header) -> bool {
    (event.space_id, event.type_) == (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI_SYSEX)
        // SAFETY: events of a kind are such.
        && unsafe { (*(&raw const *event).cast::<clap_event_midi_sysex>()).buffer.is_null() }
}

/// Whether the events of a block are in order, none comes after its last sample and none is empty.
///
/// # Safety
/// The list must be a host's.
pub(super) unsafe fn is_right(list: &clap_input_events, last: u32) -> bool {
    let mut latest = 0;
    // SAFETY: as above; hosts give pointers to events, or none.
    unsafe { events(list) }.filter_map(|event| unsafe { event.as_ref() }).all(|header| {
        // SAFETY: as above.
        let right = (latest..=last).contains(&header.time) && !unsafe { is_empty(header) };
        latest = header.time;
        right
    })
}

#[cfg(test)]
mod tests {
    use clap_sys::events::{CLAP_EVENT_NOTE_ON, clap_event_note};

    use super::*;

    fn header(time: u32, kind: u16, size: usize) -> clap_event_header {
        let space_id = CLAP_CORE_EVENT_SPACE_ID;
        clap_event_header { size: size as u32, time, space_id, type_: kind, flags: 0 }
    }

    fn message(time: u32, bytes: &[u8]) -> clap_event_midi_sysex {
        let header = header(time, CLAP_EVENT_MIDI_SYSEX, size_of::<clap_event_midi_sysex>());
        let buffer = if bytes.is_empty() { std::ptr::null() } else { bytes.as_ptr() };
        clap_event_midi_sysex { header, port_index: 0, buffer, size: bytes.len() as u32 }
    }

    unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
        // SAFETY: the test's own list.
        unsafe { (*(*list).ctx.cast::<Vec<*const clap_event_header>>()).len() as u32 }
    }

    unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
        // SAFETY: as above.
        unsafe { (&(*(*list).ctx.cast::<Vec<*const clap_event_header>>()))[index as usize] }
    }

    #[test]
    fn a_message_without_bytes_is_left_out() {
        let (bytes, note) = ([0xF0, 0x7E, 0xF7], header(3, CLAP_EVENT_NOTE_ON, size_of::<clap_event_note>()));
        let [empty, whole] = [message(1, &[]), message(2, &bytes)];
        let found = |events: &[*const clap_event_header]| {
            let mut events = events.to_vec();
            let list = clap_input_events { ctx: (&raw mut events).cast(), size: Some(size), get: Some(get) };
            let mut order = InOrder::new();
            // SAFETY: all of them are alive.
            unsafe {
                let right = is_right(&list, 511);
                let list = InOrder::put_right(&raw mut order, &list, 511);
                (right, super::events(&list).collect::<Vec<_>>())
            }
        };
        let [empty, whole] = [&empty, &whole].map(|message| &raw const message.header);
        assert_eq!(found(&[empty, whole, &note]), (false, vec![whole, &raw const note]));
        assert_eq!(found(&[whole, &note]), (true, vec![whole, &raw const note]));
    }
}
