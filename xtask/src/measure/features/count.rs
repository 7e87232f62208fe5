//! Counts instructions with callgrind, and takes time.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};

use super::cases::{BLOCK, Case};

/// Samples run before anything is counted: contacts have settled, waves have crossed the string.
pub const WARM_UP: usize = 4800;
/// Samples counted.
const COUNTED: usize = 4800;
/// Samples of which the time is taken at once, how many such pieces a run has, and how many runs there are.
const PIECE: usize = 38 * BLOCK;
const PIECES: usize = 28;
const RUNS: usize = 15;
// Instruments run whole blocks, and what they leave out would be counted as run.
const _: () =
    assert!(WARM_UP.is_multiple_of(BLOCK) && COUNTED.is_multiple_of(BLOCK) && PIECE.is_multiple_of(BLOCK));

/// Runs a case for what is counted in it: nothing but the warm-up, or the samples to count as well.
pub fn child(name: &str, count: bool) -> Result<()> {
    let mut run = Case::find(name)?.prepare()?;
    run(WARM_UP);
    if count {
        run(COUNTED);
    }
    Ok(())
}

/// Whether callgrind is there.
pub fn callgrind_is_there() -> bool {
    let answer = Command::new("valgrind").arg("--version").output();
    answer.is_ok_and(|answer| answer.status.success())
}

/// Whether this processor computes with the vectors that the table counts.
pub fn vectors_are_those_of_the_table() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        std::arch::is_x86_feature_detected!("avx2")
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        false
    }
}

/// Instructions of a case per sample.
pub fn instructions(case: &Case) -> Result<f64> {
    instructions_of(&std::env::current_exe().context("this program has no path")?, case)
}

/// The same as this program or another version of it runs the case.
pub fn instructions_of(program: &Path, case: &Case) -> Result<f64> {
    let total = |count| total_instructions(program, case.name, count);
    Ok((total(true)? - total(false)?) / COUNTED as f64)
}

/// Instructions of a whole run of this program.
fn total_instructions(program: &Path, name: &str, count: bool) -> Result<f64> {
    let mode = if count { "counted" } else { "warm-up" };
    instructions_of_run(program, &["measure", "features", "--case", name, "--part", mode])
}

/// Instructions of a run of a program.
pub fn instructions_of_run(program: &Path, arguments: &[&str]) -> Result<f64> {
    let files = callgrind(program, &[], arguments)?;
    summary(&files.join("out"))
}

/// Instructions of each [part](counted_part) of a run of a program, in their order.
pub fn instructions_of_parts(program: &Path, arguments: &[&str]) -> Result<Vec<f64>> {
    // Names of functions, whatever their crate and type parameters. One alone cannot do both.
    let options = ["--toggle-collect=*collected_part*", "--dump-after=*counted_part*"];
    let files = callgrind(program, &options, arguments)?;
    let parts = (1..).map(|number| files.join(format!("out.{number}"))).take_while(|file| file.exists());
    parts.map(|file| summary(&file)).collect()
}

/// Does what callgrind counts by itself where it is asked for [parts](instructions_of_parts): it collects while it is in the inner
/// function, and writes down what it has when the outer one is left.
#[inline(never)]
pub fn counted_part(part: impl FnOnce()) {
    collected_part(part);
    // Not the last thing that is done, so that the inner function comes back here.
    std::hint::black_box(());
}

#[inline(never)]
fn collected_part(part: impl FnOnce()) {
    std::hint::black_box(part)();
}

/// Has callgrind run a program; the folder of what it wrote, `out` and what was dumped on the way.
fn callgrind(program: &Path, options: &[&str], arguments: &[&str]) -> Result<Scratch> {
    let files = Scratch::new()?;
    let run = Command::new("valgrind")
        .args(["--tool=callgrind", &format!("--callgrind-out-file={}", files.join("out").display())])
        .args(options)
        .arg(program)
        .args(arguments)
        .output()
        .context("valgrind cannot be run")?;
    ensure!(run.status.success(), "callgrind failed: {}", String::from_utf8_lossy(&run.stderr));
    Ok(files)
}

/// A folder that goes with this.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> Result<Scratch> {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let folder =
            std::env::temp_dir().join(format!("low-action-callgrind-{}-{number}", std::process::id()));
        std::fs::create_dir(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
        Ok(Scratch(folder))
    }

    fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// The total of a callgrind file.
fn summary(path: &Path) -> Result<f64> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix("summary: ").or_else(|| line.strip_prefix("totals: ")) {
            return rest.trim().parse().with_context(|| format!("callgrind wrote `{line}`"));
        }
    }
    bail!("callgrind wrote no summary")
}

/// Nanoseconds of each case per sample. All run in turn, a piece at a time, and of each piece the fastest of some runs
/// counts: what else the machine does falls on all alike, and seldom on the same piece of every run.
pub fn nanoseconds(cases: &[Case]) -> Result<Vec<f64>> {
    let mut fastest = vec![[f64::INFINITY; PIECES]; cases.len()];
    for _ in 0..RUNS {
        let begun = |case: &Case| {
            let mut run = case.prepare()?;
            run(WARM_UP);
            Ok(run)
        };
        let mut runs = cases.iter().map(begun).collect::<Result<Vec<_>>>()?;
        for piece in 0..PIECES {
            for (run, fastest) in runs.iter_mut().zip(&mut fastest) {
                let started = Instant::now();
                run(PIECE);
                fastest[piece] = fastest[piece].min(started.elapsed().as_secs_f64());
            }
        }
    }
    let mean = |pieces: &[f64; PIECES]| pieces.iter().sum::<f64>() / (PIECES * PIECE) as f64;
    Ok(fastest.iter().map(|pieces| 1e9 * mean(pieces)).collect())
}
