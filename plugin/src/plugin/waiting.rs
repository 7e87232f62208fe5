//! What a host sends without having anything played. Some do so between blocks, or while a track is switched off: with no samples, no
//! outputs, or no memory behind them. The framework takes parameters from such a call and forgets the rest, so that a key that went up
//! in it would be down for ever. Here it waits for the next block, and is played at its first sample.

use std::sync::{Mutex, MutexGuard, TryLockError};

use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::*;

/// How many events can wait. Notes and what is said of them get no more than half of that: what ends them finds room for longer.
const ROOM: usize = 4_096;

/// What waits for a block, for the wrapper to put in and the plugin to take out.
#[derive(Default)]
pub(super) struct Waiting(Mutex<List>);

#[derive(Default)]
struct List {
    /// In order.
    events: Vec<NoteEvent<()>>,
    /// Keys of each channel that went up when there was no room left.
    lifted: [u128; 16],
    /// Whether the plugin has been asked for sound in the host's present call.
    played: bool,
}

impl Waiting {
    /// For as long as nobody else looks, which no host has reason to: nobody waits on the audio thread.
    fn open(&self) -> Option<MutexGuard<'_, List>> {
        match self.0.try_lock() {
            Ok(waiting) => Some(waiting),
            Err(TryLockError::Poisoned(waiting)) => Some(waiting.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Makes room, and nothing waits; allocates.
    pub fn make_room(&self) {
        self.forget();
        if let Some(mut waiting) = self.open() {
            waiting.events.reserve_exact(ROOM);
        }
    }

    /// Nothing waits any more.
    pub fn forget(&self) {
        self.hand_over(|_| {});
    }

    /// Hands over all that waits, for the first sample of a block that is played now.
    pub fn hand_over(&self, mut play: impl FnMut(NoteEvent<()>)) {
        let Some(mut waiting) = self.open() else { return };
        waiting.played = true;
        for mut event in waiting.events.drain(..) {
            event.subtract_timing(event.timing());
            play(event);
        }
        for (channel, keys) in (0..).zip(&mut waiting.lifted) {
            let keys = std::mem::take(keys);
            for key in (0..128).filter(|key| keys >> key & 1 == 1) {
                // However often it has been struck: how often it went up nobody has counted.
                let (channel, key) = (Channel::Number(channel), Key::Number(key));
                play(NoteEvent::Choke { timing: 0, voice_id: VoiceID::Wildcard, channel, key });
            }
        }
    }

    /// A call of the host's begins.
    pub fn begin_call(&self) {
        if let Some(mut waiting) = self.open() {
            waiting.played = false;
        }
    }

    /// The call ends. If nothing was played in it, what it brought waits.
    pub fn end_call(&self, bring: impl FnOnce(&mut dyn FnMut(NoteEvent<()>))) {
        let Some(mut waiting) = self.open() else { return };
        if waiting.played {
            return;
        }
        let first = waiting.events.len();
        bring(&mut |event| waiting.put(first, event));
    }

    /// Whether nothing waits.
    pub fn is_empty(&self) -> bool {
        self.open().is_none_or(|waiting| waiting.events.is_empty())
    }
}

impl List {
    /// An event comes, in a call whose first has or would have had the index `first`: after those of its sample and before later
    /// ones, which is moved and not sorted since sorting may allocate.
    fn put(&mut self, first: usize, event: NoteEvent<()>) {
        let Self { events, lifted, .. } = self;
        // Before there is any, nothing plays.
        let room = events.capacity().min(ROOM);
        let ends = ends(&event);
        if events.len() < if ends { room } else { room / 2 } {
            let later = events[first..].partition_point(|other| other.timing() <= event.timing());
            events.insert(first + later, event);
            return;
        }
        match event {
            NoteEvent::NoteOff { channel, key, .. } | NoteEvent::Choke { channel, key, .. } => {
                let keys = key.number().map_or(u128::MAX, |key| 1 << (key & 127));
                let meant = |own: u8| channel.number().is_none_or(|channel| channel == own);
                let channels = (0..).zip(lifted).filter(|&(own, _)| meant(own));
                channels.for_each(|(_, lifted)| *lifted |= keys);
            }
            // What a controller says last counts, if not when. A note without room is not played.
            _ if ends => {
                let same = |other: &&mut NoteEvent<()>| is_of_the_same(other, &event);
                events.iter_mut().rev().find(same).into_iter().for_each(|other| *other = event);
            }
            _ => {}
        }
    }
}

/// Whether it ends something, or may.
fn ends(event: &NoteEvent<()>) -> bool {
    use NoteEvent::{Choke, MidiCC, MidiChannelPressure, MidiPitchBend, MonoAutomation, NoteOff};
    matches!(
        event,
        NoteOff { .. }
            | Choke { .. }
            | MidiCC { .. }
            | MidiChannelPressure { .. }
            | MidiPitchBend { .. }
            | MonoAutomation { .. }
    )
}

/// Whether both say something of the same controller of a channel, or of the same parameter.
fn is_of_the_same(one: &NoteEvent<()>, other: &NoteEvent<()>) -> bool {
    let controller = |event: &NoteEvent<()>| match *event {
        NoteEvent::MidiCC { channel, cc, .. } => Some((u32::from(channel), Some(cc))),
        NoteEvent::MidiPitchBend { channel, .. } | NoteEvent::MidiChannelPressure { channel, .. } => {
            Some((u32::from(channel), None))
        }
        NoteEvent::MonoAutomation { poly_modulation_id, .. } => Some((poly_modulation_id, None)),
        _ => None,
    };
    std::mem::discriminant(one) == std::mem::discriminant(other) && controller(one) == controller(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(timing: u32, key: u8) -> NoteEvent<()> {
        let (voice_id, channel) = (VoiceID::Wildcard, Channel::Number(2));
        NoteEvent::NoteOn { timing, voice_id, channel, key: Key::Number(key), velocity: 0.5 }
    }

    fn off(channel: Channel, key: Key) -> NoteEvent<()> {
        NoteEvent::NoteOff { timing: 0, voice_id: VoiceID::Wildcard, channel, key, velocity: 0.0 }
    }

    fn cc(value: f32) -> NoteEvent<()> {
        NoteEvent::MidiCC { timing: 0, channel: 2, cc: 64, value }
    }

    fn choke(key: u8) -> NoteEvent<()> {
        let (voice_id, channel) = (VoiceID::Wildcard, Channel::Number(2));
        NoteEvent::Choke { timing: 0, voice_id, channel, key: Key::Number(key) }
    }

    /// A call in which nothing is played brings this.
    fn call(waiting: &Waiting, events: &[NoteEvent<()>]) {
        waiting.begin_call();
        waiting.end_call(|keep| events.iter().for_each(|&event| keep(event)));
    }

    fn played(waiting: &Waiting) -> Vec<NoteEvent<()>> {
        let mut events = Vec::new();
        waiting.hand_over(|event| events.push(event));
        events
    }

    #[test]
    fn events_of_a_call_are_in_order_of_their_samples_and_calls_one_after_another() {
        let waiting = Waiting::default();
        waiting.make_room();
        call(&waiting, &[on(9, 1), on(3, 2), on(9, 3), on(0, 4)]);
        call(&waiting, &[on(5, 5), on(0, 6)]);
        assert!(!waiting.is_empty());
        assert_eq!(played(&waiting), [4, 2, 1, 3, 6, 5].map(|key| on(0, key)));
        assert!(waiting.is_empty() && played(&waiting).is_empty());
    }

    #[test]
    fn what_was_played_does_not_wait() {
        let waiting = Waiting::default();
        waiting.make_room();
        call(&waiting, &[on(0, 1)]);
        waiting.begin_call();
        assert_eq!(played(&waiting), [on(0, 1)]);
        waiting.end_call(|keep| keep(on(0, 2)));
        assert!(waiting.is_empty());
    }

    #[test]
    fn room_is_made_once_and_what_ends_notes_is_not_lost() {
        let waiting = Waiting::default();
        waiting.make_room();
        let room = waiting.open().expect("nobody looks").events.capacity();
        let put = |event| waiting.open().expect("nobody looks").put(0, event);
        put(cc(1.0));
        (0..9_000).for_each(|_| put(on(0, 60)));
        (0..9_000).for_each(|_| put(off(Channel::Number(2), Key::Number(60))));
        put(off(Channel::Number(3), Key::Wildcard));
        put(off(Channel::Wildcard, Key::Number(7)));
        put(choke(61));
        put(cc(0.0));
        assert_eq!(waiting.open().expect("nobody looks").events.capacity(), room);
        let events = played(&waiting);
        assert_eq!(events[0], cc(0.0), "the pedal is up at last");
        assert_eq!(events.iter().filter(|&&event| event == on(0, 60)).count(), ROOM / 2 - 1);
        let ended: Vec<_> = events
            .iter()
            .filter_map(|event| match event {
                NoteEvent::Choke { channel, key, .. } => Some((channel.number()?, key.number()?)),
                _ => None,
            })
            .collect();
        assert!(
            ended.contains(&(2, 60))
                && ended.contains(&(2, 61))
                && (0..128).all(|key| ended.contains(&(3, key)))
        );
        assert!((0..16).all(|channel| ended.contains(&(channel, 7))));
        assert_eq!(ended.len(), 2 + 128 + 15);
        assert!(played(&waiting).is_empty());
        // Before there is any, nothing waits.
        let closed = Waiting::default();
        closed.open().expect("nobody looks").put(0, on(0, 60));
        assert!(played(&closed).is_empty());
    }
}
