//! The promise: the demo in the repository is what its source composes.

#[path = "../examples/compose_demo.rs"]
mod compose_demo;

#[test]
fn the_demo_is_up_to_date() {
    assert!(
        compose_demo::compose() == low_action::demo::MIDI,
        "run `cargo run -p low-action --example compose_demo`"
    );
}
