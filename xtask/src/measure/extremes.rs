//! Nothing blows up: random scenes and event streams that are absurd but legal, every one held to three
//! promises. Its numbers are finite; its energy is never above what was put in; its balance closes.
//!
//! A [`Trial`] is a scene and perhaps a stream of events, or playing on instruments that are exchanged, drawn from a seed and a
//! number. A run of many is tallied; what fails is made small and written where the tests replay it.

mod balance;
mod beginnings;
mod bodies;
mod campaign;
mod draw;
#[cfg(test)]
mod drawn;
mod exchanges;
mod playing;
mod progress;
mod scenes;
mod setups;
mod shrink;
mod stream;
mod tally;
mod trial;

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Parser;

use super::page;
use crate::repository::root;
pub use balance::TOLERANCE;
use campaign::Campaign;
use tally::Tally;
pub use trial::{Fault, Outcome, Record, Trial};

/// Draws absurd but legal scenes and event streams and holds each to its promises: always finite, energy never
/// above what was put in, the balance closes.
#[derive(Debug, Parser)]
#[command(
    name = "cargo xtask measure extremes",
    after_help = "Examples:\n  \
        cargo xtask measure extremes          the run of docs/stability.md\n  \
        cargo xtask measure extremes --quick  its beginning, compared with that\n  \
        cargo xtask measure extremes --seed 7 --trials 20000\n  \
        cargo xtask measure extremes --replay tests/regressions/extremes/NAME.toml\n\n\
        A run that was stopped goes on where it was when it is started again. Trials\n\
        that fail are made small and written to tests/regressions/extremes/open; once\n\
        mended they belong one folder up, where\n  \
        cargo test --workspace --test physics extremes\nreplays them."
)]
struct Arguments {
    /// Trials to draw
    #[arg(long, default_value_t = TRIALS, value_parser = clap::value_parser!(u64).range(1..))]
    trials: u64,
    /// Trials of instruments and necks exchanged under ringing strings
    #[arg(long, default_value_t = EXCHANGES)]
    exchanges: u64,
    /// Where the random numbers begin
    #[arg(long, default_value_t = SEED)]
    seed: u64,
    /// Threads at work [default: as many as the machine has]
    #[arg(long)]
    threads: Option<NonZeroUsize>,
    /// Seconds of hard playing, over all built-in instruments
    #[arg(long, default_value_t = PLAYING, value_parser = seconds)]
    playing: f64,
    /// The first trials and a little playing; compared with the page
    #[arg(long, conflicts_with_all = ["trials", "exchanges", "seed", "playing", "fresh"])]
    quick: bool,
    /// Write the tables into docs/stability.md
    #[arg(long)]
    write: bool,
    /// Begin anew even if there is something to go on with
    #[arg(long)]
    fresh: bool,
    /// Run one trial from its file and say what it comes to
    #[arg(long, conflicts_with_all = ["trials", "exchanges", "seed", "threads", "playing", "quick", "write", "fresh"])]
    replay: Option<PathBuf>,
}

/// The run whose tables are on the page: trials, those of exchanges, where random numbers begin, and seconds of playing.
const TRIALS: u64 = 100_000;
const EXCHANGES: u64 = 3000;
const SEED: u64 = 1;
const PLAYING: f64 = 600.0;

/// Reads a number of seconds.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "must be a number of seconds".to_owned())?;
    if (0.0..=1e6).contains(&seconds) { Ok(seconds) } else { Err("must be 0 to 1e6 seconds".into()) }
}

impl Arguments {
    /// Refuses to write another run's tables than the page has.
    fn check(&self) -> Result<()> {
        if !self.write {
            return Ok(());
        }
        for (name, value, wanted) in [
            ("--trials", self.trials as f64, TRIALS as f64),
            ("--exchanges", self.exchanges as f64, EXCHANGES as f64),
            ("--seed", self.seed as f64, SEED as f64),
            ("--playing", self.playing, PLAYING),
        ] {
            ensure!(value == wanted, "{name} {value} with --write: {PAGE} has the run with {wanted}");
        }
        Ok(())
    }
}

/// Where the tables stand.
const PAGE: &str = "docs/stability.md";
/// Trials, those of exchanges, and seconds of playing of `--quick`.
const QUICK: (u64, u64, f64) = (1000, 30, 8.0);

/// Runs the measurement.
///
/// # Errors
/// When a promise is broken, the tables are not those of the documentation, or a file cannot be written.
pub fn run(arguments: Vec<String>) -> Result<()> {
    let Some(arguments) = super::parse::<Arguments>(arguments)? else { return Ok(()) };
    if let Some(file) = &arguments.replay {
        return replay(file);
    }
    arguments.check()?;
    let section = if arguments.quick { "quick" } else { "full" };
    page::read(PAGE, &marks(section))?;
    let root = root();
    let (trials, exchanges, playing) =
        if arguments.quick { QUICK } else { (arguments.trials, arguments.exchanges, arguments.playing) };
    let seed = if arguments.quick { SEED } else { arguments.seed };
    let threads = arguments.threads.or_else(|| std::thread::available_parallelism().ok());
    println!("{trials} trials and {exchanges} of exchanges from seed {seed}, {playing} s of hard playing");
    let campaign = Campaign {
        name: "trials",
        draw: Trial::random,
        seed,
        trials,
        threads: threads.map_or(1, Into::into),
        kept: (!arguments.quick).then(|| root.join("target/extremes")),
        fresh: arguments.fresh,
        failures: root.join("tests/regressions/extremes/open"),
    };
    let tally = tallied(&campaign)?;
    let tables = tally.tables();
    println!("{tables}");
    let of_exchanges =
        Campaign { name: "exchanges", draw: Trial::of_exchanges, trials: exchanges, ..campaign.clone() };
    let exchanged = tallied(&of_exchanges)?;
    println!("{exchanges} trials of exchanges: {}", exchanged.exchanges_in_words());
    playing::play_all(seed, playing, campaign.threads)?;
    // Before anything is written or compared: no page may make a broken promise the usual.
    refuse_faults(tally.faults.len() + exchanged.faults.len())?;
    if arguments.write {
        write_section(PAGE, section, &tables)?;
    } else if arguments.quick {
        compare_section(PAGE, section, &tables)?;
    }
    Ok(())
}

