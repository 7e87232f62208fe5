//! What a player and a luthier have set, as plain numbers: the plugin's parameters, exact and free of
//! any host's types.

use low_action_dsp::setup::{Pickup, Player};
use low_action_dsp::{EngineSettings, Setup};

use crate::engine::{self, EngineOptions, Quality};
use crate::performance::NEAREST_PLUCK;

/// What cannot be changed without compiling the strings anew. All values are relative to a set-up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Luthier {
    /// How much computing.
    pub quality: Quality,
    /// Newton iterations at most, or 0 for the quality's own.
    pub iterations: usize,
    /// Factor of the height of the strings over the frets.
    pub action: f64,
    /// Added to the relief, m.
    pub relief: f64,
    /// Factor of the height of the frets.
    pub fret_height: f64,
    /// Factor of the loss of all frequencies alike.
    pub loss_0: f64,
    /// Factor of the loss that grows with frequency.
    pub loss_1: f64,
    /// Whether stretching raises the tension (if the set-up has it so).
    pub tension_modulation: bool,
    /// Moves the coil away from the saddle, m.
    pub pickup_position: f64,
    /// How much of the other kind of pickup is heard, 0 to 1.
    pub pickup_blend: f64,
    /// Factor of what hands take of strings that nobody plays.
    pub idle_hands: f64,
    /// Raises all strings, semitones.
    pub tuning: f64,
    /// Raises each open string, semitones.
    pub strings: [f64; crate::params::TUNED_STRINGS],
}

impl Default for Luthier {
    fn default() -> Self {
        Self {
            quality: Quality::default(),
            iterations: 0,
            action: 1.0,
            relief: 0.0,
            fret_height: 1.0,
            loss_0: 1.0,
            loss_1: 1.0,
            tension_modulation: true,
            pickup_position: 0.0,
            pickup_blend: 0.0,
            idle_hands: 1.0,
            tuning: 0.0,
            strings: [0.0; crate::params::TUNED_STRINGS],
        }
    }
}

impl Luthier {
    /// The set-up with all this done to it. What would lead off the string or past a limit of the set-up
    /// file goes as far as it can.
    pub fn work_on(&self, setup: &mut Setup) {
        let neck = &mut setup.neck;
        neck.nut_clearance *= self.action;
        neck.action *= self.action;
        neck.relief += self.relief;
        neck.fret_height *= self.fret_height;
        let scale = neck.scale_length;
        if let Pickup::Magnetic { position, aperture, .. } = &mut setup.pickup {
            let [nearest, farthest] = coil_places(*position, *aperture, scale);
            *position = (*position + self.pickup_position).min(farthest).max(nearest);
        }
        setup.blend = setup.blend.max(self.pickup_blend);
        setup.tension_modulation &= self.tension_modulation;
        setup.player.idle_loss *= self.idle_hands;
        setup.tuning += self.tuning;
        for (index, string) in setup.string.iter_mut().enumerate() {
            string.loss_0 *= self.loss_0;
            string.loss_1 *= self.loss_1;
            string.pitch += self.strings.get(index).copied().unwrap_or(0.0);
        }
        setup.limit();
    }

    /// What an engine is built from.
    pub fn options(&self, mut setup: Setup, sample_rate: f64) -> EngineOptions {
        self.work_on(&mut setup);
        let (quality, iterations) = (self.quality, self.own_iterations());
        EngineOptions { quality, iterations, ..EngineOptions::new(setup, sample_rate) }
    }

    /// How the instrument of such an engine is computed at a sample rate, Hz.
    pub fn settings(&self, sample_rate: f64) -> EngineSettings {
        engine::settings(self.quality, self.own_iterations(), sample_rate)
    }

    /// Newton iterations at most, if not as many as the quality has.
    fn own_iterations(&self) -> Option<usize> {
        (self.iterations > 0).then_some(self.iterations)
    }
}

/// The nearest and the farthest place of a coil of such an aperture on strings of such a scale, m from the saddle: half its
/// field must stay on the string, with a little to spare, but what a set-up itself has is left to it.
pub fn coil_places(own: f64, aperture: f64, scale: f64) -> [f64; 2] {
    let nearest = 0.51 * aperture + 1e-3;
    [nearest.min(own), (scale - nearest).max(own)]
}

/// The nearest and the farthest place of a pluck, m from the saddle, on strings of such a scale. Fingers have a width, but what
/// a set-up itself has is left to it.
pub fn pluck_places(own: f64, scale: f64) -> [f64; 2] {
    [NEAREST_PLUCK.min(own), (scale - NEAREST_PLUCK).max(own)]
}

