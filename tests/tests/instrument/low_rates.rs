//! Promise: at the lowest rates, too, a draft has its frets where their pitch wants them: grids that cannot tell a fret from its
//! neighbours are not used.

use low_action::engine::{Engine, EngineOptions};
use low_action::performance::PlayerEvent;
use low_action_dsp::intonation::{intonate, stopped_frequencies};
use low_action_dsp::setup::{Intonation, frequency};
use low_action_dsp::{Quality, Setup};
use low_action_tests::pitch::{cents, frequency_near};

const RATES: [f64; 6] = [8e3, 11_025.0, 12e3, 16e3, 22_050.0, 24e3];

/// Set-ups whose frets are put in tune and stop the strings.
fn in_tune() -> impl Iterator<Item = Setup> {
    // Its fingers hardly press; and a wide bridge is off by some cents itself, in `live` as well.
    let others = ["light-fingers", "sitar"];
    let names = Setup::SHIPPED.into_iter().filter(move |name| !others.contains(name));
    let setups = names.map(|name| Setup::shipped(name).expect("it is shipped"));
    setups.filter(|setup| {
        setup.intonation == Intonation::Compensated && !setup.neck.fretless && setup.neck.frets > 0
    })
}

/// What a draft says of its frets, cents off at most and where, at a rate.
fn worst_fret(setup: &Setup, rate: f64) -> (f64, String) {
    let settings = Quality::Draft.settings(rate);
    let mut worst = (0.0_f64, String::new());
    for string in &setup.string {
        let step_rate = settings.ratio(setup, string).value() * rate;
        let placed = intonate(setup, string, settings.stencil, step_rate).expect("it can be tuned");
        let said = stopped_frequencies(setup, string, &placed, settings.stencil, step_rate);
        for (fret, said) in (1..).zip(said.expect("it has been tuned")) {
            let off = cents(said, frequency(string.pitch + setup.tuning + f64::from(fret)));
            if off.abs() > worst.0.abs() {
                worst = (off, format!("{} at fret {fret}", string.name));
            }
        }
    }
    worst
}

/// On a grid twice as wide as frets are apart the nearest place that can be found is up to two semitones off. All that is left is
/// less than 3 cents.
#[test]
fn the_frets_of_a_draft_are_in_tune() {
    let setups: Vec<_> = in_tune().collect();
    assert!(setups.len() >= 14, "nearly all are");
    for setup in setups {
        for rate in RATES {
            let (off, place) = worst_fret(&setup, rate);
            println!("{} at {rate} Hz: {off:.2} cents off, {place}", setup.name);
            assert!(off.abs() < 3.0, "{} at {rate} Hz: {off:.2} cents off, {place}", setup.name);
        }
    }
}

/// Nothing but low rates asks a draft for more than a step a sample.
#[test]
fn a_draft_is_at_the_rate_of_the_host_from_32_khz_on() {
    for rate in [32e3, 44_100.0, 48e3, 192e3] {
        assert_eq!(Quality::Draft.settings(rate).widest_spacing, f64::INFINITY, "{rate} Hz");
    }
}

/// And so it sounds, where it was a semitone off.
#[test]
fn a_draft_sounds_in_tune() {
    let whole = Setup::builtin("electric").expect("it is built in");
    let setup = Setup { string: vec![whole.string[0].clone()], ..whole };
    for (rate, frets) in [(8e3, [13, 19]), (22_050.0, [13, 20])] {
        let options = EngineOptions {
            variation: 0.0,
            quality: Quality::Draft,
            ..EngineOptions::new(setup.clone(), rate)
        };
        let mut engine = Engine::new(&options).expect("it can be built");
        for fret in frets {
            let key = setup.string[0].pitch as u8 + fret;
            engine.reset();
            engine.event(0, PlayerEvent::NoteOn { channel: 0, key, velocity: 60.0 / 127.0 });
            let [mut left, mut right, mut sound] = [(); 3].map(|()| vec![0.0; (0.6 * rate) as usize]);
            engine.process_stems(&mut [&mut sound], &mut left, &mut right);
            let target = frequency(f64::from(key));
            let off = cents(frequency_near(&sound[(0.15 * rate) as usize..], rate, target), target);
            println!("fret {fret} at {rate} Hz: {off:.2} cents off");
            assert!(off.abs() < 5.0, "fret {fret} at {rate} Hz: {off:.2} cents off");
        }
    }
}
