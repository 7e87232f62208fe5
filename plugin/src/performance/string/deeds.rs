//! What is yet to be done to a note that sounds: strokes that are on their way, and touches that end.

use std::mem::discriminant;

use super::StringPlayer;
use super::stilling::Stilling;
use crate::performance::articulation::Stroke;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment, Technique};

/// A stroke of the right hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Struck {
    /// Of what kind.
    pub stroke: Stroke,
    /// How hard, 1 for the hardest velocity.
    pub strength: f64,
    /// How far beside the usual place, m, in all.
    pub beside: f64,
    /// How much of that the whole hand has been moved on purpose, m: the thumb of a pinch goes with it.
    pub moved: f64,
}

impl Struck {
    /// Where a stroke goes forth or back, it is of those in turn with another.
    pub(super) fn in_turn_with(self, before: Self) -> Self {
        let turns = |stroke| matches!(stroke, Stroke::Down | Stroke::Up);
        let stroke = if turns(self.stroke) && turns(before.stroke) { before.stroke } else { self.stroke };
        Self { stroke, ..self }
    }
}

/// Something to do at its time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Deed {
    /// A stroke.
    Strike(Struck),
    /// The hand stills the string for a stroke that follows.
    Still(Stilling),
    /// A stroke of a tremolo, back and forth, with the next one to follow.
    Tremolo,
    /// A finger strikes the string behind a fret, how hard, 0 to 1, by one technique or another.
    Tap {
        fret: usize,
        strength: f64,
        technique: Technique,
    },
    /// A light finger touches the node of a harmonic, and leaves it.
    TouchNode,
    LeaveNode,
    /// The thumb bounces off, and the palm comes back.
    Bounce,
    LayPalm,
    /// A palm that has waited for a note goes.
    LiftPalm,
    /// The thumb grazes the string at a node of this partial, and leaves it.
    Graze(u32),
    LeaveGraze,
}

/// Deeds in any order, one of each kind: there is room for all eleven.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Deeds([Option<(u64, Deed)>; 11]);

impl Deeds {
    /// Adds one, in place of another of its kind.
    pub(super) fn plan(&mut self, time: u64, deed: Deed) {
        let same = |other: &Deed| discriminant(other) == discriminant(&deed);
        let place = self.0.iter().position(|slot| slot.is_some_and(|(_, other)| same(&other)));
        let place = place.or_else(|| self.0.iter().position(Option::is_none));
        debug_assert!(place.is_some(), "no room for {deed:?}");
        if let Some(place) = place {
            self.0[place] = Some((time, deed));
        }
    }

    /// Only such are done.
    fn keep(&mut self, is_done: impl Fn(&Deed) -> bool) {
        for deed in &mut self.0 {
            *deed = deed.filter(|(_, deed)| is_done(deed));
        }
    }

    /// The palm does not come back: the thumb strikes once more.
    fn forget_laying(&mut self) {
        self.keep(|deed| *deed != Deed::LayPalm);
    }

    /// The string is stopped elsewhere: a finger that was to strike does not, and neither thumb nor finger touches what has no node
    /// there any more.
    pub(super) fn forget_touches(&mut self) {
        self.keep(|deed| !matches!(deed, Deed::Tap { .. } | Deed::Graze(_) | Deed::TouchNode));
    }

    /// No stroke comes any more.
    pub(super) fn forget_strokes(&mut self) {
        self.keep(|deed| {
            !matches!(
                deed,
                Deed::Strike(_) | Deed::Still(_) | Deed::Tremolo | Deed::Tap { .. } | Deed::TouchNode
            )
        });
    }

    /// Whether a stroke or a tap is yet to come.
    pub(super) fn await_sound(&self) -> bool {
        self.0.iter().flatten().any(|(_, deed)| matches!(deed, Deed::Strike(_) | Deed::Tap { .. }))
    }

