//! Instruments, and the set-ups they are built from: each file is a promise.

mod body;
mod body_evenness;
mod display;
mod effort;
mod full_queues;
mod handover;
mod handover_any;
mod handover_books;
mod handover_pressed;
mod impossible_gestures;
mod level;
mod low_rates;
mod no_allocation;
mod presets;
mod pressed;
mod same_bits;
mod sample_rates;
mod setups;
mod silence;
mod stilling;
mod string_rates;
mod sympathy;
mod tension_room;
mod threads;
mod timed_chord;
mod tuning;
