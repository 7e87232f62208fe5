//! The outputs that there are, and what they take: at which rates, and how many samples at a time.
//!
//! The framework opens an output only at a rate and with a period that it says it takes together. Many take one period: on
//! Windows usually 480 samples at 48 kHz.

use std::ops::RangeInclusive;

use anyhow::{Context, Result, ensure};
use cpal::SupportedBufferSize;
use cpal::traits::{DeviceTrait, HostTrait};

use super::{PERIOD, SAMPLE_RATE};

/// Channels that are played.
const CHANNELS: u16 = 2;

/// What an output takes together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Offer {
    channels: u16,
    /// Hz.
    rates: RangeInclusive<u32>,
    /// Samples.
    periods: RangeInclusive<u32>,
}

/// The names of all outputs of the system.
pub(super) fn names() -> Vec<String> {
    let devices = cpal::default_host().output_devices().into_iter().flatten();
    devices.filter_map(|device| name(&device)).collect()
}

fn name(device: &cpal::Device) -> Option<String> {
    Some(device.description().ok()?.name().to_owned())
}

/// Name of an output, or of the usual one, and what it takes; nothing where it does not say.
pub(super) fn offers(output: Option<&str>) -> (String, Vec<Offer>) {
    let host = cpal::default_host();
    let device = match output {
        Some(output) => {
            let mut devices = host.output_devices().into_iter().flatten();
            devices.find(|device| name(device).is_some_and(|name| name == output))
        }
        None => host.default_output_device(),
    };
    let Some(device) = device else { return (output.unwrap_or_default().to_owned(), Vec::new()) };
    (name(&device).unwrap_or_default(), of(&device))
}

/// What a device takes. What says nothing of its periods the framework does not open.
fn of(device: &cpal::Device) -> Vec<Offer> {
    let ranges = device.supported_output_configs().into_iter().flatten();
    let offer = |range: cpal::SupportedStreamConfigRange| match *range.buffer_size() {
        SupportedBufferSize::Range { min, max } => Some(Offer {
            channels: range.channels(),
            rates: range.min_sample_rate()..=range.max_sample_rate(),
            periods: min..=max,
        }),
        SupportedBufferSize::Unknown => None,
    };
    ranges.filter_map(offer).collect()
}

/// Rate and period at which an output is played to: those asked for, or else the nearest to the usual ones that it takes. Of one
/// that says nothing nothing is known, and the framework tells why.
///
/// # Errors
/// When it does not take what is asked for.
pub(super) fn fit(
    output: &str,
    offers: &[Offer],
    rate: Option<u32>,
    period: Option<u32>,
) -> Result<(u32, u32)> {
    if offers.is_empty() {
        return Ok((rate.unwrap_or(SAMPLE_RATE), period.unwrap_or(PERIOD)));
    }
    let rates = words(offers.iter().map(|offer| &offer.rates));
    if let Some(rate) = rate {
        let is_taken = offers.iter().any(|offer| offer.rates.contains(&rate));
        ensure!(is_taken, "{output:?} does not take --sample-rate {rate}: it must be {rates}");
    }
    fitting(offers, rate, period).with_context(|| {
        let rate = rate.or_else(|| Some(fitting(offers, None, None)?.0)).unwrap_or(SAMPLE_RATE);
        let (asked, periods) = (period.unwrap_or(PERIOD), periods_at(offers, rate));
        format!("{output:?} does not take --period-size {asked} at {rate} Hz: it must be {periods}")
    })
}

/// The rate nearest to the usual one, and the nearest period at it, where none are asked for; of offers with channels enough, if
/// there are any.
fn fitting(offers: &[Offer], rate: Option<u32>, period: Option<u32>) -> Option<(u32, u32)> {
    let nearest = |range: &RangeInclusive<u32>, asked: Option<u32>, usual: u32| match asked {
        Some(asked) => range.contains(&asked).then_some(asked),
        None => (!range.is_empty()).then(|| usual.clamp(*range.start(), *range.end())),
    };
    let fits = offers.iter().filter_map(|offer| {
        let found = (nearest(&offer.rates, rate, SAMPLE_RATE)?, nearest(&offer.periods, period, PERIOD)?);
        let off = (found.0.abs_diff(SAMPLE_RATE), found.1.abs_diff(PERIOD));
        Some((offer.channels < CHANNELS, off, found))
    });
    fits.min().map(|(_, _, found)| found)
}

/// The periods at a rate, in words.
fn periods_at(offers: &[Offer], rate: u32) -> String {
    let at = offers.iter().filter(|offer| offer.rates.contains(&rate));
    words(at.map(|offer| &offer.periods))
}

