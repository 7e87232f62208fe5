//! What sounds where fingers stop the frets, and which frets stay out of tune under them.

use low_action_dsp::intonation::{Intonated, Pressed, Sounding};
use low_action_dsp::setup::{Intonation, frequency};
use low_action_dsp::{Error, Instrument, Setup};

use crate::engine::Quality;
use crate::performance::PlayedString;

/// Frets that are farther than this off equal temperament are told of, cents.
const OUT_OF_TUNE: f64 = 15.0;

/// The strings of an instrument as they are tuned and fretted on their grids.
pub(super) struct Tuned<'a> {
    setup: &'a Setup,
    instrument: &'a Instrument,
    quality: Quality,
    /// What fingers press with, N.
    force: f64,
    pub placed: Vec<Intonated>,
    played: Vec<PlayedString>,
}

impl<'a> Tuned<'a> {
    /// Those of a set-up whose fingers press with such a force, N.
    pub fn new(setup: &'a Setup, instrument: &'a Instrument, quality: Quality, force: f64) -> Self {
        let placed = |index| Intonated {
            string: instrument.model(index).string,
            frets: instrument.geometry(index).frets.clone(),
        };
        let placed = (0..setup.string.len()).map(placed).collect();
        let played =
            (0..setup.string.len()).map(|index| PlayedString::new(setup, instrument, index)).collect();
        Self { setup, instrument, quality, force, placed, played }
    }

    /// The frequencies at the frets of a string, Hz, fret 1 first.
    pub fn stopped(&self, index: usize) -> Result<Vec<f64>, Error> {
        (1..=self.placed[index].frets.len()).map(|fret| self.pulled(index, fret, 1.0)).collect()
    }

    /// The frequency, Hz, at which a string sounds where fingers stop a fret, 0 for the open one, as it is pulled to so many times its own
    /// tension and they hold it down.
    pub fn pulled(&self, index: usize, fret: usize, tension_ratio: f64) -> Result<f64, Error> {
        let force = self.played[index].held_pulled(self.force, fret, tension_ratio);
        self.sounding(index).frequency(fret, Pressed { force, tension_ratio })
    }

    /// What to say of frets that were to be in tune and are not under these fingers, if there are any.
    pub fn out_of_tune(&self) -> Result<Option<String>, Error> {
        let setup = self.setup;
        if setup.intonation == Intonation::Physical {
            return Ok(None);
        }
        let mut off = Vec::new();
        for (index, string) in setup.string.iter().enumerate() {
            for (fret, sounds) in (1_usize..).zip(self.stopped(index)?) {
                let cents = 1200.0 * (sounds / frequency(string.pitch + setup.tuning + fret as f64)).log2();
                if cents.abs() > OUT_OF_TUNE {
                    off.push((index + 1, fret, cents));
                }
            }
        }
        let farthest = off.iter().max_by(|one, other| one.2.abs().total_cmp(&other.2.abs()));
        Ok(farthest.map(|(string, fret, cents)| {
            let others = match off.len() {
                1 => String::new(),
                2 => ", and 1 other by less".to_owned(),
                count => format!(", and {} others by less", count - 1),
            };
            format!(
                "fret {fret} of string {string} stays out of tune: it is off by {cents:+.0} cents{others}"
            )
        }))
    }

    fn sounding(&self, index: usize) -> Sounding<'_> {
        let Self { setup, instrument, quality, ref placed, .. } = *self;
        let settings = quality.settings(instrument.sample_rate());
        let rate = instrument.ratio(index).value() * instrument.sample_rate();
        Sounding::new(setup, &setup.string[index], &placed[index], settings.stencil, rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Engine, EngineOptions};
    use crate::setups::SHIPPED;

    fn told(setup: Setup, rate: f64, quality: Quality) -> Option<String> {
        let options = EngineOptions { quality, ..EngineOptions::new(setup, rate) };
        let engine = Engine::new(&options).unwrap();
        let force = options.setup.player.fretting.force;
        Tuned::new(&options.setup, engine.instrument(), quality, force).out_of_tune().unwrap()
    }

    #[test]
    fn of_all_but_one_that_come_with_the_program_every_fret_is_in_tune() {
        for name in SHIPPED {
            // Fingers that hardly hold strings.
            let is_off = name == "light-fingers";
            for rate in [44_100.0, 48_000.0] {
                let said = told(Setup::shipped(name).unwrap(), rate, Quality::Live);
                assert_eq!(said.is_some(), is_off, "{name}: {said:?}");
            }
        }
    }

    #[test]
    fn frets_beyond_what_moving_them_can_mend_are_told_of() {
        let setup = "based_on = \"electric\"\n[neck]\nfrets = 30\n";
        let said = told(Setup::from_toml(setup).unwrap(), 48_000.0, Quality::Live).unwrap();
        let worst = "fret 30 of string 5 stays out of tune: it is off by +69 cents, and 2 others by less";
        assert_eq!(said, worst);
        // As sharp as pressing makes it is what was asked for.
        let physical = setup.replace("[neck]", "intonation = \"physical\"\n[neck]");
        assert_eq!(told(Setup::from_toml(&physical).unwrap(), 48_000.0, Quality::Live), None);
    }
}
