//! The page about the paper: sections with claims, what was measured, and whether they hold.

use std::fmt::Write;

/// One statement, and what became of it.
pub struct Claim {
    /// What the paper says, or what ought to be so.
    pub says: String,
    /// What is measured.
    pub measured: String,
    /// Whether it holds, decided from the numbers measured.
    pub holds: bool,
}

impl Claim {
    /// A statement of the paper with what was measured and whether it holds.
    pub fn new(says: impl Into<String>, measured: impl Into<String>, holds: bool) -> Claim {
        Claim { says: says.into(), measured: measured.into(), holds }
    }

    /// The same for a statement that the paper does not make.
    pub fn ours(says: impl Into<String>, measured: impl Into<String>, holds: bool) -> Claim {
        Claim::new(format!("{OURS}{}", says.into()), measured, holds)
    }
}

/// The part of the page that belongs to one figure.
pub struct Section {
    title: String,
    body: String,
}

/// Columns of the page.
const WIDTH: usize = 104;

/// What stands before a statement that the paper does not make.
const OURS: &str = "*Ours:* ";

/// Words of the verdicts.
const HOLDS: &str = "holds";
const FAILS: &str = "**fails**";

impl Section {
    /// A section with nothing but its title.
    pub fn new(title: &str) -> Section {
        Section { title: title.to_owned(), body: String::new() }
    }

    /// Adds a paragraph.
    pub fn text(mut self, text: &str) -> Section {
        self.body += &format!("{}\n\n", wrap(text));
        self
    }

    /// Adds its picture; `shows` is for those who cannot see it.
    pub fn picture(mut self, shows: &str) -> Section {
        self.body += &format!("<img src=\"figures/{{name}}.svg\" width=\"900\" alt=\"{shows}\">\n\n");
        self
    }

    /// Adds statements, each with a verdict.
    pub fn claims(mut self, claims: Vec<Claim>) -> Section {
        self.body += "| statement | measured | verdict |\n|---|---|---|\n";
        for claim in claims {
            let verdict = if claim.holds { HOLDS } else { FAILS };
            self.body += &format!("| {} | {} | {verdict} |\n", claim.says, claim.measured);
        }
        self.body += "\n";
        self
    }

    /// Adds a table: a heading and rows, each with its cells divided by `|`.
    pub fn table(mut self, heading: &str, rows: &[String]) -> Section {
        let columns = heading.matches('|').count() + 1;
        self.body += &format!("| {heading} |\n{}|\n", "|---".repeat(columns));
        for row in rows {
            self.body += &format!("| {row} |\n");
        }
        self.body += "\n";
        self
    }

    /// The section of a figure.
    pub fn markdown(&self, name: &str) -> String {
        format!("{}\n## {}\n\n{}", mark(name), self.title, self.body.replace("{name}", name))
    }
}

/// What stands before the section of a figure.
fn mark(name: &str) -> String {
    format!("<!-- {name} -->")
}

/// The section of a figure as it stands in a page, with the empty line after it that the last one of a page has not.
pub fn section_of(page: &str, name: &str) -> Option<String> {
    let mark = mark(name);
    let start = page.find(&mark)?;
    let after = start + mark.len();
    let end = page[after..].find("<!-- ").map_or(page.len(), |length| after + length);
    Some(page[start..end].trim_end().to_owned() + "\n\n")
}

/// Puts the page together and counts what holds.
pub fn assemble(sections: &[String]) -> String {
    let rows: Vec<_> =
        sections.iter().flat_map(|text| text.lines().filter_map(|line| Row::read(text, line))).collect();
    let (ours, paper): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row.says.starts_with(OURS));
    let count = |rows: &[&Row]| (rows.iter().filter(|row| row.holds).count(), rows.len());
    let ((paper_hold, paper_all), (ours_hold, ours_all)) = (count(&paper), count(&ours));
    let mut page = format!("{HEAD}\n");
    let _ = writeln!(
        page,
        "**Of {paper_all} statements of the paper {paper_hold} hold here; of {ours_all} of our own {ours_hold}.**"
    );
    if paper_hold + ours_hold < rows.len() {
        page += "These fail:\n\n";
    }
    for row in rows.iter().filter(|row| !row.holds) {
        let _ = writeln!(page, "- {} ([{}](#{}))", row.says, row.title, anchor(row.title));
    }
    page += "\n";
    page += &sections.concat();
    format!("{}\n", page.trim_end())
}

