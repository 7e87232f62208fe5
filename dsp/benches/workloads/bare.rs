//! The shortest string there is: linear, flexible, lossless, touching nothing, written by hand.

use pulp::{Arch, Simd, WithSimd};

use super::SAMPLES;
use super::points::{FIRST, Points, points};

/// What is done to it.
#[derive(Debug, Clone, Copy)]
pub enum Linear {
    /// Its two arrays are copied, which is what memory alone would take.
    Copied,
    /// It is stepped: d += λ²δ²u, u += d.
    Stepped,
}

/// Displacement and motion.
pub struct Bare {
    arch: Arch,
    displacement: Points,
    motion: Points,
    unknowns: usize,
}

impl Bare {
    /// A string of so many moving points in the shape of a triangle.
    pub fn new(unknowns: usize) -> Self {
        let height = |point: usize| 1e-3 * point.min(unknowns + 1 - point) as f64 / unknowns as f64;
        let displacement: Vec<f64> = (1..=unknowns).map(height).collect();
        let motion = points(&vec![0.0; unknowns]);
        Bare { arch: Arch::new(), displacement: points(&displacement), motion, unknowns }
    }

    /// [`SAMPLES`] samples.
    pub fn run(&mut self, linear: Linear) {
        for _ in 0..SAMPLES {
            match linear {
                Linear::Copied => {
                    let (u, d) = (self.displacement.as_slice(), self.motion.as_mut_slice());
                    d.copy_from_slice(std::hint::black_box(u));
                    let (u, d) = (self.displacement.as_mut_slice(), self.motion.as_slice());
                    u.copy_from_slice(std::hint::black_box(d));
                }
                Linear::Stepped => {
                    let (u, d) = (&mut self.displacement[..], &mut self.motion[..]);
                    self.arch.dispatch(Step { u, d, unknowns: self.unknowns });
                    // What the last vector wrote beyond the end.
                    u[FIRST + self.unknowns..].fill(0.0);
                    d[FIRST + self.unknowns..].fill(0.0);
                }
            }
        }
    }
}

struct Step<'a> {
    u: &'a mut [f64],
    d: &'a mut [f64],
    unknowns: usize,
}

/// λ² = (ck/h)².
const COURANT: f64 = 0.9;

impl WithSimd for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Step { u, d, unknowns } = self;
        let count = unknowns.div_ceil(S::F64_LANES);
        let courant = simd.splat_f64s(COURANT);
        let points = [FIRST - 1, FIRST, FIRST + 1].map(|first| &S::as_simd_f64s(&u[first..]).0[..count]);
        let motion = &mut S::as_mut_simd_f64s(&mut d[FIRST..]).0[..count];
        for at in 0..count {
            let after = simd.sub_f64s(points[2][at], points[1][at]);
            let before = simd.sub_f64s(points[1][at], points[0][at]);
            let curvature = simd.sub_f64s(after, before);
            motion[at] = simd.add_f64s(motion[at], simd.mul_f64s(courant, curvature));
        }
        let place = &mut S::as_mut_simd_f64s(&mut u[FIRST..]).0[..count];
        for at in 0..count {
            place[at] = simd.add_f64s(place[at], motion[at]);
        }
    }
}
