//! The promise: the music in the documentation is what its source composes.

#[path = "../examples/compose_music/main.rs"]
mod compose_music;

#[test]
fn the_music_of_the_documentation_is_up_to_date() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for (path, bytes) in compose_music::compose() {
        let there = std::fs::read(root.join(&path)).unwrap_or_default();
        assert!(there == bytes, "{path} is old: run `cargo run -p low-action --example compose_music`");
    }
}
