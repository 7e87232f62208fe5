//! What a musician hears of each parameter: the one place from which the editor takes its explanations.

use std::collections::HashMap;

use nice_plug::params::internals::ParamPtr;
use nice_plug::prelude::{Param, Params};

use super::LowActionParams;
use crate::engine::Quality;

/// What is heard of a parameter, by its [identifier](LowActionParams). All strings' tunings share one.
const HEARD: [(&str, &str); 43] = [
    ("instrument", "The instrument: strings, neck, hands and pickup."),
    ("instrument_file", "An instrument of your own, from your folder, in place of that one."),
    (
        "quality",
        "How exactly the strings are computed while you play. More costs time and gains truth in the buzz.",
    ),
    ("render_quality", "The same where the host renders offline and time does not matter."),
    ("iterations", "Bounds the work of the hardest moment. A low number takes energy out of hard hits."),
    ("relax", "Short of time, contacts are solved less exactly instead of the sound breaking up."),
    ("action", "Height of the strings. Lower plays easily and buzzes, higher rings clean and loud."),
    ("relief", "How far the neck bows away from the strings: room for the middle of their swing."),
    ("fret_height", "Tall frets ring clean of the wood; with low ones the string touches the board."),
    ("loss_0", "How soon everything dies away. Less rings longer."),
    ("loss_1", "How soon the brightness dies away: old strings have more of it, new ones less."),
    ("tension_modulation", "A hard pluck stretches the string, and so begins sharp and settles."),
    ("pickup_position", "Near the saddle is thin and bright, near the neck round and full."),
    (
        "pickup_blend",
        "Mixes in the other pickup: the force on the bridge beside a coil, or a coil beside bridge or microphone.",
    ),
    ("tuning", "Another concert pitch: every note sounds higher or lower."),
    ("string_tuning", "Tunes this open string; keys keep their pitch and find it on other frets."),
    ("pluck_position", "Nearer to the saddle is brighter and thinner, nearer to the neck rounder."),
    ("pluck_force", "How hard the hardest pluck is. Hard plucks throw the string at the frets."),
    ("pluck_softest", "How hard the softest pluck is beside the hardest: more evens the dynamics out."),
    ("pluck_duration", "How long the string is pushed before it is let go of: a short push is a flick."),
    (
        "pluck_release",
        "A plectrum lets go at once and is bright; the longer flesh takes to slip off, the softer the tone.",
    ),
    (
        "velocity_curve",
        "How force follows velocity: low numbers are loud early, high ones late; 0 is always the hardest.",
    ),
    (
        "variation",
        "How much plucks differ from one another, as a hand's do. At 0 the hand does the same each time; the sound \
         still depends on how the string moves just then.",
    ),
    (
        "take",
        "Which of the ways in which they differ: with another number in each, two of these play a part as two people do.",
    ),
    ("finger_force", "How firmly fingers press. Too little and the note buzzes against its own fret."),
    ("finger_hardness", "Soft pads swallow the high notes, hard ones let the string rattle."),
    ("finger_mass", "A heavy finger lands with more of a thump."),
    ("finger_hover", "How high fingers hover: from higher up they strike harder and later."),
    ("hand_damping", "How much the hand swallows of what shakes the finger."),
    (
        "idle_hands",
        "How firmly hands lie on strings nobody plays, of instruments with a body: at 0 these sing along with the others.",
    ),
    (
        "input_mode",
        "What MIDI channels mean: one keyboard, a channel for each string, or a channel for each note.",
    ),
    ("bend_range", "How far a full turn of the pitch wheel bends."),
    ("tremolo_arm", "Bends all strings at once, as the arm on the bridge does."),
    ("level", "Loudness of the output. At 0 dB the samples pass untouched."),
    ("bypass", "Silences the output; the strings go on."),
    ("first_channel", "The first channel that is a string, where each channel is one."),
    ("string_order", "Whether that channel is the first string, the highest on guitars, or the last."),
    ("ignore_rpn", "Keeps the bend range as it is here, whatever the keyboard announces."),
    (
        "legato",
        "Overlapping notes on one string become hammer-ons, pull-offs and slides: while CC 68 or 65 is down, or always.",
    ),
    ("keyswitches", "The first of the keys that tell the hands how to play instead of sounding."),
    (
        "hand_position",
        "The fret about which the left hand plays what several strings could give; anywhere: it moves as little as it can.",
    ),
    (
        "hand_controllers",
        "Whether CC 20 to 28 lay palms, capos and more. Off where a keyboard's knobs send them for something else.",
    ),
    ("capo", "The fret of a capo: open strings sound from there. No farther up than leaves five frets."),
];

