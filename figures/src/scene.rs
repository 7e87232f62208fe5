//! The picture of any scene: where its strings have been, and what it cost and what it held.

use anyhow::Result;
use low_action_dsp::{Energies, Entry, Scene, Simulation};

use crate::axis::{Axis, unit_for};
use crate::course::{BINS, Course};
use crate::describe::describe;
use crate::ground::{Ground, Profile};
use crate::panel::{Layer, Panel};
use crate::sheet::Sheet;
use crate::style::{Stroke, colour};

/// Strings shown at most; the numbers below them are of all.
const STRINGS: usize = 4;

/// Moments at which strings are shown, evenly from the first sample to the last; in a run of fewer samples, all of them.
const MOMENTS: u64 = 9;

/// Watches a scene while it runs.
#[derive(Debug, Clone)]
pub struct SceneFigure {
    caption: String,
    samples: u64,
    step: f64,
    /// Moments that have been, the first among them.
    moments: u64,
    strings: Vec<StringRecord>,
    string_count: usize,
    energies: [Course; 6],
    explained: Course,
    balance: f64,
    forces: [Course; 3],
    iterations: Course,
    penetration: Course,
    contacts: u32,
}

/// What is kept of one string.
#[derive(Debug, Clone)]
struct StringRecord {
    ground: Ground,
    profiles: Vec<Profile>,
    /// Place, and lowest and highest displacement so far, m.
    reach: Vec<(f64, f64, f64)>,
}

/// Names and lines of the energies, in the order of [`SceneFigure::energies`].
const ENERGIES: [(&str, Stroke); 6] = [
    ("all", Stroke::new(colour::INK)),
    ("string", Stroke::thin(colour::BLUE)),
    ("stretching", Stroke::thin(colour::SKY)),
    ("contacts", Stroke::thin(colour::VERMILION)),
    ("fingers", Stroke::thin(colour::GREEN)),
    ("body", Stroke::thin(colour::PURPLE)),
];

/// Names and lines of the forces, in the order of [`SceneFigure::forces`].
const FORCES: [(&str, Stroke); 3] = [
    ("frets", Stroke::thin(colour::VERMILION)),
    ("board", Stroke::thin(colour::ORANGE)),
    ("fingers", Stroke::thin(colour::GREEN)),
];

impl SceneFigure {
    /// Begins the picture of a scene that has not run yet.
    pub fn new(scene: &Scene, simulation: &Simulation) -> SceneFigure {
        let samples = simulation.samples();
        let course = || Course::new(samples, BINS);
        let strings = simulation.strings().iter().take(STRINGS).map(|string| {
            let at_first = string.places().zip(string.state.displacement()).map(|(x, u)| (x, u, u));
            StringRecord {
                ground: Ground::under(string, scene),
                profiles: vec![Profile::of(string)],
                reach: at_first.collect(),
            }
        });
        let opened = simulation.accounts().map(|account| account.initial).sum();
        SceneFigure {
            caption: describe(scene),
            samples,
            step: 1.0 / simulation.sample_rate(),
            moments: 1,
            strings: strings.collect(),
            string_count: simulation.strings().len(),
            energies: std::array::from_fn(|_| course()),
            explained: course(),
            balance: opened,
            forces: std::array::from_fn(|_| course()),
            iterations: course(),
            penetration: course(),
            contacts: 0,
        }
    }

    /// Takes note of a step that has just been taken.
    pub fn look(&mut self, simulation: &Simulation, entry: &Entry) {
        let before = self.moments;
        // (In a short run several moments are one sample.)
        while self.moments < MOMENTS && simulation.steps() >= self.moments * self.samples / (MOMENTS - 1) {
            self.moments += 1;
        }
        let due = self.moments > before;
        for (record, string) in self.strings.iter_mut().zip(simulation.strings()) {
            for (reach, u) in record.reach.iter_mut().zip(string.state.displacement()) {
                reach.1 = reach.1.min(u);
                reach.2 = reach.2.max(u);
            }
            if due {
                record.profiles.push(Profile::of(string));
            }
        }
        let energies = &entry.energies;
        let Energies { string, tension, contact, finger, body } = *energies;
        let parts = [energies.total(), string, tension, contact, finger, body];
        self.energies.iter_mut().zip(parts).for_each(|(course, part)| course.add(part));
        self.balance += self.step * (entry.power_in - entry.power_loss - entry.power_solver);
        self.explained.add(self.balance);
        let strings = simulation.strings();
        let sum = |force: fn(&low_action_dsp::simulation::SceneString) -> f64| -> f64 {
            strings.iter().map(force).fold(0.0, |sum, force| sum + force)
        };
        let forces = [
            sum(|string| string.fret_forces().fold(0.0, |sum, fret| sum + fret.1)),
            sum(|string| string.board_force()),
            sum(|string| string.fingers().fold(0.0, |sum, finger| sum + finger.force)),
        ];
        self.forces.iter_mut().zip(forces).for_each(|(course, force)| course.add(force));
        let iterations: u32 = strings.iter().map(|string| string.convergence.iterations).sum();
        self.iterations.add(f64::from(iterations));
        let deepest = strings.iter().map(|string| string.penetration()).fold(0.0, f64::max);
        self.penetration.add(deepest);
        self.contacts = strings.iter().map(|string| string.convergence.active).fold(self.contacts, u32::max);
    }

