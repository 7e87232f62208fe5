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
    /// The note of a key ends however often that went down and whatever the pedals say, as a host has it that chokes it.
    NoteEnd {
        /// Channel, 0 to 15.
        channel: u8,
        /// Key, 0 to 127.
        key: u8,
    },
    /// All keys of a channel go up, however often each went down, as a host has it; pedals go on holding. In MPE, too, it is that
    /// channel's alone.
    KeysOff {
        /// Channel, 0 to 15.
        channel: u8,
    },
    /// A controller moves.
    Controller {
        /// Channel, 0 to 15.
        channel: u8,
        /// Which one, 0 to 127: 1 vibrato, 2 and 11 force, 5 time of slides, 20 palm, 21 time of strums, 22
        /// stroke, 23 way of stopping, 24 accent of strums, 25 tremolo, 26 capo, 27 keyswitches, 28 place of the hand,
        /// 64 sustain, 65 slides, 66 sostenuto, 68 legato, 74 place of the pluck; 6 and 38 with 100 and 101 set the bend
        /// range or announce MPE; 120, 121 and 123 to 127 stop sound, reset or let go of keys; others are
        /// ignored.
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
    /// A channel's keys are pressed harder.
    ChannelPressure {
        /// Channel, 0 to 15.
        channel: u8,
        /// How hard, 0 to 1.
        pressure: f32,
    },
    /// Something about one note.
    Note {
        /// Channel, 0 to 15.
        channel: u8,
        /// Key, 0 to 127.
        key: u8,
        /// What.
        expression: Expression,
    },
    /// Something about all notes there are of a channel and a key.
    Notes {
        /// Channel, 0 to 15; `None` is any.
        channel: Option<u8>,
        /// Key, 0 to 127; `None` is any.
        key: Option<u8>,
        /// What.
        expression: Expression,
    },
    /// Somebody who sees a string does something to it, without a key: no pedal holds that, and no note-off ends it. The string
    /// stays bent by the wheel of its last note's channel, and one that has had no note by none.
    Touched {
        /// Which string, 0 for the first of the set-up; others are ignored.
        string: u8,
        /// What is done.
        deed: StringDeed,
    },
    /// Everything stops, on every channel, whatever the pedals say.
    AllNotesOff,
}

impl PlayerEvent {
    /// The channel it belongs to, 0 to 15, unless it is for all.
    pub fn channel(&self) -> Option<u8> {
        match *self {
            Self::NoteOn { channel, .. }
            | Self::NoteOff { channel, .. }
            | Self::NoteEnd { channel, .. }
            | Self::KeysOff { channel }
            | Self::Controller { channel, .. }
            | Self::PitchBend { channel, .. }
            | Self::ChannelPressure { channel, .. }
            | Self::Note { channel, .. } => Some(channel),
            Self::Notes { channel, .. } => channel,
            Self::Touched { .. } | Self::AllNotesOff => None,
        }
    }
}

/// What can be done to a string in sight. Places are m from the nut; what is not on the string counts as near its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StringDeed {
    /// It is plucked.
    Pluck {
        /// Where.
        position: f32,
        /// How hard, N, up is positive; up to 50 either way.
        force: f32,
    },
    /// A finger comes down on it, or slides there if it is down.
    Press {
        /// Where.
        position: f32,
    },
    /// The finger leaves.
    Lift,
    /// It is silenced.
    Damp,
}

/// What a note can have for itself. What concerns its pluck counts if it comes after its note-on and before its pluck: at the
/// note's own sample, or while it waits for a string. What comes before the note-on, at its own sample, too, is for an earlier note
/// of its key. A note that sounds no more, but whose key is down under another one, has it when it comes back. What is no
/// finite number says nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expression {
    /// Its tuning, semitones.
    Tuning(f32),
    /// How hard its key is pressed, 0 to 1.
    Pressure(f32),
    /// Where it is plucked: 1 near the saddle, 0.5 the usual place, 0 far from it.
    Brightness(f32),
    /// Depth of its vibrato, 0 to 1.
    Vibrato(f32),
    /// Moves its pluck away from the saddle, m.
    PluckPlace(f32),
    /// Factor of its pluck's force.
    PluckForce(f32),
    /// Another one, as a player expresses it.
    Swell(f32),
    /// Another one, as hosts have it that give each note a volume: 1 is the usual one, 4 the loudest.
    Gain(f32),
    /// Factor of its finger's force, beside what pressure makes of that.
    FingerForce(f32),
}

impl Expression {
    /// How much, in its own unit.
    pub(super) fn amount(self) -> f32 {
        match self {
            Self::Tuning(amount)
            | Self::Pressure(amount)
            | Self::Brightness(amount)
            | Self::Vibrato(amount)
            | Self::PluckPlace(amount)
            | Self::PluckForce(amount)
            | Self::Swell(amount)
            | Self::Gain(amount)
            | Self::FingerForce(amount) => amount,
        }
    }
}
