//! Time is counted anew in each window, and what was done in the last one is still there.

use super::*;
use crate::params::Start;
use crate::plugin::shelf::Shelf;

fn history() -> History {
    History::new(Arc::new(LowActionParams::new(Shelf::new(Vec::new()), &Start::default())))
}

#[test]
fn a_step_in_another_window_is_another_entry() {
    let history = history();
    let param = history.params.output.level.as_ptr();
    for (step, (opens, time, entries)) in
        [(true, 3600.0, 1), (false, 3600.1, 1), (true, 0.1, 2), (false, 0.2, 2), (false, 1.0, 3)]
            .into_iter()
            .enumerate()
    {
        if opens {
            history.restart();
        }
        history.look(time);
        history.stepping(|| {
            history.begin(param);
            history.set(param, 0.1 * step as f32);
            history.end(param);
        });
        assert_eq!(history.inside().done.len(), entries, "step {step}");
    }
}

#[test]
fn what_is_not_granted_is_given_up_as_soon_in_another_window() {
    let history = history();
    history.look(3600.0);
    history.asked.ask(history.params.output.level.as_ptr(), 0.3);
    history.restart();
    for (time, is_settled) in [(0.0, false), (1.0, false), (2.0, true)] {
        assert_eq!(history.look(time), is_settled, "{time} s");
    }
}