/// Runs a campaign, and says what broke a promise in it.
fn tallied(campaign: &Campaign) -> Result<Tally> {
    let tally = campaign.run()?;
    for (number, fault) in &tally.faults {
        println!("{number} of the {}: {fault}", campaign.name);
    }
    Ok(tally)
}

/// Runs one trial and says what it comes to.
///
/// # Errors
/// When it cannot be read, or breaks a promise.
fn replay(file: &Path) -> Result<()> {
    let text = std::fs::read_to_string(file).with_context(|| format!("{}", file.display()))?;
    let outcome = Trial::from_toml(&text)?.run();
    println!("{outcome:#?}");
    if let Outcome::Computed(Record { fault: Some(fault), .. }) = outcome {
        bail!("{}: {fault}", file.display());
    }
    Ok(())
}

/// Refuses a run in which so many trials broke a promise.
fn refuse_faults(count: usize) -> Result<()> {
    ensure!(count == 0, "{count} trials broke a promise; they are in tests/regressions/extremes/open");
    Ok(())
}

/// The lines between which a section's tables stand on the page.
fn marks(section: &str) -> [String; 2] {
    [format!("<!-- extremes {section} -->"), format!("<!-- end of extremes {section} -->")]
}

fn write_section(page: &str, section: &str, tables: &str) -> Result<()> {
    page::write(page, &marks(section), &format!("\n{tables}\n"))
}

fn compare_section(page: &str, section: &str, tables: &str) -> Result<()> {
    if page::read(page, &marks(section))?.trim() != tables.trim() {
        bail!("the tables differ from those in {page}; --write puts them there");
    }
    println!("as in {page}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{compare_section, run, write_section};

    #[test]
    fn arguments_are_explained_and_refused_in_words() {
        assert!(run(vec!["--help".into()]).is_ok());
        let message = run(vec!["--sead".into(), "3".into()]).expect_err("not an argument").to_string();
        assert!(message.contains("--sead"), "{message}");
    }

    #[test]
    fn arguments_that_would_do_nothing_or_harm_are_refused() {
        let refused = |line: &str| {
            let words = line.split_whitespace().map(str::to_owned).collect();
            run(words).expect_err(line).to_string()
        };
        for line in ["--trials 2", "--exchanges 2", "--seed 2", "--playing 2", "--fresh"] {
            let name = line.split(' ').next().expect("it has a name");
            assert!(refused(&format!("--quick {line}")).contains(name), "{line}");
            assert!(refused(&format!("--replay file {line}")).contains(name), "{line}");
        }
        for line in ["--trials 2", "--exchanges 2", "--seed 2", "--playing 2"] {
            let message = refused(&format!("--write {line}"));
            assert!(message.starts_with(line) && message.contains("docs/stability.md"), "{message}");
        }
        for (line, range) in [
            ("--playing nan", "0 to 1e6"),
            ("--playing=-1", "0 to 1e6"),
            ("--playing x", "a number of seconds"),
            ("--trials 0", "1.."),
            ("--threads 0", "non-zero"),
        ] {
            let message = refused(line);
            let value = line.rsplit([' ', '=']).next().expect("it has a value");
            assert!(message.contains(value) && message.contains(range), "{line}: {message}");
        }
    }

    #[test]
    fn a_trial_that_fails_is_an_error() {
        let file = std::env::temp_dir().join(format!("low-action-trial-{}.toml", std::process::id()));
        let replay = |text: &str| {
            std::fs::write(&file, text).expect("it can be written");
            run(vec!["--replay".into(), file.to_str().expect("it is text").into()])
        };
        // What is refused has kept every promise.
        replay("sample_rate = -1").expect("it is refused");
        assert!(replay("sample_rate = ").is_err());
        std::fs::remove_file(&file).expect("it is there");
    }

    #[test]
    fn tables_are_written_and_compared_between_their_marks() {
        let file = std::env::temp_dir().join(format!("low-action-page-{}.md", std::process::id()));
        let place = file.to_str().expect("it is text");
        let page = "a\n<!-- extremes quick -->\nold\n<!-- end of extremes quick -->\nb\n";
        std::fs::write(&file, page).expect("it can be written");
        assert!(compare_section(place, "quick", "new").is_err());
        write_section(place, "quick", "new\n").expect("it has a place");
        compare_section(place, "quick", "new").expect("it is there");
        assert!(write_section(place, "full", "new").is_err());
        let text = std::fs::read_to_string(&file).expect("it is there");
        assert!(text.starts_with("a\n") && text.ends_with("\nb\n"), "{text}");
        std::fs::remove_file(&file).expect("it is there");
    }
}
