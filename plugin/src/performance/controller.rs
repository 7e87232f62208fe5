//! Numbers of the controllers that are acted on, and of what kind they are.

/// Depth of the vibrato.
pub const VIBRATO: u8 = 1;
/// Breath, a factor of the force of plucks.
pub const BREATH: u8 = 2;
/// How long slides take.
pub const SLIDE_TIME: u8 = 5;
/// Data entry, upper half.
pub const DATA_ENTRY: u8 = 6;
/// Volume, which is passed over.
pub const VOLUME: u8 = 7;
/// Pan, which is passed over.
pub const PAN: u8 = 10;
/// Expression, another factor of the force of plucks.
pub const EXPRESSION: u8 = 11;
/// How hard the palm rests on the strings; the first of those that tell hands what to do.
pub const PALM: u8 = 20;
/// How long the hand takes over the strings of a chord.
pub const STRUM: u8 = 21;
/// What the right hand does.
pub const STROKE: u8 = 22;
/// How the left hand stops a string.
pub const STOP: u8 = 23;
/// How much harder a strum grows on its way.
pub const ACCENT: u8 = 24;
/// Strokes of a tremolo.
pub const TREMOLO: u8 = 25;
/// Fret of the capo.
pub const CAPO: u8 = 26;
/// First of the keyswitches.
pub const SWITCHES: u8 = 27;
/// Where on the neck the left hand plays; the last of those that tell hands what to do.
pub const HAND: u8 = 28;
/// Data entry, lower half.
pub const DATA_ENTRY_LOWER: u8 = 38;
/// The sustain pedal.
pub const PEDAL: u8 = 64;
/// Connected notes slide.
pub const SLIDE: u8 = 65;
/// The sostenuto pedal.
pub const SOSTENUTO: u8 = 66;
/// Overlapping notes are connected.
pub const LEGATO: u8 = 68;
/// Where plucks are, from dull to bright.
pub const BRIGHTNESS: u8 = 74;
/// Lower and upper half of the number of a parameter that is not registered, which takes data entry away from those that are.
pub const OTHER_PARAMETER: [u8; 2] = [98, 99];
/// Lower half of the number of a registered parameter.
pub const PARAMETER_LOWER: u8 = 100;
/// Upper half of it.
pub const PARAMETER_UPPER: u8 = 101;
/// Silences everything; the first of the messages that stop everything or put it back.
pub const SILENCE: u8 = 120;
/// Puts everything back.
pub const RESET: u8 = 121;
/// All notes off; the first of those that let go of all keys, as the four mode messages imply it, too.
pub const KEYS_OFF: u8 = 123;
/// The last of these.
pub const LAST: u8 = 127;

/// Whether it tells hands what to do, which a keyboard's knobs may not mean.
pub(crate) fn is_of_hands(number: u8) -> bool {
    (PALM..=HAND).contains(&number)
}

/// Whether it is part of setting a registered parameter, or takes data entry away from those.
pub(crate) fn is_of_parameters(number: u8) -> bool {
    matches!(number, DATA_ENTRY | DATA_ENTRY_LOWER | PARAMETER_LOWER | PARAMETER_UPPER)
        || OTHER_PARAMETER.contains(&number)
}

/// Whether it changes something that belongs to no channel; where notes have channels of their own, one of them that is reset
/// does not.
pub(crate) fn is_of_all(number: u8, mpe: bool) -> bool {
    matches!(number, CAPO | SWITCHES | HAND) || (number == RESET && !mpe)
}

/// Whether it makes of keys that are down what it does not make of those that have gone up.
pub(crate) fn keeps_or_ends(number: u8) -> bool {
    matches!(number, PEDAL | SOSTENUTO) || number >= SILENCE
}

/// Whether it makes of notes that have begun, or of what channels mean, what it does not make of those to come.
pub(crate) fn is_of_begun(number: u8) -> bool {
    matches!(number, DATA_ENTRY | DATA_ENTRY_LOWER | SOSTENUTO) || number >= SILENCE
}
