//! Promise: the table of parameters in docs/plugin.md is what hosts see.

use low_action::params::LowActionParams;
use nice_plug::prelude::{ParamPtr, Params};

/// Name, ends of the range and default of a parameter, as hosts show them.
fn row(id: &str, param: ParamPtr, group: &str) -> String {
    // SAFETY: the parameters live as long as the test holds them.
    let (name, low, high, usual) = unsafe {
        let show = |value: f32| param.normalized_value_to_string(value, true);
        (param.name().to_owned(), show(0.0), show(1.0), show(param.default_normalized_value()))
    };
    format!("| `{id}` | {group} | {name} | {low} | {high} | {usual} |")
}

#[test]
fn the_table_of_parameters_is_what_hosts_see() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/plugin.md");
    let document = std::fs::read_to_string(path).expect("the document is there");
    let params = LowActionParams::default();
    let rows: Vec<String> =
        params.param_map().into_iter().map(|(id, param, group)| row(&id, param, &group)).collect();
    let wanted = rows.join("\n");
    let documented: Vec<&str> = document.lines().filter(|line| line.starts_with("| `")).collect();
    let documented: Vec<&str> =
        documented.into_iter().filter(|line| line.matches('|').count() == 7).collect();
    assert_eq!(documented.join("\n"), wanted, "the table should be\n{wanted}");
}
