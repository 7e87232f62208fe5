//! How notes and controllers are taken: what a song and what a keyboard or guitar can be told of alike.

use clap::Args;
use low_action_dsp::neck::Neck;
use nice_plug::prelude::Enum;

use super::whole;
use crate::cli::{Failure, render};
use crate::params::{InputChoice, Setting, StringOrder};
use crate::performance::{HIGHEST_CAPO, InputMode};

/// Options of `render` and of the stand-alone instrument.
#[derive(Debug, Clone, Args)]
pub struct TakenArgs {
    /// What channels mean: auto (MPE if the song or keyboard announces it, or else keyboard), keyboard (string and fret are
    /// chosen for each note), strings (each channel is a string, as guitar controllers send), mpe (each note has a
    /// channel, channel 1 acts on all).
    #[arg(long, value_name = "MODE", default_value = "auto", value_parser = render::parse_choice::<InputChoice>())]
    pub input: InputChoice,
    /// The first channel that is a string, 1 to 16, with --input strings; the next string has the next channel
    /// [default: 1].
    #[arg(long, value_name = "N", value_parser = whole::<u8>(1..=16), allow_hyphen_values = true)]
    pub first_channel: Option<u8>,
    /// Whether that is the set-up's first string, the highest on guitars, or its last [default: first_first].
    #[arg(long, value_name = "ORDER", value_parser = render::parse_choice::<StringOrder>())]
    pub string_order: Option<StringOrder>,
    /// How far a full turn of the pitch wheel bends, 0 to 96 semitones, unless the song or keyboard says so itself [default: 2].
    /// Not for MPE: there it is 48, channel 1's 2, or what the song says, or the keyboard.
    #[arg(long, value_name = "SEMITONES", value_parser = render::parse_bend, allow_hyphen_values = true)]
    pub bend_range: Option<f64>,
    /// Pass over what the song or keyboard says of the bend range (registered parameter 0).
    #[arg(long)]
    pub ignore_rpn: bool,
    /// The fret about which the left hand plays what several strings could give, 1 to 36, unless the song or keyboard says so
    /// itself (CC 28) [default: it moves as little as it can].
    #[arg(long, value_name = "FRET", value_parser = whole::<u8>(1..=Neck::MOST_FRETS as u64), allow_hyphen_values = true)]
    pub hand_position: Option<u8>,
    /// The fret of a capo, 1 to 31, unless the song or keyboard says so itself (CC 26); no farther up than leaves five frets
    /// [default: none].
    #[arg(long, value_name = "FRET", value_parser = whole::<u8>(1..=HIGHEST_CAPO as u64), allow_hyphen_values = true)]
    pub capo: Option<u8>,
    /// Pass over the controllers that tell hands what to do (CC 20 to 28), where they mean something else.
    #[arg(long)]
    pub ignore_hand_controllers: bool,
}

impl TakenArgs {
    /// What channels mean; refuses what would say so in vain.
    pub(in crate::cli) fn mode(&self) -> Result<InputMode, Failure> {
        let Self { input, first_channel, string_order, .. } = self;
        let of_strings =
            [("--first-channel", first_channel.is_some()), ("--string-order", string_order.is_some())];
        if self.bend_range.is_some() && *input == InputChoice::Mpe {
            let reason = "--bend-range is not for --input mpe: there wheels reach 48 semitones, channel 1's 2, or what is \
                          announced";
            return Err(Failure::Usage(reason.into()));
        }
        if self.hand_position.is_some() && *input == InputChoice::Strings {
            let reason =
                "--hand-position is not for --input strings: there each note has its string, and so its fret";
            return Err(Failure::Usage(reason.into()));
        }
        match of_strings.into_iter().find(|&(_, given)| given && *input != InputChoice::Strings) {
            Some((option, _)) => Err(Failure::Usage(format!("{option} is only for --input strings"))),
            None => {
                Ok(input.mode(first_channel.unwrap_or(1), string_order.unwrap_or(StringOrder::FirstFirst)))
            }
        }
    }

    /// The same as values of parameters; refuses what would say something in vain, and what they do not have.
    #[cfg_attr(not(any(feature = "standalone", test)), expect(dead_code, reason = "nobody begins with them"))]
    pub(in crate::cli) fn settings(&self) -> Result<Vec<Setting>, Failure> {
        self.mode()?;
        if let Some(semitones) = self.bend_range.filter(|semitones| semitones.fract() != 0.0) {
            let reason = "without a command it must be a whole number from 0 to 96";
            return Err(Failure::Usage(format!("--bend-range {semitones} is refused: {reason}")));
        }
        let named = |place: usize, names: &[&'static str]| names.get(place).map(|&name| name.to_owned());
        let number = |number: u8| number.to_string();
        let off = |off: bool, text: &str| off.then(|| text.to_owned());
        let order = self.string_order.unwrap_or(StringOrder::FirstFirst);
        let told = [
            ("input_mode", named(self.input.to_index(), InputChoice::variants())),
            ("first_channel", self.first_channel.map(number)),
            ("string_order", named(order.to_index(), StringOrder::variants())),
            ("bend_range", self.bend_range.map(|semitones| semitones.to_string())),
            ("ignore_rpn", off(self.ignore_rpn, "On")),
            ("hand_position", self.hand_position.map(number)),
            ("capo", self.capo.map(number)),
            ("hand_controllers", off(self.ignore_hand_controllers, "Off")),
        ];
        let told = told.into_iter().filter_map(|(id, text)| Some(Setting::read(id, &text?)));
        told.collect::<Result<_, _>>().map_err(Failure::Usage)
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::params::settings;
    use crate::plugin::order;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        taken: TakenArgs,
    }

    fn taken(line: &str) -> TakenArgs {
        let words = ["low-action"].into_iter().chain(line.split_whitespace());
        Line::try_parse_from(words).unwrap_or_else(|error| panic!("{line}: {error}")).taken
    }

    #[test]
    fn the_instrument_begins_as_its_options_say() {
        let line = "--input strings --first-channel 11 --string-order last_first --bend-range 12 --ignore-rpn --capo 2 \
                    --ignore-hand-controllers";
        let params = settings::with(&taken(line).settings().unwrap());
        assert_eq!(order::input(&params), InputMode::Strings { first: 10, from_last: true });
        let usual = order::touching(&settings::with(&[]));
        let expected = crate::controls::Touching {
            bend_range: 12.0,
            ignore_rpn: true,
            capo: 2,
            hand_controllers: false,
            ..usual
        };
        assert_eq!(order::touching(&params), expected);
        let params = settings::with(&taken("--input mpe").settings().unwrap());
        assert_eq!((order::input(&params), order::touching(&params)), (InputMode::Mpe, usual));
        let params = settings::with(&taken("--hand-position 7").settings().unwrap());
        assert_eq!(order::touching(&params).hand_position, Some(7));
        // Nothing is asked for: as it comes.
        let params = settings::with(&taken("").settings().unwrap());
        assert_eq!((order::input(&params), order::touching(&params)), (InputMode::Auto, usual));
    }

    #[test]
    fn what_would_be_in_vain_is_refused() {
        for (line, expected) in [
            ("--first-channel 2", "--first-channel is only for --input strings"),
            ("--input mpe --bend-range 12", "--bend-range is not for --input mpe"),
            (
                "--bend-range 2.5",
                "--bend-range 2.5 is refused: without a command it must be a whole number from 0 to 96",
            ),
        ] {
            let refused = taken(line).settings().unwrap_err();
            assert!(refused.message().starts_with(expected) && refused.code() == 2, "{refused:?}");
        }
    }
}
