//! Promise: light strings are computed at a multiple of the host's rate, and nobody hears more of that than
//! a better sound. All strings come equally late at every multiple, by what hosts are told; gestures act at
//! their exact sample; one multiple takes over from another without a click, and the ledger closes.

use low_action_dsp::{
    EngineSettings, Gesture, Instrument, Model, Quality, Ratio, Setup, StringParameters, TimedGesture,
};
use low_action_tests::clicks::{click, smallest_jump, with_jump};
use low_action_tests::numbers::rms;
use low_action_tests::stage::peak;

const RATE: f64 = 48_000.0;

/// A guitar, its strings plucked softly one after another, and what each sounds like.
fn stems(settings: &EngineSettings, first: u64) -> Vec<Vec<f32>> {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = Instrument::new(&setup, settings).expect("it can be built");
    for string in 0..instrument.string_count() {
        let position = instrument.geometry(string).length - setup.player.pluck_position;
        let gesture =
            Gesture::Pluck { position, force: 0.1, duration: setup.player.pluck_duration, release: 0.0 };
        let time = first + 100 * string as u64;
        instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
    }
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; 4800]);
    let mut stems = vec![vec![0.0; 4800]; instrument.string_count()];
    let mut parts: Vec<&mut [f32]> = stems.iter_mut().map(Vec::as_mut_slice).collect();
    instrument.process_stems(&mut parts, &mut left, &mut right);
    stems
}

/// Rates and strings that cannot be are refused, and nobody looks for a grid for ever.
#[test]
fn what_cannot_be_computed_is_refused() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let spec = &setup.string[0];
    let steel = StringParameters {
        length: setup.neck.scale_length,
        linear_density: 4e-4,
        tension: 70.0,
        tension_limit: 90.0,
        youngs_modulus: 2e11,
        core_radius: 1.2e-4,
        loss_0: 1.0,
        loss_1: 1e-4,
        tension_modulation: true,
    };
    let solver = Quality::Live.settings(RATE).solver();
    let model = |string, rate| Model::new(string, None, 1, solver, rate).map(|_| ());
    assert!(model(steel, RATE).is_ok());
    for wrong in [0.0, -48e3, 1e-300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let settings = Quality::Live.settings(wrong);
        assert!(settings.ratio(&setup, spec).value() >= 1.0, "{wrong} Hz");
        assert!(Instrument::new(&setup, &settings).is_err(), "{wrong} Hz");
        assert!(model(steel, wrong).is_err(), "{wrong} Hz");
        let above_zero = [
            StringParameters { length: wrong, ..steel },
            StringParameters { linear_density: wrong, ..steel },
            StringParameters { tension: wrong, ..steel },
            StringParameters { tension_limit: wrong, ..steel },
        ];
        let zero_or_more = [
            StringParameters { youngs_modulus: wrong, ..steel },
            StringParameters { core_radius: wrong, ..steel },
            StringParameters { loss_0: wrong, ..steel },
            StringParameters { loss_1: wrong, ..steel },
        ];
        // (What is next to nothing, but above it, may be a string or none.)
        let number = wrong.is_finite();
        for (strings, may_be) in [(above_zero, number && wrong > 0.0), (zero_or_more, number && wrong >= 0.0)]
        {
            for string in strings {
                let refused = model(string, RATE).is_err();
                assert!(refused || may_be, "{string:?}");
            }
        }
    }
}

/// So are grids too fine to be made, by name; none is too wide.
#[test]
fn the_widest_spacing_has_a_range() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let build = |widest_spacing| {
        Instrument::new(&setup, &EngineSettings { widest_spacing, ..Quality::Live.settings(RATE) })
    };
    for wrong in [0.0, -1.0, 9.9e-5, f64::NAN, f64::NEG_INFINITY] {
        let error = build(wrong).err().unwrap_or_else(|| panic!("{wrong} m are accepted")).to_string();
        assert!(
            error.starts_with("widest_spacing = ") && error.contains("1e-4 m or more"),
            "{wrong}: {error}"
        );
    }
    for right in [1e-4, f64::INFINITY] {
        assert!(build(right).is_ok(), "{right} m");
    }
}

#[test]
fn light_strings_get_more_and_higher_host_rates_need_less() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let ratios = |quality: Quality, rate: f64| -> Vec<Ratio> {
        let settings = quality.settings(rate);
        setup.string.iter().map(|string| settings.ratio(&setup, string)).collect()
    };
    let live = ratios(Quality::Live, RATE);
    assert!(live[0] > Ratio::ONE && live[5] == Ratio::ONE && live.is_sorted_by(|a, b| a >= b), "{live:?}");
    // Two samples of the host's may share a step.
    assert!(live.contains(&Ratio::of_halves(3)), "{live:?}");
    for quality in Quality::ALL {
        assert!(
            ratios(quality, 4.0 * RATE).iter().zip(ratios(quality, RATE)).all(|(high, low)| *high <= low)
        );
        // The rate of a string is about the same whatever the host's.
        for (high, low) in ratios(quality, 2.0 * RATE).into_iter().zip(ratios(quality, RATE)) {
            let apart = (2 * high.halves()).abs_diff(low.halves());
            assert!(apart <= 1 || high == Ratio::ONE, "{high} at 96 kHz, {low} at 48 kHz");
        }
    }
    assert!(ratios(Quality::Draft, RATE).iter().all(|ratio| *ratio == Ratio::ONE));
}