/// A statement as it stands in a section.
struct Row<'a> {
    title: &'a str,
    says: &'a str,
    holds: bool,
}

impl<'a> Row<'a> {
    fn read(section: &'a str, line: &'a str) -> Option<Row<'a>> {
        let verdict = |word| line.ends_with(&format!("| {word} |"));
        let holds = verdict(HOLDS);
        if !holds && !verdict(FAILS) {
            return None;
        }
        let title = section.lines().find_map(|line| line.strip_prefix("## "))?;
        Some(Row { title, says: line.split('|').nth(1)?.trim(), holds })
    }
}

/// The name under which a heading is linked to.
fn anchor(title: &str) -> String {
    let kept = title.to_lowercase();
    kept.chars()
        .filter(|c| c.is_alphanumeric() || *c == ' ' || *c == '-')
        .collect::<String>()
        .replace(' ', "-")
}

/// Breaks a paragraph into lines.
fn wrap(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= WIDTH => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.join("\n")
}

/// What stands above the sections.
const HEAD: &str = "\
<!-- Written by `cargo xtask figures` from the scenes in scenes/paper; change those, not this page. -->

# The paper's results, claim by claim

S. Bilbao and A. Torin, “Numerical simulation of string/barrier collisions: the fretboard,” *Proc. 17th
Int. Conf. on Digital Audio Effects (DAFx-14)*, Erlangen, 2014, describes the model that this instrument
is built on, and shows what it does in five figures. This page repeats them, puts what the paper says
beside what is measured here, and goes on from there. What is measured is computed when the page is
written, and every verdict is decided from the numbers beside it. Statements that the paper does not make
are marked as ours.

```sh
cargo xtask figures                     # everything: pictures, this page, and sounds in target/figures
cargo xtask figures paper_figure_3      # one figure and its section
cargo xtask figures --quick             # computes all but the minute again and compares, as .ci/run does
```

Each figure starts from a scene file in [`scenes/paper`](../scenes/paper). Copy one, change one number,
and look:

```sh
low-action scene my.toml --figure my.svg --trace my.npz --every 8
```

```python
import numpy as np
trace = np.load(\"my.npz\")
print(trace[\"t\"][trace[\"force_fret_1_5\"].argmax()], \"s: the hardest blow on fret 5\")
```

(`low-action` is `target/release/low-action`, or `cargo run --release --`; `--wav my.wav` adds the sound where the rate is a
whole number of hertz.) What scenes and traces hold is in [formats.md](formats.md), the derivation in [physics.md](physics.md),
the contact solver in [solver.md](solver.md).

**What the paper leaves open.** It gives string, contact law, rate and finger, but not the heights of
board and frets, the duration and direction of the pluck, or the finger's height, force and way. Those
are chosen here, the same for all figures: board 1.8 mm and crowns 1.2 mm below the string at rest, 12
frets in equal temperament. The scene files mark them as “ours”.

**What is drawn in another way.** The paper’s Figures 3 and 5 are over the time step n, those here over
milliseconds; and in Figure 5 the energies of collision and finger have other colours.
";

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> (Vec<String>, String) {
        let claims = vec![
            Claim::new("one", "1", true),
            Claim::new("two", "3", false),
            Claim::ours("three", "3", true),
        ];
        let first = Section::new("Figure 2: a string").picture("words").claims(claims).markdown("a");
        let second = Section::new("More").text("text").markdown("b");
        let sections = vec![first, second];
        let page = assemble(&sections);
        (sections, page)
    }

    #[test]
    fn sections_are_found_again_as_they_were_written() {
        let (sections, page) = page();
        assert_eq!(section_of(&page, "a").as_deref(), Some(&*sections[0]));
        assert_eq!(
            section_of(&page, "b").map(|text| text.trim_end().to_owned()),
            Some(sections[1].trim_end().to_owned())
        );
        assert_eq!(section_of(&page, "c"), None);
        let again = [section_of(&page, "a").unwrap(), section_of(&page, "b").unwrap()];
        assert_eq!(assemble(&again), page);
    }

    #[test]
    fn what_fails_is_named_at_the_top() {
        let (_, page) = page();
        assert!(page.contains("Of 2 statements of the paper 1 hold here; of 1 of our own 1."), "{page}");
        assert!(page.contains("- two ([Figure 2: a string](#figure-2-a-string))"), "{page}");
    }
}
