//! The command line of Low Action, and its stand-alone instrument.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(low_action::cli::run(std::env::args_os()))
}
