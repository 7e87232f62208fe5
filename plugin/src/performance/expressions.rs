//! What note expressions do: to notes that sound, begin or are yet to come.

use super::channel::pressure_factor;
use super::chord::Unplaced;
use super::string::Own;
use super::technique::BRIGHTNESS_REACH;
use super::{CHANNELS, Expression, GestureSink, Performance};

/// The widest tuning of a note that is taken at its word, semitones: what CLAP's hosts may ask for.
const WIDEST: f64 = 120.0;
/// The largest factor of a force that is.
const LARGEST: f64 = 100.0;

/// The loudest that a host may have a note, 12 dB: CLAP and VST3 go so far.
const LOUDEST: f64 = 4.0;

/// What an expression says, in the units of the hands and within what they take.
enum Said {
    /// Of the note as long as it sounds.
    Note(Own),
    /// Of its pluck: how far brightness moves it from the saddle, m.
    Brightness(f64),
    /// How far it is moved besides, m.
    PluckPlace(f64),
    /// Factor of its force.
    PluckForce(f64),
    /// Others.
    Swell(f64),
    Gain(f64),
}

impl From<Expression> for Said {
    fn from(expression: Expression) -> Self {
        let part = |value: f32| f64::from(value).clamp(0.0, 1.0);
        let factor = |value: f32| f64::from(value).clamp(0.0, LARGEST);
        match expression {
            Expression::Tuning(semitones) => {
                Self::Note(Own::Tuning(f64::from(semitones).clamp(-WIDEST, WIDEST)))
            }
            Expression::Pressure(pressure) => Self::Note(Own::Pressure(pressure_factor(pressure))),
            Expression::FingerForce(force) => Self::Note(Own::Firmness(factor(force))),
            Expression::Vibrato(depth) => Self::Note(Own::Vibrato(part(depth))),
            Expression::Brightness(bright) => Self::Brightness((1.0 - 2.0 * part(bright)) * BRIGHTNESS_REACH),
            Expression::PluckPlace(metres) => Self::PluckPlace(f64::from(metres)),
            Expression::PluckForce(force) => Self::PluckForce(factor(force)),
            Expression::Swell(force) => Self::Swell(factor(force)),
            Expression::Gain(gain) => Self::Gain(factor(gain).min(LOUDEST)),
        }
    }
}

impl Performance {
    /// Something changes about all notes of a channel and a key (`None`: of any).
    pub(super) fn express_all(
        &mut self,
        (channel, key): (Option<u8>, Option<u8>),
        expression: Expression,
        out: &mut impl GestureSink,
    ) {
        let meant = |one: Option<u8>, own: u8| one.is_none_or(|one| one == own);
        for (own, keys) in (0..).zip(self.keys()).filter(|&(own, _)| meant(channel, own)) {
            let known = (0..128).filter(|&own| keys >> own & 1 == 1 && meant(key, own));
            known.for_each(|key| self.express(own, key, expression, out));
        }
    }

    /// The keys of each channel that notes have which sound, begin or are yet to come, a bit for each.
    fn keys(&self) -> [u128; CHANNELS] {
        let mut keys = [0; CHANNELS];
        let waiting = self.chord.iter().chain(self.late.iter().map(|late| &late.note));
        let waiting = waiting.map(|note| (note.wanted.channel, note.wanted.key));
        for (channel, key) in self.strings.iter().flat_map(|string| string.keys()).chain(waiting) {
            if let Some(keys) = keys.get_mut(usize::from(channel)) {
                *keys |= 1u128.checked_shl(u32::from(key)).unwrap_or(0);
            }
        }
        keys
    }

    /// Something changes about one note.
    pub(super) fn express(
        &mut self,
        channel: u8,
        key: u8,
        expression: Expression,
        out: &mut impl GestureSink,
    ) {
        if !expression.amount().is_finite() {
            return;
        }
        // The latest note of the key: one that begins now, or waits for a string, before any that sounds.
        let late = self.late.iter_mut().filter(|late| late.key_down()).map(|late| &mut late.note);
        let note = self.chord.iter_mut().chain(late).find(|other| other.is(channel, key));
        let said = Said::from(expression);
        if let Some(Unplaced { manner, own, .. }) = note {
            match said {
                Said::Note(said) => said.tell(manner),
                Said::Brightness(metres) => own.brightness = metres,
                Said::PluckPlace(metres) => own.place = metres,
                Said::PluckForce(factor) => own.force = factor,
                Said::Swell(factor) => own.swell = factor,
                Said::Gain(factor) => own.gain = factor,
            }
            return;
        }
        // Else it has been plucked already.
        let Said::Note(own) = said else { return };
        // Rather where the key's note sounds than where it is down under another.
        let sounding = self.strings.iter().position(|string| string.is_of(channel, key));
        let under = || self.strings.iter().position(|string| string.sounds(channel, key));
        if let Some(string) = sounding.or_else(under) {
            self.strings[string].express(self.now, (channel, key), own, out);
        }
    }
}
