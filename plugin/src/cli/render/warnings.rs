//! What there is to warn of once a song has been played.

use super::files::stem_name;
use super::heard::{Cut, Heard};
use super::labels::Source;
use super::options::Tail;
use crate::cli::wav::BitDepth;
use crate::performance::Compromises;

/// All of it, a line each.
pub(super) fn afterwards(source: &Source, heard: &Heard) -> Vec<String> {
    let mut warnings = of_notes(&heard.compromises);
    if heard.lost_events > 0 {
        let lost = heard.lost_events;
        warnings.push(format!("{lost} events or gestures of theirs were lost: too many at once"));
    }
    if heard.samples == 0 {
        warnings
            .push("the sound has no samples: the song ends as it begins (--tail SECONDS goes on)".to_owned());
    }
    // (Who asks for a tail of some length gets that.)
    if let Some(cut @ Cut { after, .. }) = heard.cut.filter(|_| source.arguments.tail == Tail::Auto) {
        let below = cut.below_peak();
        let advice = "it rings on, and --tail SECONDS waits for it";
        warnings
            .push(format!("the sound is cut off after {after:.0} s, {below:.0} dB below its peak: {advice}"));
    }
    warnings.extend(clipped(source, heard));
    warnings
}

/// Notes that are not played as they are written.
fn of_notes(compromises: &Compromises) -> Vec<String> {
    let Compromises {
        moved_by_octaves,
        moved_strings,
        arpeggiated,
        left_out,
        without_string,
        doubled,
        bent_short,
        not_slid,
        overtaken,
    } = *compromises;
    let counts = [
        (moved_by_octaves, "moved by octaves: no string gives them as written"),
        (
            moved_strings,
            "struck again on another string: others of their chord that began a moment later needed theirs",
        ),
        (arpeggiated, "played a moment late: more began at once than there were strings for"),
        (
            left_out,
            "left out: more began at once than anybody could play, or all was to be silent before they were struck",
        ),
        (overtaken, "left out: another took their string before the hand had got there"),
        (without_string, "left out: no string gives them in any octave, or their channel has none"),
        (doubled, "one with another: the same key of the same channel at the same moment"),
        (bent_short, "bent less far than asked: string or finger goes no farther (max_bend)"),
        (
            not_slid,
            "plucked and not slid to: the string of the note before does not have them within reach, or was only touched",
        ),
    ];
    let some = counts.into_iter().filter(|&(count, _)| count > 0);
    some.map(|(count, what)| format!("{count} {} {what}", if count == 1 { "note was" } else { "notes were" }))
        .collect()
}

/// Files that hold less than what sounds.
fn clipped(source: &Source, heard: &Heard) -> Vec<String> {
    let Source { arguments, setup, .. } = source;
    if arguments.bit_depth == BitDepth::Float32 {
        return Vec::new();
    }
    let told = |what: &str, peak: f32, where_it_is: &str| {
        let advice = "use --bit-depth 32f or a set-up with less gain";
        format!("the {what} peaks at {} dBFS and is clipped{where_it_is}: {advice}", level(peak))
    };
    let mut warnings = Vec::new();
    if heard.mix.peak > 1.0 {
        warnings.push(told("sound", heard.mix.peak, ""));
    }
    let strings = (0..).zip(&setup.string).zip(&heard.strings);
    let clipped = strings.filter(|(_, findings)| arguments.stems.is_some() && findings.peak > 1.0);
    let (names, peaks): (Vec<String>, Vec<f32>) =
        clipped.map(|((index, string), findings)| (stem_name(index, &string.name), findings.peak)).unzip();
    if !names.is_empty() {
        let peak = peaks.into_iter().fold(0.0, f32::max);
        warnings.push(told("strings' own sound", peak, &format!(" in {}", names.join(", "))));
    }
    warnings
}

/// A size as a level in dB, 1 is 0. Above that it is rounded up: what is clipped is not at 0.
pub(super) fn level(size: f32) -> String {
    let tenths = 200.0 * f64::from(size).log10();
    if size > 1.0 { format!("{:+.1}", tenths.ceil() / 10.0) } else { format!("{:.1}", tenths / 10.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_above_full_scale_is_shown_above_it() {
        for (size, expected) in [
            (1.0, "0.0"),
            (1.000_001, "+0.1"),
            (1.1, "+0.9"),
            (1.11, "+1.0"),
            (0.5, "-6.0"),
            (1e-6, "-120.0"),
        ] {
            assert_eq!(level(size), expected, "{size}");
        }
    }
}
