//! How a snapshot is filled from an engine.

use low_action_dsp::energy::stretch_energy;
use low_action_dsp::model::ContactKind;
use low_action_dsp::pickup::stretch_tension;
use low_action_dsp::{FINGERS_PER_STRING, Instrument};

use super::Health;
use super::snapshot::{FingerSeen, FretSeen, POINTS, PluckSeen, Snapshot, StringSeen};
use crate::engine::Engine;

impl Snapshot {
    /// Takes the picture; neither allocates nor alters anything of the engine.
    pub(super) fn fill(&mut self, engine: &Engine, number: u64, health: Health) {
        let instrument = engine.instrument();
        (self.number, self.health) = (number, health);
        self.count = instrument.string_count().min(self.strings.len());
        for (index, string) in self.strings[..self.count].iter_mut().enumerate() {
            string.fill(instrument, index);
        }
    }
}

impl StringSeen {
    fn fill(&mut self, instrument: &Instrument, index: usize) {
        let (model, observed) = (instrument.model(index), instrument.observed(index));
        let (drive, scratch) = (instrument.drive(index), instrument.scratch(index));
        self.length = model.grid.length as f32;
        spread(model.grid.intervals, instrument.state(index).displacement(), &mut self.displacement);
        spread(model.grid.intervals, observed.lowest.iter().copied(), &mut self.lowest);
        spread(model.grid.intervals, observed.highest.iter().copied(), &mut self.highest);
        self.pluck = observed
            .pluck
            .map(|pluck| PluckSeen { position: pluck.position as f32, force: pluck.force as f32 });
        self.rest_tension = model.string.tension as f32;
        self.tension = (drive.tension + stretch_tension(model, scratch)) as f32;
        self.energy = (scratch.string_energy() + stretch_energy(model, scratch)) as f32;
        self.iterations = observed.iterations as f32 / observed.steps.max(1) as f32;
        self.see_barrier(instrument, index);
        self.see_fingers(instrument, index);
        // Fingers are contacts too, and come after those of the model.
        let touches = |&(contact, force): &(usize, f64)| contact < model.contacts.len() && force > 0.0;
        self.contacts = scratch.forces().filter(touches).count() as u32;
    }

    /// Frets and board, where they are now, with their forces.
    fn see_barrier(&mut self, instrument: &Instrument, index: usize) {
        let (model, state) = (instrument.model(index), instrument.state(index));
        let frets = &instrument.geometry(index).frets;
        let hits = &instrument.observed(index).forces;
        self.board.fill(f32::NAN);
        self.board_force.fill(0.0);
        self.board_hit.fill(0.0);
        self.fret_count = 0;
        let heights = model.contacts.iter().zip(state.heights()).zip(hits);
        for ((contact, &height), &hit) in heights {
            match contact.kind {
                ContactKind::Board { node } => {
                    let point = nearest_point(node, model.grid.intervals);
                    self.board[point] = height as f32;
                    self.board_hit[point] = self.board_hit[point].max(hit as f32);
                }
                ContactKind::Fret { index: fret } => {
                    let Some(seen) = self.frets.get_mut(self.fret_count) else { continue };
                    self.fret_count += 1;
                    *seen = FretSeen {
                        position: frets.get(fret).map_or(0.0, |&place| place as f32),
                        height: height as f32,
                        penetration: contact.pressed_in(height - state.displacement_at(&contact.reading))
                            as f32,
                        force: 0.0,
                        hit: hit as f32,
                    };
                }
            }
        }
        for (contact, force) in instrument.scratch(index).forces() {
            match model.contacts.get(contact).map(|contact| contact.kind) {
                // Contacts and frets are both in order of place.
                Some(ContactKind::Fret { .. }) => {
                    let before = model.contacts[..contact].iter();
                    let fret = before.filter(|other| matches!(other.kind, ContactKind::Fret { .. })).count();
                    if let Some(seen) = self.frets.get_mut(fret) {
                        seen.force = force as f32;
                    }
                }
                Some(ContactKind::Board { node }) => {
                    let point = nearest_point(node, model.grid.intervals);
                    self.board_force[point] = self.board_force[point].max(force as f32);
                }
                None => {}
            }
        }
    }

    fn see_fingers(&mut self, instrument: &Instrument, index: usize) {
        let contacts = instrument.model(index).contacts.len();
        let (hands, hits) = (&instrument.drive(index).hands, &instrument.observed(index).forces);
        let fingers = instrument.state(index).fingers();
        for slot in 0..FINGERS_PER_STRING {
            self.fingers[slot] = fingers.get(slot).copied().flatten().map(|finger| FingerSeen {
                position: finger.position as f32,
                height: finger.height as f32,
                force: hits.get(contacts + slot).map_or(0.0, |&force| force as f32),
                pressed: hands.get(slot).map_or(0.0, |hand| hand.force as f32),
            });
        }
    }
}

/// The point of a snapshot nearest to a grid point.
fn nearest_point(node: usize, intervals: usize) -> usize {
    (node as f64 / intervals as f64 * (POINTS - 1) as f64).round() as usize
}

/// Values at the interior points of a grid of so many intervals, read evenly from end to end; 0 at the ends.
fn spread(intervals: usize, interior: impl Iterator<Item = f64>, out: &mut [f32; POINTS]) {
    let mut nodes = std::iter::once(0.0).chain(interior).chain(std::iter::repeat(0.0));
    let mut next = || nodes.next().unwrap_or(0.0);
    let (mut node, mut left, mut right) = (0, next(), next());
    let step = intervals as f64 / (POINTS - 1) as f64;
    for (point, out) in out.iter_mut().enumerate() {
        let place = point as f64 * step;
        while node < place as usize {
            (node, left, right) = (node + 1, right, next());
        }
        *out = (left + (place - node as f64) * (right - left)) as f32;
    }
}