/// What a musician hears of the parameter with this identifier; nothing if there is none such.
pub fn heard(id: &str) -> Option<&'static str> {
    let id = if id.starts_with("string_tuning") { "string_tuning" } else { id };
    HEARD.iter().find(|(known, _)| *known == id).map(|(_, heard)| *heard)
}

/// What a musician hears of a quality: `docs/trade.md` in a few words, for a host's rate of 48 kHz. It stands under the
/// quality's [summary](Quality::summary), which has the numbers.
pub fn heard_of(quality: Quality) -> &'static str {
    match quality {
        Quality::Draft => {
            "A little less work than Live, for many tracks at once. All is as good but for the thinnest string, which \
             rings too short at the highest frets and, plucked hard, buzzes more or less than it should."
        }
        Quality::Live => {
            "To play with. Every open string and every stopped note is in tune, and buzz is about as hard and as \
             long as it should be."
        }
        Quality::Studio => {
            "For the bounce. Buzz is nearer to the truth, and the highest frets are within a cent."
        }
        Quality::Reference => {
            "The fastest computers just have time for it when six strings ring. There to compare with; one cannot hear \
             what it adds."
        }
    }
}

/// The same for each value of a parameter that chooses a quality, in order; none for other parameters.
fn of_each(id: &str) -> Vec<&'static str> {
    let qualities = Quality::ALL.map(heard_of);
    match id {
        "quality" => qualities.to_vec(),
        "render_quality" => [
            &["As exact as while you play: the same notes are the same bits, but for those that Relax when late has made rougher."],
            &qualities[..],
            &["Studio, or Quality if that is more."],
        ]
        .concat(),
        _ => Vec::new(),
    }
}

/// Tells of the parameters of one plugin.
#[derive(Debug)]
pub struct Words(HashMap<ParamPtr, (&'static str, Vec<&'static str>)>);

impl Words {
    /// Of these parameters.
    pub fn of(params: &LowActionParams) -> Self {
        let told = params
            .param_map()
            .into_iter()
            .filter_map(|(id, param, _)| Some((param, (heard(&id)?, of_each(&id)))));
        Self(told.collect())
    }

    /// What a musician hears of a parameter.
    pub fn heard(&self, param: &impl Param) -> &'static str {
        self.0.get(&param.as_ptr()).map_or("", |(heard, _)| heard)
    }

    /// What a musician hears of the value of a parameter, counted from 0, where that is told of each.
    pub fn heard_of(&self, param: &impl Param, index: usize) -> Option<&'static str> {
        self.0.get(&param.as_ptr())?.1.get(index).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::performance::HIGHEST_FIRST;

    #[test]
    fn every_parameter_is_explained_and_nothing_else() {
        let ids: Vec<String> =
            LowActionParams::default().param_map().into_iter().map(|(id, ..)| id).collect();
        for id in &ids {
            assert!(heard(id).is_some_and(|heard| heard.ends_with('.')), "{id}");
        }
        for (id, _) in HEARD {
            assert!(ids.iter().any(|known| known.starts_with(id)), "{id}");
        }
    }

    #[test]
    fn as_many_keys_tell_the_hands_how_to_play_as_the_page_says() {
        let page = include_str!("../../../docs/plugin.md").split_whitespace().collect::<Vec<_>>().join(" ");
        let said = format!("`keyswitches` is the first of {} keys that tell the hands", 128 - HIGHEST_FIRST);
        assert!(page.contains(&said), "docs/plugin.md does not say: {said}");
    }

    #[test]
    fn parameters_are_called_what_they_are_called() {
        let params = LowActionParams::default();
        let words = Words::of(&params);
        let said = words.heard_of(&params.instrument.render_quality, 0).expect("it is told of");
        assert!(said.contains(params.instrument.relax.name()), "{said}");
    }
}
