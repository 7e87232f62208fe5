//! The fingers of both hands on one string: which slot each takes, and how it comes and goes.
//!
//! Two slots belong to fingers that stop the string. The one that sounds is `fretting`; another may be
//! held down behind it (`anchor`), so that a pull-off finds it there, or touch the string lightly.

mod behind_bar;
mod excitation;
mod hammering;
mod handed_over;
mod held;
mod landing;
mod leaving;
mod legato;
mod pace;
mod pressing;
mod pulling;
mod sighted;
mod sliding;
mod stopping;
mod tension;
mod touches;
mod way;

use low_action_dsp::setup::{Player, frequency};
use low_action_dsp::{FINGERS_PER_STRING, FingerSlot, Gesture, StringGeometry, Touch};

use super::articulation::Stroke;
use super::right_hand::{Field, RightHand};
use super::technique::*;
use super::{GestureSink, Moment, PlayedString};
use held::Grip;
pub(super) use landing::Ahead;
use landing::Awaited;
use leaving::hurried;
pub(super) use leaving::{QUIET_LIFT, lift_force, lifting};
pub(super) use pace::Pace;
use way::Way;

/// A finger behind a fret, or a bar over one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Finger {
    slot: FingerSlot,
    fret: usize,
    touch: Touch,
    /// What it does with the string.
    grip: Grip,
    /// Whether it is a bar.
    bar: bool,
    /// Its last slide.
    way: Way,
    /// When it is where a slide to its note's fret takes it.
    at_note: u64,
    /// Semitones by which it has glided away from its fret, where nothing keeps it on frets.
    glided: f64,
    /// Where it presses, m from the nut, if its fret has nothing to do with that.
    free: Option<f64>,
}

impl Finger {
    /// Where it stops the string, counted in frets.
    fn stands(&self) -> f64 {
        self.fret as f64 + self.glided
    }

    /// The fret that is nearest to where it stops the string.
    fn nearest_fret(&self) -> usize {
        self.stands().round() as usize
    }

    /// Whether it stops the string nearer to the nut than at a place counted in frets, or nearer to the saddle.
    fn is_below(&self, place: f64) -> bool {
        self.stands() < place - same_fret(place)
    }

    fn is_above(&self, place: f64) -> bool {
        self.stands() > place + same_fret(place)
    }

    /// Whether it stops the string there.
    fn is_at(&self, place: f64) -> bool {
        !self.is_below(place) && !self.is_above(place)
    }

    /// It counts from another fret, and stays where it is.
    fn count_from(&mut self, fret: usize) {
        (self.fret, self.glided) = (fret, self.stands() - fret as f64);
    }

    /// It leaves when the next note is about to sound.
    fn gives_way(&self) -> Gesture {
        hurried(self.slot, self.touch)
    }

    /// It lets go of a string that is about to sound in a manner of leaving; nobody throws a bar up otherwise than as it goes.
    fn lets_go(&self, manner: Leaving) -> Gesture {
        if self.bar { self.gives_way() } else { lifting(self.slot, self.touch, manner) }
    }
}

/// How far from a place counted in frets a finger is there. None is where the open string is stopped.
fn same_fret(place: f64) -> f64 {
    if place > 0.0 { SAME_FRET } else { 0.0 }
}

/// A finger that is leaving the string.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Departing {
    /// What takes it off at once.
    lift: Gesture,
    /// Sample by which it is off the string.
    clear: u64,
    /// The finger, if it stopped the string, and until which sample it is surely there: the next note may want it back.
    back: Option<(Finger, u64)>,
}

/// The fingers near one string.
#[derive(Debug, Clone)]
pub(crate) struct Fingers {
    string: PlayedString,
    hands: Player,
    /// Where the set-up has plucks, m from the saddle, wherever the right hand is told to go.
    usual_place: f64,
    fretting: Option<Finger>,
    /// When that comes, if it is yet to come.
    awaited: Option<Awaited>,
    /// A finger held down behind the one that sounds.
    anchor: Option<Finger>,
    /// Slot of the next fretting finger: the one that `fretting` has not.
    next_slot: FingerSlot,
    /// Slot of a finger that touches the string lightly.
    light: Option<FingerSlot>,
    /// Where that touches it, m from the nut.
    touched: f64,
    /// The partial of what sounds that has a node there, if that is why.
    node: Option<u32>,
    /// Whether one rests behind the bar that stops the string.
    behind_bar: bool,
    /// By slot, what is leaving.
    departing: [Option<Departing>; FINGERS_PER_STRING],
    /// Which slots hold a damper that rests on the string.
    resting: [bool; FINGERS_PER_STRING],
    right: RightHand,
    /// Fret of the present note, from which slides are counted.
    home: usize,
    /// Semitones from its fret at which the next finger comes down, where nothing keeps it on frets.
    beside: f64,
    /// Factor of the fretting finger's force: what a key is pressed down with, and when it is followed.
    pressure: f64,
    pace: Pace,
    /// How tight the string is pulled, as a multiple of its own tension, no less than 1.
    tightened: f64,
    /// Fret of the capo on notes to come, 0 for none, and of the one on the string.
    capo: [usize; 2],
    /// What kind of finger that on the string is.
    capo_touch: Touch,
    /// Whether the neck has been changed under fingers, and they are not where it has them.
    misplaced: bool,
}

