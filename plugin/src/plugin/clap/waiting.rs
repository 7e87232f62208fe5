//! What a host says of notes in a block that has no samples. The framework (nice-plug 0.4.2) takes its parameters and forgets the rest,
//! so that a key that went up in it would be down for ever. Here it waits for the first sample of the next block, before its own.

use std::ffi::c_void;
use std::mem::size_of;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_MIDI, CLAP_EVENT_NOTE_CHOKE, CLAP_EVENT_NOTE_EXPRESSION,
    CLAP_EVENT_NOTE_OFF, CLAP_EVENT_NOTE_ON, clap_event_header, clap_input_events,
};

use super::in_order::events;

/// How many events can wait, and room for the largest kind there is; what comes beyond is not played.
const MOST_EVENTS: usize = 4_096;
const ROOM: usize = 8;

/// What waits.
pub(super) struct Waiting {
    events: Vec<[u64; ROOM]>,
    /// What comes after it, in the present block.
    then: *const clap_input_events,
}

impl Waiting {
    pub(super) fn new() -> Self {
        Self { events: Vec::with_capacity(MOST_EVENTS), then: std::ptr::null() }
    }

    /// Nothing waits any more.
    pub(super) fn forget(&mut self) {
        self.events.clear();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// Has wait what is said of notes. Nothing is allocated.
    ///
    /// # Safety
    /// The list must be null or a host's.
    pub(super) unsafe fn keep(&mut self, list: *const clap_input_events) {
        // SAFETY: as above; hosts give pointers to events, or none.
        let list = unsafe { list.as_ref() };
        // SAFETY: as above.
        for event in list.into_iter().flat_map(|list| unsafe { events(list) }) {
            // SAFETY: as above.
            let Some(header) = (unsafe { event.as_ref() }) else { continue };
            let size = header.size as usize;
            let is_of_notes = header.space_id == CLAP_CORE_EVENT_SPACE_ID
                && matches!(
                    header.type_,
                    CLAP_EVENT_NOTE_ON
                        | CLAP_EVENT_NOTE_OFF
                        | CLAP_EVENT_NOTE_CHOKE
                        | CLAP_EVENT_NOTE_EXPRESSION
                        | CLAP_EVENT_MIDI
                );
            let has_room = (size_of::<clap_event_header>()..=8 * ROOM).contains(&size);
            if !is_of_notes || !has_room || self.events.len() == MOST_EVENTS {
                continue;
            }
            let mut copy = [0_u64; ROOM];
            // SAFETY: the event has as many bytes as it says, and the room is large enough. It is aligned for every event.
            unsafe {
                std::ptr::copy_nonoverlapping(event.cast::<u8>(), copy.as_mut_ptr().cast(), size);
                (*copy.as_mut_ptr().cast::<clap_event_header>()).time = 0;
            }
            self.events.push(copy);
        }
    }

    /// The events of a block after those that wait, good until these are forgotten; nothing where none do.
    ///
    /// # Safety
    /// The list must be null or a host's, and this and it must live as long as what is given back.
    pub(super) unsafe fn before(
        this: *mut Self,
        then: *const clap_input_events,
    ) -> Option<clap_input_events> {
        // SAFETY: as above.
        let waiting = unsafe { &mut *this };
        waiting.then = then;
        let (size, get) = (Some(Self::size as _), Some(Self::get as _));
        (!waiting.events.is_empty()).then_some(clap_input_events { ctx: this.cast::<c_void>(), size, get })
    }

    unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
        // SAFETY: only `before` makes such lists, of what outlives them.
        unsafe {
            let waiting = &*(*list).ctx.cast::<Self>();
            let then = waiting.then.as_ref().and_then(|then| then.size).map_or(0, |size| size(waiting.then));
            then.saturating_add(waiting.events.len() as u32)
        }
    }

    unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
        // SAFETY: as above.
        unsafe {
            let waiting = &*(*list).ctx.cast::<Self>();
            match waiting.events.get(index as usize) {
                Some(event) => event.as_ptr().cast(),
                None => {
                    let get = waiting.then.as_ref().and_then(|then| then.get);
                    get.map_or(std::ptr::null(), |get| get(waiting.then, index - waiting.events.len() as u32))
                }
            }
        }
    }
}
