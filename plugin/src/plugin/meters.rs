//! What the audio thread lets others see: written without waiting, read whenever somebody looks.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use atomic_float::AtomicF32;

/// Numbers for lights and needles. They are snapshots; nothing the audio thread does depends on them.
#[derive(Debug, Default)]
pub struct Meters {
    left: AtomicF32,
    right: AtomicF32,
    load: AtomicF32,
    relaxed: AtomicBool,
    exchanges: AtomicU32,
    refusals: AtomicU32,
}

impl Meters {
    /// Largest |sample| of each channel since this was last asked, 1 is full scale.
    pub fn take_peaks(&self) -> [f32; 2] {
        [self.left.swap(0.0, Ordering::Relaxed), self.right.swap(0.0, Ordering::Relaxed)]
    }

    /// Part of the available time spent on the sound lately; 0 where the host renders offline.
    pub fn load(&self) -> f32 {
        self.load.load(Ordering::Relaxed)
    }

    /// Whether contacts are solved less exactly because there is not time enough.
    pub fn relaxed(&self) -> bool {
        self.relaxed.load(Ordering::Relaxed)
    }

    /// How often another engine was put under the strings.
    pub fn exchanges(&self) -> u32 {
        self.exchanges.load(Ordering::Relaxed)
    }

    /// How often what was asked for could not be built.
    pub fn refusals(&self) -> u32 {
        self.refusals.load(Ordering::Relaxed)
    }

    /// A block has gone out.
    pub fn see_output(&self, left: &[f32], right: &[f32]) {
        for (meter, samples) in [(&self.left, left), (&self.right, right)] {
            let peak = samples.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
            meter.fetch_max(peak, Ordering::Relaxed);
        }
    }

    /// So much of the time was spent, and contacts are solved less exactly or not.
    pub fn see_load(&self, load: f64, relaxed: bool) {
        self.load.store(load as f32, Ordering::Relaxed);
        self.relaxed.store(relaxed, Ordering::Relaxed);
    }

    pub(super) fn count_exchange(&self) {
        self.exchanges.fetch_add(1, Ordering::Relaxed);
    }

    pub(super) fn refuse(&self) {
        self.refusals.fetch_add(1, Ordering::Relaxed);
    }
}
