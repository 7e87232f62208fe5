//! A still picture of all strings, with what has happened to them since the last one.

use low_action_dsp::FINGERS_PER_STRING;
use low_action_dsp::neck::Neck;
use low_action_dsp::setup::MOST_STRINGS;

use super::Health;

/// Points at which a snapshot has each string, evenly from nut to saddle, both included.
pub const POINTS: usize = 129;

/// A still picture of all strings.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Which one it is, counted from 1; 0 before the first.
    pub number: u64,
    /// How the machine copes.
    pub health: Health,
    pub(super) strings: Vec<StringSeen>,
    pub(super) count: usize,
}

/// One string.
#[derive(Debug, Clone)]
pub struct StringSeen {
    /// From nut to saddle, m.
    pub length: f32,
    /// Displacement at the [`POINTS`], m, up is positive.
    pub displacement: [f32; POINTS],
    /// The lowest it has been since the last snapshot, m.
    pub lowest: [f32; POINTS],
    /// The highest it has been since the last snapshot, m.
    pub highest: [f32; POINTS],
    /// Height of the board under the points, m; not a number where there is none.
    pub board: [f32; POINTS],
    /// Force of the board near each point in the last step, N: the largest of a place of the board that is nearest to it.
    pub board_force: [f32; POINTS],
    /// Largest force of the board near each point since the last snapshot, N.
    pub board_hit: [f32; POINTS],
    /// Fingers near the string, by slot.
    pub fingers: [Option<FingerSeen>; FINGERS_PER_STRING],
    /// The last pluck begun since the last snapshot.
    pub pluck: Option<PluckSeen>,
    /// Tension of the open string at rest, N.
    pub rest_tension: f32,
    /// Present tension, N: bends and what stretching adds included.
    pub tension: f32,
    /// Energy of its motion and stretching, J; that of bending is left out.
    pub energy: f32,
    /// Newton iterations of a step, on average since the last snapshot.
    pub iterations: f32,
    /// Frets and places of the board with force in the last step.
    pub contacts: u32,
    pub(super) frets: [FretSeen; Neck::MOST_FRETS],
    pub(super) fret_count: usize,
}

/// A fret under a string.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FretSeen {
    /// Place, m from the nut.
    pub position: f32,
    /// Height of its crown, m.
    pub height: f32,
    /// How deep the string is in it, m; negative is the room between them.
    pub penetration: f32,
    /// Force in the last step, N.
    pub force: f32,
    /// Largest force since the last snapshot, N.
    pub hit: f32,
}

/// A finger near a string.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FingerSeen {
    /// Place, m from the nut.
    pub position: f32,
    /// Height of its pad, m.
    pub height: f32,
    /// Force between pad and string, the largest since the last snapshot, N.
    pub force: f32,
    /// Force with which the hand presses it, N, down is positive.
    pub pressed: f32,
}

/// A pluck.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PluckSeen {
    /// Place, m from the nut.
    pub position: f32,
    /// Largest force, N, up is positive.
    pub force: f32,
}

impl Default for Snapshot {
    fn default() -> Self {
        Self {
            number: 0,
            health: Health::default(),
            strings: vec![StringSeen::default(); MOST_STRINGS],
            count: 0,
        }
    }
}

impl Snapshot {
    /// One of such strings.
    #[cfg(all(test, feature = "editor"))]
    pub(crate) fn of(strings: Vec<StringSeen>) -> Self {
        Self { count: strings.len(), strings, ..Self::default() }
    }

    /// Takes in what has happened in the one before, which nobody has seen, if it is of the same strings.
    pub(super) fn go_on_from(&mut self, before: &Self) {
        if self.count == before.count {
            let strings = self.strings.iter_mut().zip(&before.strings).take(self.count);
            strings.for_each(|(string, before)| string.go_on_from(before));
        }
    }

    /// The strings, in the set-up's order.
    pub fn strings(&self) -> &[StringSeen] {
        &self.strings[..self.count]
    }
}

impl Default for StringSeen {
    fn default() -> Self {
        Self {
            length: 0.0,
            displacement: [0.0; POINTS],
            lowest: [0.0; POINTS],
            highest: [0.0; POINTS],
            board: [f32::NAN; POINTS],
            board_force: [0.0; POINTS],
            board_hit: [0.0; POINTS],
            fingers: [None; FINGERS_PER_STRING],
            pluck: None,
            rest_tension: 0.0,
            tension: 0.0,
            energy: 0.0,
            iterations: 0.0,
            contacts: 0,
            frets: [FretSeen::default(); Neck::MOST_FRETS],
            fret_count: 0,
        }
    }
}

impl StringSeen {
    fn go_on_from(&mut self, before: &Self) {
        if self.length != before.length || self.fret_count != before.fret_count {
            return;
        }
        let each = |own: &mut [f32], others: &[f32], of: fn(f32, f32) -> f32| {
            own.iter_mut().zip(others).for_each(|(own, other)| *own = of(*own, *other));
        };
        each(&mut self.lowest, &before.lowest, f32::min);
        each(&mut self.highest, &before.highest, f32::max);
        each(&mut self.board_hit, &before.board_hit, f32::max);
        for (fret, before) in self.frets.iter_mut().zip(&before.frets).take(self.fret_count) {
            fret.hit = fret.hit.max(before.hit);
        }
        for (finger, before) in self.fingers.iter_mut().zip(&before.fingers) {
            if let (Some(finger), Some(before)) = (finger, before) {
                finger.force = finger.force.max(before.force);
            }
        }
        self.pluck = self.pluck.or(before.pluck);
    }

    /// The frets under it, fret 1 first.
    pub fn frets(&self) -> &[FretSeen] {
        &self.frets[..self.fret_count]
    }

    /// Place of a point, m from the nut.
    pub fn place(&self, point: usize) -> f32 {
        self.length * point as f32 / (POINTS - 1) as f32
    }

    /// Displacement at a place (m from the nut), m.
    pub fn displacement_at(&self, place: f32) -> f32 {
        let along = (place / self.length * (POINTS - 1) as f32).clamp(0.0, (POINTS - 1) as f32);
        let point = (along as usize).min(POINTS - 2);
        let part = along - point as f32;
        self.displacement[point] + part * (self.displacement[point + 1] - self.displacement[point])
    }
}