    /// Takes out the stroke that is to come before a time. The hand that was to still the string for it has no time for that.
    pub(super) fn take_stroke(&mut self, until: u64) -> Option<Struck> {
        let struck = self.0.iter_mut().find_map(|slot| match *slot {
            Some((time, Deed::Strike(struck))) if time < until => {
                *slot = None;
                Some(struck)
            }
            _ => None,
        })?;
        self.keep(|deed| !matches!(deed, Deed::Still(_)));
        Some(struck)
    }

    /// A palm waits no more.
    pub(super) fn forget_palm(&mut self) {
        self.keep(|deed| *deed != Deed::LiftPalm);
    }

    /// A tremolo ends.
    fn forget_tremolo(&mut self) {
        self.keep(|deed| !matches!(deed, Deed::Tremolo));
    }

    /// When the next one is due.
    pub(super) fn next(&self) -> Option<u64> {
        self.0.iter().flatten().map(|&(time, _)| time).min()
    }

    /// Takes the next one out.
    fn take(&mut self) -> Option<Deed> {
        let next = self.next()?;
        let slot = self.0.iter_mut().find(|deed| deed.is_some_and(|(time, _)| time == next))?;
        slot.take().map(|(_, deed)| deed)
    }
}

impl StringPlayer {
    /// Does what is due next.
    pub(super) fn do_next(&mut self, at: &mut Moment<impl GestureSink>) {
        match self.deeds.take() {
            None => {}
            Some(Deed::Strike(struck)) => self.strike(struck, 0.0, at),
            Some(Deed::Still(stilling)) => self.still(stilling, at),
            Some(Deed::Tremolo) => self.tremble(at),
            Some(Deed::Tap { fret, strength, technique }) => self.tap(fret, strength, technique, at),
            Some(Deed::TouchNode) => self.lay_light_finger(at),
            Some(Deed::LeaveNode) => self.fingers.leave_node(at),
            Some(Deed::Bounce) => {
                self.fingers.bounce(at);
                self.deeds.plan(at.after(SLAP_CLEAR), Deed::LayPalm);
            }
            Some(Deed::LayPalm) => self.fingers.lay_palm(at),
            Some(Deed::LiftPalm) => self.fingers.lift_palm(at),
            Some(Deed::Graze(partial)) => {
                self.fingers.graze(partial, at);
                self.deeds.plan(at.after(GRAZE_TIME), Deed::LeaveGraze);
            }
            Some(Deed::LeaveGraze) => self.fingers.leave_graze(at),
        }
    }

    /// The next stroke of a tremolo, and one to follow.
    fn tremble(&mut self, at: &mut Moment<impl GestureSink>) {
        let Some(note) = self.note.as_mut().filter(|_| self.tremolo > 0.0) else { return };
        note.struck.stroke = match note.struck.stroke {
            Stroke::Down => Stroke::Up,
            Stroke::Up => Stroke::Down,
            other => other,
        };
        let note = *note;
        // Under the pedal it waits: a key below may come back.
        if note.key_down() {
            // A light finger that is at its node already lets no finger up: nothing asks the hand to stay longer for it.
            let stilling = self.stilling(note.struck.stroke, note.fret, false, None);
            self.touch_node(stilling.lead, at);
            self.still(stilling, at);
            self.deeds.plan(at.after(stilling.lead), Deed::Strike(note.struck));
        }
        self.deeds.plan(at.after(1.0 / self.tremolo).max(at.time + 1), Deed::Tremolo);
    }

    /// A finger touches the node of a harmonic for a stroke so many seconds from now, and stays for a while after it, in a tremolo until
    /// the next one. It comes with the stroke: what stopped the string before has let it up by then, and hands that damped it have gone.
    pub(super) fn touch_node(&mut self, wait: f64, at: &mut Moment<impl GestureSink>) {
        if self.note.is_none_or(|note| note.partial.is_none()) {
            return;
        }
        if wait > 0.0 {
            self.deeds.plan(at.after(wait), Deed::TouchNode);
        } else {
            self.lay_light_finger(at);
        }
        let next = if self.tremolo > 0.0 { 1.0 / self.tremolo } else { 0.0 };
        self.deeds.plan(at.after(wait + next + AT_NODE), Deed::LeaveNode);
    }

