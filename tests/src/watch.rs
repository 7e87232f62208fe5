//! The allocator that keeps watch: whether it does.

use std::hint::black_box;
use std::process::{Command, Output};

// The allocator comes with the plugin.
use low_action as _;
use nice_assert_no_alloc::assert_no_alloc;

/// Tells the test that it is run by itself, and whether to ask for memory.
const VARIABLE: &str = "LOW_ACTION_TESTS_ALLOCATE";
/// What it says before and after.
const BEFORE: &str = "nothing may be allocated now";
const AFTER: &str = "nobody has minded";

/// Runs the test of this name, which calls this, by itself in another process: asking for memory where none may be asked
/// for must end it, and doing nothing there must not.
pub fn assert_it_is_kept(test: &str) {
    if let Ok(allocates) = std::env::var(VARIABLE) {
        println!("{BEFORE}");
        assert_no_alloc(|| {
            if allocates == "yes" {
                drop(black_box(Box::new(black_box(1))));
            }
        });
        println!("{AFTER}");
        return;
    }
    let run = |allocates: &str| -> Output {
        let program = std::env::current_exe().expect("this program has a path");
        let mut again = Command::new(program);
        again.args([test, "--exact", "--nocapture"]).env(VARIABLE, allocates);
        again.output().expect("this program can be run again")
    };
    let says = |done: &Output, words: &str| String::from_utf8_lossy(&done.stdout).contains(words);
    let (quiet, loud) = (run("no"), run("yes"));
    assert!(quiet.status.success() && says(&quiet, AFTER), "{test} does not run by itself: {quiet:?}");
    assert!(
        !loud.status.success() && says(&loud, BEFORE) && !says(&loud, AFTER),
        "nobody keeps watch over allocations: the plugin's feature assert-process-allocs is off"
    );
}
