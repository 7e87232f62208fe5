//! The last thing that happens to the samples: level and bypass. Neither ever jumps.

use nice_plug::prelude::Smoother;

use crate::params::OutputParams;

/// Time in which the bypass fades the sound out or in, s.
const FADE: f32 = 0.02;

/// Fades, and the state they are in.
#[derive(Debug)]
pub(super) struct Output {
    /// 1 sounds, 0 is bypassed.
    heard: f32,
    /// Change of it in a sample.
    step: f32,
    /// The level of the last sample, dB; none at first.
    level: Option<f32>,
    /// What the sound still has to go to its level, dB, which has been put elsewhere at once: by a session that is loaded.
    behind: f32,
    /// Change of it in a sample.
    catching_up: f32,
}

impl Default for Output {
    fn default() -> Self {
        Self { heard: 1.0, step: 1.0, level: None, behind: 0.0, catching_up: 0.0 }
    }
}

impl Output {
    /// Begins at a sample rate in Hz, bypassed or not.
    pub fn activate(&mut self, sample_rate: f32, bypassed: bool) {
        self.heard = if bypassed { 0.0 } else { 1.0 };
        self.step = 1.0 / (FADE * sample_rate).max(1.0);
        (self.level, self.behind) = (None, 0.0);
    }

    /// Multiplies the samples by level and bypass; 0 dB leaves them as they are.
    pub fn shape(
        &mut self,
        params: &OutputParams,
        left: &mut [f32],
        right: &mut [f32],
        stems: &mut [&mut [f32]],
    ) {
        let goal = if params.bypass.value() { 0.0 } else { 1.0 };
        let level: &Smoother<f32> = &params.level.smoothed;
        let now = level.previous_value();
        let last = self.level.unwrap_or(now);
        if last != now && (last - now).is_finite() {
            self.behind += last - now;
            self.catching_up = self.step * self.behind.abs();
        }
        if !level.is_smoothing() && self.heard == goal && self.behind == 0.0 {
            self.level = Some(now);
            let gain = decibels_to_gain(level.next()) * goal;
            if gain != 1.0 {
                for channel in [left, right].into_iter().chain(stems.iter_mut().map(|stem| &mut **stem)) {
                    channel.iter_mut().for_each(|sample| *sample = scaled(*sample, gain));
                }
            }
            return;
        }
        for i in 0..left.len() {
            self.heard += (goal - self.heard).clamp(-self.step, self.step);
            self.behind -= self.behind.clamp(-self.catching_up, self.catching_up);
            let gain = decibels_to_gain(level.next() + self.behind) * self.heard;
            left[i] = scaled(left[i], gain);
            right[i] = scaled(right[i], gain);
            stems.iter_mut().for_each(|stem| stem[i] = scaled(stem[i], gain));
        }
        self.level = Some(level.previous_value());
    }
}

/// A sample at another level. One that is too small for a whole mantissa becomes 0: such numbers cost hosts time,
/// and nobody hears −750 dB.
fn scaled(sample: f32, gain: f32) -> f32 {
    let scaled = sample * gain;
    if scaled.is_subnormal() { 0.0 } else { scaled }
}

/// A factor of the amplitude out of decibels; exactly 1 at 0 dB, and where a host sends what is no number.
fn decibels_to_gain(decibels: f32) -> f32 {
    if decibels.is_nan() {
        return 1.0;
    }
    libm::powf(10.0, decibels / 20.0)
}

#[cfg(test)]
mod tests {
    use super::{FADE, Output, decibels_to_gain, scaled};
    use crate::params::OutputParams;

    /// A session that is loaded sets the level at once.
    #[test]
    fn a_level_that_is_put_elsewhere_is_gone_to() {
        const RATE: f32 = 48_000.0;
        let (params, mut output) = (OutputParams::default(), Output::default());
        output.activate(RATE, false);
        let mut play = |count: usize| {
            let [mut left, mut right] = [(); 2].map(|()| vec![1.0; count]);
            output.shape(&params, &mut left, &mut right, &mut []);
            assert_eq!(left, right);
            left
        };
        assert_eq!(play(100), vec![1.0; 100]);
        params.level.smoothed.reset(-12.0);
        // In blocks, and half way back again.
        let mut heard: Vec<f32> = (0..5).flat_map(|_| play(100)).collect();
        params.level.smoothed.reset(0.0);
        heard.extend(play(970));
        params.level.smoothed.reset(-12.0);
        heard.extend(play(970));
        // 12 dB in 20 ms.
        let most = decibels_to_gain(12.0 / (FADE * RATE)) - 1.0;
        assert!(heard.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1.01 * most), "it jumps");
        assert!((heard[499] / decibels_to_gain(-12.0 * 500.0 / 960.0) - 1.0).abs() < 1e-3, "{}", heard[499]);
        assert_eq!(heard[500 + 969], 1.0);
        let low = decibels_to_gain(-12.0);
        assert!((heard[heard.len() - 1] / low - 1.0).abs() < 1e-5);
        assert!(play(10).iter().all(|sample| *sample == low));
    }

    #[test]
    fn nothing_subnormal_comes_out() {
        assert_eq!(scaled(1e-37, 1e-3), 0.0);
        assert_eq!(scaled(-0.5, 0.5), -0.25);
    }

    #[test]
    fn no_decibels_are_a_factor_of_one() {
        assert_eq!(decibels_to_gain(0.0), 1.0);
        assert!((decibels_to_gain(-20.0) - 0.1).abs() < 1e-7);
        assert_eq!(decibels_to_gain(f32::NAN), 1.0);
    }
}
