//! The comparison of errors with the tables that were committed.

use anyhow::{Context, Result, ensure};

use super::PAGE;
use super::columns::{Agreement, COLUMNS};
use super::table::head;

/// Refuses errors that are not those of the committed tables, column by column.
pub fn compare(now: &str, committed: &str) -> Result<()> {
    let names = COLUMNS.iter().map(|column| column.name.to_owned());
    let title = head(names);
    let first = title.lines().next().unwrap_or_default();
    ensure!(
        committed.contains(first),
        "the table has other columns: run `cargo xtask measure trade --write`"
    );
    for line in now.lines().skip(2) {
        let (name, found) = cells(line).with_context(|| format!("`{line}` is no row"))?;
        let stated = committed.lines().filter_map(cells).find(|(known, _)| *known == name);
        let (_, stated) = stated.with_context(|| format!("{} has no row `{name}`", PAGE))?;
        ensure!(found.len() == stated.len(), "row `{name}` has other columns");
        for (column, (found, stated)) in COLUMNS.iter().zip(found.iter().zip(stated)) {
            let (Ok(found), Ok(stated)) = (found.parse::<f64>(), stated.parse::<f64>()) else {
                ensure!(*found == stated, "`{name}`, {}: {found}, but {} says {stated}", column.name, PAGE);
                continue;
            };
            let Agreement { part, least } = column.agreement;
            ensure!(
                (found - stated).abs() <= least.max(part * stated),
                "`{name}`, {}: {found}, but {} says {stated}: if that is meant, run `cargo xtask measure trade --write`",
                column.name,
                PAGE
            );
        }
    }
    Ok(())
}

/// Name and cells of a row.
fn cells(line: &str) -> Option<(&str, Vec<&str>)> {
    let mut cells = line.strip_prefix('|')?.strip_suffix('|')?.split('|').map(str::trim);
    Some((cells.next()?, cells.collect()))
}

#[cfg(test)]
mod tests {
    use super::{COLUMNS, PAGE, cells, compare, head};
    use crate::measure::page;
    use crate::measure::trade::settings::{Axis, quick};

    #[test]
    fn a_changed_number_is_refused_and_a_last_digit_is_not() {
        let names = || COLUMNS.iter().map(|column| column.name.to_owned());
        let table = |first: &str| {
            let rest = " | 2.00".repeat(COLUMNS.len() - 1);
            format!("{}| 48 kHz, wide | {first}{rest} |\n", head(names()))
        };
        assert!(compare(&table("2.06"), &table("2.01")).is_ok());
        let refused = compare(&table("2.51"), &table("2.01")).unwrap_err().to_string();
        assert!(refused.contains(COLUMNS[0].name) && refused.contains("2.51"), "{refused}");
        assert!(compare(&table("–"), &table("2.00")).is_err());
        assert!(compare(&table("2.00"), "nothing").is_err());
        assert!(compare(&table("NaN"), &table("2.00")).is_err());
    }

    /// Of those that `--quick` compares.
    #[test]
    fn no_number_of_the_page_may_double() {
        let committed = page::read(PAGE, &page::marks("trade")).expect("there are tables");
        for axis in [Axis::Quality, Axis::Grid] {
            for setting in quick(axis) {
                let rows = || committed.lines().filter_map(cells);
                let name = setting.name(axis);
                let (_, numbers) = rows().find(|(known, _)| *known == name).expect("it has a row");
                let table = |numbers: &[String]| {
                    let names = COLUMNS.iter().map(|column| column.name.to_owned());
                    format!("{}| {name} | {} |\n", head(names), numbers.join(" | "))
                };
                let numbers: Vec<String> = numbers.into_iter().map(str::to_owned).collect();
                compare(&table(&numbers), &committed).expect("it is what is there");
                for (place, column) in COLUMNS.iter().enumerate() {
                    let mut doubled = numbers.clone();
                    let number: f64 = numbers[place].parse().expect("it is a number");
                    doubled[place] = (2.0 * number).to_string();
                    assert!(compare(&table(&doubled), &committed).is_err(), "{name}, {}", column.name);
                }
            }
        }
    }
}
