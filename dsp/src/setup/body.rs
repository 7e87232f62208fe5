//! The body of an instrument: what the strings move at the bridge, and what sounds in the air.

use std::f64::consts::{PI, TAU};
use std::fmt::{self, Formatter};

use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::error::{Error, ranged, within};

/// A box with a soundboard and a hole, as a luthier would measure it. The bridge stands on the soundboard and gives way with it.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Frequency of the soundboard's lowest mode while the box is open, so that no air resists, Hz, 30 to 2000, and as low as the
    /// rate of its strings asks for.
    pub frequency: f64,
    /// What moves in that mode as seen at the bridge, kg, 0.01 to 1000.
    pub mass: f64,
    /// The area of a piston that moves as much air when it moves with the bridge, m², 1e-4 to 1.
    pub area: f64,
    /// How long every mode rings: its frequency times the time in which its energy falls by a factor of exp(2π), 1 to 200.
    pub quality: f64,
    /// How far apart its modes are on the mean, Hz, 5 to 1000.
    pub spacing: f64,
    /// Air in the box, m³, 1e-4 to 1.
    pub volume: f64,
    /// Area of its hole, m², 1e-5 to 0.1.
    pub hole: f64,
}

/// A body as a table, or `false` for none: what takes away the one that a set-up is based on.
pub(super) fn or_none<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Body>, D::Error> {
    struct OrNone;

    impl<'de> Visitor<'de> for OrNone {
        type Value = Option<Body>;

        fn expecting(&self, formatter: &mut Formatter) -> fmt::Result {
            formatter.write_str("a table or `false`")
        }

        fn visit_bool<E: serde::de::Error>(self, value: bool) -> Result<Self::Value, E> {
            if value { Err(E::invalid_type(Unexpected::Bool(true), &self)) } else { Ok(None) }
        }

        // As JSON has none: in labels, which hold the set-up whole.
        fn visit_unit<E: serde::de::Error>(self) -> Result<Self::Value, E> {
            Ok(None)
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
            Body::deserialize(MapAccessDeserializer::new(map)).map(Some)
        }
    }

    deserializer.deserialize_any(OrNone)
}

/// One way in which body and air swing, by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mode {
    /// Hz.
    pub frequency: f64,
    /// ω/Q is what its velocity loses, 1/s.
    pub quality: f64,
    /// How far the bridge moves with it: of a mode shape whose mass is 1 kg, 1/√kg.
    pub bridge: f64,
    /// What it sends out: the sound pressure [`DISTANCE`] away for its acceleration, Pa s²/(m √kg).
    pub pressure: f64,
}

/// Density of air, kg/m³, and the speed of sound in it, m/s, at 20 °C.
const AIR: f64 = 1.204;
const SPEED: f64 = 343.2;

/// From where it is heard, m: in front of the box, in a room without walls.
const DISTANCE: f64 = 1.0;

/// What moves in a hole in a thin plate is as much air as would fill a tube of this many radii: 8/(3π) on either side.
const PLUG: f64 = 16.0 / (3.0 * PI);

/// No higher modes of the soundboard are counted above this, Hz.
const HIGHEST: f64 = 8000.0;

/// Where modes are nearer to one another than this part of their frequency, one stands for several.
const NEAREST: f64 = 1.0 / 12.0;

/// 1/x and 1/x² of the solution x of x⁴ = x + 1: what multiples of them leave beside whole numbers is spread evenly over a square.
const SPREAD: [f64; 2] = [0.819_172_513_396_164_5, 0.671_043_606_703_789_3];

/// The first of so many neighbours sends out against the motion of the bridge, the others with it.
const AGAINST: u32 = 3;

impl Body {
    /// What its frequency may be, Hz, where the rate is high enough.
    pub(crate) const FREQUENCY: [f64; 2] = [30.0, 2000.0];
    /// What its mass may be, kg, where the strings are light enough.
    pub(crate) const MASS: [f64; 2] = [0.01, 1000.0];

