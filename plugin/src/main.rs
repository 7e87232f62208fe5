//! The command line of Low Action.
fn main() {}