    /// It does so now.
    fn lay_light_finger(&mut self, at: &mut Moment<impl GestureSink>) {
        if let Some(order) = self.note.and_then(|note| note.partial) {
            self.fingers.touch_node(order, at);
        }
    }

    /// How far beside its usual place a stroke must fall for a harmonic, m.
    pub(super) fn towards_antinode(&self) -> f64 {
        let partial = self.note.and_then(|note| note.partial);
        partial.map_or(0.0, |order| self.fingers.towards_antinode(order))
    }

    /// A tremolo has so many strokes a second from its next one on, 0 for none. Gives back how many it had.
    pub(super) fn set_tremolo(&mut self, rate: f64) -> f64 {
        if rate <= 0.0 {
            // A stroke that was yet to come would begin a second one beside the next.
            self.deeds.forget_tremolo();
        }
        std::mem::replace(&mut self.tremolo, rate)
    }

    /// The note that sounds, whose string had so many strokes a second before, has a tremolo from now on if it is to have one.
    pub(super) fn begin_tremolo(&mut self, before: f64, at: &Moment<impl GestureSink>) {
        if self.note.is_some() && before == 0.0 && self.tremolo > 0.0 {
            self.deeds.plan(at.after(1.0 / self.tremolo), Deed::Tremolo);
        }
    }

    /// A finger strikes the string behind a fret, how hard, 0 to 1: once the string is up there. Gives back in how many seconds.
    pub(super) fn tap_when_up(
        &mut self,
        fret: usize,
        strength: f64,
        technique: Technique,
        at: &mut Moment<impl GestureSink>,
    ) -> f64 {
        let Some(rising) = self.fingers.let_up(fret, strength, at) else {
            self.tap(fret, strength, technique, at);
            return 0.0;
        };
        self.deeds.plan(at.after(rising), Deed::Tap { fret, strength, technique });
        // Even the shortest note is to be heard.
        let later = self.samples(rising);
        if let Some(note) = &mut self.note {
            note.since += later;
        }
        rising
    }

    /// It does so now.
    fn tap(&mut self, fret: usize, strength: f64, technique: Technique, at: &mut Moment<impl GestureSink>) {
        let thrown = self.fingers.hammer(fret, strength, at);
        if let Some(note) = self.note {
            self.fingers.count_from(note.fret);
        }
        self.bend.tell_change(&self.fingers, at);
        self.bend.renew(at.time);
        self.tells_sound(0.0, self.fingers.excitation(technique, Some(thrown), None), at);
    }

    /// The right hand strikes, so many seconds from now.
    pub(super) fn strike(&mut self, struck: Struck, delay: f64, at: &mut Moment<impl GestureSink>) {
        let Struck { stroke, strength, beside, moved } = struck;
        if stroke == Stroke::Slap {
            let thrown = self.fingers.slap(strength, at);
            self.tells_sound(0.0, self.fingers.excitation(Technique::Slap, Some(thrown), None), at);
            self.deeds.forget_laying();
            return self.deeds.plan(at.after(SLAP_TIME), Deed::Bounce);
        }
        let pinched = (stroke == Stroke::Pinch).then(|| self.fingers.pinched_partial(moved));
        if let Some(pluck) = self.fingers.pluck(stroke, strength, beside, moved) {
            at.does_later(delay, pluck);
            let excitation = self.fingers.excitation(Technique::of(stroke), Some(pluck), pinched);
            self.tells_sound(delay, excitation, at);
        }
        if let Some(partial) = pinched {
            let [push, _] = self.fingers.pluck_times();
            self.deeds.plan(at.after(delay + push), Deed::Graze(partial));
        }
    }
}
