//! Which arrays a trace has, and how large they are.

use low_action_dsp::Simulation;
use low_action_dsp::digits::{at_least, plain};

use super::booked::{LEDGER, WORK};
use crate::cli::PROGRAM as PROGRAM_NAME;
use crate::cli::npz::{Array, Kind};

/// Where the numbers of one string go.
pub(super) struct StringArrays {
    pub displacement: usize,
    pub tension: usize,
    /// Of it on the bridge.
    pub on_bridge: usize,
    /// What is stored in it, where that is not all there is.
    pub stored: Option<usize>,
    /// Of the bridge of a body.
    pub bridge: Option<usize>,
    pub board: Option<usize>,
    /// The first of its frets' arrays; the others follow.
    pub frets: usize,
}

/// Where the numbers of one finger go.
pub(super) struct FingerArrays {
    pub place: usize,
    pub height: usize,
    pub force: usize,
}

/// Where times go, and what the trace is of: the scene's text, what computed it, at which rate, and how many samples apart rows
/// are.
pub(super) const TIME: usize = 0;
pub(super) const SCENE: usize = 1;
pub(super) const PROGRAM: usize = 2;
pub(super) const SAMPLE_RATE: usize = 3;
pub(super) const EVERY: usize = 4;

/// The arrays of a trace and what fills them. Those above are the first.
pub(super) struct Plan {
    pub arrays: Vec<Array>,
    pub strings: Vec<StringArrays>,
    /// The force of each pluck.
    pub plucks: Vec<usize>,
    pub fingers: Vec<FingerArrays>,
    /// Where the bridge of a body is.
    pub lift: Option<usize>,
    pub output: usize,
    pub iterations: usize,
    pub ledger: usize,
    pub rows: u64,
    pub every: u64,
}

impl Plan {
    /// The trace of every so many-th sample of a simulation of a scene that is so written.
    pub(super) fn new(text: &str, simulation: &Simulation, every: u64) -> Plan {
        let rows = simulation.samples().div_ceil(every);
        let mut arrays = Vec::new();
        let mut array = |name: String, kind: Kind, shape: &[u64]| {
            arrays.push(Array { name, kind, shape: shape.to_vec() });
            arrays.len() - 1
        };
        array("t".into(), Kind::Real, &[rows]);
        array("scene".into(), Kind::Text(text.chars().count() as u64), &[]);
        array("program".into(), Kind::Text(PROGRAM_NAME.chars().count() as u64), &[]);
        array("sample_rate".into(), Kind::Real, &[]);
        array("every".into(), Kind::Whole, &[]);
        let has_body = simulation.has_body();
        let has_others = has_body || simulation.strings().len() > 1;
        let mut strings = Vec::new();
        let mut pluck_count = 0;
        let mut finger_numbers = Vec::new();
        for (number, string) in (1..).zip(simulation.strings()) {
            let points = string.model.grid.unknowns() as u64;
            array(format!("x_{number}"), Kind::Real, &[points]);
            let displacement = array(format!("u_{number}"), Kind::Real, &[rows, points]);
            let tension = array(format!("tension_{number}"), Kind::Real, &[rows]);
            let on_bridge = array(format!("force_bridge_{number}"), Kind::Real, &[rows]);
            let stored = has_others.then(|| array(format!("stored_{number}"), Kind::Real, &[rows]));
            let bridge = has_body.then(|| array(format!("power_bridge_{number}"), Kind::Real, &[rows]));
            let board =
                string.has_board().then(|| array(format!("force_board_{number}"), Kind::Real, &[rows]));
            let before = [stored, bridge, board].into_iter().flatten().count();
            let frets = on_bridge + 1 + before;
            for fret in 1..=string.fret_count() {
                array(format!("force_fret_{number}_{fret}"), Kind::Real, &[rows]);
            }
            strings.push(StringArrays { displacement, tension, on_bridge, stored, bridge, board, frets });
            pluck_count += string.plucks().count();
            finger_numbers.extend(string.fingers().map(|finger| finger.number));
        }
        finger_numbers.sort_unstable();
        let plucks =
            (1..=pluck_count).map(|pluck| array(format!("force_pluck_{pluck}"), Kind::Real, &[rows]));
        let plucks = plucks.collect();
        let fingers = finger_numbers.iter().map(|index| FingerArrays {
            place: array(format!("x_finger_{}", index + 1), Kind::Real, &[rows]),
            height: array(format!("u_finger_{}", index + 1), Kind::Real, &[rows]),
            force: array(format!("force_finger_{}", index + 1), Kind::Real, &[rows]),
        });
        let fingers = fingers.collect();
        let lift = has_body.then(|| array("u_bridge".into(), Kind::Real, &[rows]));
        let output = array("output".into(), Kind::Real, &[rows]);
        let iterations = array("iterations".into(), Kind::Count, &[rows]);
        let ledger = iterations + 1;
        for (name, _) in LEDGER.iter().chain(&WORK) {
            array((*name).into(), Kind::Real, &[rows]);
        }
        Plan { arrays, strings, plucks, fingers, lift, output, iterations, ledger, rows, every }
    }

    /// How many samples apart rows must be for all numbers to take at most so many bytes.
    pub(super) fn least_every(text: &str, simulation: &Simulation, most: u64) -> u64 {
        let samples = simulation.samples();
        let bytes = |rows: u64| Plan::new(text, simulation, samples.div_ceil(rows).max(1)).bytes();
        let (one, row) = (bytes(1), bytes(2).saturating_sub(bytes(1)).max(1));
        let rows = (most + row).saturating_sub(one) / row;
        samples.div_ceil(rows.max(1))
    }

    /// Why it is refused where at most so many bytes can be written, in words, too; and how few rows would do, if any.
    pub(super) fn too_large(&self, most: u64, limit: &str, text: &str, simulation: &Simulation) -> String {
        let (every, bytes) = (self.every, plain(at_least(self.bytes() as f64)));
        let least = Plan::least_every(text, simulation, most);
        let advice = match Plan::new(text, simulation, least).bytes() <= most {
            true => format!(": it must be at least {least}"),
            false => String::new(),
        };
        format!("--every {every} is refused: the trace would take {bytes} bytes, and {limit}{advice}")
    }

    /// Bytes of all numbers.
    pub(super) fn bytes(&self) -> u64 {
        self.arrays.iter().map(Array::bytes).sum()
    }
}

#[cfg(test)]
mod tests {
    use low_action_dsp::Scene;

    use super::*;

    #[test]
    fn the_least_that_is_named_for_every_is_enough_and_no_less_is() {
        let text = "sample_rate = 44100\nduration = 0.1\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\n";
        let simulation = Simulation::new(&Scene::from_toml(text).unwrap()).unwrap();
        let bytes = |every| Plan::new(text, &simulation, every).bytes();
        for most in [bytes(4410), bytes(4410) + 1, 10_000, 100_000, 123_456, bytes(2), bytes(2) - 1] {
            let least = Plan::least_every(text, &simulation, most);
            assert!(bytes(least) <= most && bytes(least - 1) > most, "{most}: {least}");
        }
    }
}
