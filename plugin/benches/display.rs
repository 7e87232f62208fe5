//! How long a snapshot of the strings takes, which the audio thread makes sixty times a second while an editor is
//! open: under 50 µs is the promise, one part in three hundred of a sixtieth of a second.

use criterion::{Criterion, criterion_group, criterion_main};
use low_action::display::{Health, Writer, display};
use low_action::engine::{Engine, EngineOptions};
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;

/// Hz.
const RATE: f64 = 48_000.0;
/// As many samples as lie between two snapshots.
const BLOCK: usize = 800;

/// What `.ci/run` has callgrind count.
#[inline(never)]
fn one_snapshot(writer: &mut Writer, engine: &mut Engine) {
    assert!(writer.write(engine, BLOCK, Health::default()));
}

fn snapshot(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("snapshot");
    for name in ["electric", "sitar"] {
        let setup = Setup::shipped(name).expect("it comes with the program");
        let keys: Vec<u8> = setup.string.iter().map(|string| string.pitch.round() as u8 + 1).collect();
        let mut engine = Engine::new(&EngineOptions::new(setup, RATE)).expect("it can be built");
        let (mut writer, mut reader) = display();
        let (mut left, mut right) = ([0.0; BLOCK], [0.0; BLOCK]);
        for key in keys {
            engine.event(0, PlayerEvent::NoteOn { channel: 0, key, velocity: 1.0 });
        }
        for _ in 0..10 {
            writer.look(true, &mut engine);
            engine.process(&mut left, &mut right);
        }
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                one_snapshot(&mut writer, &mut engine);
                reader.fetch()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, snapshot);
criterion_main!(benches);