impl Fingers {
    /// No finger near the string.
    pub(crate) fn new(string: PlayedString, hands: Player) -> Self {
        let (usual_place, capo_touch) = (hands.pluck_position, hands.fretting.touch);
        Self {
            string,
            hands,
            usual_place,
            fretting: None,
            awaited: None,
            anchor: None,
            next_slot: 0,
            light: None,
            touched: 0.0,
            node: None,
            behind_bar: false,
            departing: [None; FINGERS_PER_STRING],
            resting: [false; FINGERS_PER_STRING],
            right: RightHand::default(),
            home: 0,
            beside: 0.0,
            pressure: 1.0,
            pace: Pace::default(),
            tightened: 1.0,
            capo: [0, 0],
            capo_touch,
            misplaced: false,
        }
    }

    /// All away.
    pub(crate) fn reset(&mut self) {
        (self.fretting, self.anchor, self.light, self.touched) = (None, None, None, 0.0);
        (self.awaited, self.node) = (None, None);
        self.behind_bar = false;
        self.departing = [None; FINGERS_PER_STRING];
        self.next_slot = 0;
        self.resting = [false; FINGERS_PER_STRING];
        self.right.reset();
        (self.home, self.beside) = (0, 0.0);
        (self.pressure, self.pace, self.tightened) = (1.0, Pace::default(), 1.0);
        (self.capo, self.misplaced) = ([0, 0], false);
    }

    /// The hands of a string nobody has touched yet act so.
    pub(crate) fn begin_with(&mut self, hands: &Player) {
        self.hands = hands.clone();
    }

    /// How long a pluck pushes before it lets go, and how long that takes, s.
    pub(crate) fn pluck_times(&self) -> [f64; 2] {
        [self.hands.pluck_duration, self.hands.pluck_release]
    }

    /// How long a stroke pushes, s; none for those that strike.
    pub(crate) fn push_time(&self, stroke: Stroke) -> Option<f64> {
        match self.pluck(stroke, 1.0, 0.0, 0.0)? {
            Gesture::Pluck { duration, .. } => Some(duration),
            _ => None,
        }
    }

    /// Period of the string as it is stopped, or as it will be at a fret (0 for none) if that is longer, s.
    pub(crate) fn period(&self, fret: usize) -> f64 {
        self.stopped_period(fret.max(self.capo[0]) as f64).max(self.period_of(self.sounding_length()))
    }

    /// Period of the string stopped at a place counted in frets, 0 for the open string, s.
    fn stopped_period(&self, place: f64) -> f64 {
        self.period_of(self.string.geometry.length - self.glided_place(place, false))
    }

    /// Period of a part of the string so long, m, in s.
    fn period_of(&self, sounding: f64) -> f64 {
        self.open_period() * (sounding / self.string.geometry.length)
    }

    /// Whether the finger that stops the string lets it up for a note at a place counted in frets, 0 for the open string.
    pub(crate) fn lets_up_to(&self, place: f64) -> bool {
        self.fretting.is_some_and(|finger| !finger.bar && finger.is_above(place))
    }

    /// Period of the open string, s.
    fn open_period(&self) -> f64 {
        1.0 / frequency(self.string.geometry.open_pitch)
    }

