//! How notes and controllers are taken: what a song and what a keyboard or guitar can be told of alike.

use std::ffi::OsStr;
use std::fmt;

use clap::Args;
use low_action_dsp::Setup;
use low_action_dsp::neck::Neck;
use nice_plug::prelude::Enum;

use super::whole;
use crate::cli::names::escaped;
use crate::cli::{Failure, Outcome, render};
use crate::controls::Touching;
use crate::engine::EngineOptions;
use crate::params::{InputChoice, LegatoChoice, Setting, StringOrder, idle, settings};
use crate::performance::{InputMode, highest_capo};
use crate::plugin::order::{self, Order};

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
    /// The fret about which the left hand plays what several strings could give, 1 to the instrument's last, unless the song or
    /// keyboard says so itself (CC 28) [default: it moves as little as it can].
    #[arg(long, value_name = "FRET", allow_hyphen_values = true)]
    pub hand_position: Option<Fret>,
    /// The fret of a capo, 1 to the last that leaves five of the instrument's (17 on electric), unless the song or keyboard says
    /// so itself (CC 26) [default: none].
    #[arg(long, value_name = "FRET", allow_hyphen_values = true)]
    pub capo: Option<Fret>,
    /// When overlapping notes on one string are connected by hammers, pulls and slides: pedal (while CC 68 or 65 is down) or always.
    #[arg(long, value_name = "WHEN", default_value = "pedal", value_parser = render::parse_choice::<LegatoChoice>())]
    pub legato: LegatoChoice,
    /// Pass over the controllers that tell hands what to do (CC 20 to 28), where they mean something else.
    #[arg(long)]
    pub ignore_hand_controllers: bool,
    /// Set another parameter of the plugins, of those of hands, set-up, strings and control, to what they show: velocity_curve=2,
    /// keyswitches=36, pluck_force="80 %"; any number of times, once for each.
    #[arg(long, value_name = "ID=VALUE", value_parser = parse_setting, allow_hyphen_values = true)]
    pub set: Vec<Setting>,
}

/// A fret as it is asked for: whether there is one of that number depends on the instrument.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fret(String);

impl Fret {
    /// Its number, 1 or more, if it is any that [an instrument](Neck::MOST_FRETS) may have.
    fn number(&self) -> Option<u8> {
        self.0.parse().ok().filter(|&fret| (1..=Neck::MOST_FRETS).contains(&usize::from(fret)))
    }
}

/// What is more than a word in quotes.
impl fmt::Display for Fret {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(text) = self;
        let is_word = !text.is_empty() && text.chars().all(|letter| letter.is_ascii_graphic());
        if is_word { out.write_str(text) } else { write!(out, "{text:?}") }
    }
}

