//! The instruction sets that a step is compiled for.

use pulp::{Arch, Scalar128b, WithSimd};

/// The instructions by which strings are stepped. Every set gives the same bits: sums have a fixed order and
/// there is no fused multiply-add.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instructions(Arch);

impl Instructions {
    /// The widest of this machine.
    pub fn best() -> Self {
        Instructions(Arch::new())
    }

    /// Those that any processor has.
    pub fn any() -> Self {
        Instructions(Arch::Scalar)
    }

    /// Whether they are those that any processor has.
    #[cfg(test)]
    pub fn is_any(self) -> bool {
        matches!(self.0, Arch::Scalar)
    }

    /// All that this machine has.
    #[cfg(test)]
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::best(), Self::any()];
        #[cfg(target_arch = "x86_64")]
        all.extend(pulp::x86::V3::try_new().map(|set| Instructions(Arch::V3(set))));
        all
    }

    /// Runs what was compiled for them.
    #[inline(always)]
    pub fn run<P: WithSimd>(self, pass: P) -> P::Output {
        match self.0 {
            // Still two lanes at once.
            Arch::Scalar => pass.with_simd(Scalar128b),
            arch => arch.dispatch(pass),
        }
    }
}
