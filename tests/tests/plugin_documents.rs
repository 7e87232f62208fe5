//! Promise: the table of parameters in docs/plugin.md is what hosts see, and what the editor says of qualities is what was
//! measured in docs/trade.md.

use low_action::engine::Quality;
use low_action::params::LowActionParams;
use low_action::params::words::heard_of;
use low_action_tests::user::isolate;
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

fn document(name: &str) -> String {
    let path = format!("{}/../docs/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("the document is there")
}

/// The numbers of the row of a table that begins so.
fn numbers(document: &str, row: &str) -> Vec<f64> {
    let begins = format!("| {row} |");
    let line = document.lines().find(|line| line.starts_with(&begins));
    let cells = line.unwrap_or_else(|| panic!("there is no row {row:?}"))[begins.len()..].split('|');
    // A cell may have a unit after its number.
    cells.filter_map(|cell| cell.split_whitespace().next()?.parse().ok()).collect()
}

#[test]
fn what_is_said_of_qualities_was_measured() {
    let trade = document("trade.md");
    // The second number of these rows is what was found, the first what is allowed.
    let found = |row: &str| numbers(&trade, row)[1];
    let said = |quality: Quality, words: &str| assert!(heard_of(quality).contains(words), "{words}");
    let price = |quality: &str| found(&format!("`{quality}`: price over that of `draft`"));
    said(Quality::Draft, "A little less work");
    assert!((0.85..0.98).contains(&price("live").recip()));
    said(Quality::Draft, "by up to a half");
    let buzzing = &trade[trade.find("Buzz, and the spacing of the grid").expect("a table")..];
    for string in ["E4", "B3", "G3", "D3", "A2", "E2"] {
        assert!(numbers(buzzing, &format!("{string}, %"))[0] < 50.0, "{string}");
    }
    said(Quality::Draft, "too short at the highest frets");
    // The last number is how long the reference rings.
    for (string, least, most) in [("E4", 0.5, 0.9), ("B3", 0.9, 1.1), ("G3", 0.9, 1.1)] {
        let ringing = numbers(&trade, &format!("{string}, fret 21, T60, s"));
        assert!((least..most).contains(&(ringing[0] / ringing[ringing.len() - 1])), "{string}");
    }
    said(Quality::Live, "within a cent");
    assert!(found("`live`: partials of every open string, up to 4 kHz, cents") < 1.0);
    assert!(found("`live`: pitch of stopped strings, cents") < 1.0);
    said(Quality::Live, "within a quarter");
    assert!(found("`live`: buzz, %") < 25.0);
    said(Quality::Studio, "Three and a half times the work");
    assert!((3.2..3.8).contains(&(price("studio") / price("live"))));
    said(Quality::Studio, "within an eighth");
    assert!(found("`studio`: buzz, %") < 12.5);
    // What hosts show is fewer words and closer bounds.
    for quality in [Quality::Live, Quality::Studio, Quality::Reference] {
        let (_, words) = quality.summary().split_once("buzz within ").expect("it says so");
        let bound: f64 = words.trim_end_matches(" %").parse().expect("a bound");
        assert!(found(&format!("`{quality}`: buzz, %")) < bound, "{quality}");
    }
    said(Quality::Reference, "Twelve times the work");
    assert!((11.0..13.0).contains(&(price("reference") / price("live"))));
    said(Quality::Reference, "the fastest computers just have time for it");
    let chord = &trade[trade.find("Six strings fretted and ringing").expect("a table")..];
    assert!((0.8..1.5).contains(&numbers(chord, "`reference`, 48 kHz")[0]));
}

#[test]
fn the_table_of_parameters_is_what_hosts_see() {
    let document = document("plugin.md");
    isolate();
    let params = LowActionParams::default();
    let rows: Vec<String> =
        params.param_map().into_iter().map(|(id, param, group)| row(&id, param, &group)).collect();
    let wanted = rows.join("\n");
    let documented: Vec<&str> = document.lines().filter(|line| line.starts_with("| `")).collect();
    let documented: Vec<&str> =
        documented.into_iter().filter(|line| line.matches('|').count() == 7).collect();
    assert_eq!(documented.join("\n"), wanted, "the table should be\n{wanted}");
}
