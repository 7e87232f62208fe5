//! The promise: a harder stroke is not only louder. The string slips off faster, and so is brighter; one that is let go of at once
//! is as bright however soft it is.

use low_action::engine::{Engine, EngineOptions};
use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, Setup, TimedGesture};
use low_action_tests::hands::{EXACT, Neck};
use low_action_tests::numbers::brightness;
use low_action_tests::stage::{at_the_bridge, on};

const RATE: f64 = 48_000.0;
/// From pianissimo to where the first string begins to buzz.
const VELOCITIES: [u8; 3] = [30, 60, 90];

/// How bright the first quarter of a second of a note is, at each velocity.
fn brightnesses(setup: &Setup, string: usize, fret: u8) -> [f64; 3] {
    let spec = setup.string[string].clone();
    let key = spec.pitch as u8 + fret;
    let alone = Setup { string: vec![spec], ..setup.clone() };
    let options = EngineOptions { variation: 0.0, ..EngineOptions::new(alone, RATE) };
    let mut engine = Engine::new(&options).expect("it can be built");
    VELOCITIES.map(|velocity| {
        engine.reset();
        engine.event(0, PlayerEvent::NoteOn { channel: 0, key, velocity: f32::from(velocity) / 127.0 });
        let [mut left, mut right, mut sound] = [(); 3].map(|()| vec![0.0; 13_000]);
        engine.process_stems(&mut [&mut sound], &mut left, &mut right);
        brightness(&sound[960..])
    })
}

/// On open strings, where no finger lands. What is linear is as bright at any velocity: so are strings that nothing touches.
#[test]
fn harder_is_brighter() {
    for name in Setup::BUILTIN {
        let setup = at_the_bridge(&Setup::builtin(name).expect("it is built in"));
        let mut sharp = setup.clone();
        sharp.player.pluck_release = 0.0;
        let last = setup.string.len() - 1;
        for string in [0, last / 2, last] {
            let [soft, medium, hard] = brightnesses(&setup, string, 0);
            let at_once = brightnesses(&sharp, string, 0);
            println!("{name} {string}: {soft:.4}, {medium:.4}, {hard:.4}, at once {at_once:.4?}");
            assert!(medium > soft && hard > 1.05 * medium, "{name} {string}: {soft}, {medium}, {hard}");
            assert!(soft < 0.9 * at_once[0], "{name} {string}: {soft}, at once {}", at_once[0]);
            assert!((at_once[1] / at_once[0] - 1.0).abs() < 1e-3, "{name} {string}: {at_once:?}");
        }
    }
}

/// What it takes to let go goes against the force, up to four times as long as at the hardest.
#[test]
fn a_softer_stroke_lets_go_more_slowly() {
    let neck = Neck::of("electric");
    let hardest = neck.setup.player.pluck_release;
    let pluck = |velocity: u8| {
        let mut gestures: Vec<TimedGesture> = Vec::new();
        let mut player = neck.player(EXACT);
        player.event(0, on(64, velocity), &mut gestures);
        player.advance(4_800, &mut gestures);
        let mut plucks = gestures.iter().filter_map(|timed| match timed.gesture {
            Gesture::Pluck { force, release, .. } => Some((force / neck.setup.player.pluck_force, release)),
            _ => None,
        });
        plucks.next_back().expect("it is plucked")
    };
    for velocity in 1..=127 {
        let (strength, release) = pluck(velocity);
        let expected = hardest * (1.0 / strength).min(4.0);
        assert!((release / expected - 1.0).abs() < 1e-12, "velocity {velocity}: {release} s for {strength}");
    }
    assert_eq!(pluck(127), (1.0, hardest));
}
