//! The same cases as an earlier version computes them: built beside this one, counted in the same run by the same
//! compiler on the same machine, so that a difference is one of the code.

use std::env::consts::EXE_SUFFIX;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};

use super::Row;
use super::cases::{self, Case};
use super::{count, threads};
use crate::repository::root;

/// How many more instructions than before a case may take.
const WORSE: f64 = 0.05;

/// Where the earlier version is laid out and built.
const FOLDER: &str = "target/baseline";

/// The branch that versions are made from, as a clone knows it.
const TRUNK: &str = "origin/main";

/// The version to compare with: the one named, or the last release before this commit, or where this branch left the trunk, or,
/// on the trunk itself, the commit before.
fn version(named: &str) -> Result<String> {
    if named != "auto" {
        return git(&["rev-parse", "--verify", &format!("{named}^{{commit}}")]);
    }
    if let Ok(tag) = git(&["describe", "--tags", "--abbrev=0", "--match", "v*", "HEAD^"]) {
        return git(&["rev-parse", &format!("{tag}^{{commit}}")]);
    }
    let left_trunk = git(&["merge-base", "HEAD", TRUNK]).ok();
    match left_trunk.filter(|base| git(&["rev-parse", "HEAD"]).is_ok_and(|head| head != *base)) {
        Some(base) => Ok(base),
        None => git(&["rev-parse", "--verify", "HEAD^"]),
    }
}

fn git(arguments: &[&str]) -> Result<String> {
    let out =
        Command::new("git").args(arguments).current_dir(root()).output().context("git cannot be run")?;
    ensure!(
        out.status.success(),
        "git {}: {}",
        arguments.join(" "),
        String::from_utf8_lossy(&out.stderr).trim()
    );
    Ok(String::from_utf8_lossy(&out.stdout).trim().to_owned())
}

/// Whether this is a copy of the repository without its whole history.
fn is_shallow() -> bool {
    git(&["rev-parse", "--is-shallow-repository"]).is_ok_and(|said| said == "true")
}

/// Builds the measuring program of a version; the path of it.
fn build(version: &str) -> Result<PathBuf> {
    let tree = Path::new(FOLDER).join("tree");
    let tree_name = tree.to_string_lossy().into_owned();
    // What an interrupted run left behind.
    let _ = git(&["worktree", "remove", "--force", &tree_name]);
    let _ = git(&["worktree", "prune"]);
    git(&["worktree", "add", "--force", "--detach", &tree_name, version])?;
    let target = root().join(FOLDER).join("build");
    let built = Command::new("cargo")
        .args(["build", "--release", "--locked", "--package", "xtask"])
        .current_dir(root().join(&tree))
        .env("CARGO_TARGET_DIR", &target)
        .stdout(Stdio::null())
        .status()
        .context("cargo cannot be run");
    git(&["worktree", "remove", "--force", &tree_name])?;
    ensure!(built?.success(), "version {version} cannot be built");
    Ok(target.join(format!("release/xtask{EXE_SUFFIX}")))
}

/// What an earlier version takes for the cases that it knows; `count` is how it counts one.
fn earlier(rows: &[Row], count: impl Fn(&Case) -> Result<f64> + Sync) -> Result<Vec<(&Row, f64)>> {
    let mut counted = Vec::new();
    let counts = threads::each(rows, |number, row| {
        eprintln!("{} of {} as before: {}", number + 1, rows.len(), row.case.name);
        count(row.case)
    });
    for (row, count) in rows.iter().zip(counts) {
        let name = row.case.name;
        match count {
            Ok(before) => counted.push((row, before)),
            // It is new.
            Err(error) if format!("{error:#}").contains(&cases::unknown(name)) => (),
            Err(error) => return Err(error.context(format!("the earlier version cannot run `{name}`"))),
        }
    }
    ensure!(!counted.is_empty(), "the earlier version knows none of the cases");
    Ok(counted)
}

/// Counts the cases as an earlier version runs them, prints the difference, and refuses what takes more than
/// before by over 5 %.
pub fn compare(rows: &[Row], named: &str) -> Result<()> {
    let version = match version(named) {
        Ok(version) => version,
        Err(reason) if named == "auto" => {
            // What there is to compare with may be left out of this copy alone.
            if std::env::var("CI").as_deref() == Ok("true") && is_shallow() {
                return Err(
                    reason.context("this copy lacks the commits before this one, and under CI=true must not")
                );
            }
            println!(
                "passed over: nothing is compared with an earlier version, since there is none here: {reason}"
            );
            return Ok(());
        }
        Err(reason) => return Err(reason),
    };
    let short = &version[..version.len().min(9)];
    eprintln!("building version {short} to compare with");
    let program = build(&version)?;
    let counted = earlier(rows, |case| count::instructions_of(&program, case))?;
    let mut worse = Vec::new();
    println!("| | {short} | now | change |\n|---|--:|--:|--:|");
    for (row, before) in counted {
        let change = row.instructions / before - 1.0;
        println!("| {} | {before:.0} | {:.0} | {:+.1} % |", row.case.name, row.instructions, 100.0 * change);
        if change > WORSE {
            worse.push(format!("`{}` by {:.1} %", row.case.name, 100.0 * change));
        }
    }
    if !worse.is_empty() {
        bail!("more instructions than {short}, over 5 %: {}", worse.join(", "));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use anyhow::bail;

    use super::super::cases::CASES;
    use super::*;

    #[test]
    fn only_cases_that_are_new_are_passed_over() {
        let rows: Vec<Row> = CASES.iter().map(|case| Row { case, instructions: 1.0, time: None }).collect();
        let new = CASES[1].name;
        let known = |case: &Case| if case.name == new { bail!("{}", cases::unknown(new)) } else { Ok(1.0) };
        let counted = earlier(&rows, known).expect("all others can be counted");
        assert_eq!(counted.len(), rows.len() - 1);
        assert!(counted.iter().all(|(row, _)| row.case.name != new));
        let message = earlier(&rows, |_| bail!("callgrind failed")).err().map(|error| format!("{error:#}"));
        assert!(message.is_some_and(|message| message.contains("callgrind failed")));
        assert!(earlier(&rows, |case| bail!("{}", cases::unknown(case.name))).is_err());
    }
}
