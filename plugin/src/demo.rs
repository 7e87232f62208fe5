//! The piece that `low-action render` plays when no song is named.

/// A MIDI file, written by `cargo run -p low-action --example compose_demo`.
pub const MIDI: &[u8] = include_bytes!("demo/demo.mid");