    /// Refuses values outside their range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        ranged("body.frequency", self.frequency, Self::FREQUENCY, "Hz")?;
        ranged("body.mass", self.mass, Self::MASS, "kg")?;
        within("body.area", self.area, 1e-4, 1.0, "m²")?;
        within("body.quality", self.quality, 1.0, 200.0, "")?;
        within("body.spacing", self.spacing, 5.0, 1000.0, "Hz")?;
        within("body.volume", self.volume, 1e-4, 1.0, "m³")?;
        within("body.hole", self.hole, 1e-5, 0.1, "m²").map(drop)
    }

    /// About how much is heard of 1 N on the bridge, Pa: what makes notes as loud as at the bridge itself, on the mean of those that
    /// come with the program.
    pub fn pascals_per_newton(&self) -> f64 {
        0.4 * self.area / self.mass
    }

    /// What the bridge takes up of a force of a frequency, Hz: the real part of its velocity over that force, s/kg.
    pub fn takes_up(&self, frequency: f64) -> f64 {
        let omega = TAU * frequency;
        // Of what stands in phase with the force and a quarter of a turn behind it, the latter is displacement that has velocity.
        self.moved(frequency, |mode| mode.bridge * mode.bridge)[1] * omega
    }

    /// The sound pressure that a force of a frequency, Hz, on the bridge makes, Pa for each newton.
    pub fn sounds(&self, frequency: f64) -> f64 {
        let omega = TAU * frequency;
        let [ahead, behind] = self.moved(frequency, |mode| mode.bridge * mode.pressure);
        omega * omega * (ahead * ahead + behind * behind).sqrt()
    }

    /// The sum over all modes of what each is moved by a force of 1 N on 1 kg, m, times something of it: in phase with the force, and a
    /// quarter of a turn behind.
    fn moved(&self, frequency: f64, of: impl Fn(Mode) -> f64) -> [f64; 2] {
        let omega = TAU * frequency;
        let [mut ahead, mut behind] = [0.0; 2];
        for mode in self.modes() {
            let own = TAU * mode.frequency;
            let (stiff, lossy) = (own * own - omega * omega, omega * own / mode.quality);
            let part = of(mode) / (stiff * stiff + lossy * lossy);
            (ahead, behind) = (ahead + part * stiff, behind + part * lossy);
        }
        [ahead, behind]
    }

    /// All modes: the two in which soundboard and air swing together, then those of the soundboard alone.
    pub(crate) fn modes(&self) -> Vec<Mode> {
        let mut modes: Vec<Mode> = self.with_air().into();
        modes.extend(self.higher(modes[1].frequency));
        modes
    }

    /// The soundboard as a piston of one mass and the air in the hole as another, both on the spring of the air in the box: the
    /// two modes of M ẍ = −K x, with p = −(ρc²/V)(A x₁ + S x₂) inside. What both move together is what is heard: far below the
    /// lower mode as much goes in by the hole as the soundboard pushes out.
    pub(crate) fn with_air(&self) -> [Mode; 2] {
        let plug = AIR * self.hole * PLUG * (self.hole / PI).sqrt();
        let spring = AIR * SPEED * SPEED / self.volume;
        let own = TAU * self.frequency;
        // By masses of 1 kg: M^(−½) K M^(−½).
        let board = own * own + spring * self.area * self.area / self.mass;
        let air = spring * self.hole * self.hole / plug;
        let both = spring * self.area * self.hole / (self.mass * plug).sqrt();
        let (mean, half) = (0.5 * (board + air), 0.5 * (board - air));
        let apart = (half * half + both * both).sqrt();
        // (mean − apart would cancel; the product of both squares is what the soundboard has without the box.)
        let high = mean + apart;
        let low = own * own * air / high;
        // The higher mode; the lower one stands upright on it. (Of two rows that say it the one that does not cancel.)
        let [x, y] = if half > 0.0 { [half + apart, both] } else { [both, apart - half] };
        let length = (x * x + y * y).sqrt();
        let [x, y] = [x / length, y / length];
        [low, high].map(|square| {
            let [x, y] = if square == low { [-y, x] } else { [x, y] };
            let (board, plug) = (x / self.mass.sqrt(), y / plug.sqrt());
            let volume = self.area * board + self.hole * plug;
            self.mode(square.sqrt() / TAU, board, volume)
        })
    }

    /// The higher modes of the soundboard, as they are on the mean: as many as there are in a band, but no more than can be told
    /// apart, each at a place, of a size and of a sign that a fixed rule gives it. No guitar has just these.
    ///
    /// A plate has m₁₁ = M/4 in its lowest mode and M in others where the bridge happens to stand, on the mean of φ². Of its modes
    /// (a, b) only those with odd numbers move any air, a part 1/(ab) of it; in a band of frequencies, where a² + b² is about the
    /// same, the square of that falls as f^(−3/2), by those along the edges, (1, b) and (a, 1), a quarter of which are to be had.
    ///
    /// Between two neighbours what both send out cancels if it goes with the bridge in both, or against it, and adds up if it does not;
    /// near each of them it is the other way round. Drawn signs have whole notes cancel; one in three against, first of all the one
    /// above the two with air, which are strong, leaves no note more than 8 dB under its neighbours (docs/physics.md).
    fn higher(&self, from: f64) -> impl Iterator<Item = Mode> {
        let body = *self;
        let mut frequency = from;
        (1..).map_while(move |count| {
            let gap = body.spacing.max(NEAREST * frequency);
            // Parts of multiples of numbers like the golden section never come near to one another.
            let [place, size] = SPREAD.map(|number| (f64::from(count) * number).fract());
            frequency += gap * (0.75 + 0.5 * place);
            // (Of a mean square of 1.)
            let size = (0.4 + 1.2 * size).sqrt();
            let several = (gap / body.spacing).sqrt();
            let bridge = 0.5 * several * size / body.mass.sqrt();
            let volume = body.area / body.mass.sqrt() * libm::pow(from / frequency, 0.75);
            let against = count % AGAINST == 1;
            (frequency < HIGHEST)
                .then(|| body.mode(frequency, bridge, if against { -volume } else { volume }))
        })
    }

    /// A mode by how far the bridge moves and how much air, m³, while a mass of 1 kg moves by 1 m. Small sources send sound out
    /// alike in all directions: ρ/(4πr) times how the flow changes.
    fn mode(&self, frequency: f64, bridge: f64, volume: f64) -> Mode {
        let pressure = AIR / (4.0 * PI * DISTANCE) * volume;
        Mode { frequency, quality: self.quality, bridge, pressure }
    }
}