impl From<&str> for Fret {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

/// Parameters that have options of their own.
const OWN: [(&str, &str); 9] = [
    ("input_mode", "--input"),
    ("first_channel", "--first-channel"),
    ("string_order", "--string-order"),
    ("bend_range", "--bend-range"),
    ("ignore_rpn", "--ignore-rpn"),
    ("hand_position", "--hand-position"),
    ("capo", "--capo"),
    ("legato", "--legato"),
    ("hand_controllers", "--ignore-hand-controllers"),
];

/// Reads `--set`.
fn parse_setting(text: &str) -> Result<Setting, String> {
    let named = text.split_once('=').filter(|(id, _)| !id.is_empty());
    let (id, value) = named.ok_or("must be ID=VALUE, as velocity_curve=2")?;
    if let Some((_, option)) = OWN.iter().find(|(own, _)| *own == id) {
        return Err(format!("{id} has an option of its own, {option}"));
    }
    let ids: Vec<String> =
        settings::ids().into_iter().filter(|known| OWN.iter().all(|(own, _)| own != known)).collect();
    match ids.iter().any(|known| known == id) {
        true => Setting::read(id, value),
        false => Err(format!("there is no parameter {id}: must be {}", ids.join(", "))),
    }
}

impl TakenArgs {
    /// What channels mean; refuses what would say so, or set a parameter, in vain.
    pub(in crate::cli) fn mode(&self) -> Result<InputMode, Failure> {
        let Self { input, first_channel, string_order, .. } = self;
        let of_strings =
            [("--first-channel", first_channel.is_some()), ("--string-order", string_order.is_some())];
        let ids = || self.set.iter().map(Setting::id);
        if let Some((_, id)) =
            ids().enumerate().find(|&(place, id)| ids().take(place).any(|before| before == id))
        {
            return Err(Failure::Usage(format!("--set {id} cannot be used multiple times")));
        }
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

    /// Refuses what is no fret of an instrument of that name.
    pub(in crate::cli) fn fits(&self, setup: &Setup, name: &OsStr) -> Outcome {
        let (name, frets) = (escaped(&name.to_string_lossy()), setup.neck.frets);
        let beyond =
            |fret: &&Fret, highest: usize| fret.number().is_none_or(|fret| usize::from(fret) > highest);
        let refused = |option: &str, fret: &Fret, reason: String| {
            Err(Failure::Usage(format!("{option} {fret} is refused: {reason}")))
        };
        if let Some(fret) = self.hand_position.as_ref().filter(|fret| beyond(fret, frets)) {
            let reason = match frets {
                0 => format!("{name} has no frets"),
                _ => format!("must be a whole number from 1 to {frets} on {name}"),
            };
            return refused("--hand-position", fret, reason);
        }
        let highest = if setup.wants_bar() { 0 } else { highest_capo(frets) };
        match self.capo.as_ref().filter(|fret| beyond(fret, highest)) {
            Some(fret) if highest > 0 => refused(
                "--capo",
                fret,
                format!("must be a whole number from 1 to {highest} on {name}, so that five frets are left"),
            ),
            Some(fret) if setup.wants_bar() => {
                refused("--capo", fret, format!("no capo on {name}: its strings are too high over the frets"))
            }
            Some(fret) => refused("--capo", fret, format!("no capo on {name}: it leaves no five frets")),
            None => Ok(()),
        }
    }

    /// The fret about which the left hand plays, if it is told; [one there is](Self::fits).
    pub(in crate::cli) fn hand_position(&self) -> Option<u8> {
        self.hand_position.as_ref().and_then(Fret::number)
    }

    /// The fret of the capo, if there is one; [one there may be](Self::fits).
    pub(in crate::cli) fn capo(&self) -> Option<u8> {
        self.capo.as_ref().and_then(Fret::number)
    }

    /// What to warn of: settings of which nothing comes on an instrument.
    pub(in crate::cli) fn in_vain(&self, setup: &Setup) -> Vec<String> {
        let told = |setting: &Setting| {
            let why = idle::why(setting.id(), setup)?.trim_end_matches('.');
            let why = why.replacen("This", "this", 1);
            Some(format!("--set {}={} does nothing: {why}", setting.id(), setting.shown()))
        };
        self.set.iter().filter_map(told).collect()
    }

    /// How hands act, as far as they are told here.
    pub(in crate::cli) fn touching(&self) -> Touching {
        Touching {
            bend_range: self.bend_range.unwrap_or(EngineOptions::BEND_RANGE),
            ignore_rpn: self.ignore_rpn,
            hand_position: self.hand_position(),
            capo: self.capo().unwrap_or(0),
            legato: self.legato == LegatoChoice::Always,
            hand_controllers: !self.ignore_hand_controllers,
            ..order::touching(&settings::with(&self.set))
        }
    }

    /// Does to a set-up what is set of it.
    pub(in crate::cli) fn work_on(&self, setup: &mut Setup) {
        if !self.set.is_empty() {
            Order::of(&settings::with(&self.set), 0.0, false).luthier.work_on(setup);
        }
    }

    /// The same as values of parameters; refuses what would say something in vain, and what they do not have. (Frets are to
    /// [fit](Self::fits) the instrument.)
    #[cfg_attr(not(any(feature = "standalone", test)), expect(dead_code, reason = "nobody begins with them"))]
    pub(in crate::cli) fn settings(&self) -> Result<Vec<Setting>, Failure> {
        self.mode()?;
        if let Some(semitones) = self.bend_range.filter(|semitones| semitones.fract() != 0.0) {
            let widest = EngineOptions::WIDEST_BEND_RANGE;
            let reason = format!("without a command it must be a whole number from 0 to {widest}");
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
            ("hand_position", self.hand_position().map(number)),
            ("capo", self.capo().map(number)),
            ("legato", named(self.legato.to_index(), LegatoChoice::variants())),
            ("hand_controllers", off(self.ignore_hand_controllers, "Off")),
        ];
        let told = told.into_iter().filter_map(|(id, text)| Some(Setting::read(id, &text?)));
        told.chain(self.set.iter().cloned().map(Ok)).collect::<Result<_, _>>().map_err(Failure::Usage)
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

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
                    --ignore-hand-controllers --legato always --set keyswitches=36";
        let params = settings::with(&taken(line).settings().unwrap());
        assert_eq!(order::input(&params), InputMode::Strings { first: 10, from_last: true });
        let usual = order::touching(&settings::with(&[]));
        let expected = Touching {
            legato: true,
            keyswitches: Some(36),
            bend_range: 12.0,
            ignore_rpn: true,
            capo: 2,
            hand_controllers: false,
            ..usual
        };
        assert_eq!(order::touching(&params), expected);
        // As a song is rendered.
        assert_eq!(taken(line).touching(), expected);
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
