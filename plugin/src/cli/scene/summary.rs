//! What the `scene` command says at the end.

use std::io::{self, Write};

use low_action_dsp::scene::ListeningPoint;
use low_action_dsp::{Account, Scene, Simulation};

use super::check::open_part;
use super::seen::Seen;
use crate::cli::SceneArgs;
use crate::cli::descriptors::is_standard_output;
use crate::cli::names::shown;
use crate::cli::wav::Findings;

/// What there is to say at the end.
pub(super) struct Summary<'a> {
    pub arguments: &'a SceneArgs,
    pub scene: &'a Scene,
    pub simulation: &'a Simulation,
    pub seen: Seen,
    pub sound: Option<Findings>,
    /// Rows and bytes.
    pub trace_size: Option<(u64, u64)>,
    /// Time taken, s.
    pub elapsed: f64,
}

impl Summary<'_> {
    /// Prints a few lines, on standard output unless that carries a result.
    pub fn print(&self) {
        let results = [&self.arguments.wav, &self.arguments.trace, &self.arguments.figure];
        let text = self.lines().join("\n") + "\n";
        // A closed output is no reason to fail.
        if results.into_iter().flatten().any(|path| is_standard_output(path)) {
            io::stderr().write_all(text.as_bytes()).ok();
        } else {
            io::stdout().write_all(text.as_bytes()).ok();
        }
    }

    fn lines(&self) -> Vec<String> {
        let strings = (1..).zip(self.simulation.strings());
        let mut lines: Vec<_> = strings
            .map(|(number, string)| {
                let (grid, fingers) = (&string.model.grid, string.fingers().count());
                let (intervals, spacing) = (grid.intervals, grid.spacing * 1e3);
                let contacts = string.model.contacts.len();
                format!("string {number}: N = {intervals}, h = {spacing:.3} mm, contacts {contacts}, fingers {fingers}")
            })
            .collect();
        let (samples, rate) = (self.simulation.samples(), self.scene.sample_rate);
        let (seconds, elapsed) = (samples as f64 / rate, self.elapsed);
        lines.push(format!(
            "time: {samples} samples at {rate} Hz, {seconds:.4} s, computed in {elapsed:.2} s"
        ));
        lines.extend(self.contact());
        lines.push(self.energy());
        lines.extend(self.files());
        lines
    }

    fn contact(&self) -> Option<String> {
        let Seen { penetration, iterations, most_iterations, contacts, .. } = self.seen;
        let mean = iterations as f64 / self.simulation.samples() as f64;
        (contacts > 0).then(|| {
            format!(
                "contact: at most {contacts} at once, penetration at most {penetration:.2e} m, {mean:.2} iterations a \
                 sample, at most {most_iterations}"
            )
        })
    }

    fn energy(&self) -> String {
        let accounts: Vec<_> = self.simulation.accounts().collect();
        if accounts.is_empty() {
            return "energy: not measured (with --trace or --figure it is)".into();
        }
        let most = |of: fn(&Account) -> f64| accounts.iter().map(|account| of(account)).fold(0.0, f64::max);
        let (largest, worst) = (most(|account| account.largest), most(|account| account.worst_residual));
        let place = if self.simulation.has_body() { "a string or the body" } else { "a string" };
        format!(
            "energy: at most {largest:.3e} J in {place}; the balance is open in a sample by at most {worst:.1e} of the \
             largest so far, {}",
            in_all(&accounts)
        )
    }

    fn files(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if let (Some(path), Some(sound)) = (&self.arguments.wav, self.sound) {
            let (path, peak) = (shown(path), size(sound.peak));
            lines.push(match self.scene.output.position {
                ListeningPoint::Bridge => format!("{path}: force on the bridge, at most {peak} N"),
                ListeningPoint::At(place) => format!("{path}: velocity at {place} m, at most {peak} m/s"),
                ListeningPoint::Air => format!("{path}: sound pressure before the body, at most {peak} Pa"),
            });
        }
        if let (Some(path), Some((rows, bytes))) = (&self.arguments.trace, self.trace_size) {
            lines.push(format!("{}: {rows} rows, {:.1} MB", shown(path), bytes as f64 / 1e6));
        }
        lines.extend(self.arguments.figure.iter().map(|path| format!("{}: a picture", shown(path))));
        lines
    }
}

/// A size with four digits after the point, or with its exponent where these would hide it.
fn size(size: f32) -> String {
    if size == 0.0 || size >= 0.001 { format!("{size:.4}") } else { format!("{size:.3e}") }
}

/// How far the ledgers are open in all at the end, where it is most, and what of.
fn in_all(accounts: &[&Account]) -> String {
    let Some(worst) = accounts.iter().max_by(|a, b| open_part(a).total_cmp(&open_part(b))) else {
        return String::new();
    };
    let (part, put_in, largest) = (open_part(worst), worst.put_in_gross, worst.largest);
    let whole = if put_in > largest {
        format!("the {put_in:.3e} J put in")
    } else {
        format!("the largest energy, {largest:.3e} J")
    };
    format!("and in all at the end by {part:.1e} of {whole}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_size_is_not_shown_as_none() {
        for (number, expected) in [
            (0.0, "0.0000"),
            (0.001, "0.0010"),
            (12.345_67, "12.3457"),
            (4.2e-5, "4.200e-5"),
            (f32::NAN, "NaN"),
        ] {
            assert_eq!(size(number), expected);
        }
    }
}