    /// Where a stroke falls now.
    fn field(&self) -> Field<'_> {
        Field { geometry: &self.string.geometry, hands: &self.hands, sounding: self.sounding_length() }
    }

    /// The right hand, and where a stroke of it falls now.
    fn right_hand(&mut self) -> (&mut RightHand, Field<'_>) {
        let sounding = self.sounding_length();
        (&mut self.right, Field { geometry: &self.string.geometry, hands: &self.hands, sounding })
    }

    /// The palm is to rest so hard, 0 to 1, at the next stroke.
    pub(crate) fn expect_palm(&mut self, palm: f64) {
        self.right.expect_palm(palm);
    }

    /// The palm is to rest so hard on the string, 0 to 1.
    pub(crate) fn set_palm(&mut self, palm: f64, at: &mut Moment<impl GestureSink>) {
        let (right, field) = self.right_hand();
        right.set_palm(palm, &field, at);
    }

    /// Whether the palm rests on the string.
    pub(crate) fn palm_rests(&self) -> bool {
        self.right.rests()
    }

    /// The palm, or a thumb, leaves the string until the next stroke.
    pub(crate) fn lift_palm(&mut self, at: &mut Moment<impl GestureSink>) {
        let (right, field) = self.right_hand();
        right.leave(&field, at);
    }

    /// The string under them.
    pub(crate) fn geometry(&self) -> &StringGeometry {
        &self.string.geometry
    }

    /// Whether a finger stops the string, or the capo.
    pub(crate) fn stopped(&self) -> bool {
        self.fretting.is_some() || self.capo[1] > 0
    }

    /// A finger leaves in a manner of leaving, and at once if the next note comes first.
    fn depart(&mut self, slot: FingerSlot, touch: Touch, manner: Leaving, at: &mut Moment<impl GestureSink>) {
        at.does(lifting(slot, touch, manner));
        let (lift, clear) = (hurried(slot, touch), at.after(LINGERING * manner.turning));
        self.departing[slot] = Some(Departing { lift, clear, back: None });
    }

    /// A finger that stopped the string does so.
    fn depart_from(&mut self, finger: Finger, manner: Leaving, at: &mut Moment<impl GestureSink>) {
        self.depart(finger.slot, finger.touch, manner, at);
        if let Some(departing) = &mut self.departing[finger.slot] {
            departing.back = Some((finger, at.after(manner.turning)));
        }
    }

    /// The finger that is still leaving behind the one that stops the string, which a note there wants back.
    fn call_back(&mut self, time: u64) -> Option<Finger> {
        let (finger, until) = self.departing[self.next_slot]?.back?;
        if time >= until || finger.bar {
            return None;
        }
        self.departing[finger.slot] = None;
        Some(finger)
    }

    /// Whatever keeps the string from sounding leaves at once, for a note so hard, 0 to 1; the palm stays as it is told.
    fn make_way(&mut self, strength: f64, at: &mut Moment<impl GestureSink>) {
        self.come(at);
        for slot in self.resting_slots() {
            at.does(lifting(slot, self.hands.damper.touch, QUICK_LIFT));
        }
        self.resting = [false; FINGERS_PER_STRING];
        for Departing { lift, clear, .. } in self.departing.iter_mut().filter_map(Option::take) {
            if at.time < clear {
                at.does(lift);
            }
        }
        if let Some(slot) = self.light.take() {
            at.does(lifting(slot, self.hands.damper.touch, QUICK_LIFT));
        }
        let (right, field) = self.right_hand();
        right.prepare(strength, &field, at);
    }

    /// The pluck of a note: so hard (0 to 1), and so far beside the usual place (m), of which the hand has been moved so
    /// far on purpose (m); none for strokes that strike.
    pub(crate) fn pluck(&self, stroke: Stroke, strength: f64, beside: f64, moved: f64) -> Option<Gesture> {
        self.field().pluck(stroke, strength, beside, moved)
    }

    /// The partial that a thumb picks out beside the pluck of a hand that has been moved so far from the saddle, m.
    pub(crate) fn pinched_partial(&self, moved: f64) -> u32 {
        self.field().pinched_partial(moved)
    }

    /// Length that sounds: from the fretting finger, or the capo, or the nut, to the saddle, m.
    fn sounding_length(&self) -> f64 {
        self.string.geometry.length - self.sounding_from()
    }

    /// Where that begins, m from the nut.
    fn sounding_from(&self) -> f64 {
        let capo = self.string.geometry.finger_position(self.capo[1]);
        self.fretting.map_or(capo, |finger| self.pressed(&finger))
    }

    /// Where a finger presses, m from the nut.
    fn pressed(&self, finger: &Finger) -> f64 {
        finger.free.unwrap_or_else(|| self.glided_place(finger.stands(), finger.bar))
    }

    /// Where a finger presses, or a bar lies, m from the nut, counted in frets: between two of them the sounding length goes by equal
    /// factors.
    fn glided_place(&self, stands: f64, bar: bool) -> f64 {
        let (below, part) = (stands.floor(), stands - stands.floor());
        if part == 0.0 {
            return self.place(below as usize, bar);
        }
        let last = self.string.geometry.frets.len() as f64;
        let sounding = |fret: f64| self.string.geometry.length - self.place(fret as usize, bar);
        let (long, short) = (sounding(below), sounding((below + 1.0).min(last)));
        self.string.geometry.length - long * libm::pow(short / long, part)
    }

    /// The frets after which a finger presses, or a bar lies, at a place, m from the nut, counted so.
    fn frets_at(&self, place: f64, bar: bool) -> f64 {
        let last = self.string.geometry.frets.len();
        let below = (1..last).take_while(|&fret| self.place(fret, bar) <= place).count();
        let [long, short] =
            [below, below + 1].map(|fret| self.string.geometry.length - self.place(fret, bar));
        below as f64 + libm::log((self.string.geometry.length - place) / long) / libm::log(short / long)
    }

    /// Where a finger stops a fret, or a bar lies over it, m from the nut.
    fn place(&self, fret: usize, bar: bool) -> f64 {
        match bar {
            true => self.string.bar_place(fret),
            false => self.string.geometry.finger_position(fret),
        }
    }
}
