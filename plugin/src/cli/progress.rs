//! How far a long computation has come, for someone watching, now or later in a log.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::say;

/// How often a line says how far it has come where there is no terminal to draw on.
const BETWEEN_LINES: Duration = Duration::from_secs(60);

const TEMPLATE: &str = "{msg} {wide_bar} {percent} %, {eta} to go";

/// How many of so many samples are done: a bar on standard error if that is a terminal, and else a line there every
/// minute.
pub(super) struct Progress {
    name: String,
    total: u64,
    bar: Option<ProgressBar>,
    started: Instant,
    next_line: Duration,
}

impl Progress {
    /// Of a song or a scene that is so called, and has so many samples, or as many at most.
    pub fn new(name: String, total: u64) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template(TEMPLATE);
            let style = style.expect("the template is constant and the tests show it");
            let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
            bar.with_style(style).with_message(name.clone())
        });
        Self { name, total, bar, started: Instant::now(), next_line: BETWEEN_LINES }
    }

    /// Of what nobody watches.
    pub fn unseen() -> Self {
        let (started, next_line) = (Instant::now(), Duration::MAX);
        Self { name: String::new(), total: 0, bar: None, started, next_line }
    }

    /// So many samples are done.
    pub fn reach(&mut self, done: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(done);
            return;
        }
        let elapsed = self.started.elapsed();
        if elapsed >= self.next_line {
            self.next_line += BETWEEN_LINES;
            say("progress", &line(&self.name, done, self.total, elapsed.as_secs_f64()));
        }
    }

    /// All of them are.
    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// How many of so many samples are done after so many seconds, and how long the rest will take.
fn line(name: &str, done: u64, total: u64, elapsed: f64) -> String {
    // There may be a few more than was thought: notes that wait for strings.
    let part = done.max(1) as f64 / total.max(done).max(1) as f64;
    let left = elapsed * (1.0 - part) / part;
    let minutes = (left / 60.0).ceil();
    format!("{name}: {:.0} %, about {minutes:.0} min to go", 100.0 * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_is_valid() {
        assert!(ProgressStyle::with_template(TEMPLATE).is_ok());
    }

    #[test]
    fn a_line_says_of_what_how_far_and_how_long() {
        assert_eq!(line("song.mid", 250, 1000, 60.0), "song.mid: 25 %, about 3 min to go");
        assert_eq!(line("song.mid", 990, 1000, 600.0), "song.mid: 99 %, about 1 min to go");
        for (done, total) in [(1000, 1000), (1001, 1000), (0, 0), (512, 0)] {
            assert_eq!(line("song.mid", done, total, 60.0), "song.mid: 100 %, about 0 min to go");
        }
        // That takes long, but it is a number.
        assert_eq!(line("song.mid", 0, 1000, 60.0), "song.mid: 0 %, about 999 min to go");
    }
}
