//! Low Action, as it is played: notes become gestures, gestures become sound.
//!
//! ```text
//! MIDI file ─> midi_file ────┐                                                    ┌─> cli (files)
//! host ─> plugin (events) ───┼─> engine: performance ─gestures─> dsp::Instrument ─┼─> plugin (CLAP, VST3)
//! editor (mouse, keys) ──────┘      ^                                             └─> standalone (devices)
//! params ─> plugin/order ───────────┴─ controls at once; set-ups compiled by plugin/workshop, then handed over
//! ```
//!
//! - [`performance`] is the player: on which string and fret a note is played, and what the fingers do for it.
//! - [`engine`] is a player with an instrument: what commands, plugins and the stand-alone program all play.
//! - [`params`] are the knobs, [`controls`] what of them needs no other coefficients.
//! - [`plugin`] is what hosts see, [`cli`] the commands, [`setups`] users' own files; the editor draws what [`display`] is told.
//!
//! | to add or change | where, in `plugin/src` unless it says otherwise |
//! |---|---|
//! | what a note, pedal or controller does | `performance`: `controller.rs` (numbers), `channel.rs`, `articulation.rs` (controllers), `control.rs` (what they ask of strings), `chord.rs` (who plays what), `right_hand` (strokes, palm, thumb), `technique` (constants), `string/` (a note's life on its string), `fingers/` (what fingers and hands do for it); `docs/gestures.md` |
//! | a parameter | `params.rs`, its range in `params/ranges.rs`, its words in `params/words.rs`, where nothing comes of it `params/idle.rs`, what it asks for in `plugin/order.rs`, what that does in `controls.rs`, its knob in `editor/panels`; `docs/plugin.md` |
//! | a set-up that comes with the program | `dsp/instruments/presets` and `dsp/src/preset.rs`, a phrase in `plugin/examples/compose_music`; `docs/formats.md` |
//! | what labels say of notes | `performance/annotation.rs`, put into words in `cli/render/labels`; `docs/formats.md` |
//! | a command or an option | `cli/arguments.rs`, then the command's own file |
//! | an array of traces | `cli/trace/plan.rs` and `cli/trace.rs` (what fills it), of the energy balance `cli/trace/booked.rs`, the help in `cli/arguments.rs`; `docs/formats.md` |
//! | a format of files that are written | a file of its own as `cli/wav.rs` and `cli/npz.rs`, `cli/endings.rs` (what such files are called), then `cli/scene/outputs.rs` or `cli/render/files.rs`; `docs/formats.md` |
//! | a control of the editor | `editor/panels`; `docs/editor.md` |

pub mod cli;
pub mod controls;
pub mod demo;
pub mod display;
#[cfg(feature = "editor")]
pub mod editor;
pub mod engine;
mod files;
mod locked;
pub mod midi_file;
pub mod params;
pub mod performance;
mod pitch_wheel;
pub mod plugin;
pub mod pointer;
pub mod setups;
#[cfg(feature = "standalone")]
pub mod standalone;
