//! The chores of the repository, run as `cargo xtask COMMAND`.
//!
//! Each command is one entry of [`COMMANDS`]; a command that outgrows a few lines gets a module.

mod bundles;
mod figures;
mod hosts;
mod notices;

use std::process::ExitCode;

use anyhow::{Result, bail};

/// Arguments that follow the command's name.
type Arguments = Vec<String>;

/// One chore.
struct Command {
    /// The word that selects it.
    name: &'static str,
    /// How its arguments are written, for the help text.
    arguments: &'static str,
    /// What it does, in one line.
    summary: &'static str,
    /// How it is called, for the help of its own; none where it says more by itself.
    examples: &'static [&'static str],
    /// What its arguments may be, where that is a list of names.
    names: fn() -> Vec<&'static str>,
    /// Does it.
    run: fn(Arguments) -> Result<()>,
}

impl Command {
    /// The help of this command.
    fn usage(&self) -> String {
        let Self { name, arguments, summary, examples, .. } = self;
        let mut text = format!("usage: cargo xtask {name} {arguments}\n\n{summary}\n\nexamples:\n");
        for example in *examples {
            let line = format!("  cargo xtask {name} {example}");
            text += line.trim_end();
            text.push('\n');
        }
        let names = (self.names)();
        if !names.is_empty() {
            text += &format!("\nnames:\n  {}\n", names.join("\n  "));
        }
        text
    }

    /// Whether it is asked for its help, and has one to be printed here.
    fn is_asked_for_help(&self, arguments: &[String]) -> bool {
        !self.examples.is_empty() && arguments.iter().any(|word| matches!(word.as_str(), "-h" | "--help"))
    }
}

/// Everything `cargo xtask` can do, in the order of the help text.
const COMMANDS: &[Command] = &[
    Command {
        name: "bundle",
        arguments: "low-action [--release] [cargo build options]",
        summary: "builds the plugin and lays out target/bundled/Low Action.clap and Low Action.vst3, with the notices of \
                  the libraries in them",
        examples: &["low-action --release", "low-action --release --no-default-features"],
        names: Vec::new,
        run: |arguments| bundles::make("bundle", &arguments),
    },
    Command {
        name: "bundle-universal",
        arguments: "low-action [--release]",
        summary: "bundles for both processors of macOS in one binary (on macOS only)",
        examples: &["low-action --release"],
        names: Vec::new,
        run: |arguments| bundles::make("bundle-universal", &arguments),
    },
    Command {
        name: "figures",
        arguments: "[--quick] [NAME ...]",
        summary: "draws the pictures of the documentation but trade.svg (which `measure trade` draws), or those named, and writes \
                  docs/paper.md; with --quick compares them with what is there",
        examples: &["--quick", "paper_figure_2 paper_figure_3"],
        names: figures::names,
        run: |arguments| figures::run(&arguments),
    },
    Command {
        name: "hosts",
        arguments: "[dawdreamer] [pedalboard]",
        summary: "bundles the plugin and compares what hosts play through it with what is rendered",
        examples: &["", "pedalboard"],
        names: Vec::new,
        run: |names| hosts::run(&names),
    },
    Command {
        name: "measure",
        arguments: "NAME [ARGUMENTS]",
        summary: "measures what the documentation states; `measure help` lists what there is",
        examples: &[],
        names: Vec::new,
        run: xtask::measure::run,
    },
    Command {
        name: "notices",
        arguments: "[cargo features] FILE",
        summary: "writes the licences of all libraries that are linked into the plugin, or with the feature `standalone` into \
                  the stand-alone program, to a file to be handed on with it",
        examples: &["--features standalone THIRD-PARTY.txt"],
        names: Vec::new,
        run: |arguments| bundles::write_notices(&arguments),
    },
];

/// The list of commands, one line each.
fn help() -> String {
    let mut text = String::from("usage: cargo xtask COMMAND [ARGUMENTS]\n\ncommands:\n");
    for command in COMMANDS {
        text += &format!("  {} {}\n      {}\n", command.name, command.arguments, command.summary);
    }
    text + "\nexamples:\n  cargo xtask figures --quick\n  cargo xtask measure features --quick\n"
}

/// Finds the command and runs it.
fn run(mut arguments: impl Iterator<Item = String>) -> Result<()> {
    let Some(name) = arguments.next() else { bail!("no command given\n\n{}", help()) };
    if matches!(name.as_str(), "help" | "-h" | "--help") {
        print!("{}", help());
        return Ok(());
    }
    let Some(command) = COMMANDS.iter().find(|command| command.name == name) else {
        bail!("unknown command `{name}`\n\n{}", help());
    };
    let arguments: Arguments = arguments.collect();
    if command.is_asked_for_help(&arguments) {
        print!("{}", command.usage());
        return Ok(());
    }
    (command.run)(arguments)
}

fn main() -> ExitCode {
    match run(std::env::args().skip(1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{COMMANDS, run};

    fn words(line: &str) -> impl Iterator<Item = String> {
        line.split_whitespace().map(str::to_owned).collect::<Vec<_>>().into_iter()
    }

    #[test]
    fn unknown_commands_are_answered_with_the_list() {
        let message = run(words("bunble low-action")).expect_err("not a command").to_string();
        assert!(message.starts_with("unknown command `bunble`"), "{message}");
        for command in COMMANDS {
            assert!(message.contains(command.name), "{message}");
        }
        assert!(run(words("")).is_err());
        assert!(run(words("help")).is_ok());
    }

    #[test]
    fn every_command_has_a_help_of_its_own() {
        for command in COMMANDS {
            for word in ["--help", "-h"] {
                assert!(run(words(&format!("{} {word}", command.name))).is_ok(), "{} {word}", command.name);
            }
            let usage = command.usage();
            assert!(usage.starts_with(&format!("usage: cargo xtask {} ", command.name)), "{usage}");
            assert!(usage.contains(command.summary), "{usage}");
        }
        let figures = COMMANDS.iter().find(|command| command.name == "figures").expect("there are figures");
        assert!(figures.usage().contains("\n  paper_figure_5_minute\n"), "{}", figures.usage());
        // Wherever it stands, and nothing is built.
        assert!(run(words("bundle low-action --release --help")).is_ok());
    }
}
