//! The events of a block in which what is set stands apart from what is added to it: around each value for a parameter to which
//! something is added stand two events that take that away and put it back. And what is added when, as the editor may set something
//! in the middle of a block.

use std::ffi::c_void;
use std::mem::size_of;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_MOD, CLAP_EVENT_PARAM_VALUE, clap_event_header,
    clap_event_param_mod, clap_event_param_value, clap_input_events,
};
use clap_sys::id::clap_id;

use super::Modulated;
use crate::plugin::clap::in_order::{MOST_EVENTS, events};

/// Values of one block that can stand apart; those beyond pass as they are, as do all events of a block that has more than can be
/// put in order.
const MOST_VALUES: usize = 2048;

/// Up to a time in the block this was added to a parameter.
struct Until {
    time: u32,
    id: clap_id,
    amount: f64,
}

/// A block's events, with values apart.
pub(in super::super) struct Apart {
    given: Vec<*const clap_event_header>,
    /// What is given beside the host's own.
    made: Vec<clap_event_param_mod>,
    /// What is no longer added at the block's end, in the order of times.
    ends: Vec<Until>,
}

impl Apart {
    pub fn new() -> Self {
        let most_made = 2 * MOST_VALUES;
        Self {
            given: Vec::with_capacity(MOST_EVENTS + most_made),
            made: Vec::with_capacity(most_made),
            ends: Vec::with_capacity(MOST_EVENTS),
        }
    }

    /// What was added to a parameter at a time in the block when the events of that time had been taken in, if it is not what is
    /// added at the block's end.
    pub fn added_at(&self, time: u32, id: clap_id) -> Option<f64> {
        self.ends.iter().find(|until| until.id == id && until.time > time).map(|until| until.amount)
    }

    /// All that the host brought is taken in at once: at any time what counts is what is added at the end.
    pub fn take_in_at_once(&mut self) {
        self.ends.clear();
    }

    /// The events of a block with values apart, good until the next block's; nothing where they can pass as they are. Nothing
    /// is allocated.
    ///
    /// # Safety
    /// The list must be a host's, with all its functions and in order, and `this` must live as long as what is given back.
    pub unsafe fn put(
        this: *mut Self,
        list: &clap_input_events,
        modulated: &Modulated,
    ) -> Option<clap_input_events> {
        // SAFETY: as above.
        let made = unsafe { (*this).take(list, modulated) };
        let (size, get) = (Some(Self::size as _), Some(Self::get as _));
        made.then_some(clap_input_events { ctx: this.cast::<c_void>(), size, get })
    }

    /// Takes the events of a block in, and says whether there is anything beside them.
    ///
    /// # Safety
    /// As above.
    unsafe fn take(&mut self, list: &clap_input_events, modulated: &Modulated) -> bool {
        self.given.clear();
        self.made.clear();
        self.ends.clear();
        // SAFETY: as above.
        for event in unsafe { events(list) } {
            // SAFETY: hosts give pointers to events, or none.
            let Some(header) = (unsafe { event.as_ref() }) else { continue };
            let mut around = None;
            match (header.space_id, header.type_) {
                (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_MOD) => {
                    // SAFETY: events of a kind are such.
                    let event = unsafe { &*event.cast::<clap_event_param_mod>() };
                    let (time, id) = (header.time, event.param_id);
                    let before = modulated.note(id, event.note_id, event.amount);
                    let before = before.filter(|_| self.ends.len() < MOST_EVENTS);
                    self.ends.extend(before.map(|amount| Until { time, id, amount }));
                }
                (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE) => {
                    // SAFETY: as above.
                    let id = unsafe { (*event.cast::<clap_event_param_value>()).param_id };
                    around = modulated.added(id).map(|amount| (id, amount));
                }
                _ => {}
            }
            if self.given.len() - self.made.len() >= MOST_EVENTS {
                // What is added is still to be known at the next block.
                continue;
            }
            match around.filter(|_| self.made.len() + 2 <= 2 * MOST_VALUES) {
                Some((id, amount)) => {
                    self.make(header.time, id, 0.0);
                    self.given.push(event);
                    self.make(header.time, id, amount);
                }
                None => self.given.push(event),
            }
        }
        // SAFETY: as above.
        let count = list.size.map_or(0, |size| unsafe { size(list) }) as usize;
        !self.made.is_empty() && count <= MOST_EVENTS
    }

    /// Has so much added to a parameter from a time on.
    fn make(&mut self, time: u32, param_id: clap_id, amount: f64) {
        let size = size_of::<clap_event_param_mod>() as u32;
        let (space_id, type_) = (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_MOD);
        let header = clap_event_header { size, time, space_id, type_, flags: 0 };
        let (cookie, note_id, port_index, channel, key) = (std::ptr::null_mut(), -1, -1, -1, -1);
        // Within the capacity, so that those already there stay where they are.
        self.made.push(clap_event_param_mod {
            header,
            param_id,
            cookie,
            note_id,
            port_index,
            channel,
            key,
            amount,
        });
        if let Some(made) = self.made.last() {
            self.given.push(&raw const made.header);
        }
    }

    unsafe extern "C" fn size(list: *const clap_input_events) -> u32 {
        // SAFETY: only `put` makes such lists, of what outlives them.
        unsafe { (*(*list).ctx.cast::<Self>()).given.len() as u32 }
    }

    unsafe extern "C" fn get(list: *const clap_input_events, index: u32) -> *const clap_event_header {
        // SAFETY: as above.
        let apart = unsafe { &*(*list).ctx.cast::<Self>() };
        apart.given.get(index as usize).copied().unwrap_or(std::ptr::null())
    }
}
