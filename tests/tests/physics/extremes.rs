//! Promise: no scene and no stream of events makes it blow up, however absurd, as long as it is legal. Numbers
//! stay finite; energy is never above what was put in so far, and the balance closes, both to 1e-9 of what was
//! put in, or to the last digits of the numbers in the balance where these are worth more; at every cap of the
//! solver. `docs/stability.md` says why; `cargo xtask measure extremes` tries very many more.

use xtask::measure::extremes::{Outcome, TOLERANCE, Trial};

/// The seed of the trials, unless `EXTREMES_SEED` says another. It is not that of the long run.
const SEED: u64 = 2;
/// How many are tried here.
const TRIALS: u64 = 300;

#[test]
fn random_scenes_and_streams() {
    let seed = seed();
    println!("seed {seed}");
    // Computed; where rounding alone may be more than the tolerance, and where it was.
    let (mut computed, mut coarse, mut beyond) = (0, 0, 0);
    for number in 0..TRIALS {
        let trial = Trial::random(seed, number);
        if let Outcome::Computed(record) = trial.run() {
            computed += 1;
            coarse += u32::from(record.rounding > TOLERANCE);
            beyond += u32::from(record.created > TOLERANCE || record.open > TOLERANCE);
            if let Some(fault) = record.fault {
                panic!("trial {number} of seed {seed}: {fault}\n{}", trial.to_toml());
            }
        }
    }
    // Refusals may only be rare: a generator of illegal scenes would check nothing.
    assert!(computed * 100 >= TRIALS * 99, "only {computed} of {TRIALS} were computed");
    // And so may be excuses. Of the trials of the long run rounding may be more in 6.8 % (struck strings, which stretch most, among
    // them), and was in 0.12 %: of 300 in 20 with a deviation of 4.3, of which 3 more make 33, and in 0.37, which is more than 3
    // once in 1,700 times.
    let [trials, may_be, was] =
        ["trials", "rounding alone may be more than 1e-9", "of these, it was"].map(counted);
    let expected = |part: f64| TRIALS as f64 * part / trials;
    let most = expected(may_be) + 3.0 * (expected(may_be) * (1.0 - may_be / trials)).sqrt();
    println!("rounding alone may be more in {coarse} of {TRIALS}, {most:.1} at most, and was in {beyond}");
    assert!(
        f64::from(coarse) <= most,
        "rounding alone may be more than {TOLERANCE:e} in {coarse} of {TRIALS}"
    );
    assert!(expected(was) < 0.4, "{was} of {trials}");
    assert!(beyond <= 3, "more than {TOLERANCE:e} is open or created in {beyond} of {TRIALS}");
}

/// The seed of the trials.
fn seed() -> u64 {
    let Some(seed) = std::env::var_os("EXTREMES_SEED") else { return SEED };
    let number = seed.to_str().and_then(|seed| seed.parse().ok());
    number
        .unwrap_or_else(|| panic!("EXTREMES_SEED={seed:?} is refused: it must be a whole number, 0 or more"))
}

/// A number of the page's table of the long run.
fn counted(what: &str) -> f64 {
    let page = include_str!("../../../docs/stability.md");
    let (_, table) = page.split_once("<!-- extremes full -->").expect("the page has the table");
    let (table, _) = table.split_once("<!-- end of extremes full -->").expect("it ends");
    let row = table.lines().find_map(|line| line.strip_prefix(&format!("| {what} | ")));
    let number = row.unwrap_or_else(|| panic!("no row {what}")).trim_end_matches([' ', '|']).replace(',', "");
    number.parse().expect("it is a number")
}

/// How many failed once.
const REGRESSIONS: usize = 19;

/// What failed once is tried for ever.
#[test]
fn regressions() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/regressions/extremes");
    let mut tried = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "toml") {
            let trial = Trial::from_toml(&std::fs::read_to_string(&path).unwrap()).unwrap();
            match trial.run() {
                Outcome::Computed(record) => assert_eq!(record.fault, None, "{}", path.display()),
                Outcome::Refused(reason) => panic!("{} is refused: {reason}", path.display()),
            }
            tried += 1;
        }
    }
    assert_eq!(tried, REGRESSIONS, "regressions are lost, or new ones not counted");
    // What failed and is not mended yet is put one folder down.
    let open = std::fs::read_dir(format!("{folder}/open")).map_or(0, Iterator::count);
    assert_eq!(open, 0, "trials that failed wait in {folder}/open");
}
