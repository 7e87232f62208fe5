//! Values of options that are more than a number.

use std::fmt;
use std::str::FromStr;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use nice_plug::prelude::Enum;

use crate::engine::EngineOptions;

/// What `auto` waits at most, s: as long as the instrument's own losses need for as much as it waits for, and a tenth more, but no
/// less than the one, which ends what nothing damps (a tremolo whose key stays down), and no more than the other: without losses it
/// would wait for ever. The longest strings of the set-ups that come with the program need 11 to 37 s.
const LONGEST_TAIL: (f64, f64) = (30.0, 120.0);

/// The longest tail that can be asked for, s.
const LONGEST_ASKED: f64 = 3_600.0;

/// The longest music that can be asked for, minutes.
const LONGEST_MUSIC: f64 = 1e6;

/// How long to go on after the last event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tail {
    /// Until it is quiet: 72 dB below the song's peak for 50 ms, at least 0.1 s, at most as long as the instrument rings, but 30 s
    /// if that is less and 120 s if it is more.
    Auto,
    /// So many seconds, 0 to 3,600.
    Seconds(f64),
}

impl Tail {
    /// The most it can last where strings ring for so long, s.
    pub(super) fn longest(self, ringing: f64) -> f64 {
        match self {
            Self::Auto => (1.1 * ringing).clamp(LONGEST_TAIL.0, LONGEST_TAIL.1),
            Self::Seconds(seconds) => seconds,
        }
    }
}

impl fmt::Display for Tail {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => out.write_str("auto"),
            Self::Seconds(seconds) => write!(out, "{seconds}"),
        }
    }
}

impl FromStr for Tail {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            "none" => Ok(Self::Seconds(0.0)),
            _ => match text.parse::<f64>() {
                Ok(seconds) if (0.0..=LONGEST_ASKED).contains(&seconds) => Ok(Self::Seconds(seconds)),
                _ => Err(format!("must be auto, none or 0 to {LONGEST_ASKED} seconds")),
            },
        }
    }
}

/// Which sequence of small differences between plucks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seed {
    /// The one of this number.
    Number(u64),
    /// One of the song's own, by its bytes.
    Song,
}

impl FromStr for Seed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "song" => Ok(Self::Song),
            _ => {
                let number = text.parse().map(Self::Number);
                number.map_err(|_| format!("must be a whole number from 0 to {}, or song", u64::MAX))
            }
        }
    }
}

impl fmt::Display for Seed {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(out),
            Self::Song => out.write_str("song"),
        }
    }
}

/// Reads `--sample-rate`.
pub(in crate::cli) fn parse_rate(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(rate) if EngineOptions::SAMPLE_RATES.contains(&rate) => Ok(rate),
        _ => {
            let (lowest, highest) = EngineOptions::SAMPLE_RATES.into_inner();
            Err(format!("must be a whole number of Hz from {lowest} to {highest}"))
        }
    }
}

/// Reads `--max-length`.
pub(in crate::cli) fn parse_minutes(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(minutes) if minutes > 0.0 && minutes <= LONGEST_MUSIC => Ok(minutes),
        _ => Err(format!("must be above 0 and at most {LONGEST_MUSIC} minutes")),
    }
}

/// Reads `--bend-range`.
pub(in crate::cli) fn parse_bend(text: &str) -> Result<f64, String> {
    let widest = EngineOptions::WIDEST_BEND_RANGE;
    match text.parse::<f64>() {
        Ok(semitones) if (0.0..=widest).contains(&semitones) => Ok(semitones),
        _ => Err(format!("must be 0 to {widest} semitones")),
    }
}

/// Reads a choice by the identifier that it has as a parameter of the plugin.
pub(in crate::cli) fn parse_choice<T: Enum + Clone + Send + Sync + 'static>()
-> impl TypedValueParser<Value = T> {
    let ids = T::ids().unwrap_or_default();
    let place = move |id: String| ids.iter().position(|known| *known == id).unwrap_or(0);
    PossibleValuesParser::new(ids).map(move |id| T::from_index(place(id)))
}

/// Reads `--variation`.
pub(in crate::cli) fn parse_variation(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(amount) if (0.0..=1.0).contains(&amount) => Ok(amount),
        _ => Err("must be 0 to 1".into()),
    }
}
