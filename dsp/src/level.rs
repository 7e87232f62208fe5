//! How loud it has been lately.

/// The time over which it looks back, s.
const WINDOW: f64 = 0.05;

/// The largest output of the last while.
#[derive(Debug, Clone)]
pub(crate) struct Level {
    window: u64,
    left: u64,
    present: f64,
    before: f64,
}

impl Level {
    /// Nothing has been heard yet at a rate, Hz.
    pub fn new(sample_rate: f64) -> Self {
        let window = (WINDOW * sample_rate) as u64;
        Level { window, left: window, present: 0.0, before: 0.0 }
    }

    /// Another sample of both channels.
    #[inline]
    pub fn see(&mut self, left: f64, right: f64) {
        if self.left == 0 {
            self.before = self.present;
            self.present = 0.0;
            self.left = self.window;
        }
        self.left -= 1;
        self.present = self.present.max(left.abs()).max(right.abs());
    }

    /// The largest of the last one to two windows.
    pub fn value(&self) -> f64 {
        self.present.max(self.before)
    }

    /// Forgets what was.
    pub fn reset(&mut self) {
        *self = Level { left: self.window, present: 0.0, before: 0.0, ..*self };
    }
}
