//! Promise: where the sound takes more time than there is, contacts are solved less exactly, in real time alone and
//! only if allowed, and the sound never breaks; offline it is as exact as was asked for, however long it takes.

use low_action_tests::host::{Action, Host, Score, parameter};

/// At this rate and in the best quality a chord takes any machine several times as long as it lasts.
const RATE: f64 = 384_000.0;
const LENGTH: usize = 19_200;

fn score(relax: f64) -> Score {
    let mut score = vec![
        (0, Action::Parameter(parameter("quality"), 3.0)),
        (0, Action::Parameter(parameter("relax"), relax)),
        // The frets are hit, too.
        (0, Action::Parameter(parameter("pluck_force"), 0.8)),
    ];
    // All stopped.
    score.extend([41, 46, 51, 56, 60, 65].map(|key| (1, Action::NoteOn { channel: 0, key, velocity: 110 })));
    score
}

/// The sound of a plugin that was told everything before it was activated.
fn play(mut host: Host, relax: f64) -> Vec<f32> {
    let settings = score(relax).into_iter().filter(|(at, _)| *at == 0).collect();
    host.play(RATE, &settings, 64, &[64]);
    let [left, _] = host.play(RATE, &score(relax), LENGTH, &[1024]);
    left
}

fn level(sound: &[f32]) -> f64 {
    10.0 * (sound.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / sound.len() as f64).log10()
}

#[test]
fn only_in_real_time_and_only_if_allowed() {
    let exact = play(Host::new(), 0.0);
    assert!(exact == play(Host::new(), 1.0), "relaxed offline");
    assert!(exact == play(Host::in_real_time(), 0.0), "relaxed though it is not allowed");
    let relaxed = play(Host::in_real_time(), 1.0);
    assert!(exact != relaxed, "never relaxed");
    // It is the same music, whole.
    assert!(relaxed.iter().all(|sample| sample.is_finite()));
    for (one, other) in exact.chunks_exact(9600).zip(relaxed.chunks_exact(9600)) {
        assert!((level(one) - level(other)).abs() < 1.0, "{} and {} dB", level(one), level(other));
    }
}
