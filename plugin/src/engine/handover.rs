//! Another instrument, or the same one with other screws turned, in the middle of the music.

use low_action_dsp::{Error, Instrument};

use super::{Engine, EngineOptions};
use crate::performance::Performance;

/// All that an engine needs to go on as another: built beforehand, where allocating does no harm, and given
/// back with what it replaced.
#[derive(Debug)]
pub struct Replacement {
    performance: Performance,
    instrument: Option<Box<Instrument>>,
    /// How long it rings at most, s.
    tail: f64,
}

impl Replacement {
    /// Builds everything; allocates.
    ///
    /// # Errors
    /// When the set-up cannot be built at this rate; the message names the value and its range.
    pub fn new(options: &EngineOptions) -> Result<Self, Error> {
        let (performance, instrument) = options.build()?;
        Ok(Self { performance, instrument: Some(Box::new(instrument)), tail: options.tail() })
    }
}

impl Engine {
    /// Goes on as another engine from the next sample on. If its strings are much the same, they go on
    /// sounding with the fingers on them and the notes held; otherwise the sound fades away and the strings
    /// are silent. But notes whose keys are down and that began at sample `asked` or later, when this engine was asked for, were
    /// meant for it: they are struck again. Nothing is allocated or given back.
    ///
    /// # Errors
    /// When the replacement is built for another sample rate, and while what the engine was before is still fading or has
    /// not been fetched; the replacement comes back unused.
    pub fn replace(&mut self, mut replacement: Box<Replacement>, asked: u64) -> Result<(), Box<Replacement>> {
        if self.outgoing.is_some() {
            return Err(replacement);
        }
        let Some(instrument) = replacement.instrument.take() else { return Err(replacement) };
        let goes_on = self.played.instrument.continues_in(&instrument);
        if let Err(instrument) = self.played.instrument.hand_over(instrument) {
            replacement.instrument = Some(instrument);
            return Err(replacement);
        }
        replacement.performance.take_over(&self.performance, goes_on);
        if !goes_on {
            replacement.performance.strike_again(&self.performance, asked);
        }
        std::mem::swap(&mut self.performance, &mut replacement.performance);
        std::mem::swap(&mut self.tail, &mut replacement.tail);
        self.outgoing = Some(replacement);
        Ok(())
    }

    /// Samples until what the engine was before has faded, 0 if nothing fades.
    pub fn fading_left(&self) -> u64 {
        self.played.instrument.fading_left()
    }

    /// What the engine was before, once it has faded; to be dropped where that does no harm.
    pub fn take_outgoing(&mut self) -> Option<Box<Replacement>> {
        let instrument = self.played.instrument.take_before()?;
        let mut outgoing = self.outgoing.take()?;
        outgoing.instrument = Some(instrument);
        Some(outgoing)
    }
}
