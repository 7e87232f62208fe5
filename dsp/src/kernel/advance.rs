//! The last pass of a step.

use pulp::{Simd, WithSimd};

use super::lanes::{part_of, rows, rows_mut, vectors};
use crate::field::{Field, LANES};

/// Motion below this, m, is none: what runs ahead of a wave on a silent string would otherwise become a
/// subnormal number, slow on most machines and flushed to zero on some, and the bits would depend on the
/// host. The square of such a motion's last digit is still a normal number.
pub(crate) const STILL: f64 = 1e-120;

/// What the last pass goes from, and where it writes.
pub(crate) struct Advance<'a> {
    /// ψ.
    pub pull: f64,
    /// w, v and u.
    pub from: (&'a Field, &'a Field, &'a Field),
    /// d⁺ and u⁺.
    pub to: (&'a mut Field, &'a mut Field),
}

/// The last pass: d⁺ = w − ψv and u⁺ = u + d⁺; returns the largest |d⁺|.
pub(super) struct LastPass<'a, 'b, const STRETCH: bool>(pub &'a mut Advance<'b>);

impl<const STRETCH: bool> WithSimd for LastPass<'_, '_, STRETCH> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Advance { pull, from: (w, v, u), to: (d_next, u_next) } = self.0;
        let (w, v, u, d_next, u_next) = (rows(w), rows(v), rows(u), rows_mut(d_next), rows_mut(u_next));
        let count = w.len();
        let (v, u, d_next, u_next) = (&v[..count], &u[..count], &mut d_next[..count], &mut u_next[..count]);
        let (pull, still) = (simd.splat_f64s(*pull), simd.splat_f64s(STILL));
        let mut sizes = [0.0; LANES];
        for part in 0..vectors::<S>() {
            let mut largest = simd.splat_f64s(0.0);
            for at in 0..count {
                let d = part_of::<S>(&w[at], part);
                let v = part_of::<S>(&v[at], part);
                let d = if STRETCH { simd.sub_f64s(d, simd.mul_f64s(pull, v)) } else { d };
                let size = simd.abs_f64s(d);
                let d = simd.select_f64s(simd.less_than_f64s(size, still), simd.splat_f64s(0.0), d);
                S::as_mut_simd_f64s(&mut d_next[at]).0[part] = d;
                S::as_mut_simd_f64s(&mut u_next[at]).0[part] = simd.add_f64s(part_of::<S>(&u[at], part), d);
                largest = simd.max_f64s(size, largest);
            }
            S::as_mut_simd_f64s(&mut sizes).0[part] = largest;
        }
        sizes.iter().fold(0.0, |most, &size| if size > most { size } else { most })
    }
}
