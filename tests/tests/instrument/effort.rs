//! The promise: an instrument's contacts are solved as exactly as it is told, on every string, and whatever it is told is brought
//! into the range that scenes have.

use low_action_dsp::{Instrument, Quality, Setup, SolverSettings};

#[test]
fn any_effort_is_brought_into_its_range() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = Instrument::new(&setup, &Quality::Live.settings(48e3)).expect("it can be built");
    let before: Vec<_> =
        (0..instrument.string_count()).map(|string| instrument.model(string).settings).collect();
    for (asked, (max_iterations, tolerance)) in [
        ((7, 1e-9), (7, 1e-9)),
        ((usize::MAX, f64::NAN), (1000, 0.0)),
        ((0, -1.0), (0, 0.0)),
        ((1000, 1e-3), (1000, 1e-3)),
        ((1001, 0.0), (1000, 0.0)),
        ((5, 1.0), (5, 1e-3)),
        ((5, f64::INFINITY), (5, 1e-3)),
        ((5, f64::NEG_INFINITY), (5, 0.0)),
    ] {
        instrument.set_effort(asked.0, asked.1);
        for (string, &before) in before.iter().enumerate() {
            let settings = instrument.model(string).settings;
            assert_eq!(settings, SolverSettings { max_iterations, tolerance, ..before }, "{asked:?}");
        }
    }
}
