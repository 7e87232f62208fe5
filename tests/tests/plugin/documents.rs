//! Promise: the table of parameters in docs/plugin.md is what hosts see, and what is said of qualities, by commands, hosts, the
//! editor and docs/trade.md, is one thing and what was measured.

use low_action::engine::Quality;
use low_action::params::LowActionParams;
use low_action::params::words::heard_of;
use low_action_tests::numbers::largest;
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

/// What docs/trade.md says of a quality to musicians.
fn told(trade: &str, quality: Quality) -> String {
    let begins = format!("\n- **`{quality}` ");
    let (_, told) = trade.split_once(&begins).unwrap_or_else(|| panic!("nothing is told of {quality}"));
    let (told, _) = told.split_once("\n- ").expect("others come after it");
    told.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_is_said_of_qualities_was_measured() {
    let trade = document("trade.md");
    // The second number of these rows is what was found, the first what is allowed.
    let found = |row: &str| numbers(&trade, row)[1];
    let said = |quality: Quality, words: &str| assert!(heard_of(quality).contains(words), "{words}");
    let price = |quality: Quality| match quality {
        Quality::Draft => 1.0,
        _ => found(&format!("`{quality}`: price over that of `draft`")),
    };
    let buzzing = &trade[trade.find("Buzz, and the spacing of the grid").expect("a table")..];
    let strings = ["E4", "B3", "G3", "D3", "A2", "E2"];
    let buzz = |quality: Quality| match quality {
        // It has all strings at the host's rate, 48 kHz in the first column.
        Quality::Draft => largest(strings.map(|string| numbers(buzzing, &format!("{string}, %"))[0])),
        _ => found(&format!("`{quality}`: buzz, %")),
    };
    for quality in Quality::ALL {
        let summary = quality.summary();
        let told = told(&trade, quality);
        // Bounds are no closer than what was found, and not much wider.
        let (_, words) = summary.split_once("buzz within ").expect("it says so");
        let bound: f64 = words.trim_end_matches(" %").parse().expect("a bound");
        assert!((0.5 * bound..bound).contains(&buzz(quality)), "{quality}: {} %", buzz(quality));
        assert!(told.contains(&format!(" {words}")), "{quality}: {told}");
        if let Some((times, _)) = summary.split_once(" × the work") {
            let found = price(quality) / price(Quality::Live);
            // In whole numbers, of times that differ by some ten per cent from run to run.
            let said: f64 = times.parse().expect("a number");
            assert!(said.fract() == 0.0 && (said - found).abs() < 0.5 + 0.1 * found, "{quality}: {found} ×");
            assert!(told.contains(&format!("{times} × the work of `live`")), "{quality}: {told}");
        }
    }
    assert!(Quality::Draft.summary().contains("least work") && price(Quality::Live) > 1.0);
    said(Quality::Draft, "A little less work");
    assert!((0.85..0.98).contains(&price(Quality::Live).recip()));
    said(Quality::Draft, "too short at the highest frets");
    // The last number is how long the reference rings.
    for (string, least, most) in [("E4", 0.5, 0.9), ("B3", 0.9, 1.1), ("G3", 0.9, 1.1)] {
        let ringing = numbers(&trade, &format!("{string}, fret 21, T60, s"));
        assert!((least..most).contains(&(ringing[0] / ringing[ringing.len() - 1])), "{string}");
    }
    assert!(Quality::Live.summary().contains("within 1 cent"));
    assert!(found("`live`: partials of every open string, up to 4 kHz, cents") < 1.0);
    assert!(found("`live`: pitch of stopped strings before they are put in tune, cents") < 1.0);
    // That is `instrument/tuning.rs`'s to hold once they are.
    let high = "`live`: pitch of light strings stopped high on the neck, before they are put in tune, cents";
    assert!((1.0..=1.25).contains(&found(high)));
    assert!(told(&trade, Quality::Live).contains("before that they are within a cent and a quarter"));
    said(Quality::Studio, "the highest frets are within a cent");
    for (string, fret) in
        ["E4", "B3", "G3"].into_iter().flat_map(|string| [12, 15, 18, 21].map(|fret| (string, fret)))
    {
        // Four rates come before `live` and `studio`.
        assert!(
            numbers(&trade, &format!("{string}, fret {fret}, cents off"))[5] < 1.0,
            "{string}, fret {fret}"
        );
    }
    said(Quality::Reference, "The fastest computers just have time for it");
    // They play `live` faster than the machine that wrote the tables, and `reference` as much faster.
    let chord = &trade[trade.find("Six strings fretted and ringing").expect("a table")..];
    let [live, reference] = ["live", "reference"].map(|name| numbers(chord, &format!("`{name}`, 48 kHz"))[0]);
    assert!((0.8..1.5).contains(&(reference * fastest(&document("speed.md")) / live)));
}

/// How many times faster than real time the fastest of the machines of docs/speed.md plays `live`.
fn fastest(speed: &str) -> f64 {
    let (_, machines) = speed.split_once("| core | `live` |").expect("a table of machines");
    let rows = machines.lines().skip(2).take_while(|line| line.starts_with('|'));
    let live = rows.map(|row| row.split(['|', '×']).nth(2)?.trim().parse::<f64>().ok());
    live.map(|times| times.expect("a number")).fold(0.0, f64::max)
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

/// Who is told that a log says something has to find it.
#[test]
fn the_log_can_be_found() {
    let document = document("plugin.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let (before, section) = document.split_once("## The log ").expect("there is a section about it");
    let (section, after) = section.split_once(" ## ").expect("others come after it");
    for words in ["standard error", "on Windows to a debugger", "`NICE_LOG`", "names a file"] {
        assert!(section.contains(words), "where it is: {words}");
    }
    let elsewhere = [before, after].concat();
    assert!(elsewhere.matches("[the log](#the-log)").count() >= 4);
    assert_eq!(elsewhere.matches("the log").count(), elsewhere.matches("[the log](#the-log)").count());
}
