//! Other engines in the place of the one that plays.

use super::Playing;
use crate::engine::Replacement;
use crate::plugin::order::Order;
use crate::plugin::shelf::Shelf;
use crate::plugin::workshop::Finished;

/// How long values may take that belong to an awaited file, s: longer than the editor waits for them. A window that was closed
/// meanwhile waits for nothing.
const PATIENCE: f64 = 2.0;

impl Playing {
    /// Sees to it that the engine becomes what is wanted: at once where the host renders offline, as soon as
    /// it is built in real time. Gives the number of samples after which to look again, if before the
    /// end of the block.
    ///
    /// What was built for a knob that has moved on since is played in the meantime.
    pub(super) fn exchange(&mut self, wanted: Order) -> Option<u64> {
        self.ask(wanted);
        if self.asked.is_none() {
            // What is finished now comes too late.
            while let Some(late) = self.ready.take().or_else(|| self.workshop.collect()) {
                if late.result.is_err() && wanted == self.order {
                    self.say_that_all_is_well();
                }
                self.workshop.give_back(late.result);
            }
            return None;
        }
        if self.ready.is_none() {
            let fading = self.engine.fading_left();
            if self.offline && fading > 0 {
                return Some(fading);
            }
            self.ready = if self.offline { self.workshop.wait(&wanted) } else { self.workshop.collect() };
        }
        let Finished { order, result } = self.ready.take()?;
        if order == self.order {
            self.workshop.give_back(result);
            return None;
        }
        match result {
            Ok(replacement) => match self.engine.replace(replacement, self.asked_at) {
                Ok(()) => {
                    self.order = order;
                    self.set_effort(self.relaxed);
                    self.meters.count_exchange();
                }
                Err(replacement) => {
                    self.ready = Some(Finished { order, result: Ok(replacement) });
                    return Some(self.engine.fading_left().max(1));
                }
            },
            Err(message) => {
                // The engine there is plays on, and nothing is asked for again.
                self.refused = Some(order);
                self.meters.refuse();
                self.workshop.give_back(Err(message));
            }
        }
        if self.asked == Some(order) {
            self.asked = None;
        }
        None
    }

    /// Looks whether a file is awaited, before the parameters are looked at: in real time only, since the editor has its own
    /// time.
    pub(super) fn look_at(&mut self, shelf: &Shelf) {
        let awaits = !self.offline && shelf.is_awaited();
        self.awaits_since = awaits.then(|| self.awaits_since.unwrap_or_else(|| self.engine.now()));
    }

    /// Whether what is wanted now is to be passed over: a mixture of one file's values and another's.
    pub(super) fn awaits(&self) -> bool {
        let patience = (PATIENCE * f64::from(self.order.sample_rate)) as u64;
        self.awaits_since.is_some_and(|since| self.engine.now().saturating_sub(since) < patience)
    }

    /// What is wanted plays already. But only who builds it takes back what was told of something else.
    fn say_that_all_is_well(&self) {
        self.workshop.order(self.order);
    }

    /// Orders what is wanted, unless it is played, on its way, or was refused; or something else is awaited.
    fn ask(&mut self, wanted: Order) {
        if self.awaits() {
            return;
        }
        if self.refused.take_if(|refused| *refused != wanted).is_some() && wanted == self.order {
            self.say_that_all_is_well();
        }
        if wanted != self.asked.or(self.refused).unwrap_or(self.order) {
            // What follows of the same instrument is meant by the notes that began since it was first asked for.
            if self.asked.is_none_or(|before| !wanted.is_of_the_same(&before)) {
                self.asked_at = self.engine.now();
            }
            self.asked = (wanted != self.order).then_some(wanted);
            if let Some(order) = self.asked {
                self.workshop.order(order);
            }
        }
    }

    /// Sends what has been replaced back to the workshop.
    pub(super) fn retire(&mut self) {
        if let Some(outgoing) = self.engine.take_outgoing() {
            self.workshop.give_back(Ok(outgoing));
        }
    }
}

