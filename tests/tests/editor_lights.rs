//! Promise: the editor says what a player should know of: that there is not time enough, and that a set-up file of theirs
//! is not played, and why. Otherwise it is silent about both.

use egui_kittest::kittest::Queryable;
use low_action_tests::desk::Desk;

const LATE: &str = "Over budget: contacts are solved less exactly";

#[test]
fn too_little_time() {
    let mut desk = Desk::new();
    assert!(desk.harness.query_by_label(LATE).is_none());
    desk.meters.see_load(0.95, true);
    desk.picture();
    assert!(desk.harness.query_by_label(LATE).is_some());
    desk.meters.see_load(0.4, false);
    desk.picture();
    assert!(desk.harness.query_by_label(LATE).is_none());
}

#[test]
fn a_file_that_is_not_played() {
    let mut desk = Desk::new();
    for message in ["there is no set-up file 3; electric is played instead", &"so long a reason ".repeat(20)]
    {
        desk.params.shelf.tell(Some(message.to_owned()));
        desk.picture();
        assert!(desk.harness.query_by_label(message).is_some(), "{message}");
    }
    desk.params.shelf.tell(None);
    desk.picture();
    assert!(desk.harness.query_by_label_contains("set-up file").is_none());
}
