//! What touches a string as it goes over to another model: board, frets and fingers.

use super::Side;
use super::state::Change;
use crate::contact::ContactLaw;
use crate::finger::{Finger, Inertia};
use crate::model::{Contact, ContactKind, Model};
use crate::state::State;

/// How deep a contact is in the string, m, or its force, N, at n and at n − 1.
type Twice = [f64; 2];

/// The force of a contact that has deflected the string, N. A wave goes hardly farther than a spacing in a step, so what has pressed
/// through one, from a sample to the next, has made the kink that is too sharp to be read; what has only just struck, or has just let
/// go, has none.
fn lasting(law: &ContactLaw, depths: Twice) -> f64 {
    let [now, before] = depths.map(|depth| law.force(depth));
    now.min(before)
}

/// How deep a contact of one law is pressed by a part of the force that pressed one of another to `depth`, m; that itself where
/// nothing touches.
fn same_force(law: &ContactLaw, other: &ContactLaw, depth: f64, part: f64) -> f64 {
    let is_same = law == other && part == 1.0;
    if depth > 0.0 && !is_same { law.penetration_at(part * other.force(depth)) } else { depth }
}

impl State {
    /// How deep a fixed contact is in the string.
    fn depths(&self, index: usize, contact: &Contact) -> Twice {
        let string = contact.reading.of(&self.displacement);
        let before = string - contact.reading.of(&self.motion);
        [self.heights[index] - string, self.heights_before[index] - before]
    }

    /// How deep a finger is in it.
    fn depths_under(&self, finger: &Finger) -> Twice {
        let string = finger.reading.of(&self.displacement);
        let at = &finger.reading_before;
        let before = at.of(&self.displacement) - at.of(&self.motion);
        [string - finger.height, before - (finger.height - finger.motion)]
    }

    /// Takes over how deep every contact is that presses the string, in the place of its height, and what of that deflects both.
    pub(super) fn take_contacts(&mut self, new: &mut Side, old: &State, before: &mut Side, change: Change) {
        let (model, old_model) = (new.model, before.model);
        let Change { same_grid, force: part } = change;
        let has_partners = |contact: &Contact| match contact.kind {
            ContactKind::Fret { .. } => true,
            ContactKind::Board { .. } => same_grid,
        };
        // Where steps grow longer the depth before is not guessed at: it might be far deeper than anything was.
        let share = (model.grid.time_step / old_model.grid.time_step).min(1.0);
        let in_this_step = |[now, past]: Twice| if share < 1.0 { now + share * (past - now) } else { past };
        self.heights.fill(0.0);
        self.heights_before.fill(0.0);
        self.calm.fill(0);
        let count = old_model.contacts.len();
        // Both lists are in order of place, so the partner of a contact follows that of the one before.
        let mut next = 0;
        for (index, contact) in model.contacts.iter().enumerate() {
            // (No point of a board has a partner on another grid. To look for one takes time that an audio thread has not.)
            let looked_at = if has_partners(contact) { count } else { 0 };
            let partner = (0..looked_at)
                .map(|step| (next + step) % count)
                .find(|&candidate| contact.kind == old_model.contacts[candidate].kind);
            let Some(partner) = partner else { continue };
            next = partner + 1;
            let old_contact = &old_model.contacts[partner];
            let depths = old.depths(partner, old_contact);
            let force = lasting(&old_contact.law, depths);
            before.deflection.press(&old_contact.reading, force);
            new.deflection.press(&contact.reading, part * force);
            // On another grid a string gives way otherwise: as deep as the same force presses it.
            let carried = [depths[0], in_this_step(depths)];
            let [now, past] = carried.map(|depth| same_force(&contact.law, &old_contact.law, depth, part));
            (self.heights[index], self.heights_before[index]) = (now, past);
            // What has just been struck goes on to resist from where it is, for as many of the steps of this grid.
            self.calm[index] = old.calm[partner];
        }
        if same_grid {
            return;
        }
        for (index, contact) in old_model.contacts.iter().enumerate() {
            let depths = old.depths(index, contact);
            if matches!(contact.kind, ContactKind::Board { .. }) && depths[0].max(depths[1]) > 0.0 {
                let forces = [depths[0], in_this_step(depths)].map(|depth| part * contact.law.force(depth));
                self.share_out(new, before, contact, forces, [lasting(&contact.law, depths), part]);
            }
        }
    }

