//! Promise: `low-action instruments` lists every instrument there is, with the numbers the plugin knows files by, and
//! installs set-up files: checked, whole or not at all; what is installed can be named like what comes with the
//! program.

use low_action::setups::SHIPPED;
use low_action_dsp::Setup;
use low_action_tests::command::Workplace;

use crate::workplace;

const LOWER: &str =
    "name = \"lower\"\ndescription = \"two semitones lower\"\nbased_on = \"electric\"\ntuning = -2.0\n";

/// What is in the folder of the user's own.
fn installed(place: &Workplace) -> Vec<String> {
    let entries = std::fs::read_dir(place.path("instruments")).into_iter().flatten().flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn what_comes_with_the_program_is_listed() {
    let place = workplace();
    let done = place.run(&["instruments"]);
    assert_eq!((done.code, done.error.as_str()), (0, ""));
    for name in SHIPPED {
        let line = done.text().lines().find(|line| line.trim_start().starts_with(name)).map(str::to_owned);
        // With what it is, after its name.
        assert!(line.is_some_and(|line| line.trim().len() > name.len() + 10), "{name}");
    }
    assert!(done.text().contains("none;"), "{}", done.text());
}

#[test]
fn what_is_installed_is_listed_and_played() {
    let place = workplace();
    place.write("lower.toml", LOWER);
    place.write("zither.toml", LOWER);
    let done = place.run(&["instruments", "--install", "zither.toml", "lower.toml"]);
    assert_eq!(done.code, 0, "{}", done.error);
    assert_eq!(installed(&place), ["lower.toml", "zither.toml"]);
    let list = place.run(&["instruments"]).text();
    assert!(list.contains(" 1 lower          two semitones lower\n"), "{list}");
    assert!(list.contains(" 2 zither"), "{list}");
    // By its name, from anywhere.
    std::fs::remove_file(place.path("lower.toml")).expect("it is there");
    let render = ["render", "-o", "low.wav", "--instrument", "lower", "--quality", "draft", "--tail", "none"];
    let done = place.run(&render);
    assert_eq!(done.code, 0, "{}", done.error);
    assert!(place.path("low.wav").exists());
    // Once more takes the place of the old one.
    place.write("lower.toml", LOWER.replace("two", "three"));
    assert_eq!(place.run(&["instruments", "--install", "lower.toml"]).code, 0);
    assert!(place.run(&["instruments"]).text().contains("three semitones lower"));
}

#[test]
fn the_plugin_has_numbers_for_the_first_64() {
    let place = workplace();
    let folder = place.path("instruments");
    std::fs::create_dir(&folder).expect("there is room");
    // (All are built to be listed. Frets that nobody places take no time.)
    let quick = LOWER.to_owned() + "intonation = \"physical\"\n";
    let put = |number: usize| {
        std::fs::write(folder.join(format!("own{number:02}.toml")), &quick).expect("there is room");
    };
    (1..=64).for_each(put);
    let list = place.run(&["instruments"]).text();
    for number in 1..=64 {
        assert!(list.contains(&format!("\n  {number:>2} own{number:02} ")), "{number}: {list}");
    }
    assert!(!list.contains("has numbers"), "{list}");
    (65..=66).for_each(put);
    let list = place.run(&["instruments"]).text();
    assert!(list.contains("\n  64 own64 "), "{list}");
    assert!(list.contains("\n   - own65 ") && list.contains("\n   - own66 "), "{list}");
    assert!(list.ends_with("\n  (the plugin has numbers for the first 64)\n"), "{list}");
    // Those it has are the first of the same order, and what lies beyond is played by its name.
    let render = ["render", "-o", "low.wav", "--instrument", "own65", "--quality", "draft", "--tail", "none"];
    let done = place.run(&render);
    assert_eq!(done.code, 0, "{}", done.error);
}

#[cfg(unix)]
#[test]
fn names_break_no_line_of_the_list() {
    let place = workplace();
    place.write("a\nb\u{1b}.toml", LOWER);
    let done = place.run(&["instruments", "--install", "a\nb\u{1b}.toml"]);
    assert!(done.code == 0 && done.error.starts_with("a\\nb\\u{1b}: "), "{:?}", done.error);
    assert_eq!(done.error.lines().count(), 1, "{:?}", done.error);
    let list = place.run(&["instruments"]).text();
    assert!(list.contains(" 1 a\\nb\\u{1b}"), "{list:?}");
}

#[test]
fn names_with_dots_are_whole_names() {
    let place = workplace();
    place.write("les-paul-v1.toml", LOWER);
    place.write("les-paul-v1.2.toml", LOWER.replace("two", "three"));
    let done = place.run(&["instruments", "--install", "les-paul-v1.toml", "les-paul-v1.2.toml"]);
    assert_eq!(done.code, 0, "{}", done.error);
    assert_eq!(installed(&place), ["les-paul-v1.2.toml", "les-paul-v1.toml"]);
    std::fs::remove_file(place.path("les-paul-v1.2.toml")).expect("it is there");
    let render =
        ["render", "-o", "low.wav", "--instrument", "les-paul-v1.2", "--quality", "draft", "--tail", "none"];
    let done = place.run(&render);
    assert_eq!(done.code, 0, "{}", done.error);
}

/// A folder of the same name is none.
#[test]
fn an_installed_name_is_found_beside_a_folder() {
    let place = workplace();
    place.write("lower.toml", LOWER);
    assert_eq!(place.run(&["instruments", "--install", "lower.toml"]).code, 0);
    for folder in ["lower", "higher"] {
        std::fs::create_dir_all(place.path(folder)).expect("there is room");
    }
    let render =
        |name| place.run(&["render", "-o", "a.wav", "-i", name, "--quality", "draft", "--tail", "none"]);
    let done = render("lower");
    assert_eq!(done.code, 0, "{}", done.error);
    let done = render("higher");
    assert_eq!(done.code, 2, "{}", done.error);
    assert!(done.error.contains("unknown instrument \"higher\""), "{}", done.error);
}

#[test]
fn what_is_played_is_not_written_over() {
    let place = workplace();
    place.write("lower.toml", LOWER);
    assert_eq!(place.run(&["instruments", "--install", "lower.toml"]).code, 0);
    std::fs::remove_file(place.path("lower.toml")).expect("it is there");
    let render = |instrument, output| {
        let rest = ["--quality", "draft", "--tail", "none"];
        place.run(&[&["render", "--instrument", instrument, "-o", output], &rest[..]].concat())
    };
    let done = render("lower", "instruments/lower.toml");
    assert_eq!(done.code, 2, "{}", done.error);
    assert!(done.error.contains("the instrument and the sound name the same file"), "{}", done.error);
    assert_eq!(std::fs::read_to_string(place.path("instruments/lower.toml")).expect("it is there"), LOWER);
    // What comes with the program is no file that could be lost.
    let done = render("electric", "electric");
    assert_eq!(done.code, 0, "{}", done.error);
}

#[test]
fn where_one_cannot_be_written_none_is() {
    let place = workplace();
    place.write("aa.toml", LOWER);
    assert_eq!(place.run(&["instruments", "--install", "aa.toml"]).code, 0);
    place.write("aa.toml", LOWER.replace("two", "three"));
    place.write("bb.toml", LOWER);
    std::fs::create_dir(place.path("instruments/bb.toml")).expect("there is room");
    let done = place.run(&["instruments", "--install", "aa.toml", "bb.toml"]);
    assert_eq!(done.code, 1, "{}", done.error);
    assert!(done.error.contains("bb.toml: it is a folder"), "{}", done.error);
    assert_eq!(done.error.lines().count(), 1, "{}", done.error);
    assert_eq!(std::fs::read_to_string(place.path("instruments/aa.toml")).expect("it is there"), LOWER);
    assert_eq!(installed(&place), ["aa.toml", "bb.toml"]);
}

#[test]
fn what_is_no_set_up_is_refused_in_one_line() {
    let place = workplace();
    place.write("broken.toml", "name = \"broken\"\nbased_on = \"electric\"\n[neck]\naction = 9.0\n");
    place.write("bass.toml", LOWER);
    // What is in all ranges, and cannot be built: a string too stiff to sound so low, a bridge no grid is fine enough for.
    place.write("stiff.toml", LOWER.to_owned() + "[[string]]\npitch = 20.0\ncore_radius = 0.005\n");
    place.write("short.toml", LOWER.to_owned() + "[bridge]\nlength = 1e-4\nradius = 1.0\n");
    for (file, words) in [
        ("broken.toml", ["broken.toml", "neck.action"]),
        ("stiff.toml", ["stiff.toml", "string[1]"]),
        ("short.toml", ["short.toml", "bridge.length"]),
        ("bass.toml", ["bass comes with the program", "another name"]),
        ("nowhere.toml", ["nowhere.toml", "cannot read"]),
    ] {
        let done = place.run(&["instruments", "--install", file]);
        assert_eq!(done.code, 1);
        assert!(done.error.lines().count() == 1, "{}", done.error);
        assert!(words.iter().all(|word| done.error.contains(word)), "{}", done.error);
    }
    // One that is refused keeps the others out.
    place.write("lower.toml", LOWER);
    assert_eq!(place.run(&["instruments", "--install", "lower.toml", "broken.toml"]).code, 1);
    assert!(installed(&place).is_empty());
    // So are two of one name, of which one would be lost.
    std::fs::create_dir_all(place.path("other")).expect("there is room");
    place.write("other/lower.toml", LOWER);
    let done = place.run(&["instruments", "--install", "lower.toml", "other/lower.toml"]);
    assert_eq!(done.code, 2, "{}", done.error);
    assert!(
        done.error.contains("lower.toml and other/lower.toml would both be installed as lower"),
        "{}",
        done.error
    );
    // So are two that are one to some systems.
    place.write("other/Lower.toml", LOWER);
    let done = place.run(&["instruments", "--install", "lower.toml", "other/Lower.toml"]);
    assert_eq!(done.code, 2, "{}", done.error);
    assert!(
        done.error.contains("lower.toml and other/Lower.toml would both be installed as Lower"),
        "{}",
        done.error
    );
    assert!(installed(&place).is_empty());
    // Where the folder would be there is a file.
    place.write("instruments", "");
    let done = place.run(&["instruments", "--install", "lower.toml"]);
    assert_eq!(done.code, 1);
    assert!(done.error.ends_with("instruments: it is a file\n"), "{}", done.error);
    std::fs::remove_file(place.path("instruments")).expect("it is there");
    // One that was put there by hand is listed with what is wrong with it.
    std::fs::create_dir_all(place.path("instruments")).expect("there is room");
    for file in ["broken.toml", "stiff.toml"] {
        std::fs::copy(place.path(file), place.path("instruments").join(file)).expect("it is there");
    }
    let list = place.run(&["instruments"]).text();
    assert!(list.contains("broken         not usable: neck.action = 9"), "{list}");
    assert!(list.contains("stiff          not usable: string[1]"), "{list}");
    let done = place.run(&["render", "--instrument", "fiddle"]);
    assert_eq!(done.code, 2);
    assert!(
        done.error.contains("unknown instrument \"fiddle\"") && done.error.contains("broken"),
        "{}",
        done.error
    );
}

/// A set-up file is a good beginning for another if it is all there.
#[test]
fn what_is_shown_is_the_whole_set_up() {
    let place = workplace();
    for name in SHIPPED {
        let done = place.run(&["instruments", "--show", name]);
        assert_eq!((done.code, done.error.as_str()), (0, ""), "{name}");
        assert_eq!(Setup::from_toml(&done.text()).unwrap(), Setup::shipped(name).unwrap(), "{name}");
        assert!(!done.text().contains("based_on"), "{name}");
    }
    // Also of one's own, by its name or its file.
    let own = "name = \"own\"\nbased_on = \"steel\"\ntuning = -1.0\n";
    place.write("own.toml", own);
    let from_file = place.run(&["instruments", "--show", "own.toml"]);
    assert_eq!(place.run(&["instruments", "--install", "own.toml"]).code, 0);
    let by_name = place.run(&["instruments", "--show", "own"]);
    for done in [from_file, by_name] {
        assert_eq!(Setup::from_toml(&done.text()).unwrap(), Setup::from_toml(own).unwrap(), "{}", done.error);
    }
    for arguments in [&["banjo"][..], &["steel", "--install", "own.toml"]] {
        let done = place.run(&[&["instruments", "--show"], arguments].concat());
        assert!(done.code == 2 && done.output.is_empty(), "{arguments:?}: {}", done.error);
    }
}
