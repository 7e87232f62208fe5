//! The command line as a program of this package, so that tests can run it and see all it writes.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(low_action::cli::run(std::env::args_os()))
}
