//! The instruction sets that a step is compiled for.

#[cfg(target_arch = "x86_64")]
use pulp::Simd;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V2;
use pulp::{Arch, Scalar128b, WithSimd};

/// The instructions by which strings are stepped. Every set gives the same bits: sums have a fixed order and
/// there is no fused multiply-add.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Instructions {
    /// Vectors of four or eight lanes, or of two where a processor has no wider ones.
    Wide(Arch),
    /// Two lanes, as processors of this kind have had since 2008.
    #[cfg(target_arch = "x86_64")]
    Two(V2),
    /// What any processor has. (Two lanes at once as well, if the compiler sees them.)
    Any,
}

impl Instructions {
    /// The widest of this machine.
    pub fn best() -> Self {
        match Arch::new() {
            Arch::Scalar => Self::narrow(),
            arch => Self::Wide(arch),
        }
    }

    /// Those of a processor that has no wide vectors.
    pub fn narrow() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(set) = V2::try_new() {
            return Self::Two(set);
        }
        Self::Any
    }

    /// Whether they are wide.
    #[cfg(test)]
    pub fn are_wide(self) -> bool {
        matches!(self, Self::Wide(_))
    }

    /// All that this machine has, those that any processor has first.
    #[cfg(test)]
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::Any, Self::narrow(), Self::best()];
        #[cfg(target_arch = "x86_64")]
        all.extend(pulp::x86::V3::try_new().map(|set| Self::Wide(Arch::V3(set))));
        all
    }

    /// Runs what was compiled for them.
    #[inline(always)]
    pub fn run<P: WithSimd>(self, pass: P) -> P::Output {
        match self {
            Self::Wide(arch) => arch.dispatch(pass),
            #[cfg(target_arch = "x86_64")]
            Self::Two(set) => Simd::vectorize(set, pass),
            Self::Any => pass.with_simd(Scalar128b),
        }
    }
}