/// How the hands act: what can change from one pluck to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touching {
    /// Moves the pluck away from the saddle, m.
    pub pluck_position: f64,
    /// Factor of the hardest pluck's force.
    pub pluck_force: f64,
    /// The softest pluck's force, as a part of the hardest one's.
    pub pluck_softest: f64,
    /// Factor of how long a pluck pushes.
    pub pluck_duration: f64,
    /// Adds to how long it takes to let go, s.
    pub pluck_release: f64,
    /// Power of the velocity with which the force goes.
    pub velocity_curve: f64,
    /// Size of the small differences between plucks, 0 to 1.
    pub variation: f64,
    /// Which sequence of them, as [`EngineOptions::seed`]; another begins with the next pluck.
    pub take: u64,
    /// Factor of the force of the finger that stops a string.
    pub finger_force: f64,
    /// Factor of the stiffness of its pad.
    pub finger_hardness: f64,
    /// Factor of its mass.
    pub finger_mass: f64,
    /// Factor of the height from which it comes.
    pub finger_hover: f64,
    /// Factor of the damping of the hand behind it.
    pub hand_damping: f64,
    /// Semitones of a full turn of the pitch wheel.
    pub bend_range: f64,
    /// Whether an announced range is passed over.
    pub ignore_rpn: bool,
    /// Bends all strings at once, semitones.
    pub tremolo_arm: f64,
    /// Whether overlapping notes on one string are connected, controller 68 or not.
    pub legato: bool,
    /// The key at which keyswitches begin, if there are any.
    pub keyswitches: Option<u8>,
    /// The fret, from 1 on, that the first finger of the left hand stays at where it can, or the last one if there are fewer; without,
    /// the hand moves as little as it can.
    pub hand_position: Option<u8>,
    /// The fret of a capo on all strings, 0 for none.
    pub capo: u8,
    /// Whether controllers 20 to 28 are heard, which tell hands what to do.
    pub hand_controllers: bool,
}

impl Touching {
    /// Everything as the set-up has it, with so much variation (0 to 1) and such a bend range
    /// (semitones).
    pub fn new(variation: f64, bend_range: f64) -> Self {
        Self {
            pluck_position: 0.0,
            pluck_force: 1.0,
            pluck_softest: 0.0,
            pluck_duration: 1.0,
            pluck_release: 0.0,
            velocity_curve: crate::performance::VELOCITY_CURVE,
            variation,
            take: 0,
            finger_force: 1.0,
            finger_hardness: 1.0,
            finger_mass: 1.0,
            finger_hover: 1.0,
            hand_damping: 1.0,
            bend_range,
            ignore_rpn: false,
            tremolo_arm: 0.0,
            legato: false,
            keyswitches: None,
            hand_position: None,
            capo: 0,
            hand_controllers: true,
        }
    }

    /// The force of a pluck as a part of the hardest one's, for a velocity of 0 to 1.
    pub fn strength(&self, velocity: f64) -> f64 {
        self.pluck_softest + (1.0 - self.pluck_softest) * libm::pow(velocity, self.velocity_curve)
    }

    /// The hands of a set-up with strings of such a scale (m), acting so; what would lead past a limit of the
    /// set-up file goes as far as it can.
    pub fn hands(&self, hands: &Player, scale: f64) -> Player {
        let mut hands = hands.clone();
        let own = hands.pluck_position;
        let [nearest, farthest] = pluck_places(own, scale);
        hands.pluck_position = (own + self.pluck_position).min(farthest).max(nearest);
        hands.pluck_force *= self.pluck_force;
        hands.pluck_duration *= self.pluck_duration;
        hands.pluck_release += self.pluck_release;
        let fretting = &mut hands.fretting;
        fretting.force *= self.finger_force;
        fretting.touch.stiffness *= self.finger_hardness;
        fretting.touch.mass *= self.finger_mass;
        fretting.hover *= self.finger_hover;
        fretting.touch.hand_damping *= self.hand_damping;
        hands.limit();
        hands
    }
}

impl Default for Touching {
    fn default() -> Self {
        Self::new(EngineOptions::VARIATION, EngineOptions::BEND_RANGE)
    }
}

#[cfg(test)]
mod tests {
    use low_action_dsp::setup::Pickup;

    use super::*;

    /// What the plugin plays of a set-up is what `low-action render` plays of it, however tight the coil is in its place.
    #[test]
    fn who_changes_nothing_leaves_the_setup_as_it_is() {
        let tight = |position: f64, aperture: f64| {
            let text =
                format!("based_on = \"electric\"\n[pickup]\nposition = {position}\naperture = {aperture}\n");
            Setup::from_toml(&text).expect("the coil is on the string")
        };
        let mut setups =
            Setup::SHIPPED.map(|name| Setup::shipped(name).expect("it comes with the program")).to_vec();
        // Beside the saddle, beside the nut, and all along the string of 0.6477 m.
        setups.extend([tight(0.0104, 0.02), tight(0.637, 0.02), tight(0.3238, 0.645), tight(5e-4, 0.0)]);
        for setup in setups {
            let mut same = setup.clone();
            Luthier::default().work_on(&mut same);
            assert_eq!(same, setup);
        }
    }

    /// From wherever a coil is, it goes no farther than to where it can be.
    #[test]
    fn a_coil_stays_where_a_setup_may_have_it() {
        for (own, aperture) in [(0.162, 0.02), (0.0104, 0.02), (0.637, 0.02), (0.3238, 0.645), (5e-4, 0.0)] {
            let mut setup = Setup::builtin("electric").expect("it is built in");
            for offset in [-1.0, -0.01, -1e-4, 0.0, 1e-4, 0.01, 1.0] {
                if let Pickup::Magnetic { position, aperture: width, .. } = &mut setup.pickup {
                    (*position, *width) = (own, aperture);
                }
                Luthier { pickup_position: offset, ..Luthier::default() }.work_on(&mut setup);
                assert_eq!(setup.check(), Ok(()), "{own} m, {aperture} m, by {offset} m");
            }
        }
    }
}
