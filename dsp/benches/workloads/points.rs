//! Numbers along a string written by hand: in order of place, with room for a whole vector on either side.

use aligned_vec::{AVec, ConstAlign};

/// The most vector lanes of any instruction set that is chosen.
const LANES: usize = 8;

/// Numbers of which the first moving point's begins a cache line, wherever they are put.
pub type Points = AVec<f64, ConstAlign<64>>;

/// Where it stands.
pub const FIRST: usize = LANES;

/// Numbers at the moving points, and 0 beside them.
pub fn points(numbers: &[f64]) -> Points {
    let room = (numbers.len().div_ceil(LANES) + 2) * LANES;
    let mut points = Points::from_iter(64, std::iter::repeat_n(0.0, room));
    points[FIRST..FIRST + numbers.len()].copy_from_slice(numbers);
    points
}
