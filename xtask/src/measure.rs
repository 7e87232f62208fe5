//! `cargo xtask measure NAME`: measurements whose results stand in the documentation.
//!
//! Each is one entry of `MEASUREMENTS` and one module; it reads its own arguments.

// Its place is with the benchmarks, whose workload it is.
#[path = "../../dsp/benches/workloads/chord.rs"]
pub mod chord;
pub mod extremes;
pub mod features;
mod page;
pub mod speed;
mod threads;
pub mod trade;

use anyhow::{Result, bail};
use clap::Parser;

/// One measurement.
struct Measurement {
    /// The word that selects it.
    name: &'static str,
    /// What it measures, in one line.
    summary: &'static str,
    /// Measures it, given the arguments after its name.
    run: fn(Vec<String>) -> Result<()>,
}

/// Everything that can be measured, in the order of the help text.
const MEASUREMENTS: &[Measurement] = &[
    Measurement {
        name: "extremes",
        summary: "random absurd scenes and event streams: nothing blows up and every balance closes",
        run: extremes::run,
    },
    Measurement {
        name: "features",
        summary: "what each element of a scene costs, in instructions and in time",
        run: features::run,
    },
    Measurement {
        name: "speed",
        summary: "how fast strings are, over a bare one, by points, strings and frets",
        run: speed::run,
    },
    Measurement {
        name: "trade",
        summary: "what rates, stencils, caps, tolerances and contact laws cost, and what they buy",
        run: trade::run,
    },
];

/// Reads a measurement's arguments; nothing where they ask for help, which is then given.
fn parse<T: Parser>(arguments: Vec<String>) -> Result<Option<T>> {
    // The first argument is what usage begins with.
    let name = T::command().get_name().to_owned();
    match T::try_parse_from(std::iter::once(name).chain(arguments)) {
        Ok(arguments) => Ok(Some(arguments)),
        Err(error) if !error.use_stderr() => {
            print!("{error}");
            Ok(None)
        }
        Err(error) => bail!("{}", error.to_string().trim_end()),
    }
}

/// The list of measurements, one line each.
fn help() -> String {
    let mut text = String::from("usage: cargo xtask measure NAME [ARGUMENTS]\n\nmeasurements:\n");
    for measurement in MEASUREMENTS {
        text += &format!("  {}\n      {}\n", measurement.name, measurement.summary);
    }
    text + "\n`cargo xtask measure NAME --help` lists the arguments of one.\n\nexamples:\n  cargo xtask measure \
            speed\n  cargo xtask measure trade --help\n"
}

/// Finds the measurement named first and runs it with the rest.
pub fn run(arguments: Vec<String>) -> Result<()> {
    let mut arguments = arguments.into_iter();
    let Some(name) = arguments.next() else { bail!("no measurement named\n\n{}", help()) };
    if matches!(name.as_str(), "help" | "-h" | "--help") {
        print!("{}", help());
        return Ok(());
    }
    match MEASUREMENTS.iter().find(|measurement| measurement.name == name) {
        Some(measurement) => (measurement.run)(arguments.collect()),
        None => bail!("unknown measurement `{name}`\n\n{}", help()),
    }
}

#[cfg(test)]
mod tests {
    use super::{MEASUREMENTS, Measurement, run};

    #[test]
    fn unknown_measurements_are_answered_with_the_list() {
        let message = run(vec!["extrems".into()]).expect_err("not a measurement").to_string();
        assert!(message.starts_with("unknown measurement `extrems`"), "{message}");
        for measurement in MEASUREMENTS {
            assert!(message.contains(measurement.name), "{message}");
        }
        assert!(run(vec![]).is_err());
        assert!(run(vec!["help".into()]).is_ok());
    }

    #[test]
    fn usage_names_the_measurement() {
        for Measurement { name, run, .. } in MEASUREMENTS {
            assert!(run(vec!["--help".into()]).is_ok());
            let message = run(vec!["--nonsense".into()]).expect_err("not an argument").to_string();
            assert!(message.contains(&format!("Usage: cargo xtask measure {name}")), "{message}");
        }
    }
}
