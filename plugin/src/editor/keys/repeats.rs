//! Keys that repeat. X11 tells of a key that is held as if it went up and came down again and again, and the window passes
//! that on: a note must neither end nor begin with it.

use egui::{Event, Key};

/// Whether each event is half of a repetition: a key that may repeat goes up, and the next that is heard of it is that it
/// comes down.
pub(super) fn halves(events: &[Event], may_repeat: impl Fn(Key) -> bool) -> Vec<bool> {
    let mut halves = vec![false; events.len()];
    for (up, event) in events.iter().enumerate() {
        let Some((key, false)) = stroke(event).filter(|(key, _)| may_repeat(*key)) else { continue };
        let next = events[up + 1..].iter().position(|event| of(event, key).is_some());
        if let Some(down) =
            next.map(|next| up + 1 + next).filter(|&down| of(&events[down], key) == Some(true))
        {
            halves[up] = true;
            halves[down] = true;
        }
    }
    halves
}

/// Where among the events a key comes down, if that is the first that is heard of it.
pub(super) fn comes_down(events: &[Event], key: Key) -> Option<usize> {
    let first = events.iter().position(|event| of(event, key).is_some())?;
    (of(&events[first], key) == Some(true)).then_some(first)
}

/// The key of an event, and whether it goes down.
fn stroke(event: &Event) -> Option<(Key, bool)> {
    match event {
        Event::Key { key, pressed, .. } => Some((*key, *pressed)),
        _ => None,
    }
}

/// Whether a key goes down with an event, if it is about that key.
fn of(event: &Event, wanted: Key) -> Option<bool> {
    stroke(event).filter(|(key, _)| *key == wanted).map(|(_, pressed)| pressed)
}