#[test]
fn every_string_is_as_late_as_hosts_are_told() {
    const FIRST: u64 = 300;
    let alone = EngineSettings { widest_spacing: f64::INFINITY, ..Quality::Live.settings(RATE) };
    let (once, often) = (stems(&alone, FIRST), stems(&Quality::Studio.settings(RATE), FIRST));
    for (string, (once, often)) in once.iter().zip(&often).enumerate() {
        let start = (FIRST + 100 * string as u64) as usize + Instrument::LATENCY as usize;
        // Nothing sounds before: a low-pass rings 100 dB below what comes, and a pluck comes slowly.
        let before = peak(&often[..start]);
        let peak = peak(often);
        assert!(before < 1e-4 * peak, "string {string}: {before:e} of {peak:e} too early");
        // The first 10 ms are the same at both multiples but for the grids' own errors and for velocities being those of half a
        // step later, up to 0.4 samples: nearest at no shift.
        let off = |shift: isize| {
            let apart = |n: usize| often[(n as isize + shift) as usize] - once[n];
            let apart: Vec<f32> = (start..start + 480).map(apart).collect();
            rms(&apart) / rms(&once[start..start + 480])
        };
        let errors = [-1, 0, 1].map(off);
        println!("string {string}: {errors:.3?}");
        assert!(errors[1] < errors[0] && errors[1] < errors[2], "string {string}: {errors:?}");
    }
}

#[test]
fn a_gesture_acts_at_its_sample_at_every_multiple() {
    for quality in [Quality::Live, Quality::Studio] {
        let settings = quality.settings(RATE);
        let (early, late) = (stems(&settings, 300), stems(&settings, 337));
        for (early, late) in early.iter().zip(&late) {
            assert!(early[..4700].iter().zip(&late[37..]).all(|(a, b)| a.to_bits() == b.to_bits()));
        }
    }
}

#[test]
fn one_multiple_takes_over_from_another() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let build = |quality: Quality| Instrument::new(&setup, &quality.settings(RATE)).expect("it can be built");
    for (from, to) in [
        (Quality::Draft, Quality::Live),
        (Quality::Live, Quality::Studio),
        (Quality::Studio, Quality::Draft),
        (Quality::Live, Quality::Draft),
    ] {
        let mut instrument = build(from);
        instrument.open_ledgers();
        let fretting = setup.player.fretting;
        for string in 0..instrument.string_count() {
            let geometry = instrument.geometry(string).clone();
            let place = geometry.finger_position(5 + string);
            let position = geometry.length - setup.player.pluck_position;
            for (time, gesture) in [
                (0, Gesture::Place { finger: 0, touch: fretting.touch, position: place, clearance: 1e-4 }),
                (0, Gesture::Press { finger: 0, force: fretting.force, duration: fretting.landing }),
                (960, Gesture::Pluck { position, force: 0.4, duration: 0.003, release: 0.0 }),
                // A slide and a bend are under way when the change comes.
                (9000, Gesture::Slide { finger: 0, position: place + 0.03, duration: 0.1 }),
                (9000, Gesture::Bend { tension_ratio: 1.1, duration: 0.1 }),
            ] {
                instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
            }
        }
        let mut expected = instrument.clone();
        let play = |instrument: &mut Instrument, samples: usize| {
            let [mut left, mut right] = [(); 2].map(|()| vec![0.0; samples]);
            instrument.process(&mut left, &mut right);
            left
        };
        let mut whole = play(&mut instrument, 9600);
        play(&mut expected, 9600);
        assert!(instrument.hand_over(Box::new(build(to))).is_ok());
        let (found, expected) = (play(&mut instrument, 19_200), play(&mut expected, 19_200));
        whole.extend(&found);
        assert_eq!(click(&whole, 9600), None, "{from} to {to}");
        // And one would be found.
        let jump = smallest_jump(&whole, 9600);
        println!("{from} to {to}: a jump of {:.1e} of the peak is a click", jump / peak(&whole));
        assert!(click(&with_jump(&whole, 9600, jump), 9600).is_some(), "{from} to {to}: {jump:e}");
        // The sound of the other grid: the same for a while, then with its own errors, as loud.
        let difference: Vec<f32> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
        let off = rms(&difference[..960]) / rms(&expected[..960]);
        let level = 20.0 * (rms(&found[9600..]) / rms(&expected[9600..])).log10();
        println!("{from} to {to}: {off:.3} off at first, {level:+.2} dB later");
        // Found are 0.10 at most, of what turns by so much of a radian in 20 ms from `live` to `studio`, and 0.10 dB.
        assert!(off < 0.13, "{from} to {to}: {off}");
        assert!(level.abs() < 0.3, "{from} to {to}: {level} dB");
        for string in 0..instrument.string_count() {
            let ledger = instrument.ledger(string).expect("it is open");
            let worst = ledger.worst_residual;
            assert!(worst <= 1e-14, "{from} to {to}, string {string}: {worst:e}");
            let (energy, put_in) = (ledger.energies().total(), ledger.put_in);
            assert!(energy <= put_in * (1.0 + 1e-9), "{from} to {to}, string {string}: {energy} of {put_in}");
        }
    }
}