    /// Shares out forces of a point of the old board between the two points of this one beside it, N, as a lever would. What
    /// lasts of them deflects the old string, and a part of that this one.
    fn share_out(
        &mut self,
        new: &mut Side,
        before: &mut Side,
        contact: &Contact,
        forces: Twice,
        [lasts, goes_on]: [f64; 2],
    ) {
        let grid = &new.model.grid;
        let spacings = contact.place / before.model.grid.length * grid.intervals as f64;
        let first = grid.interval(spacings);
        let part = (spacings - first as f64).clamp(0.0, 1.0);
        let shares = [(first, 1.0 - part), (first + 1, part)]
            .map(|(node, part)| board_at(new.model, node).map(|index| (index, part)));
        let all: f64 = shares.iter().flatten().map(|(_, part)| part).sum();
        // Where there is no such board, nothing goes on.
        if all == 0.0 {
            return;
        }
        before.deflection.press(&contact.reading, lasts);
        for (index, part) in shares.into_iter().flatten() {
            let Contact { reading, law, .. } = &new.model.contacts[index];
            let part = part / all;
            new.deflection.press(reading, part * goes_on * lasts);
            let pressed = |depth: f64, force: f64| law.penetration_at(law.force(depth) + part * force);
            self.heights[index] = pressed(self.heights[index], forces[0]);
            self.heights_before[index] = pressed(self.heights_before[index], forces[1]);
        }
    }

    /// Puts every contact that was in touch where it is pressed just as hard, and every other one under
    /// the string.
    pub(super) fn raise_contacts(&mut self, model: &Model) {
        for (index, contact) in model.contacts.iter().enumerate() {
            let now = contact.reading.of(&self.displacement);
            let before = now - contact.reading.of(&self.motion);
            let (depth, depth_before) = (self.heights[index], self.heights_before[index]);
            if depth.max(depth_before) > 0.0 {
                self.heights[index] = now + depth;
                self.heights_before[index] = before + depth_before;
            } else {
                let free = contact.height.min(now).min(before);
                self.heights[index] = free;
                self.heights_before[index] = free;
            }
        }
        self.heights_next.copy_from_slice(&self.heights);
        self.heights_rest_in = 2;
    }

    /// Takes over the fingers and what they deflect.
    pub(super) fn take_fingers(&mut self, new: &mut Side, old: &State, before: &mut Side, change: Change) {
        let (model, old_model) = (new.model, before.model);
        let grid = &model.grid;
        self.no_finger_from = self.fingers.len();
        for slot in 0..self.fingers.len() {
            self.fingers[slot] = old.fingers[slot].and_then(|mut finger| {
                let depths = old.depths_under(&finger);
                let law = model.finger_law_if(&finger.touch)?;
                before.deflection.press(&finger.reading, -lasting(&finger.law, depths));
                finger.law = law;
                finger.inertia = Inertia::new(&finger.touch, grid.time_step);
                if !change.same_grid {
                    finger.position *= grid.length / old_model.grid.length;
                    finger.position_before = finger.position;
                    finger.reading = grid.reading(finger.position);
                    finger.reading_before = finger.reading;
                }
                new.deflection.press(&finger.reading, -change.force * lasting(&finger.law, depths));
                Some(finger)
            });
        }
    }

    /// Under a finger the string is elsewhere now, and moves otherwise; the pad goes with it, as deep in it as it was, or as the
    /// part of its force asks for that presses now.
    pub(super) fn carry_fingers(&mut self, model: &Model, old: &State, old_model: &Model, change: Change) {
        let share = model.grid.time_step / old_model.grid.time_step;
        let State { fingers, displacement, motion, .. } = self;
        for (finger, old_finger) in fingers.iter_mut().zip(&old.fingers) {
            let (Some(finger), Some(old_finger)) = (finger, old_finger) else { continue };
            let (at, old_at) = (&finger.reading, &old_finger.reading);
            finger.height += at.of(displacement) - old_at.of(&old.displacement);
            let [depth, _] = old.depths_under(old_finger);
            finger.height += depth - same_force(&finger.law, &finger.law, depth, change.force);
            finger.motion *= share;
            finger.motion += at.of(motion) - share * old_at.of(&old.motion);
        }
    }
}

/// Which contact the board is at a grid point, if it is there.
fn board_at(model: &Model, node: usize) -> Option<usize> {
    let place = model.grid.place(node);
    let half = 0.5 * model.grid.spacing;
    let from = model.contacts.partition_point(|contact| contact.place < place - half);
    let near = model.contacts[from..].iter().take_while(|contact| contact.place < place + half);
    near.zip(from..).find(|(contact, _)| contact.kind == ContactKind::Board { node }).map(|(_, index)| index)
}
