//! What a player is told to do, in the words of a keyboard.

/// A musical event, free of any host's or file's types. Channels count from 0 to 15; events of
/// other channels are ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlayerEvent {
    /// A key goes down.
    NoteOn {
        /// Channel, 0 to 15.
        channel: u8,
        /// Key, 0 to 127; 60 is middle C.
        key: u8,
        /// How hard, 0 to 1; 0 or less lifts the key, as MIDI has it.
        velocity: f32,
    },
    /// A key goes up.
    NoteOff {
        /// Channel, 0 to 15.
        channel: u8,
        /// Key, 0 to 127.
        key: u8,
    },
    /// A controller moves.
    Controller {
        /// Channel, 0 to 15.
        channel: u8,
        /// Which one, 0 to 127: 6 and 38 with 100 and 101 set the bend range, 64 is the sustain
        /// pedal, 120, 121 and 123 to 127 stop sound, reset or let go of keys; others are ignored.
        number: u8,
        /// Its value, 0 to 1 for 0 to 127.
        value: f32,
    },
    /// The pitch wheel moves.
    PitchBend {
        /// Channel, 0 to 15.
        channel: u8,
        /// Where to, −1 to 1.
        value: f32,
    },
    /// Everything stops, on every channel, whatever the pedals say.
    AllNotesOff,
}