    /// Draws what was seen, as SVG.
    ///
    /// # Errors
    /// When the drawing library refuses a shape.
    pub fn draw(&self, title: &str) -> Result<String> {
        let mut sheet = Sheet::new(title, self.caption.as_str());
        for (number, string) in (1..).zip(&self.strings) {
            sheet = sheet.row(1000, vec![self.draw_string(number, string)]);
        }
        let mut row = vec![self.draw_energies()];
        if self.contacts > 0 {
            row.push(self.draw_forces());
        }
        sheet = sheet.row(1100, row);
        if self.contacts > 0 {
            sheet = sheet.row(1000, vec![self.draw_iterations(), self.draw_penetration()]);
        }
        sheet.draw()
    }

    fn time(&self) -> Axis {
        Axis::linear("time, s", 0.0..self.samples as f64 * self.step)
    }

    fn draw_string(&self, number: usize, record: &StringRecord) -> Panel {
        let (mut low, mut high) = record.ground.extent();
        for &(_, lowest, highest) in &record.reach {
            (low, high) = (low.min(1e3 * lowest), high.max(1e3 * highest));
        }
        // Room for fingers that hover, or whose pads are pressed in deeply, not for those that fly away.
        let room = 0.5 * (high - low);
        let extents = record.profiles.iter().map(|profile| profile.extent());
        let fingers = extents.fold((low, high), |(low, high), found| (low.min(found.0), high.max(found.1)));
        (low, high) = (fingers.0.max(low - room), fingers.1.min(high + room));
        let margin = 0.08 * (high - low).max(1e-9);
        let length = record.ground.length;
        let title = match self.string_count {
            1 => "The string at moments evenly through the scene, from light to dark".to_owned(),
            count => {
                format!("String {number} of {count} at moments evenly through the scene, from light to dark")
            }
        };
        let every = record.reach.len().div_ceil(1000).max(1);
        let reach = record.reach.iter().step_by(every).map(|&(x, low, high)| (x, 1e3 * low, 1e3 * high));
        let mut panel = Panel::new(
            title,
            Axis::linear("place, m from the nut", -0.015 * length..1.015 * length),
            Axis::linear("height, mm", low - margin..high + margin).cut(),
        )
        .with(Layer::Ground(record.ground.clone()))
        .with(Layer::Band {
            points: reach.collect(),
            stroke: Stroke::new(colour::FAINT).faded(0.6),
            name: "where it has been".into(),
        });
        let last = record.profiles.len().max(2) - 1;
        for (index, profile) in record.profiles.iter().enumerate() {
            let strength = 0.25 + 0.75 * index as f64 / last as f64;
            let string = Stroke::new(colour::BLUE).faded(strength);
            let finger = Stroke::new(colour::GREEN).faded(strength);
            panel = panel.with_all(Layer::profile(profile, string, finger));
        }
        let name = |layer: &mut Layer, called: &str| match layer {
            Layer::Line { name, .. } | Layer::Dots { name, .. } => *name = called.into(),
            _ => {}
        };
        if let Some(line) = panel.layers.iter_mut().rev().find(|layer| matches!(layer, Layer::Line { .. })) {
            name(line, "string");
        }
        if let Some(dot) = panel.layers.iter_mut().rev().find(|layer| matches!(layer, Layer::Dots { .. })) {
            name(dot, "finger, fainter while it touches nothing");
        }
        panel
    }

    fn draw_energies(&self) -> Panel {
        let largest = self.energies[0].largest().max(0.0);
        let (scale, unit) = unit_for(largest, "J");
        let y = Axis::linear(format!("energy, {unit}"), 0.0..1.08 * scale * largest).cut();
        let mut panel = Panel::new("Stored energy", self.time(), y);
        for (course, (name, stroke)) in self.energies.iter().zip(ENERGIES) {
            if course.largest() > 0.0 {
                panel = panel.with(Layer::line(name, stroke, course.points(0.5, self.step, scale)));
            }
        }
        let explained = self.explained.points(0.5, self.step, scale);
        panel.with(Layer::line("put in, less lost", Stroke::new(colour::ORANGE).dashed().wide(6), explained))
    }

    fn draw_forces(&self) -> Panel {
        let largest = self.forces.iter().map(Course::largest).fold(0.0, f64::max);
        let (scale, unit) = unit_for(largest, "N");
        let y = Axis::linear(format!("force, {unit}"), 0.0..1.08 * scale * largest).cut();
        let mut panel = Panel::new("Contact forces, sums", self.time(), y);
        for (course, (name, stroke)) in self.forces.iter().zip(FORCES) {
            if course.largest() > 0.0 {
                panel = panel.with(Layer::line(name, stroke, course.points(0.0, self.step, scale)));
            }
        }
        panel
    }

