//! Fingers that move along the string: over frets, and where nothing keeps them on any.

use low_action_dsp::Gesture;

use super::held::Grip;
use super::{Departing, Finger, Fingers, Way};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// The finger that sounds slides to another fret, which is the note's own from then on. Gives back the slide.
    pub(super) fn slide_to(
        &mut self,
        fret: usize,
        duration: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> Option<Gesture> {
        self.home = fret;
        let slide = self.slide(0, duration, at).1;
        let taken = self.time_to_arrive(at);
        if let Some(finger) = &mut self.fretting {
            finger.at_note = at.after(taken);
        }
        if self.tightened > 1.0 {
            self.press_on(taken, at);
        }
        slide
    }

    /// How long the finger that stops the string will be under way, s.
    pub(crate) fn time_to_arrive(&self, at: &Moment<impl GestureSink>) -> f64 {
        self.fretting.map_or(0.0, |finger| finger.time_to_arrive(at))
    }

    /// A finger behind the one that moves to a place counted in frets leaves, fast if it is in the way, as one does that is leaving there
    /// already.
    fn lift_anchor(&mut self, place: f64, at: &mut Moment<impl GestureSink>) {
        if let Some(anchor) = self.anchor.take() {
            let manner = if anchor.is_below(place) { NODE_LIFT } else { QUICK_LIFT };
            self.depart(anchor.slot, anchor.touch, manner, at);
        }
        let time = at.time;
        let in_the_way = |departing: &mut Departing| {
            time < departing.clear && departing.back.is_some_and(|(finger, _)| !finger.is_below(place))
        };
        for departing in &mut self.departing {
            if let Some(Departing { lift, .. }) = departing.take_if(in_the_way) {
                at.does(lift);
            }
        }
    }

    /// Slides the fretting finger so many frets away from where the note began, as far as it [can](Self::can_slide), and no faster
    /// than hands do, however often it is told: a wheel that moves sends a hundred goals a second. Gives back how many frets it is
    /// away then, and the slide if it moves.
    pub(crate) fn slide(
        &mut self,
        frets: i32,
        duration: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> (i32, Option<Gesture>) {
        let frets = self.can_slide(frets);
        let Some(sliding) = self.slidable() else { return (frets, None) };
        let fret = self.home as i32 + frets;
        let mut slide = None;
        if f64::from(fret) != sliding.stands() {
            self.come(at);
            let here = sliding.way.come_to(self.pressed(&sliding), at.time);
            self.lift_anchor(f64::from(fret), at);
            let position = self.place(fret as usize, sliding.bar);
            let duration = sliding.unhurried(duration, at).max((position - here).abs() / SLIDE_SPEED);
            if let Some(finger) = &mut self.fretting {
                (finger.fret, finger.glided, finger.free) = (fret as usize, 0.0, None);
                finger.way = Way::from(here, duration, at);
            }
            slide = Some(self.move_along(&sliding, position, duration, at));
        }
        (frets, slide)
    }

    /// How far the fretting finger can be away from where the note began if it is to be so many frets: as far as the neck goes. One
    /// that has ceased to press stays where it is, and where there is none nothing slides.
    pub(crate) fn can_slide(&self, frets: i32) -> i32 {
        let home = self.home as i32;
        if self.slidable().is_none() {
            return self.fretting.map_or(0, |finger| finger.fret as i32 - home);
        }
        self.within_neck(self.home, self.capo[1], frets)
    }

    /// How far from the fret of a note, 0 for the open string, a finger can come down that is to be so many frets away: as
    /// far as the neck goes. On an open string none comes down for less.
    pub(crate) fn reach(&self, fret: usize, frets: i32) -> i32 {
        let capo = self.capo[0];
        if fret <= capo && (fret as i32).saturating_add(frets) <= capo as i32 {
            return 0;
        }
        self.within_neck(fret, capo, frets)
    }

    fn within_neck(&self, home: usize, capo: usize, frets: i32) -> i32 {
        let (home, first, last) = (home as i32, capo as i32 + 1, self.string.geometry.frets.len() as i32);
        frets.clamp(first.min(last) - home, last - home)
    }

    /// Slides count from this fret, that of the note, though its finger may have come down elsewhere.
    pub(crate) fn count_from(&mut self, fret: usize) {
        (self.home, self.beside) = (fret, 0.0);
    }

    /// So many semitones, or as many of them as the neck has for a finger that glides.
    pub(crate) fn can_glide(&self, semitones: f64) -> f64 {
        self.slidable().map_or(semitones, |finger| self.within_board(finger.fret, semitones))
    }

    /// Whether a finger that glides is to be elsewhere for so many semitones than where it is or goes.
    pub(crate) fn has_to_glide(&self, semitones: f64) -> bool {
        self.slidable().is_some_and(|finger| finger.glided != semitones)
    }

    pub(super) fn within_board(&self, fret: usize, semitones: f64) -> f64 {
        let (fret, last) = (fret as f64, self.string.geometry.frets.len() as f64);
        semitones.max(0.3 - fret).min(last - fret)
    }

    /// Where nothing keeps it on frets, the finger of a note to come is to come down so many semitones from its fret.
    pub(crate) fn expect_beside(&mut self, semitones: f64) {
        self.beside = semitones;
    }

    /// How far from a fret a finger comes down, semitones; what nut or capo stops has none.
    pub(super) fn comes_beside(&self, fret: usize) -> f64 {
        if self.beside == 0.0 || fret <= self.capo[0] { 0.0 } else { self.within_board(fret, self.beside) }
    }

    /// Where that is, counted in frets.
    pub(super) fn comes_to(&self, fret: usize) -> f64 {
        fret as f64 + self.comes_beside(fret)
    }

    pub(super) fn slidable(&self) -> Option<Finger> {
        self.fretting.filter(|finger| finger.grip == Grip::Presses)
    }

    /// How far from the fret of its note a finger stops the string once it is there, semitones.
    pub(crate) fn away(&self) -> f64 {
        self.fretting.map_or(0.0, |finger| finger.stands() - self.home as f64)
    }

    /// Whether nothing keeps fingers on frets.
    pub(crate) fn is_fretless(&self) -> bool {
        self.string.fretless
    }

    /// Whether nothing keeps the finger on frets, so that it is moved where others pull the string.
    pub(crate) fn glides(&self) -> bool {
        self.slidable().is_some_and(|finger| finger.bar || self.string.fretless)
    }

    /// Moves a finger that glides to so many semitones from its note, as far as the neck goes. Gives back how many it is
    /// away then.
    pub(crate) fn glide(&mut self, semitones: f64, duration: f64, at: &mut Moment<impl GestureSink>) -> f64 {
        let Some(finger) = self.slidable() else { return 0.0 };
        let reached = self.can_glide(semitones);
        if !self.has_to_glide(reached) {
            return reached;
        }
        self.come(at);
        self.lift_anchor(finger.fret as f64 + reached, at);
        self.move_beside(reached, finger.unhurried(duration, at), at);
        reached
    }

    /// The finger that stops the string goes to so many semitones from its fret.
    pub(super) fn move_beside(&mut self, semitones: f64, duration: f64, at: &mut Moment<impl GestureSink>) {
        let Some(finger) = self.fretting else { return };
        let way = Way::from(finger.way.come_to(self.pressed(&finger), at.time), duration, at);
        let moved = Finger { glided: semitones, way, ..finger };
        self.fretting = Some(moved);
        self.move_along(&moved, self.glided_place(moved.stands(), moved.bar), duration, at);
    }
}
