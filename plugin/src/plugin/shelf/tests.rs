//! What is promised is read once, is seen at once, and is heard.

use std::fs;

use tempfile::TempDir;

use super::*;

/// A folder with one file, and its shelf.
fn shelf() -> (TempDir, Shelf) {
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join("Mine.toml");
    fs::write(&path, "based_on = \"steel\"\n").expect("it can be written");
    (folder, Shelf::new(vec![SetupFile { name: "Mine".into(), path }]))
}

fn kept(text: &str) -> Kept {
    Kept { number: 1, name: "Mine".into(), text: text.into() }
}

#[test]
fn a_file_that_is_chosen_is_built_once() {
    let (_folder, shelf) = shelf();
    shelf.promise(1, None);
    shelf.choose(1);
    let edition = shelf.edition();
    shelf.setup(1).expect("it is a set-up");
    shelf.keep_promise();
    assert_eq!(shelf.edition(), edition);
    assert!(shelf.held(1).is_some());
}

#[test]
fn what_is_to_be_kept_counts_before_it_is() {
    let (_folder, shelf) = shelf();
    shelf.choose(1);
    shelf.setup(1).expect("it is a set-up");
    let first = shelf.held(1).expect("it is kept");
    let second = kept("based_on = \"bass\"\n");
    shelf.promise(1, Some(second.clone()));
    assert_eq!(shelf.held(1), Some(second.clone()));
    assert_eq!(shelf.take_up(1), Ok(first), "it is played once all that belongs to it is there");
    shelf.keep_promise();
    assert_eq!(shelf.take_up(1), Ok(second));
    shelf.promise(1, None);
    assert_eq!(shelf.held(1), None, "what the folder has");
}

/// Only where it is chosen already: another one is taken up as soon as it is.
#[test]
fn a_file_in_place_of_the_one_that_is_chosen_is_awaited() {
    let (_folder, shelf) = shelf();
    let other = kept("based_on = \"bass\"\n");
    shelf.promise(1, Some(other.clone()));
    shelf.choose(1);
    assert!(!shelf.is_awaited());
    shelf.setup(1).expect("it is a set-up");
    let ends: [fn(&Shelf); 2] = [Shelf::keep_promise, |shelf| shelf.choose(2)];
    for end in ends {
        shelf.choose(1);
        shelf.promise(1, Some(other.clone()));
        assert!(shelf.is_awaited());
        end(&shelf);
        assert!(!shelf.is_awaited());
    }
}

/// As when the one that was chosen after it could not be read.
#[test]
fn a_file_that_comes_back_is_heard() {
    let (folder, shelf) = shelf();
    fs::remove_file(folder.path().join("Mine.toml")).expect("it is there");
    shelf.choose(1);
    let edition = shelf.edition();
    shelf.setup(1).expect_err("it is gone");
    shelf.promise(1, Some(kept("based_on = \"bass\"\n")));
    shelf.keep_promise();
    assert_ne!(shelf.edition(), edition);
    shelf.setup(1).expect("it is a set-up");
}