    fn draw_iterations(&self) -> Panel {
        let mean = self.iterations.sum() / self.samples.max(1) as f64;
        let title = format!("Newton iterations, {mean:.2} a sample on average");
        let y = Axis::linear("iterations", 0.0..1.08 * self.iterations.largest().max(1.0)).cut();
        let peaks = self.iterations.peaks(0.0, self.step, 1.0);
        Panel::new(title, self.time(), y).with(Layer::line("", Stroke::thin(colour::PURPLE), peaks))
    }

    fn draw_penetration(&self) -> Panel {
        let y = Axis::log_below("depth, m", self.penetration.largest(), 6);
        let peaks = self.penetration.peaks(1.0, self.step, 1.0);
        Panel::new("Deepest overlap of string with board or frets", self.time(), y).with(Layer::line(
            "",
            Stroke::thin(colour::VERMILION),
            peaks,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watched(text: &str) -> (SceneFigure, Simulation) {
        let scene = Scene::from_toml(text).unwrap();
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.open_ledger();
        let mut figure = SceneFigure::new(&scene, &simulation);
        while simulation.steps() < simulation.samples() {
            let entry = simulation.step().unwrap();
            figure.look(&simulation, &entry);
        }
        (figure, simulation)
    }

    const SCENE: &str = "sample_rate = 44100\nduration = 0.02\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                         tension = 60.0\nloss_0 = 5.0\nshape = [[0.0, 0.0], [0.3, 0.002], [0.65, 0.0]]\n\
                         [fretboard]\nstiffness = 1e10\nexponent = 1.5\nboard = -0.001\n";

    #[test]
    fn what_was_put_in_less_what_was_lost_is_what_is_stored() {
        let (figure, simulation) = watched(SCENE);
        let (stored, explained) =
            (figure.energies[0].points(0.0, 1.0, 1.0), figure.explained.points(0.0, 1.0, 1.0));
        assert_eq!(stored.len(), simulation.samples() as usize);
        for (stored, explained) in stored.iter().zip(&explained) {
            assert!((stored.1 - explained.1).abs() < 1e-12 * stored.1, "{stored:?} {explained:?}");
        }
        assert!(figure.energies[0].smallest() < 0.99 * figure.energies[0].largest(), "nothing was lost");
    }

    #[test]
    fn the_last_moment_of_a_short_run_is_shown_too() {
        for (samples, shown) in [(1, 2), (4, 5), (7, 8), (8, 9), (9, 9)] {
            let duration = f64::from(samples) / 44100.0;
            let (figure, simulation) = watched(&SCENE.replace("0.02\n", &format!("{duration:e}\n")));
            assert_eq!(simulation.samples(), samples as u64);
            let profiles = &figure.strings[0].profiles;
            assert_eq!(profiles.len(), shown, "{samples} samples");
            assert_eq!(profiles[shown - 1], Profile::of(simulation.string(0)), "{samples} samples");
        }
    }

    #[test]
    fn energies_and_forces_of_any_size_can_be_read() {
        for (height, energy) in
            [("0.002", "energy, mJ"), ("2e-6", "energy, nJ"), ("2e-12", "energy, 10⁻²⁴ J")]
        {
            let (figure, _) = watched(&SCENE.replace("0.002", height));
            let picture = figure.draw("scene").unwrap();
            assert!(picture.contains(energy), "{energy} is not in the picture");
        }
    }

    #[test]
    fn fingers_whose_pads_are_pressed_in_deeply_are_shown_too() {
        let soft =
            "[[finger]]\nmass = 5e-3\nstiffness = 1e3\nexponent = 2.0\nposition = 0.2\nheight = -0.002\n";
        let (figure, _) = watched(&format!("{SCENE}{soft}"));
        let panel = figure.draw_string(1, &figure.strings[0]);
        let places = panel.layers.iter().filter_map(|layer| match layer {
            Layer::Dots { points, .. } => Some(points[0].1),
            _ => None,
        });
        let lowest = places.fold(0.0, f64::min);
        assert!(lowest <= -2.0 && panel.y.range.contains(&lowest), "{lowest} in {:?}", panel.y.range);
    }

    #[test]
    fn strings_are_shown_from_the_first_moment_to_the_last() {
        let (figure, simulation) = watched(SCENE);
        let record = &figure.strings[0];
        assert_eq!(record.profiles.len() as u64, MOMENTS);
        assert_eq!(record.profiles[MOMENTS as usize - 1], Profile::of(simulation.string(0)));
        let highest = record.reach.iter().map(|reach| reach.2).fold(0.0, f64::max);
        let lowest = record.reach.iter().map(|reach| reach.1).fold(0.0, f64::min);
        assert!(highest > 0.0019 && lowest < -0.0009, "from {lowest} to {highest}");
        assert!(
            figure.contacts > 0 && figure.forces[1].largest() > 0.0 && figure.penetration.largest() > 0.0
        );
    }
}
