//! The chores of the repository, run as `cargo xtask COMMAND`.
//!
//! Each command is one entry of [`COMMANDS`]; a command that outgrows a few lines gets a module.

mod figures;
mod hosts;

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
    /// Does it.
    run: fn(Arguments) -> Result<()>,
}

/// Everything `cargo xtask` can do, in the order of the help text.
const COMMANDS: &[Command] = &[
    Command {
        name: "bundle",
        arguments: "low-action [--release] [cargo build options]",
        summary: "builds the plugin and lays out target/bundled/Low Action.clap and Low Action.vst3",
        run: |arguments| bundle("bundle", arguments),
    },
    Command {
        name: "bundle-universal",
        arguments: "low-action [--release]",
        summary: "the same for both processors of macOS in one binary (on macOS only)",
        run: |arguments| bundle("bundle-universal", arguments),
    },
    Command {
        name: "figures",
        arguments: "[--quick] [NAME ...]",
        summary: "draws the pictures of the documentation, or those named, and writes docs/paper.md; \
                  with --quick compares them with what is there",
        run: |arguments| figures::run(&arguments),
    },
    Command {
        name: "hosts",
        arguments: "[dawdreamer] [pedalboard]",
        summary: "bundles the plugin and compares what hosts play through it with what is rendered",
        run: |names| hosts::run(&names),
    },
    Command {
        name: "measure",
        arguments: "NAME [ARGUMENTS]",
        summary: "measures what the documentation states; `measure help` lists what there is",
        run: xtask::measure::run,
    },
];

/// Hands a bundling command to the plugin framework, which reads `bundler.toml`.
fn bundle(name: &str, arguments: Arguments) -> Result<()> {
    nice_plug_xtask::main_with_args("cargo xtask", std::iter::once(name.to_owned()).chain(arguments))
}

/// The list of commands, one line each.
fn help() -> String {
    let mut text = String::from("usage: cargo xtask COMMAND [ARGUMENTS]\n\ncommands:\n");
    for command in COMMANDS {
        text += &format!("  {} {}\n      {}\n", command.name, command.arguments, command.summary);
    }
    text
}

/// Finds the command and runs it.
fn run(mut arguments: impl Iterator<Item = String>) -> Result<()> {
    let Some(name) = arguments.next() else { bail!("no command given\n\n{}", help()) };
    if matches!(name.as_str(), "help" | "-h" | "--help") {
        print!("{}", help());
        return Ok(());
    }
    match COMMANDS.iter().find(|command| command.name == name) {
        Some(command) => (command.run)(arguments.collect()),
        None => bail!("unknown command `{name}`\n\n{}", help()),
    }
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
}
