//! What happens to a scene beyond what a scene file can say: every sample, everything may change.

use low_action_dsp::Touch;
use low_action_dsp::drive::{PUSHES, Push};
use low_action_dsp::simulation::SceneString;
use serde::{Deserialize, Serialize};

use super::draw::Draw;
use super::scenes::FASTEST_SLIDE;

/// A stream of events. It is random in itself but follows from these numbers.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Stream {
    /// Where its random numbers begin.
    pub seed: i64,
    /// Samples from one change of heights, forces and tension to the next; 1 is every sample.
    pub every: u64,
    /// Samples between fingers being placed or taken away, about; 0 is never.
    pub regrip: u64,
    /// How far each fret and board point is moved at a time, m, up or down; 0 is not at all.
    pub lift: f64,
    /// How far the whole board is moved at a time, m: another action, or another instrument.
    pub exchange: f64,
    /// Whether frets and board come above the string at rest, too, as an exchange may leave some for a moment that are elsewhere
    /// along a bent string; otherwise they stay at or under it, as in scene files.
    pub above: bool,
    /// Largest force of hands, N; 0 leaves hands to the scene.
    pub force: f64,
    /// Speed of slides at most, m/s; 0 leaves places to the scene.
    pub slide: f64,
    /// Whether the tension jumps about under its limit.
    pub bend: bool,
    /// The most that a hand laid along the string adds to its loss, as a part of 1/k, which brings a free point to rest in a
    /// step; 0 is no hand.
    pub still: f64,
    /// Largest force of pushes beside those of the scene, N; 0 is none.
    pub push: f64,
}

impl Default for Stream {
    fn default() -> Stream {
        Stream {
            seed: 0,
            every: 1,
            regrip: 0,
            lift: 0.0,
            exchange: 0.0,
            above: false,
            force: 0.0,
            slide: 0.0,
            bend: false,
            still: 0.0,
            push: 0.0,
        }
    }
}

impl Stream {
    /// A stream for a scene whose distances are of the order of `reach`, m.
    pub fn random(draw: &mut Draw, reach: f64) -> Stream {
        let now_and_then = |draw: &mut Draw, low: f64, high: f64| draw.over_or_nothing(0.5, low, high);
        Stream {
            seed: (draw.seed() >> 1) as i64,
            every: if draw.chance(0.4) { 1 } else { draw.whole(2, 300) as u64 },
            regrip: if draw.chance(0.5) { 0 } else { draw.whole(1, 400) as u64 },
            lift: now_and_then(draw, 1e-4 * reach, reach),
            exchange: now_and_then(draw, 1e-3 * reach, reach),
            above: false,
            force: now_and_then(draw, 1e-2, 1e4),
            slide: now_and_then(draw, 1e-2, FASTEST_SLIDE),
            bend: draw.chance(0.4),
            still: if draw.chance(0.2) { 1.0 } else { now_and_then(draw, 1e-6, 1.0) },
            push: now_and_then(draw, 1e-2, 1e4),
        }
    }

    /// The same with frets and board that come above the string.
    pub fn raised(draw: &mut Draw, reach: f64) -> Stream {
        let exchange = draw.over(1e-3, 1.0) * reach;
        Stream { exchange, above: true, ..Stream::random(draw, reach) }
    }
}

/// A stream under way on one string.
#[derive(Debug, Clone)]
pub struct Acting {
    stream: Stream,
    draw: Draw,
    until_change: u64,
    until_regrip: u64,
    rest: Vec<f64>,
    heights: Vec<f64>,
    tension: Option<f64>,
    loss: f64,
    pushes: Vec<Push>,
    touches: Vec<Touch>,
    hands: Vec<Automated>,
}

/// What is automated of one hand: its place once it slides, m, its speed, m/s, its force, N.
#[derive(Debug, Clone, Copy, Default)]
struct Automated {
    place: Option<f64>,
    speed: f64,
    force: f64,
}

impl Acting {
    /// The stream on one string of a scene, 0 for the first.
    pub fn new(stream: &Stream, index: usize, string: &SceneString) -> Acting {
        let rest: Vec<f64> = string.model.contacts.iter().map(|contact| contact.height).collect();
        Acting {
            draw: Draw::new(stream.seed as u64, index as u64),
            until_change: 0,
            until_regrip: stream.regrip,
            heights: rest.clone(),
            rest,
            tension: None,
            loss: 0.0,
            pushes: Vec::new(),
            touches: string.state.fingers().iter().flatten().map(|finger| finger.touch).collect(),
            hands: vec![Automated::default(); string.model.finger_slots],
            stream: stream.clone(),
        }
    }