/// Numbers, each once, in their order.
fn words<'a>(ranges: impl Iterator<Item = &'a RangeInclusive<u32>>) -> String {
    let mut sorted: Vec<(u32, u32)> = ranges.map(|range| (*range.start(), *range.end())).collect();
    sorted.sort_unstable();
    let mut joined: Vec<(u32, u32)> = Vec::new();
    for (low, high) in sorted {
        match joined.last_mut() {
            Some((_, end)) if low <= end.saturating_add(1) => *end = high.max(*end),
            _ => joined.push((low, high)),
        }
    }
    let word = |(low, high): &(u32, u32)| match low == high {
        true => low.to_string(),
        false => format!("{low} to {high}"),
    };
    joined.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// A line for each, for people to read.
pub(super) fn listed() -> String {
    let host = cpal::default_host();
    let usual = host.default_output_device().as_ref().and_then(name);
    let devices = host.output_devices().into_iter().flatten();
    let lines: String = devices
        .filter_map(|device| {
            let name = name(&device)?;
            Some(line(&name, usual.as_ref() == Some(&name), &of(&device)))
        })
        .collect();
    if lines.is_empty() { "  none\n".to_owned() } else { lines }
}

/// What there is to say of one.
fn line(name: &str, is_usual: bool, offers: &[Offer]) -> String {
    let usual = if is_usual { " (the usual one)" } else { "" };
    let taken = fitting(offers, None, None).map(|(rate, _)| {
        let (rates, periods) = (words(offers.iter().map(|offer| &offer.rates)), periods_at(offers, rate));
        format!(": {rates} Hz, periods of {periods} samples at {rate} Hz")
    });
    format!("  {name}{usual}{}\n", taken.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer(channels: u16, rates: RangeInclusive<u32>, periods: RangeInclusive<u32>) -> Offer {
        Offer { channels, rates, periods }
    }

    /// As Windows has it: one period at each rate, of 10 ms.
    fn shared() -> Vec<Offer> {
        [44_100, 48_000, 96_000].map(|rate| offer(2, rate..=rate, rate / 100..=rate / 100)).into()
    }

    #[test]
    fn what_an_output_takes_is_asked_of_it() {
        let wide = [offer(2, 44_100..=192_000, 15..=4_096)];
        for (offers, found) in [
            (&[offer(2, 48_000..=48_000, 480..=480)][..], (48_000, 480)),
            (&shared(), (48_000, 480)),
            (&wide, (48_000, 256)),
            (&[offer(2, 44_100..=44_100, 15..=4_096)], (44_100, 256)),
            (&[offer(2, 88_200..=96_000, 512..=4_096)], (88_200, 512)),
            (&[offer(2, 44_100..=48_000, 32..=128)], (48_000, 128)),
            // The rate goes before the period, and channels before both.
            (&[offer(2, 44_100..=44_100, 256..=256), offer(2, 48_000..=48_000, 480..=480)], (48_000, 480)),
            (&[offer(1, 48_000..=48_000, 256..=256), offer(2, 44_100..=44_100, 441..=441)], (44_100, 441)),
            (&[offer(1, 48_000..=48_000, 480..=480)], (48_000, 480)),
            (&[], (48_000, 256)),
        ] {
            assert_eq!(fit("it", offers, None, None).expect("it takes something"), found, "{offers:?}");
        }
    }

    #[test]
    fn what_is_asked_for_is_taken_or_refused() {
        assert_eq!(fit("it", &shared(), Some(44_100), None).expect("it is there"), (44_100, 441));
        assert_eq!(fit("it", &shared(), None, Some(960)).expect("it is there"), (96_000, 960));
        let wide = [offer(2, 44_100..=192_000, 15..=4_096)];
        assert_eq!(fit("it", &wide, Some(96_000), Some(64)).expect("it is there"), (96_000, 64));
        assert_eq!(fit("it", &[], Some(8_000), Some(9)).expect("nothing is known"), (8_000, 9));
        let told =
            |rate, period| fit("Speakers", &shared(), rate, period).expect_err("it is not").to_string();
        assert_eq!(
            told(Some(22_050), None),
            "\"Speakers\" does not take --sample-rate 22050: it must be 44100, 48000, 96000"
        );
        let period = "\"Speakers\" does not take --period-size 128 at 48000 Hz: it must be 480";
        assert_eq!(told(None, Some(128)), period);
        let other = "\"Speakers\" does not take --period-size 480 at 96000 Hz: it must be 960";
        assert_eq!(told(Some(96_000), Some(480)), other);
    }

    #[test]
    fn rates_and_periods_are_listed() {
        assert_eq!(
            line("Speakers", true, &shared()),
            "  Speakers (the usual one): 44100, 48000, 96000 Hz, periods of 480 samples at 48000 Hz\n"
        );
        let offers = [offer(2, 44_100..=48_000, 15..=4_096), offer(6, 48_000..=192_000, 15..=1_024)];
        assert_eq!(
            line("USB", false, &offers),
            "  USB: 44100 to 192000 Hz, periods of 15 to 4096 samples at 48000 Hz\n"
        );
        assert_eq!(line("HDMI", false, &[]), "  HDMI\n");
    }
}
