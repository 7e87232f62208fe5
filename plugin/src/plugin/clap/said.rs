//! What the host is told in a block, on its way out of the framework: in the order of its times, as CLAP has it, and what the editor
//! sets comes by here as it is set.
//!
//! The framework (nice-plug 0.4.2) cuts a block at events, and says of each part first which notes have ended, at its last sample,
//! and then what the editor did, at its first one. So the ends of notes wait here until nothing earlier can come.

use std::ffi::c_void;

use clap_sys::events::{
    CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_NOTE_END, CLAP_EVENT_PARAM_VALUE, clap_event_header,
    clap_event_note, clap_event_param_value, clap_output_events,
};

use super::modulated::{Apart, Modulated};

/// Ends of notes that can wait; beyond that the plugin says them again after the next block.
const MOST_ENDS: usize = 256;

/// Ends of notes that are still to be told, the first one first.
pub(super) struct Ends(Vec<clap_event_note>);

impl Ends {
    pub(super) fn new() -> Self {
        Self(Vec::with_capacity(MOST_ENDS))
    }

    /// None is to be told any more.
    pub(super) fn forget(&mut self) {
        self.0.clear();
    }
}

/// Where a block's events go.
pub(super) struct Said<'a> {
    host: &'a clap_output_events,
    modulated: &'a Modulated,
    /// What the host brought in the block.
    brought: &'a Apart,
    ends: &'a mut Ends,
    any: bool,
}

impl<'a> Said<'a> {
    pub(super) fn new(
        host: &'a clap_output_events,
        modulated: &'a Modulated,
        brought: &'a Apart,
        ends: &'a mut Ends,
    ) -> Self {
        Self { host, modulated, brought, ends, any: false }
    }

    /// What the framework is given in place of the host's; good as long as this is.
    pub(super) fn list(&mut self) -> clap_output_events {
        clap_output_events { ctx: (&raw mut *self).cast::<c_void>(), try_push: Some(try_push) }
    }

    /// The block is over: says what has waited, and whether anything was said. What the host has no room for waits for the next block.
    pub(super) fn end(mut self) -> bool {
        self.tell_ends(u32::MAX);
        self.ends.0.iter_mut().for_each(|end| end.header.time = 0);
        self.any
    }

    /// Tells the host of the notes that ended up to a time.
    fn tell_ends(&mut self, until: u32) {
        let due = self.ends.0.iter().take_while(|end| end.header.time <= until);
        // SAFETY: they are events.
        let told = due.take_while(|end| unsafe { self.push(&raw const end.header) }).count();
        self.ends.0.drain(..told);
    }

    /// Takes an event of the framework's.
    ///
    /// # Safety
    /// It must be one.
    unsafe fn take(&mut self, event: *const clap_event_header) -> bool {
        self.any = true;
        // SAFETY: as above, and events of a kind are such.
        unsafe {
            match ((*event).space_id, (*event).type_) {
                (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_NOTE_END) => {
                    let has_room = self.ends.0.len() < MOST_ENDS;
                    if has_room {
                        self.ends.0.push(*event.cast::<clap_event_note>());
                    }
                    return has_room;
                }
                (CLAP_CORE_EVENT_SPACE_ID, CLAP_EVENT_PARAM_VALUE) => {
                    let set = &*event.cast::<clap_event_param_value>();
                    self.modulated.set(set.param_id, set.value, set.header.time, self.brought);
                }
                _ => {}
            }
            self.tell_ends((*event).time);
            self.push(event)
        }
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
    unsafe { (*(*list).ctx.cast::<Said>()).take(event) }
}

#[cfg(test)]
mod tests {
    use std::mem::size_of;

    use super::*;

    /// A host's list with so much room.
    struct Host {
        room: usize,
        told: Vec<(u16, u32)>,
    }

    unsafe extern "C" fn write(list: *const clap_output_events, event: *const clap_event_header) -> bool {
        // SAFETY: the test's own list, and events.
        let (host, event) = unsafe { (&mut *(*list).ctx.cast::<Host>(), &*event) };
        let has_room = host.told.len() < host.room;
        if has_room {
            host.told.push((event.type_, event.time));
        }
        has_room
    }

    fn header(time: u32, type_: u16, size: usize) -> clap_event_header {
        clap_event_header { size: size as u32, time, space_id: CLAP_CORE_EVENT_SPACE_ID, type_, flags: 0 }
    }

    const END: u16 = CLAP_EVENT_NOTE_END;
    const SET: u16 = CLAP_EVENT_PARAM_VALUE;

    /// What a host with so much room is told of a block in which the framework says this.
    fn told(ends: &mut Ends, room: usize, said: &[(u16, u32)]) -> Vec<(u16, u32)> {
        let mut host = Host { room, told: Vec::new() };
        let list = clap_output_events { ctx: (&raw mut host).cast(), try_push: Some(write) };
        let (modulated, brought) = (Modulated::default(), Apart::new());
        let mut saying = Said::new(&list, &modulated, &brought, ends);
        let framework = saying.list();
        for &(kind, time) in said {
            let (note_id, port_index, channel, key) = (1, 0, 0, 60);
            let header = header(time, kind, size_of::<clap_event_note>());
            let note = clap_event_note { header, note_id, port_index, channel, key, velocity: 0.0 };
            let (cookie, header) =
                (std::ptr::null_mut(), self::header(time, kind, size_of::<clap_event_param_value>()));
            let (param_id, value) = (0, 0.0);
            let set =
                clap_event_param_value { header, param_id, cookie, note_id, port_index, channel, key, value };
            let event = if kind == END { &raw const note.header } else { &raw const set.header };
            // SAFETY: all of it is alive.
            unsafe { framework.try_push.expect("it takes events")(&framework, event) };
        }
        assert_eq!(saying.end(), !said.is_empty());
        host.told
    }

    #[test]
    fn a_host_is_told_in_the_order_of_times() {
        let said = [(END, 63), (SET, 0), (SET, 0), (END, 127), (SET, 64), (END, 511)];
        let expected = [(SET, 0), (SET, 0), (END, 63), (SET, 64), (END, 127), (END, 511)];
        assert_eq!(told(&mut Ends::new(), 9, &said), expected);
    }

    #[test]
    fn a_host_without_room_is_told_of_ends_in_the_next_block() {
        let mut ends = Ends::new();
        assert_eq!(told(&mut ends, 1, &[(END, 63), (END, 64)]), [(END, 63)]);
        assert_eq!(told(&mut ends, 9, &[(END, 5), (SET, 0)]), [(END, 0), (SET, 0), (END, 5)]);
        assert!(told(&mut ends, 9, &[]).is_empty());
    }
}
