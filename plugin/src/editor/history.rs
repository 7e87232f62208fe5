//! Undo and redo: one entry for each gesture that is finished in the editor, whichever view made it.
//!
//! What a host does by itself is no gesture of the editor's, and is not undone.

#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};

use nice_plug::context::gui::GuiContext;
use nice_plug::params::internals::ParamPtr;
use nice_plug::prelude::{Param, Params};

use super::asked::Asked;
use super::compare::{Compare, Set};
use super::noted::put;
use crate::locked::lock;
use crate::params::LowActionParams;
use crate::plugin::shelf::Kept;

/// Entries that are kept.
const MOST: usize = 100;
/// Steps of one parameter, by wheel or arrows, are one entry while less time lies between them, s.
const PAUSE: f64 = 0.5;

/// A parameter before and after, 0 to 1.
#[derive(Debug, Clone, Copy)]
struct Change {
    param: ParamPtr,
    before: f32,
    after: f32,
}

/// One that is under way.
#[derive(Debug)]
struct Gesture {
    change: Change,
    /// Whether somebody had hold of it at this picture.
    is_held: bool,
    /// The set-up file that was played before, where another may come.
    file: Option<Option<Kept>>,
}

/// What is undone at once.
#[derive(Debug, Default)]
struct Entry {
    changes: Vec<Change>,
    /// Where the set-up file is concerned, the one that is played on the other side of the entry: a number alone does not tell
    /// it, as a session may keep another than the folder has.
    file: Option<Option<Kept>>,
    /// Where it goes from A to B or back: whether B was heard before, and whether it is after.
    sides: Option<[bool; 2]>,
    /// When it was last a step, s.
    stepped: Option<f64>,
}

#[derive(Debug, Default)]
struct Inside {
    /// How many sessions had been loaded at the last picture.
    loads: u32,
    /// Gestures that have begun.
    under_way: Vec<Gesture>,
    /// What is one entry together, while it is being done.
    together: Option<Entry>,
    /// Whether what is done is a step.
    stepping: bool,
    done: VecDeque<Entry>,
    undone: Vec<Entry>,
}

/// What has been done in an editor.
pub struct History {
    params: Arc<LowActionParams>,
    /// What the host has yet to do of it.
    pub asked: Asked,
    /// The two sets of values it goes on with.
    pub compare: Compare,
    inside: Mutex<Inside>,
}

impl History {
    /// Of these parameters, so far empty.
    pub fn new(params: Arc<LowActionParams>) -> Self {
        let inside = Inside { loads: params.shelf.loads(), ..Inside::default() };
        Self { params, asked: Asked::default(), compare: Compare::default(), inside: Mutex::new(inside) }
    }

    /// A new picture at a time, s. Gives back whether all that was asked for is there.
    pub fn look(&self, now: f64) -> bool {
        self.asked.look(now);
        let loads = self.params.shelf.loads();
        if std::mem::replace(&mut self.inside().loads, loads) != loads {
            self.forget();
        }
        let is_settled = self.asked.is_settled();
        if is_settled {
            self.params.shelf.keep_promise();
        }
        is_settled
    }

    /// A window opens, in which time is counted from 0 again: nothing is a step just after what was done in another.
    pub fn restart(&self) {
        self.asked.restart();
        self.inside().done.iter_mut().for_each(|entry| entry.stepped = None);
    }

    /// Another session is there, in which nothing has been done yet. A gesture that is under way goes on from what that has.
    fn forget(&self) {
        let file = self.params.shelf.held(self.number());
        let mut inside = self.inside();
        for Gesture { change, file: before, .. } in &mut inside.under_way {
            change.before = self.asked.value(change.param);
            change.after = change.before;
            *before = before.take().map(|_| file.clone());
        }
        inside.done.clear();
        inside.undone.clear();
        self.compare.forget();
    }

    /// All gestures that are made meanwhile are one entry, and so are those of parts that are such themselves.
    pub fn together(&self, act: impl FnOnce()) {
        if self.inside().together.is_some() {
            return act();
        }
        self.inside().together = Some(Entry::default());
        act();
        let mut inside = self.inside();
        if let Some(entry) = inside.together.take() {
            inside.keep(entry);
        }
    }

    /// All gestures that are made meanwhile are steps, which are one entry with those just before.
    pub fn stepping(&self, act: impl FnOnce()) {
        self.inside().stepping = true;
        act();
        self.inside().stepping = false;
    }

    /// Has a number stand for a file, or for what the folder has under it; part of what is done together.
    pub(crate) fn play_file(&self, number: u32, file: Option<Kept>) {
        let present = self.number();
        let is_another = number != present || file != self.params.shelf.held(present);
        let before = self.put_file(number, file);
        if let Some(together) = self.inside().together.as_mut().filter(|_| is_another) {
            together.file.get_or_insert(before);
        }
    }

    /// What is done together goes over to the set that is heard now, from A or B.
    pub fn turns_from(&self, was_b: bool) {
        let sides = [was_b, self.compare.is_b()];
        if let Some(together) = &mut self.inside().together {
            together.sides = Some(sides);
        }
    }

    /// All values as they are, or are to be.
    pub(crate) fn present(&self) -> Set {
        let number = self.number();
        let map = self.params.param_map().into_iter();
        let values = map.map(|(_, param, _)| (param, self.asked.value(param))).collect();
        Set { values, file: (number, self.params.shelf.held(number)) }
    }

    /// Whether there is something to undo, and to redo.
    pub fn can(&self) -> [bool; 2] {
        let inside = self.inside();
        [!inside.done.is_empty(), !inside.undone.is_empty()]
    }

