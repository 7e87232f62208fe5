//! What can be seen of the strings of an instrument: models, states, what has happened, and ledgers.

use super::Instrument;
use crate::drive::Drive;
use crate::energy::Ledger;
use crate::model::Model;
use crate::observed::Observed;
use crate::state::State;
use crate::string::Scratch;
use crate::voice::Voice;

impl Instrument {
    /// The model of a string.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn model(&self, string: usize) -> &Model {
        &self.voices[string].model
    }

    /// The state of a string.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn state(&self, string: usize) -> &State {
        &self.voices[string].state
    }

    /// What acted on a string in its last step; a string at rest takes none.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn drive(&self, string: usize) -> &Drive {
        &self.voices[string].drive
    }

    /// The record of a string's last step.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn scratch(&self, string: usize) -> &Scratch {
        &self.voices[string].scratch
    }

    /// Has what happens to the strings kept from now on, or no longer. The sound is the same bits.
    pub fn observe(&mut self, looking: bool) {
        self.voices.iter_mut().for_each(|voice| voice.observed.look(looking, &voice.state));
    }

    /// What has happened to a string since [`Instrument::observe_anew`], while it is kept.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn observed(&self, string: usize) -> &Observed {
        &self.voices[string].observed
    }

    /// Forgets what has happened to the strings.
    pub fn observe_anew(&mut self) {
        self.voices.iter_mut().for_each(|voice| voice.observed.begin_anew(&voice.state));
    }

    /// Opens a ledger for each string; allocates, and so do steps, hand-overs and resets while ledgers are open. Where strings
    /// go on through a hand-over so do their ledgers, which book it. Where they do not, ledgers stay with the instrument that
    /// goes, and its successor has those that were opened in it, if any.
    pub fn open_ledgers(&mut self) {
        self.voices.iter_mut().for_each(Voice::open_ledger);
    }

    /// The ledger of a string, if it was opened.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn ledger(&self, string: usize) -> Option<&Ledger> {
        self.voices[string].ledger.as_ref()
    }
}