#[cfg(test)]
impl Body {
    /// As a guitar may have it, for tests.
    pub(crate) const GUITAR: Body = Body {
        frequency: 170.0,
        mass: 0.1,
        area: 0.05,
        quality: 20.0,
        spacing: 50.0,
        volume: 0.0145,
        hole: 0.0055,
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both modes together know what the matrix is made of: the sum and the product of their squares, and a mass of 1 kg each.
    #[test]
    fn board_and_air_swing_together() {
        for body in [
            Body::GUITAR,
            Body { frequency: 60.0, ..Body::GUITAR },
            Body { frequency: 900.0, ..Body::GUITAR },
        ] {
            let plug = AIR * body.hole * PLUG * (body.hole / PI).sqrt();
            let spring = AIR * SPEED * SPEED / body.volume;
            let helmholtz = (spring * body.hole * body.hole / plug).sqrt() / TAU;
            let closed = body.frequency.powi(2) + spring * body.area * body.area / body.mass / TAU.powi(2);
            let [low, high] = body.with_air();
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
            assert!(near(low.frequency.powi(2) + high.frequency.powi(2), closed + helmholtz.powi(2)));
            assert!(near(low.frequency * high.frequency, body.frequency * helmholtz));
            // The bridge answers a blow as the soundboard's mass does.
            assert!(near(low.bridge.powi(2) + high.bridge.powi(2), 1.0 / body.mass));
            // Pushed for ever, it moves no air: what the board pushes out comes in by the hole.
            let slow = |mode: Mode| mode.bridge * mode.pressure / mode.frequency.powi(2);
            assert!((slow(low) + slow(high)).abs() < 1e-12 * slow(high).abs());
        }
    }

    /// Where the two lowest modes are that the files of instruments name.
    #[test]
    fn instruments_swing_where_they_say() {
        for (name, low, high) in
            [("classical", 100.0, 190.0), ("steel", 103.0, 192.0), ("ukulele", 216.0, 382.0)]
        {
            let modes = crate::setup::Setup::shipped(name)
                .and_then(|setup| setup.body)
                .expect("it has one")
                .with_air();
            println!("{name}: {:.1} and {:.1} Hz", modes[0].frequency, modes[1].frequency);
            assert!(
                (modes[0].frequency - low).abs() < 0.6 && (modes[1].frequency - high).abs() < 0.6,
                "{name}"
            );
        }
    }

    /// However far apart modes are said to be, as much of the bridge's motion is in each band: on the mean 1/(4 · 4m · spacing)
    /// is what a plate of mass 4m takes up.
    #[test]
    fn higher_modes_take_up_as_much_as_a_plate() {
        let body = Body::GUITAR;
        let band = 1000.0..6000.0;
        let own = body.higher(200.0).filter(|mode| band.contains(&mode.frequency));
        // Each mode has π/2 · φ² of ∫ Re Y dω.
        let taken = own.map(|mode| 0.5 * PI * mode.bridge * mode.bridge).sum::<f64>() / (TAU * 5000.0);
        let plate = 1.0 / (16.0 * body.mass * body.spacing);
        assert!((taken / plate - 1.0).abs() < 0.15, "{taken} and {plate} s/kg");
    }
}
