//! What each element of a scene costs: over the bare string in instructions, which callgrind counts and
//! which are the same on every run, and in time.

mod baseline;
mod cases;
mod count;

pub use count::{callgrind_is_there, counted_part, instructions_of_parts, instructions_of_run};

use anyhow::{Context, Result, bail, ensure};
use clap::Parser;

use super::{page, threads};
use cases::{BARE, CASES, Case};

/// Where the table stands.
const PAGE: &str = "docs/features.md";
/// How far a count may be from the one in the table: compilers differ, computers hardly do.
const AGREEMENT: f64 = 0.05;

/// Measures what each element of a scene costs over the bare string.
#[derive(Parser)]
#[command(
    name = "cargo xtask measure features",
    after_help = "Examples:\n  cargo xtask measure features            measures and prints the table\n  \
                  cargo xtask measure features --write    puts it into docs/features.md\n  \
                  cargo xtask measure features --quick    counts only, and compares with docs/features.md\n  \
                  cargo xtask measure features --quick --since HEAD~1    and with an earlier version"
)]
struct Arguments {
    /// Count instructions only, and compare with the table in docs/features.md.
    #[arg(long, conflicts_with = "write")]
    quick: bool,
    /// Count an earlier version too and refuse over 5 % more than it takes: a tag or commit, or `auto` for the last
    /// release, or if there is none where this branch left origin/main, or on that the commit before this.
    #[arg(long, value_name = "VERSION")]
    since: Option<String>,
    /// Put the table into docs/features.md.
    #[arg(long)]
    write: bool,
    /// Run one case, as callgrind is told to.
    #[arg(long, hide = true, requires = "part")]
    case: Option<String>,
    /// Which part of it.
    #[arg(long, hide = true)]
    part: Option<String>,
}

/// What was measured of a case.
struct Row {
    case: &'static Case,
    /// Instructions per sample.
    instructions: f64,
    /// Nanoseconds per sample.
    time: Option<f64>,
}

/// Runs the measurement.
pub fn run(arguments: Vec<String>) -> Result<()> {
    let Some(arguments) = super::parse::<Arguments>(arguments)? else { return Ok(()) };
    if let Some(name) = &arguments.case {
        return count::child(name, arguments.part.as_deref() == Some("counted"));
    }
    ensure!(count::callgrind_is_there(), "valgrind is not there, and it counts the instructions: install it");
    if arguments.write {
        // What is counted here would take the place of what was counted with vectors.
        ensure!(
            count::vectors_are_those_of_the_table(),
            "--write: this processor has no AVX2, and {PAGE} has the counts of one that does"
        );
        page::read(PAGE, &page::marks("features"))?;
    }
    let committed = arguments.quick.then(committed).transpose()?;
    let rows = measure(!arguments.quick)?;
    let table = table(&rows);
    println!("{table}");
    check_promises(&rows)?;
    if let Some(committed) = committed {
        if count::vectors_are_those_of_the_table() {
            compare(&rows, &committed)?;
            println!("as in {PAGE}, within {} %", 100.0 * AGREEMENT);
        } else {
            println!("passed over: nothing is compared with {PAGE}, since this processor has no AVX2");
        }
    }
    if let Some(version) = &arguments.since {
        baseline::compare(&rows, version)?;
    }
    if arguments.write {
        page::write(PAGE, &page::marks("features"), &table)?;
    }
    Ok(())
}

fn measure(timed: bool) -> Result<Vec<Row>> {
    let times = if timed {
        eprintln!("times of all");
        count::nanoseconds(CASES)?.into_iter().map(Some).collect()
    } else {
        vec![None; CASES.len()]
    };
    // How many there are does not depend on what else the machine does.
    let counted = threads::each(CASES, |index, case| {
        eprintln!("{} of {}: {}", index + 1, CASES.len(), case.name);
        count::instructions(case)
    });
    let row =
        |((case, time), instructions): (_, Result<f64>)| Ok(Row { case, instructions: instructions?, time });
    CASES.iter().zip(times).zip(counted).map(row).collect()
}

fn row<'a>(rows: &'a [Row], name: &str) -> Result<&'a Row> {
    rows.iter().find(|row| row.case.name == name).with_context(|| format!("`{name}` was not measured"))
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "| | instructions a sample | over the first of its group | ns a sample | over it |\n|---|--:|--:|--:|--:|\n",
    );
    for this in rows {
        let base = rows.iter().find(|row| row.case.name == this.case.over).unwrap_or(this);
        let percent = |part: f64, whole: f64| format!("{:+.1} %", 100.0 * (part / whole - 1.0));
        let is_base = base.case.name == this.case.name;
        let counted = if is_base { String::new() } else { percent(this.instructions, base.instructions) };
        let (time, timed) = match (this.time, base.time) {
            (Some(time), Some(_)) if is_base => (format!("{time:.0}"), String::new()),
            (Some(time), Some(base)) => (format!("{time:.0}"), percent(time, base)),
            _ => Default::default(),
        };
        let name = if is_base { format!("**{}**", this.case.name) } else { this.case.name.to_owned() };
        text += &format!("| {name} | {:.0} | {counted} | {time} | {timed} |\n", this.instructions);
    }
    text
}

