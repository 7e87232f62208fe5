//! Promise: `low-action scene --figure` draws any scene that can be computed, the same picture on every run,
//! and drawing changes nothing else.

use std::fs;
use std::path::Path;

use low_action_tests::scenes::PLUCKED_AND_TAPPED as SCENE;

use crate::workplace;

/// Every element of a picture ends, in the order in which they begin, every attribute has its quotes, and no `&` or `<`
/// stands for itself.
fn assert_well_formed(picture: &str) {
    let mut open = Vec::new();
    let mut rest = picture;
    while let Some((text, element)) = rest.split_once('<') {
        assert!(!text.contains('>') && entities(text), "text {text:?}");
        assert!(!open.is_empty() || text.trim().is_empty(), "{text:?} stands outside");
        let (tag, after) = element.split_once('>').unwrap_or_else(|| panic!("<{element} does not end"));
        assert!(!tag.contains('<') && entities(tag), "<{tag}>");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "</{name}>");
        } else {
            assert_eq!(tag.matches('"').count(), 2 * tag.matches("=\"").count(), "<{tag}>");
            let name = tag.split([' ', '\n', '/']).next().expect("split gives one part");
            assert!(!name.is_empty() && name.chars().all(char::is_alphanumeric), "<{tag}>");
            if !tag.ends_with('/') {
                open.push(name);
            }
        }
        rest = after;
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} do not end");
}

/// Whether every `&` begins an entity.
fn entities(text: &str) -> bool {
    text.split('&').skip(1).all(|rest| {
        rest.split_once(';').is_some_and(|(name, _)| name.chars().all(|c| c.is_alphanumeric() || c == '#'))
    })
}

/// The texts of a picture, in order.
fn texts(picture: &str) -> Vec<String> {
    assert!(picture.starts_with("<svg ") && picture.trim_end().ends_with("</svg>"), "not SVG");
    assert_well_formed(picture);
    let mut found = Vec::new();
    for element in picture.split("<text ").skip(1) {
        let (_, rest) = element.split_once('>').expect("tags end");
        found.push(rest.split_once("</text>").expect("elements end").0.trim().to_owned());
    }
    found
}

/// Every number of a picture is finite.
fn assert_finite(picture: &str) {
    for word in ["NaN", "inf"] {
        assert!(!picture.contains(word), "{word} in the picture");
    }
}

#[test]
fn a_picture_shows_string_energies_forces_and_the_solver() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    let done = place.run(&["scene", "scene.toml", "--figure", "out.svg"]);
    assert_eq!(done.code, 0, "{}", done.error);
    assert!(done.text().contains("out.svg"), "{}", done.text());
    let picture = fs::read_to_string(place.path("out.svg")).unwrap();
    assert_finite(&picture);
    // Numbers stay on the line of their units.
    let texts = texts(&picture).join("\n").replace('\u{a0}', " ");
    for words in [
        "scene.toml",
        "place, m from the nut",
        "height, mm",
        "time, s",
        "energy, mJ",
        "force, N",
        "iterations",
        "depth, m",
        "3 frets",
        "44.1 kHz",
    ] {
        assert!(texts.contains(words), "{words} is not in the picture:\n{texts}");
    }
}

#[test]
fn drawing_changes_no_other_result_and_is_the_same_on_every_run() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    assert_eq!(place.run(&["scene", "scene.toml", "--wav", "a.wav", "--trace", "a.npz"]).code, 0);
    let with = ["scene", "scene.toml", "--wav", "b.wav", "--trace", "b.npz", "--figure", "b.svg"];
    assert_eq!(place.run(&with).code, 0);
    assert_eq!(place.run(&["scene", "scene.toml", "--figure", "c.svg"]).code, 0);
    let read = |name: &str| fs::read(place.path(name)).unwrap();
    assert!(read("a.wav") == read("b.wav") && read("a.npz") == read("b.npz"), "drawing changed a result");
    assert!(read("b.svg") == read("c.svg"), "the same scene gave two pictures");
    let done = place.run_with(&["scene", "scene.toml", "--figure", "-"], &[]);
    assert!(done.output == read("b.svg"), "standard output is not the file");
}

#[test]
fn scenes_without_contacts_length_or_motion_are_drawn_too() {
    let place = workplace();
    let string = "sample_rate = 44100\nduration = 0.01\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\ntension = 60.0\n";
    let strings = &string[string.find("[[string]]").expect("it has one")..];
    let scenes = [
        string.to_owned(),
        string.replace("0.01", "0"),
        string.replace("0.01", "1e-5"),
        format!("{string}{}", strings.repeat(6)),
        format!("{string}shape = [[0.0, 0.0], [0.3, 1e-200], [0.65, 0.0]]\n"),
        format!("{string}[[pluck]]\nduration = 0.001\nposition = 0.3\nforce = 1e6\n"),
    ];
    for scene in scenes {
        place.write("scene.toml", &scene);
        let done = place.run(&["scene", "scene.toml", "--figure", "out.svg"]);
        assert_eq!(done.code, 0, "{}\n{scene}", done.error);
        let picture = fs::read_to_string(place.path("out.svg")).unwrap();
        assert_finite(&picture);
        assert!(texts(&picture).iter().any(|text| text == "Stored energy"), "{scene}");
        fs::remove_file(place.path("out.svg")).unwrap();
    }
}

#[test]
fn a_picture_that_cannot_be_written_is_refused_before_anything_is_left_behind() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    let same = place.run(&["scene", "scene.toml", "--wav", "out", "--figure", "out"]);
    assert_eq!(same.code, 2, "{}", same.error);
    let over_scene = place.run(&["scene", "scene.toml", "--figure", "scene.toml"]);
    assert_eq!(over_scene.code, 2, "{}", over_scene.error);
    let nowhere = place.run(&["scene", "scene.toml", "--wav", "out.wav", "--figure", "nowhere/out.svg"]);
    assert_eq!(nowhere.code, 1, "{}", nowhere.error);
    assert_eq!(nowhere.error.lines().count(), 1, "{}", nowhere.error);
    assert!(nowhere.error.contains(&Path::new("nowhere").join("out.svg").display().to_string()));
    assert_eq!(place.names(), ["scene.toml"]);
}
