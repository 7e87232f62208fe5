//! Which arrays a trace has, and how large they are.

use low_action_dsp::Simulation;
use low_action_dsp::digits::{at_least, plain};

use super::booked::{LEDGER, WORK};
use crate::cli::PROGRAM;
use crate::cli::npz::{Array, Kind};

/// Where it is said what the trace is of: the scene's text, what computed it, at which rate, and how many samples apart rows are.
#[derive(Clone, Copy)]
pub(super) struct OriginArrays {
    pub scene: usize,
    pub program: usize,
    pub sample_rate: usize,
    pub every: usize,
}

/// Where the numbers of one string go.
pub(super) struct StringArrays {
    pub places: usize,
    pub displacement: usize,
    pub tension: usize,
    /// Of it on the bridge.
    pub on_bridge: usize,
    /// What is stored in it, where that is not all there is.
    pub stored: Option<usize>,
    /// Of the bridge of a body.
    pub bridge: Option<usize>,
    pub board: Option<usize>,
    pub frets: Vec<usize>,
}

/// Where the numbers of one finger go.
pub(super) struct FingerArrays {
    pub place: usize,
    pub height: usize,
    pub force: usize,
}

/// The arrays of a trace and what fills them.
pub(super) struct Plan {
    pub arrays: Vec<Array>,
    pub time: usize,
    pub origin: OriginArrays,
    pub strings: Vec<StringArrays>,
    /// The force of each pluck.
    pub plucks: Vec<usize>,
    pub fingers: Vec<FingerArrays>,
    /// Where the bridge of a body is.
    pub lift: Option<usize>,
    pub output: usize,
    pub iterations: usize,
    /// As [`LEDGER`] and [`WORK`] have them.
    pub ledger: [usize; LEDGER.len()],
    pub work: [usize; WORK.len()],
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
        let written = |text: &str| Kind::Text(text.chars().count() as u64);
        let time = array("t".into(), Kind::Real, &[rows]);
        let origin = OriginArrays {
            scene: array("scene".into(), written(text), &[]),
            program: array("program".into(), written(PROGRAM), &[]),
            sample_rate: array("sample_rate".into(), Kind::Real, &[]),
            every: array("every".into(), Kind::Whole, &[]),
        };
        let has_body = simulation.has_body();
        let has_others = has_body || simulation.strings().len() > 1;
        let mut strings = Vec::new();
        let mut pluck_count = 0;
        let mut finger_numbers = Vec::new();
        for (number, string) in (1..).zip(simulation.strings()) {
            let points = string.model.grid.unknowns() as u64;
            let places = array(format!("x_{number}"), Kind::Real, &[points]);
            let displacement = array(format!("u_{number}"), Kind::Real, &[rows, points]);
            let tension = array(format!("tension_{number}"), Kind::Real, &[rows]);
            let on_bridge = array(format!("force_bridge_{number}"), Kind::Real, &[rows]);
            let stored = has_others.then(|| array(format!("stored_{number}"), Kind::Real, &[rows]));
            let bridge = has_body.then(|| array(format!("power_bridge_{number}"), Kind::Real, &[rows]));
            let board =
                string.has_board().then(|| array(format!("force_board_{number}"), Kind::Real, &[rows]));
            let frets = (1..=string.fret_count())
                .map(|fret| array(format!("force_fret_{number}_{fret}"), Kind::Real, &[rows]))
                .collect();
            strings.push(StringArrays {
                places,
                displacement,
                tension,
                on_bridge,
                stored,
                bridge,
                board,
                frets,
            });
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
        let ledger = LEDGER.map(|(name, _)| array(name.into(), Kind::Real, &[rows]));
        let work = WORK.map(|(name, _)| array(name.into(), Kind::Real, &[rows]));
        Plan {
            arrays,
            time,
            origin,
            strings,
            plucks,
            fingers,
            lift,
            output,
            iterations,
            ledger,
            work,
            rows,
            every,
        }
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
    use std::collections::BTreeSet;

    use clap::Args;
    use low_action_dsp::Scene;

    use super::*;
    use crate::cli::SceneArgs;

    /// The help lists all arrays and no others: those of the scene that it shows, which has all there can be.
    #[test]
    fn the_help_has_the_names_of_all_arrays() {
        let command = SceneArgs::augment_args(clap::Command::new("scene"));
        let help = command.get_after_help().expect("there is more to say").to_string();
        let between = |from, to| help.split_once(from).unwrap().1.split_once(to).unwrap().0;
        let scene = between("(docs/formats.md has all that may stand in one):\n", "\n\nThe trace");
        let simulation = Simulation::new(&Scene::from_toml(scene).unwrap()).unwrap();
        let plan = Plan::new(scene, &simulation, 1);
        // Of many frets the first will do.
        let is_another = |name: &str| name.starts_with("force_fret_1_") && name != "force_fret_1_1";
        let arrays: BTreeSet<_> =
            plan.arrays.into_iter().map(|array| array.name).filter(|name| !is_another(name)).collect();
        let first = |name: &str| {
            ["_S", "_F", "_N"].into_iter().fold(name.to_owned(), |name, of| name.replace(of, "_1"))
        };
        // Two spaces, names, more spaces, what they are.
        let lines = between("half a sample later.\n", "\n\n").lines().filter(|line| !line.starts_with("   "));
        let names = lines.flat_map(|line| line.trim().split("  ").next().unwrap().split(", "));
        let listed: BTreeSet<_> = names.map(|name| first(name.trim_matches(','))).collect();
        assert_eq!(listed, arrays);
    }

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