/// Cases that are promised to take hardly more instructions than another, and by which part of its at most. The first is what
/// a scene costs that has nothing but a string; the others are out of reach.
const PROMISES: [(&str, &str, f64); 4] = [
    (BARE, cases::BY_HAND, 0.02),
    ("board, out of reach", BARE, 0.15),
    ("22 frets, out of reach", BARE, 0.15),
    ("finger, hovering", BARE, 0.35),
];

/// What must hold whatever the table says.
fn check_promises(rows: &[Row]) -> Result<()> {
    let ringing = row(rows, cases::ONE_RINGS)?.instructions;
    let silent = (row(rows, cases::FIVE_SILENT)?.instructions - ringing) / 5.0;
    println!("a silent string costs {:.2} % of a ringing one", 100.0 * silent / ringing);
    ensure!(
        silent < 0.01 * ringing,
        "a silent string costs {silent:.1} instructions, over 1 % of {ringing:.0}"
    );
    for (name, over, part) in PROMISES {
        let base = row(rows, over)?.instructions;
        let more = row(rows, name)?.instructions - base;
        println!("{name}: {more:.0} instructions more than `{over}`, {:.1} %", 100.0 * more / base);
        ensure!(
            more < part * base,
            "`{name}` takes {more:.0} instructions more than `{over}`: must be under {:.0} % of {base:.0}",
            100.0 * part
        );
    }
    Ok(())
}

/// The counts in the table of the documentation: name and instructions.
fn committed() -> Result<Vec<(String, f64)>> {
    let table = page::read(PAGE, &page::marks("features"))?;
    let rows = table.lines().filter_map(|line| {
        let mut cells = line.split('|').map(str::trim);
        let (name, count) = (cells.nth(1)?, cells.next()?);
        Some((name.trim_matches('*').to_owned(), count.parse().ok()?))
    });
    Ok(rows.collect())
}

/// Refuses counts that are not those of the table, and a table that is not of these cases.
fn compare(rows: &[Row], committed: &[(String, f64)]) -> Result<()> {
    if let Some((name, _)) = committed.iter().find(|(name, _)| rows.iter().all(|row| row.case.name != name)) {
        bail!("{PAGE} has a row for `{name}`, which no case is called: {AGAIN}");
    }
    for row in rows {
        let found = committed.iter().find(|(name, _)| name == row.case.name);
        let (name, stated) = found.with_context(|| format!("{PAGE} has no row for `{}`", row.case.name))?;
        let now = row.instructions;
        ensure!(
            (now / stated - 1.0).abs() <= AGREEMENT,
            "`{name}` takes {now:.0} instructions a sample, but {PAGE} says {stated:.0}: {AGAIN}"
        );
    }
    Ok(())
}

/// What to do about a table that is not what is counted.
const AGAIN: &str = "if that is meant, run `cargo xtask measure features --write`";

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows with the counts of the page.
    fn of_the_page() -> (Vec<Row>, Vec<(String, f64)>) {
        let committed = committed().expect("there is a table");
        let count = |name: &str| committed.iter().find(|(known, _)| known == name).expect("it has a row").1;
        let row = |case: &'static Case| Row { case, instructions: count(case.name), time: None };
        (CASES.iter().map(row).collect(), committed)
    }

    #[test]
    fn the_page_keeps_its_promises() {
        let (mut rows, _) = of_the_page();
        check_promises(&rows).expect("they are kept");
        for (name, over, part) in PROMISES {
            let base = row(&rows, over).expect("it is there").instructions;
            let place = rows.iter().position(|row| row.case.name == name).expect("it is there");
            let before = std::mem::replace(&mut rows[place].instructions, (1.01 + part) * base);
            let refused = check_promises(&rows).expect_err("it is broken").to_string();
            assert!(refused.contains(name), "{refused}");
            rows[place].instructions = before;
        }
    }

    #[test]
    fn the_page_has_each_case_and_no_other() {
        let (rows, mut committed) = of_the_page();
        compare(&rows, &committed).expect("it is what is there");
        let removed = compare(&rows[1..], &committed).expect_err("there is a row too many").to_string();
        assert!(removed.contains(rows[0].case.name), "{removed}");
        committed[2].1 *= 1.06;
        assert!(compare(&rows, &committed).is_err());
        committed.remove(2);
        let missing = compare(&rows, &committed).expect_err("a row is missing").to_string();
        assert!(missing.contains(rows[2].case.name), "{missing}");
    }
}
