//! Strings that move together, sample by sample: those over one body, of which each hears all others, or one by itself.

use std::ops::Range;
use std::slice::from_mut;

use crate::body::Body;
use crate::gesture::{Gesture, TimedGesture};
use crate::voice::{RUN, Voice};

/// Begins a gesture on one of them, for which all wake.
pub(crate) fn begin(strings: &mut [Voice], index: usize, gesture: Gesture) {
    let rest = are_at_rest(strings);
    strings.iter_mut().for_each(|string| string.wake(rest));
    strings[index].begin(gesture);
}

/// Steps them through so many samples of the host's, at most [`RUN`], into the `run` of each.
pub(crate) fn run(strings: &mut [Voice], samples: usize) {
    if are_at_rest(strings) {
        strings.iter_mut().for_each(Voice::be_silent);
    } else {
        sound(strings, 0..samples);
    }
}

/// Plays a string that is by itself through a stretch from sample `now` on into its `run`, with its gestures in order of time: the
/// same samples as those of one [`run`] after another. Allocates where the stretch is longer than any before.
pub(crate) fn play<'a>(
    string: &mut Voice,
    now: u64,
    gestures: impl Iterator<Item = &'a TimedGesture>,
    samples: usize,
) {
    string.make_room(samples);
    let strings = from_mut(string);
    let mut gestures = gestures.peekable();
    let (mut done, mut sounded) = (0, false);
    while done < samples {
        let time = now + done as u64;
        while let Some(due) = gestures.next_if(|next| next.time <= time) {
            begin(strings, 0, due.gesture);
        }
        let until_gesture = gestures.peek().map_or(u64::MAX, |next| next.time - time);
        let run = (samples - done).min(RUN).min(usize::try_from(until_gesture).unwrap_or(RUN));
        let span = done..done + run;
        if are_at_rest(strings) {
            strings[0].run[span].fill(0.0);
        } else {
            sounded = true;
            sound(strings, span);
        }
        done += run;
    }
    if !sounded {
        strings[0].be_silent();
    }
}

/// Whether all rest, and nothing that they have sent out is still on its way.
fn are_at_rest(strings: &mut [Voice]) -> bool {
    strings.iter_mut().all(Voice::is_at_rest)
}

/// Steps them through the samples `span` of the `run` of each, at most [`RUN`].
fn sound(strings: &mut [Voice], span: Range<usize>) {
    // (Over one body all have the same rate, and wake at the same sample.)
    let over_body = strings[0].body.is_some();
    for index in 0..strings[0].steps(span.len()) {
        let lift = if over_body { strings.iter().map(Voice::lift).sum() } else { 0.0 };
        let mut may_rest = true;
        for string in &mut *strings {
            may_rest &= string.step(index, lift);
        }
        if may_rest && strings.iter().all(Voice::has_quiet_body) {
            strings.iter_mut().for_each(Voice::fall_asleep);
        }
    }
    strings.iter_mut().for_each(|string| string.give(span.clone()));
}

/// Has them take over from as many others, in their order.
pub(crate) fn take_over(strings: &mut [Voice], old: &mut [Voice]) {
    let lift = old.iter().map(Voice::lift).sum();
    for (string, old) in strings.iter_mut().zip(old) {
        string.take_over(old, lift);
    }
    let Some((first, others)) = strings.split_first_mut() else { return };
    if others.is_empty() && first.body.is_none() {
        return;
    }
    // Those that come from by themselves may sleep, or share other steps with the host.
    let asleep = first.is_asleep() && others.iter().all(Voice::is_asleep);
    for string in &mut *others {
        string.follow(first);
    }
    if !asleep {
        strings.iter_mut().for_each(|string| string.wake(false));
    }
    if strings.iter().any(|string| string.body.as_ref().is_some_and(Body::is_new)) {
        hold(strings);
    }
}

/// Has a body begin where its strings hold it: the bridge gives way to F = Σ(pull·u − back·w) by w = CF, C = Σφ²/ω².
fn hold(strings: &mut [Voice]) {
    let (mut pulled, mut held) = (0.0, 1.0);
    for string in &*strings {
        let Some(body) = &string.body else { return };
        pulled += body.gives() * body.end().force(&string.state, 0.0);
        held += body.gives() * body.end().back;
    }
    let lift = pulled / held;
    for string in strings {
        if let Some(body) = &mut string.body {
            body.rest_under(body.end().force(&string.state, lift));
        }
    }
}