// A replacement travels between threads.
const _: fn() = || {
    fn assert_send<T: Send>() {}
    assert_send::<Box<Replacement>>();
};

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::thread::sleep;
    use std::time::{Duration, Instant};

    use nice_plug::prelude::Enum;

    use super::*;
    use crate::engine::Quality;
    use crate::params::{InstrumentChoice, LowActionParams};
    use crate::plugin::meters::Meters;

    fn order() -> Order {
        Order::of(&LowActionParams::default(), 48_000.0, false)
    }

    /// With another action.
    fn other(action: f64) -> Order {
        let mut order = order();
        order.luthier.action = action;
        order
    }

    fn playing(order: Order, offline: bool, meters: &Arc<Meters>) -> Playing {
        Playing::new(order, offline, Shelf::new(Vec::new()), meters.clone()).expect("it can be built")
    }

    /// Has an engine exchanged in real time until something has come of it.
    fn exchange_until(playing: &mut Playing, wanted: Order, done: impl Fn(&Playing) -> bool) {
        let begun = Instant::now();
        while !done(playing) {
            assert!(begun.elapsed() < Duration::from_secs(60), "waited in vain");
            playing.exchange(wanted);
            sleep(Duration::from_millis(1));
        }
    }

    /// One that was exchanged, while another waits until the first has faded.
    fn waiting(meters: &Arc<Meters>) -> Playing {
        let mut playing = playing(order(), false, meters);
        exchange_until(&mut playing, other(1.1), |playing| playing.order == other(1.1));
        exchange_until(&mut playing, other(1.2), |playing| playing.ready.is_some());
        assert!(playing.engine.fading_left() > 0);
        playing
    }

    /// Plays until everything has faded.
    fn fade(playing: &mut Playing) {
        let (mut left, mut right) = ([0.0; 4096], [0.0; 4096]);
        playing.engine.process(&mut left, &mut right);
        playing.retire();
    }

    #[test]
    fn what_waits_for_a_fade_is_not_ordered_again() {
        let meters = Arc::new(Meters::default());
        let mut playing = waiting(&meters);
        for _ in 0..3 {
            assert!(playing.exchange(other(1.2)).is_some());
            assert!(playing.asked == Some(other(1.2)) && playing.ready.is_some());
        }
        fade(&mut playing);
        playing.exchange(other(1.2));
        assert!(playing.is(&other(1.2)) && playing.ready.is_none());
        assert_eq!(meters.exchanges(), 2);
    }

    #[test]
    fn who_goes_back_keeps_what_plays() {
        let meters = Arc::new(Meters::default());
        let mut playing = waiting(&meters);
        playing.exchange(other(1.1));
        assert!(playing.is(&other(1.1)) && playing.ready.is_none());
        fade(&mut playing);
        playing.exchange(other(1.1));
        assert_eq!(meters.exchanges(), 1);
    }

    /// Another instrument.
    fn another(action: f64) -> Order {
        let mut order = other(action);
        order.instrument = InstrumentChoice::from_index(3);
        order
    }

    #[test]
    fn notes_count_from_when_the_instrument_was_asked_for_that_is_to_play_them() {
        let meters = Arc::new(Meters::default());
        let mut playing = playing(order(), false, &meters);
        let mut asked_after = |wanted| {
            let (mut left, mut right) = ([0.0; 512], [0.0; 512]);
            playing.engine.process(&mut left, &mut right);
            // Whatever is built meanwhile is not fetched.
            playing.ask(wanted);
            playing.asked_at / 512
        };
        // Another action of the same instrument, then another instrument, and that with other actions.
        assert_eq!(
            [other(1.1), another(1.1), another(1.2), another(1.3)].map(&mut asked_after),
            [1, 2, 2, 2]
        );
        // Back to the one that plays, with another action, and to another one once more.
        assert_eq!([other(1.4), other(1.5), another(1.5)].map(&mut asked_after), [5, 5, 7]);
    }

    /// Nothing can be built from it: no string is as heavy as the lowest and bears the tension of the highest key.
    fn impossible() -> Order {
        let mut order = order();
        order.luthier.strings[5] = 127.0;
        (order.luthier.quality, order.luthier.iterations) = (Quality::Reference, 150);
        order
    }

    #[test]
    fn what_cannot_be_built_changes_nothing() {
        let meters = Arc::new(Meters::default());
        let mut playing = playing(order(), true, &meters);
        for _ in 0..3 {
            playing.exchange(impossible());
            assert!(playing.order == order() && !playing.is(&impossible()));
        }
        assert_eq!(meters.refusals(), 1);
    }

    /// Where the editor looks for it.
    #[test]
    fn what_cannot_be_built_is_told_until_something_else_is_asked_for() {
        let (meters, shelf) = (Arc::new(Meters::default()), Shelf::new(Vec::new()));
        let of = |order| Playing::new(order, true, shelf.clone(), meters.clone()).expect("it can be built");
        let told = |ending: &str| shelf.message().is_some_and(|message| message.ends_with(ending));
        let mut as_it_comes = of(impossible());
        assert!(told("; the set-up is played as it comes"), "{:?}", shelf.message());
        as_it_comes.exchange(impossible());
        assert!(told("; the set-up is played as it comes"), "{:?}", shelf.message());
        as_it_comes.exchange(order());
        assert_eq!(shelf.message(), None);
        drop(as_it_comes);
        let mut before = of(order());
        before.exchange(impossible());
        assert!(told("; what was there before plays on"), "{:?}", shelf.message());
        // What plays already is not exchanged.
        let begun = Instant::now();
        while shelf.message().is_some() {
            assert!(begun.elapsed() < Duration::from_secs(60), "it is told for ever");
            before.exchange(order());
            sleep(Duration::from_millis(1));
        }
        assert_eq!(meters.exchanges(), 1);
    }

    /// Who asks for something impossible and at once for what plays hears of it when it has been tried, and no longer.
    #[test]
    fn what_is_told_too_late_is_taken_back() {
        let (meters, shelf) = (Arc::new(Meters::default()), Shelf::new(Vec::new()));
        let mut playing = Playing::new(order(), false, shelf.clone(), meters).expect("it can be built");
        playing.exchange(impossible());
        playing.exchange(order());
        let begun = Instant::now();
        let wait = || {
            assert!(begun.elapsed() < Duration::from_secs(60), "waited in vain: {:?}", shelf.message());
            sleep(Duration::from_millis(1));
        };
        while shelf.message().is_none() {
            wait();
        }
        while shelf.message().is_some() {
            playing.exchange(order());
            wait();
        }
    }

    #[test]
    fn what_cannot_be_built_is_played_as_it_comes() {
        let meters = Arc::new(Meters::default());
        let mut playing = playing(impossible(), true, &meters);
        playing.exchange(impossible());
        assert!(playing.is(&impossible()), "it would be built again at every activation");
        assert!(playing.order == impossible().untouched());
        assert_eq!(meters.refusals(), 1);
    }
}
