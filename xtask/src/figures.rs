//! `cargo xtask figures`: draws the pictures of the documentation, and writes `docs/paper.md`, from scenes
//! in the repository.
//!
//! Each figure is one entry of [`FIGURES`] and one module. Scenes are run through the same library as
//! everything else, so that a picture or a number cannot disagree with the code. Beside every picture there
//! is a sound, which stays out of the repository.

mod bodies;
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
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use xtask::files;

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

/// The picture of the README, of which nothing is said on the page.
const WITHOUT_SECTION: &str = "string_over_frets";

/// Every picture, in the order of the page.
const FIGURES: &[Figure] = &[
    quick(WITHOUT_SECTION, string_over_frets::make),
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
    quick("beyond_bodies", bodies::make),
];

/// The page, in `docs`.
const PAGE: &str = "paper.md";

/// Names of the figures, in the order of the page.
pub fn names() -> Vec<&'static str> {
    FIGURES.iter().map(|figure| figure.name).collect()
}

/// Draws the figures named, or all of them, and writes their sections of the page, all of it or nothing; with `--quick` writes
/// nothing, and compares those that are computed quickly with what is there.
///
/// # Errors
/// When a name is unknown, a scene cannot be read, a file cannot be written, or something differs.
pub fn run(arguments: &[String]) -> Result<()> {
    let is_quick = arguments.iter().any(|word| word == "--quick");
    let names: Vec<_> = arguments.iter().filter(|word| *word != "--quick").map(String::as_str).collect();
    let asked_for = asked_for(&names, is_quick)?;
    let repository = Repository::find();
    let page = repository.docs().join(PAGE);
    let present = read(&page)?.unwrap_or_default();
    let (mut made, mut sections, mut sounds) = (Vec::new(), Vec::new(), Vec::new());
    for figure in FIGURES {
        if !asked_for.contains(&figure.name) {
            let section = page::section_of(&present, figure.name);
            ensure!(
                section.is_some() || figure.name == WITHOUT_SECTION,
                "{PAGE} has no section of figure `{0}`: run `cargo xtask figures {0}`",
                figure.name
            );
            sections.extend(section);
            continue;
        }
        eprintln!("{}", figure.name);
        let one = (figure.make)(&repository).with_context(|| format!("figure `{}`", figure.name))?;
        let file = repository.docs().join("figures").join(figure.name).with_extension("svg");
        made.push((file, one.picture));
        sections.extend(one.section.map(|section| section.markdown(figure.name)));
        sounds.extend(one.sounds);
    }
    made.push((page, page::assemble(&sections)));
    if is_quick {
        return compare(&made);
    }
    files::write_all(&made)?;
    made.iter().for_each(|(file, _)| println!("wrote {}", file.display()));
    sounds.iter().try_for_each(|sound| sound.write(&repository.sounds()))
}

/// The names of the figures that are made: those asked for, or all, or all that are quick.
fn asked_for(names: &[&str], is_quick: bool) -> Result<Vec<&'static str>> {
    let all = self::names();
    if let Some(unknown) = names.iter().find(|name| !all.contains(name)) {
        bail!("unknown figure `{unknown}`: there are {}", all.join(", "));
    }
    let long = FIGURES.iter().find(|figure| is_quick && figure.long && names.contains(&figure.name));
    if let Some(Figure { name, .. }) = long {
        bail!("`{name}` takes too long for --quick: name others, or leave out --quick");
    }
    let is_asked_for = |figure: &&Figure| {
        if names.is_empty() { !(is_quick && figure.long) } else { names.contains(&figure.name) }
    };
    Ok(FIGURES.iter().filter(is_asked_for).map(|figure| figure.name).collect())
}

/// The text of a file, if there is one.
fn read(file: &Path) -> Result<Option<String>> {
    match fs::read_to_string(file) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error).with_context(|| format!("cannot read {}", file.display())),
    }
}

/// Refuses texts that are not those of their files.
fn compare(made: &[(PathBuf, String)]) -> Result<()> {
    let mut different = Vec::new();
    for (file, text) in made {
        match first_difference(&read(file)?.unwrap_or_default(), text) {
            None => println!("as it should be: {}", file.display()),
            Some(where_to_look) => different.push(format!("{}: {where_to_look}", file.display())),
        }
    }
    ensure!(
        different.is_empty(),
        "not what `cargo xtask figures` makes of the scenes (run it, look at the change, commit it):\n{}",
        different.join("\n")
    );
    Ok(())
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
    use super::{FIGURES, asked_for, compare, first_difference, names, read};

    #[test]
    fn differences_are_found_wherever_they_are() {
        assert!(first_difference("a\nb\n", "a\nb\n").is_none());
        for (present, made) in [("", "a"), ("a\nb", "a\nc"), ("a\nb", "a"), ("a", "a\n")] {
            assert!(first_difference(present, made).is_some(), "{present:?} {made:?}");
        }
        assert!(first_difference("a\nb", "a\nc").unwrap().contains("line 2"));
    }

    #[test]
    fn what_takes_long_is_not_asked_for_in_haste() {
        assert_eq!(asked_for(&[], false).unwrap(), names());
        let quick = asked_for(&[], true).unwrap();
        assert!(FIGURES.iter().all(|figure| quick.contains(&figure.name) != figure.long));
        assert_eq!(asked_for(&["paper_figure_2"], true).unwrap(), ["paper_figure_2"]);
        assert_eq!(asked_for(&["paper_figure_5_minute"], false).unwrap(), ["paper_figure_5_minute"]);
        let refused = asked_for(&["paper_figure_5_minute"], true).unwrap_err().to_string();
        assert!(refused.contains("`paper_figure_5_minute`") && refused.contains("--quick"), "{refused}");
        assert!(asked_for(&["paper_figure_7"], true).is_err());
    }

    #[test]
    fn what_is_not_there_differs_and_what_cannot_be_read_is_refused() {
        let folder = std::env::temp_dir();
        let nothing = folder.join("there is no such file");
        assert_eq!(read(&nothing).unwrap(), None);
        assert!(read(&folder).is_err());
        assert!(compare(&[(nothing, "text".into())]).is_err());
        assert!(compare(&[(folder, String::new())]).unwrap_err().to_string().contains("cannot read"));
    }
}
