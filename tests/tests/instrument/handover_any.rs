//! Promise: whatever two set-ups are exchanged under ringing strings, the ledger books what the change does to the energy and
//! closes in every sample, and nothing blows up.

use low_action_dsp::{Instrument, Setup};
use low_action_tests::cases::cases;
use low_action_tests::ringing::{build, play, strike};
use low_action_tests::stage::peak;
use proptest::prelude::*;

/// What set-ups are made from: those built in and some of other lengths, numbers of strings and necks.
const BASES: [&str; 9] = [
    "electric",
    "classical",
    "steel",
    "bass",
    "baritone",
    "drop-d",
    "ukulele",
    "five-string-bass",
    "fretless-bass",
];

/// A set-up out of numbers from 0 to 1.
fn any_setup(which: usize, numbers: &[f64]) -> Setup {
    let mut setup = Setup::shipped(BASES[which]).expect("it comes with the program");
    setup.neck.nut_clearance = 5e-5 + 1e-3 * numbers[0];
    setup.neck.action = setup.neck.nut_clearance + 5e-3 * numbers[1];
    setup.neck.relief = (1e-3 * numbers[2]).min(setup.neck.most_relief());
    setup.neck.fret_height = 2e-3 * numbers[3];
    setup.tuning = 10.0 * numbers[4] - 5.0;
    setup.tension_modulation = numbers[5] > 0.3;
    setup.blend = numbers[6];
    for string in &mut setup.string {
        string.loss_0 *= 4.0 * numbers[7];
        string.linear_density *= 0.97 + 0.06 * numbers[8];
    }
    setup
}

/// The ledger of every string has closed in every sample so far.
///
/// A string that only hears others moves with the bridge, w: it holds Tw²/2L, out of what the bridge pushes, Tw²/h, and what the
/// points next to it push back. So its balance is known to some 2(L/h)ε of what it holds, for each of the two.
fn books(instrument: &Instrument, over_body: bool) -> Result<(), TestCaseError> {
    for string in 0..instrument.string_count() {
        let ledger = instrument.ledger(string).expect("it is open");
        let intervals = instrument.model(string).grid.intervals as f64;
        let known = if over_body { 4.0 * intervals * f64::EPSILON } else { 1e-14 };
        prop_assert!(ledger.worst_residual <= known, "string {string}: {:e}", ledger.worst_residual);
        let sum = ledger.residual_sum.abs();
        prop_assert!(sum <= 1e-12 * ledger.largest, "string {string}: {sum:e} of {:e}", ledger.largest);
        let energy = ledger.energies().total();
        prop_assert!(energy <= ledger.put_in * (1.0 + 1e-9) + 1e-15, "string {string}: {energy:e}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(16))]

    #[test]
    fn the_ledger_closes(
        bases in proptest::collection::vec(0..BASES.len(), 2),
        setups in proptest::collection::vec(proptest::collection::vec(0.0..1.0_f64, 9), 3),
        samples in 300_usize..3000,
    ) {
        // Once much the same strings, once perhaps others.
        let bases = [bases[0], bases[0], bases[1]];
        let setups: Vec<Setup> = bases.iter().zip(&setups).map(|(base, numbers)| any_setup(*base, numbers)).collect();
        let over_body = setups.iter().any(|setup| setup.body.is_some());
        let mut instrument = build(&setups[0]);
        instrument.open_ledgers();
        strike(&mut instrument, &setups[0]);
        let mut sound = Vec::new();
        play(&mut instrument, samples, &mut sound);
        for (setup, base) in setups[1..].iter().zip(&bases[1..]) {
            prop_assert!(peak(&sound[sound.len() - samples.min(300)..]) > 0.0, "nothing is handed over");
            // Ledgers of strings that do not go on stay behind.
            books(&instrument, over_body)?;
            prop_assert!(instrument.hand_over(Box::new(build(setup))).is_ok());
            if instrument.ledger(0).is_none() {
                // Other strings, which begin at rest.
                prop_assert!(*base != bases[0], "much the same strings do not go on");
                instrument.open_ledgers();
                strike(&mut instrument, setup);
            }
            play(&mut instrument, samples.max(960), &mut sound);
            instrument.take_before();
        }
        prop_assert!(sound.iter().all(|sample| sample.is_finite()));
        books(&instrument, over_body)?;
    }
}
