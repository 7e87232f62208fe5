//! What is set is kept, whatever is added to it for the moment.
//!
//! CLAP hosts modulate: what they add to a parameter comes and goes, and what is set stays under it. The framework
//! (`nice-plug-core` 0.4.2, `_internal_set_plain_value` in `params/float.rs` and of the other kinds) compares sums only: where a new
//! value makes the same one, as at the end of a range or on the same step of a switch, it is not kept, and the session saves the
//! old. So nothing is set here while anything is added: it is taken away, and put back on the value. Between these there is no sample.

mod apart;

use std::sync::atomic::{AtomicU64, Ordering};

use clap_sys::id::clap_id;
use nice_plug::params::internals::ParamPtr;
use nice_plug::wrapper::clap::Wrapper;

pub(super) use apart::Apart;

use crate::plugin::LowAction;

/// A parameter and what is added to it.
struct Added {
    id: clap_id,
    param: ParamPtr,
    /// In the units that CLAP shows to a host, as bits: sessions are loaded on another thread than sounds are made.
    amount: AtomicU64,
}

impl Added {
    fn amount(&self) -> f64 {
        f64::from_bits(self.amount.load(Ordering::Relaxed))
    }

    fn steps(&self) -> f32 {
        // SAFETY: parameters live as long as the plugin, to which this belongs.
        unsafe { self.param.step_count() }.unwrap_or(1) as f32
    }

    fn add(&self, amount: f64) {
        // SAFETY: as above.
        unsafe { self.param._internal_modulate_value(amount as f32 / self.steps()) };
    }
}

/// What a host adds to each of the parameters.
#[derive(Default)]
pub(super) struct Modulated(Vec<Added>);

impl Modulated {
    /// Nothing yet.
    pub(super) fn of(wrapper: &Wrapper<LowAction>) -> Self {
        let each = wrapper.param_ptr_to_hash.iter();
        let mut all: Vec<_> = each
            .map(|(&param, &id)| Added { id, param, amount: AtomicU64::new(0.0_f64.to_bits()) })
            .collect();
        all.sort_unstable_by_key(|added| added.id);
        Self(all)
    }

    fn find(&self, id: clap_id) -> Option<&Added> {
        self.0.binary_search_by_key(&id, |added| added.id).ok().and_then(|place| self.0.get(place))
    }

    /// The number by which players know a parameter that can be modulated for each note, and the steps it is told in; nothing for
    /// others.
    pub(super) fn by_note(&self, id: clap_id) -> Option<(u32, f32)> {
        let added = self.find(id)?;
        // SAFETY: parameters live as long as the plugin, to which this belongs.
        unsafe { added.param.poly_modulation_id() }.map(|number| (number, added.steps()))
    }

    /// What is added to a parameter, if anything is.
    fn added(&self, id: clap_id) -> Option<f64> {
        self.find(id).map(Added::amount).filter(|&amount| amount != 0.0)
    }

    /// Notes what the host adds from now on, and says what it was before; for single notes of those that can have it so, it is
    /// another matter.
    fn note(&self, id: clap_id, note: i32, amount: f64) -> Option<f64> {
        let added = self.find(id).filter(|_| amount.is_finite())?;
        let is_of_all = note == -1 || self.by_note(id).is_none();
        is_of_all.then(|| f64::from_bits(added.amount.swap(amount.to_bits(), Ordering::Relaxed)))
    }

    /// Sets once more what the framework has just set at a time in a block, if something is added to it then.
    pub(super) fn set(&self, id: clap_id, value: f64, time: u32, block: &Apart) {
        let Some(added) = self.find(id).filter(|_| value.is_finite()) else { return };
        let amount = block.added_at(time, id).unwrap_or_else(|| added.amount());
        if amount == 0.0 {
            return;
        }
        added.add(0.0);
        // SAFETY: parameters live as long as the plugin, to which this belongs.
        unsafe { added.param._internal_set_normalized_value(value as f32 / added.steps()) };
        added.add(amount);
    }

    /// Does something that may set any parameter while nothing is added.
    pub(super) fn without<T>(&self, set: impl FnOnce() -> T) -> T {
        let all = || self.0.iter().filter(|added| added.amount() != 0.0);
        all().for_each(|added| added.add(0.0));
        let said = set();
        for added in all() {
            let mut amount = added.amount();
            loop {
                added.add(amount);
                // What goes over to another value slowly begins with it.
                // SAFETY: parameters live as long as the plugin, to which this belongs.
                unsafe { added.param._internal_update_smoother(0.0, true) };
                // The host may have added something else meanwhile, where sounds are made.
                let now = added.amount();
                if now == amount {
                    break;
                }
                amount = now;
            }
        }
        said
    }
}

#[cfg(test)]
mod tests;
