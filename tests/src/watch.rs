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
/// for must end it, and doing nothing there must not. `module` is the test's `module_path!()`.
pub fn assert_it_is_kept(module: &str, test: &str) {
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
    // Tests are told apart by their modules, but for that of the program.
    let name = module.split_once("::").map_or(test.into(), |(_, module)| format!("{module}::{test}"));
    let run = |allocates: &str| -> Output {
        let program = std::env::current_exe().expect("this program has a path");
        let mut again = Command::new(program);
        again.args([&name, "--exact", "--nocapture"]).env(VARIABLE, allocates);
        again.output().expect("this program can be run again")
    };
    let says = |done: &Output, words: &str| String::from_utf8_lossy(&done.stdout).contains(words);
    let (quiet, loud) = (run("no"), run("yes"));
    assert!(quiet.status.success() && says(&quiet, AFTER), "{name} does not run by itself: {quiet:?}");
    assert!(
        !loud.status.success() && says(&loud, BEFORE) && !says(&loud, AFTER),
        "nobody keeps watch over allocations: the plugin's feature assert-process-allocs is off"
    );
}
