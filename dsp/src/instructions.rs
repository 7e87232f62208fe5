//! The instruction sets that a step is compiled for.

#[cfg(test)]
mod tests;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod two;
mod vectors;
mod wide;

#[cfg(target_arch = "aarch64")]
use pulp::aarch64::Neon;
#[cfg(target_arch = "x86_64")]
use pulp::x86::{V2, V3, V4};
use pulp::{Scalar128b, Simd, WithSimd};

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use two::Two;
pub(crate) use vectors::Vectors;
use wide::Wide;

/// What is compiled for each instruction set.
pub(crate) trait Pass {
    /// What comes of it.
    type Output;

    /// Done by the vectors of one.
    fn by<V: Vectors>(self, simd: V) -> Self::Output;
}

/// The instructions by which strings are stepped. Every set gives the same bits: sums have a fixed order and
/// there is no fused multiply-add.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Instructions {
    /// Vectors of eight lanes.
    #[cfg(target_arch = "x86_64")]
    Eight(V4),
    /// Of four.
    #[cfg(target_arch = "x86_64")]
    Four(V3),
    /// Of two, as processors of this kind have had since 2008.
    #[cfg(target_arch = "x86_64")]
    Two(V2),
    /// Of two, as all processors of this kind have.
    #[cfg(target_arch = "aarch64")]
    Two(Neon),
    /// What any processor has. (Two lanes at once as well, if the compiler sees them.)
    Any,
}

impl Instructions {
    /// The widest of this machine.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(set) = V4::try_new() {
            return Self::Eight(set);
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(set) = V3::try_new() {
            return Self::Four(set);
        }
        Self::narrow()
    }

    /// Those of a processor that has no wide vectors.
    pub fn narrow() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(set) = V2::try_new() {
            return Self::Two(set);
        }
        #[cfg(target_arch = "aarch64")]
        if let Some(set) = Neon::try_new() {
            return Self::Two(set);
        }
        Self::Any
    }

    /// All that this machine has, the widest first and those that any processor has last.
    #[cfg(test)]
    pub fn all() -> Vec<Self> {
        #[cfg(target_arch = "x86_64")]
        let wide = [V4::try_new().map(Self::Eight), V3::try_new().map(Self::Four)];
        #[cfg(not(target_arch = "x86_64"))]
        let wide: [Option<Self>; 0] = [];
        wide.into_iter().flatten().chain([Self::narrow(), Self::Any]).collect()
    }

    /// Runs what was compiled for them.
    #[inline(always)]
    pub fn run<P: Pass>(self, pass: P) -> P::Output {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Eight(set) => Wide(set).run(pass),
            #[cfg(target_arch = "x86_64")]
            Self::Four(set) => Wide(set).run(pass),
            #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
            Self::Two(set) => Two(set).run(pass),
            Self::Any => pass.by(Wide(Scalar128b)),
        }
    }
}

/// A pass as [`pulp`] takes it, by the vectors that are ours.
struct By<P, V>(P, V);

impl<P: Pass, V: Vectors> WithSimd for By<P, V> {
    type Output = P::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> P::Output {
        self.0.by(self.1)
    }
}
