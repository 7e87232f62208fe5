//! `cargo xtask figures`: draws the pictures of the documentation, and writes `docs/paper.md`, from scenes
//! in the repository.
//!
//! Each figure is one entry of [`FIGURES`] and one module. Scenes are run through the same library as
//! everything else, so that a picture or a number cannot disagree with the code. Beside every picture there
//! is a sound, which stays out of the repository.

mod chaos;
mod convergence;
mod figure_2;
mod figure_3;
mod figure_4;
mod figure_5;
mod figure_5_minute;
mod figure_6;
mod iterations;
mod ledger;
mod modes;
mod page;
mod pitch;
mod running;
mod sound;
mod string_over_frets;
mod strings;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};

use page::Section;
use running::Repository;
use sound::Sound;

/// One picture, with what it shows in words and as sound.
struct Figure {
    /// Its name on the command line; the picture is `docs/figures/NAME.svg`.
    name: &'static str,
    /// Whether it takes so long to compute that `--quick` leaves it out.
    long: bool,
    /// Makes it.
    make: fn(&Repository) -> Result<Made>,
}

/// What a figure comes to.
struct Made {
    /// The picture, as SVG.
    picture: String,
    /// Its section of the page about the paper, if it has one.
    section: Option<Section>,
    /// What it sounds like.
    sounds: Vec<Sound>,
}

const fn quick(name: &'static str, make: fn(&Repository) -> Result<Made>) -> Figure {
    Figure { name, long: false, make }
}

const fn long(name: &'static str, make: fn(&Repository) -> Result<Made>) -> Figure {
    Figure { name, long: true, make }
}

/// Every picture, in the order of the page.
const FIGURES: &[Figure] = &[
    quick("string_over_frets", string_over_frets::make),
    quick("paper_figure_2", figure_2::make),
    quick("paper_figure_3", figure_3::make),
    quick("paper_figure_4", figure_4::make),
    quick("paper_figure_5", figure_5::make),
    long("paper_figure_5_minute", figure_5_minute::make),
    quick("paper_figure_6", figure_6::make),
    quick("paper_iterations", iterations::make),
    quick("beyond_ledger", ledger::make),
    quick("beyond_convergence", convergence::make),
    quick("beyond_strings", strings::make),
    quick("beyond_chaos", chaos::make),
];

/// The page, in `docs`.
const PAGE: &str = "paper.md";

/// Names of the figures, in the order of the page.
pub fn names() -> Vec<&'static str> {
    FIGURES.iter().map(|figure| figure.name).collect()
}

/// Draws the figures named, or all of them, and writes their sections of the page; with `--quick` writes
/// nothing, and compares those that are computed quickly with what is there.
///
/// # Errors
/// When a name is unknown, a scene cannot be read, a file cannot be written, or something differs.
pub fn run(arguments: &[String]) -> Result<()> {
    let is_quick = arguments.iter().any(|word| word == "--quick");
    let names: Vec<_> = arguments.iter().filter(|word| *word != "--quick").collect();
    if let Some(unknown) = names.iter().find(|name| FIGURES.iter().all(|figure| figure.name != **name)) {
        bail!("unknown figure `{unknown}`: there are {}", self::names().join(", "));
    }
    let repository = Repository::find();
    let page = repository.docs().join(PAGE);
    let present = fs::read_to_string(&page).unwrap_or_default();
    let mut outcome = if is_quick { Outcome::Compared(Vec::new()) } else { Outcome::Written };
    let mut sections = Vec::new();
    for figure in FIGURES {
        let is_asked_for = names.is_empty() || names.iter().any(|name| *name == figure.name);
        if !is_asked_for || (is_quick && figure.long) {
            sections.extend(page::section_of(&present, figure.name));
            continue;
        }
        let made = (figure.make)(&repository).with_context(|| format!("figure `{}`", figure.name))?;
        let file = repository.docs().join("figures").join(figure.name).with_extension("svg");
        outcome.settle(&file, &made.picture)?;
        sections.extend(made.section.map(|section| section.markdown(figure.name)));
        if !is_quick {
            made.sounds.iter().try_for_each(|sound| sound.write(&repository.sounds()))?;
        }
    }
    outcome.settle(&page, &page::assemble(&sections))?;
    outcome.finish()
}

/// What becomes of a text that was made.
enum Outcome {
    /// It is written.
    Written,
    /// It is compared with the file; here are those that differ.
    Compared(Vec<String>),
}

impl Outcome {
    fn settle(&mut self, file: &Path, text: &str) -> Result<()> {
        match self {
            Outcome::Written => {
                fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))?;
                println!("wrote {}", file.display());
            }
            Outcome::Compared(different) => {
                let present = fs::read_to_string(file).unwrap_or_default();
                match first_difference(&present, text) {
                    None => println!("as it should be: {}", file.display()),
                    Some(where_to_look) => different.push(format!("{}: {where_to_look}", file.display())),
                }
            }
        }
        Ok(())
    }

    fn finish(self) -> Result<()> {
        match self {
            Outcome::Compared(different) if !different.is_empty() => bail!(
                "not what `cargo xtask figures` makes of the scenes (run it, look at the change, commit it):\n{}",
                different.join("\n")
            ),
            _ => Ok(()),
        }
    }
}

/// The first line in which two texts differ, and both versions of it.
fn first_difference(present: &str, made: &str) -> Option<String> {
    if present == made {
        return None;
    }
    let short = |line: &str| line.chars().take(160).collect::<String>();
    let (mut old, mut new) = (present.lines(), made.lines());
    let mut number = 1;
    loop {
        match (old.next(), new.next()) {
            (None, None) => return Some("it ends in another way".into()),
            (old, new) if old == new => number += 1,
            (old, new) => {
                let (old, new) = (short(old.unwrap_or("nothing")), short(new.unwrap_or("nothing")));
                return Some(format!("line {number}\n  there: {old}\n  made:  {new}"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::first_difference;

    #[test]
    fn differences_are_found_wherever_they_are() {
        assert!(first_difference("a\nb\n", "a\nb\n").is_none());
        for (present, made) in [("", "a"), ("a\nb", "a\nc"), ("a\nb", "a"), ("a", "a\n")] {
            assert!(first_difference(present, made).is_some(), "{present:?} {made:?}");
        }
        assert!(first_difference("a\nb", "a\nc").unwrap().contains("line 2"));
    }
}