    /// Takes the last entry back, unless something is under way.
    pub fn undo(&self, gui: &GuiContext) {
        if self.is_busy() {
            return;
        }
        let Some(mut entry) = self.inside().done.pop_back() else { return };
        let back: Vec<_> = entry.changes.iter().rev().map(|change| (change.param, change.before)).collect();
        self.cross(&mut entry, &back, 0, gui);
        self.inside().undone.push(entry);
    }

    /// Does again what was taken back last, unless something is under way.
    pub fn redo(&self, gui: &GuiContext) {
        if self.is_busy() {
            return;
        }
        let Some(mut entry) = self.inside().undone.pop() else { return };
        let again: Vec<_> = entry.changes.iter().map(|change| (change.param, change.after)).collect();
        self.cross(&mut entry, &again, 1, gui);
        self.inside().done.push_back(entry);
    }

    /// Goes over an entry to one end of it, before (0) or after (1), past what notes gestures.
    fn cross(&self, entry: &mut Entry, values: &[(ParamPtr, f32)], end: usize, gui: &GuiContext) {
        if let Some(sides) = entry.sides {
            // What is set now is that set's own; what was heard is kept as the other.
            self.compare.turn(sides[end], || self.present());
        }
        if let Some(file) = entry.file.take() {
            let own = self.params.instrument.file.as_ptr();
            let value = values.iter().rfind(|(param, _)| *param == own).map(|(_, value)| *value);
            let number = value.map_or_else(|| self.number(), |value| self.as_number(value));
            entry.file = Some(self.put_file(number, file));
        }
        for &(param, value) in values {
            self.asked.ask(param, value);
            put(gui.param_setter().raw_context, param, value);
        }
    }

    /// Has a number stand for a file from when it is there on, and gives back what is played now.
    fn put_file(&self, number: u32, file: Option<Kept>) -> Option<Kept> {
        let present = self.number();
        let before = self.params.shelf.held(present);
        if number != present || file != before {
            self.params.shelf.promise(number, file);
        }
        before
    }

    /// The number of the file that is played, or is to be.
    pub fn number(&self) -> u32 {
        self.as_number(self.asked.value(self.params.instrument.file.as_ptr()))
    }

    fn as_number(&self, value: f32) -> u32 {
        self.params.instrument.file.preview_plain(value).unsigned_abs()
    }

    /// Somebody has hold of a parameter at this picture. Gives back whether a gesture of it is under way.
    pub fn hold(&self, param: ParamPtr) -> bool {
        let mut inside = self.inside();
        let gesture = inside.under_way.iter_mut().find(|gesture| gesture.change.param == param);
        gesture.map(|gesture| gesture.is_held = true).is_some()
    }

    /// Whether a gesture of a parameter has begun and not ended.
    pub fn is_under_way(&self, param: ParamPtr) -> bool {
        self.inside().under_way.iter().any(|gesture| gesture.change.param == param)
    }

    /// Whether any gesture has begun and not ended: an entry would be set within it.
    fn is_busy(&self) -> bool {
        !self.inside().under_way.is_empty()
    }

    /// The parameters that nobody has hold of any more though nobody has let go of them either: what had hold of them is
    /// gone. For the rest another picture begins.
    pub fn dropped(&self) -> Vec<ParamPtr> {
        let mut inside = self.inside();
        let dropped = inside.under_way.iter().filter(|gesture| !gesture.is_held);
        let dropped = dropped.map(|gesture| gesture.change.param).collect();
        inside.under_way.iter_mut().for_each(|gesture| gesture.is_held = false);
        dropped
    }

    pub(super) fn begin(&self, param: ParamPtr) {
        let before = self.asked.value(param);
        let concerns_file = param == self.params.instrument.file.as_ptr();
        let file = concerns_file.then(|| self.params.shelf.held(self.number()));
        let mut inside = self.inside();
        // One that never ended would take what is set now for its own.
        inside.under_way.retain(|gesture| gesture.change.param != param);
        let change = Change { param, before, after: before };
        inside.under_way.push(Gesture { change, is_held: true, file });
    }

    pub(super) fn set(&self, param: ParamPtr, value: f32) {
        self.asked.ask(param, value);
        let mut inside = self.inside();
        if let Some(gesture) = inside.under_way.iter_mut().find(|gesture| gesture.change.param == param) {
            gesture.change.after = value;
        }
    }

    pub(super) fn end(&self, param: ParamPtr) {
        let now = self.asked.now();
        let mut inside = self.inside();
        if let Some(place) = inside.under_way.iter().position(|gesture| gesture.change.param == param) {
            let Gesture { change, file, .. } = inside.under_way.remove(place);
            if change.before != change.after {
                let stepped = inside.stepping.then_some(now);
                inside.keep(Entry { changes: vec![change], file, sides: None, stepped });
            }
        }
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        lock(&self.inside)
    }
}

impl Inside {
    fn keep(&mut self, entry: Entry) {
        if entry.changes.is_empty() && entry.file.is_none() {
            return;
        }
        if let Some(together) = &mut self.together {
            together.changes.extend(entry.changes);
            together.file = together.file.take().or(entry.file);
            together.stepped = together.stepped.or(entry.stepped);
            return;
        }
        self.undone.clear();
        if let Some(last) = self.done.back_mut().filter(|last| last.goes_on_with(&entry)) {
            last.changes[0].after = entry.changes[0].after;
            last.stepped = entry.stepped;
            return;
        }
        if self.done.len() == MOST {
            self.done.pop_front();
        }
        self.done.push_back(entry);
    }
}

impl Entry {
    /// Whether another is one more step of the same.
    fn goes_on_with(&self, next: &Self) -> bool {
        let (Some(before), Some(now)) = (self.stepped, next.stepped) else { return false };
        let (&[own], &[other]) = (&self.changes[..], &next.changes[..]) else { return false };
        own.param == other.param && now - before < PAUSE
    }
}