    /// Changes what acts on the string in its next step.
    pub fn act(&mut self, string: &mut SceneString) {
        if self.until_change == 0 {
            self.until_change = self.stream.every;
            self.change(string);
        }
        self.until_change -= 1;
        if self.stream.regrip > 0 {
            if self.until_regrip == 0 {
                self.until_regrip = 1 + self.draw.seed() % (2 * self.stream.regrip);
                self.regrip(string);
            }
            self.until_regrip -= 1;
        }
        let drive = &mut string.drive;
        if self.stream.lift > 0.0 || self.stream.exchange > 0.0 {
            drive.heights.extend_from_slice(&self.heights);
        }
        if let Some(tension) = self.tension {
            drive.tension = tension;
        }
        drive.loss = self.loss;
        drive.pushes.extend_from_slice(&self.pushes);
        let k = string.model.grid.time_step;
        let end = 1e-6 * string.model.grid.length;
        for (hand, automated) in drive.hands.iter_mut().zip(&mut self.hands) {
            if self.stream.force > 0.0 {
                hand.force = automated.force;
            }
            if self.stream.slide > 0.0 {
                let place = automated.place.unwrap_or(hand.position) + automated.speed * k;
                hand.position = place.clamp(end, string.model.grid.length - end);
                automated.place = Some(hand.position);
            }
        }
    }

    /// New targets for everything that is automated.
    fn change(&mut self, string: &SceneString) {
        let Stream { lift, exchange, above, force, slide, bend, still, push, .. } = self.stream;
        let highest = if above { f64::INFINITY } else { 0.0 };
        let draw = &mut self.draw;
        if lift > 0.0 || exchange > 0.0 {
            let together = if draw.chance(0.2) { exchange * draw.between(-1.0, 1.0) } else { 0.0 };
            for (height, rest) in self.heights.iter_mut().zip(&self.rest) {
                *height = (rest + together + lift * draw.between(-1.0, 1.0)).min(highest);
            }
        }
        if bend {
            self.tension = Some(string.most_tension() * draw.between(0.05, 1.0));
        }
        for hand in &mut self.hands {
            hand.speed = slide * draw.between(-1.0, 1.0);
            hand.force = force * draw.between(-1.0, 1.0);
        }
        if still > 0.0 {
            let most = still / string.model.grid.time_step;
            // Half the time it is not there: it comes and goes, and one that comes again at once is another.
            self.loss = match draw.whole(0, 3) {
                0 | 1 => 0.0,
                2 => most,
                _ => most * draw.over(1e-9, 1.0),
            };
        }
        if push > 0.0 {
            let grid = &string.model.grid;
            self.pushes.clear();
            for _ in 0..draw.whole(0, PUSHES) {
                let reading = grid.reading(grid.length * draw.between(0.001, 0.999));
                self.pushes.push(Push { reading, force: push * draw.between(-1.0, 1.0) });
            }
        }
    }

    /// Places one of the scene's fingers anew, or takes it away.
    fn regrip(&mut self, string: &mut SceneString) {
        let Some(slot) = self.touches.len().checked_sub(1).map(|last| self.draw.whole(0, last)) else {
            return;
        };
        if string.state.fingers()[slot].is_some() {
            string.state.remove_finger(slot);
            return;
        }
        let mut place = string.drive.hands[slot].position;
        if self.stream.slide > 0.0 {
            place = string.model.grid.length * self.draw.between(0.001, 0.999);
            self.hands[slot].place = Some(place);
        }
        let reading = string.model.grid.reading(place);
        let velocity = self.draw.either_way(1e-3, 100.0);
        // Clear of the string now and a step ago, but for a small overlap now and then.
        let now = string.state.displacement_at(&reading);
        let k = string.model.grid.time_step;
        let before = now - string.state.velocity_at(&string.model, &reading) * k + velocity * k;
        let height = now.max(before) + self.stream.lift.max(1e-4) * self.draw.between(-0.1, 1.0);
        // It was there before, so it can be there again.
        let placed =
            string.state.place_finger(&string.model, slot, self.touches[slot], place, height, velocity);
        debug_assert!(placed.is_ok(), "{placed:?}");
    }
}
