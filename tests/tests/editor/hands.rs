//! Promise: strings are played with the mouse. Dragged across them it plucks each where it crosses it, the harder the
//! faster; held on one it is a finger; the strings sound by it.

use egui::{Event, Key, Modifiers, PointerButton};
use low_action::performance::{PlayerEvent, StringDeed};
use low_action_tests::desk::Desk;
use low_action_tests::numbers::largest;
use low_action_tests::stage::peak;

/// A place beyond the board, m from the nut, and one between frets 4 and 5.
const BEYOND: f32 = 0.56;
const FIFTH: f32 = 0.155;

/// All plucks: string, place (m) and force (N).
fn plucks(desk: &Desk) -> Vec<(u8, f32, f32)> {
    let pluck = |event: &PlayerEvent| match *event {
        PlayerEvent::Touched { string, deed: StringDeed::Pluck { position, force } } => {
            Some((string, position, force))
        }
        _ => None,
    };
    desk.played.iter().filter_map(pluck).collect()
}

fn deeds(desk: &Desk, of: u8) -> Vec<StringDeed> {
    let deed = |event: &PlayerEvent| match *event {
        PlayerEvent::Touched { string, deed } if string == of => Some(deed),
        _ => None,
    };
    desk.played.iter().filter_map(deed).collect()
}

/// A strum from over the first string to under the last, or back, in so many seconds.
fn strummed(down: bool, seconds: f64) -> Desk {
    let mut desk = Desk::new();
    let (mut from, mut to) = (desk.at(BEYOND, -0.5), desk.at(BEYOND + 0.02, 5.5));
    if !down {
        (from, to) = (to, from);
    }
    desk.drag(&[from, to], seconds);
    desk
}

#[test]
fn a_strum_plucks_every_string_where_it_is_crossed() {
    for down in [true, false] {
        let mut desk = strummed(down, 0.2);
        desk.wait(0.3);
        let mut strings: Vec<u8> = plucks(&desk).iter().map(|pluck| pluck.0).collect();
        if !down {
            strings.reverse();
        }
        assert_eq!(strings, [0, 1, 2, 3, 4, 5]);
        for (string, place, _) in plucks(&desk) {
            let crossed = BEYOND + 0.02 * (f32::from(string) + 0.5) / 6.0;
            assert!((place - crossed).abs() < 1e-3, "string {string} at {place} m instead of {crossed} m");
        }
        assert!(peak(&desk.sound) > 0.05, "nothing sounds");
    }
}

#[test]
fn faster_is_harder() {
    let force = |seconds| {
        let plucks = plucks(&strummed(true, seconds));
        plucks.iter().map(|pluck| pluck.2).sum::<f32>() / plucks.len() as f32
    };
    let (slow, fast) = (force(0.6), force(0.1));
    // Thirty strings a second are as hard as the hardest note, 0.8 N, and force goes with the power of 0.6 of the speed: at
    // 10 and 60 it is 0.414 and 1.213 N. A picture more or less of the six in a tenth of a second would be 11 %.
    let force = |speed: f32| 0.8 * (speed / 30.0).powf(0.6);
    for (found, speed) in [(slow, 10.0), (fast, 60.0)] {
        let expected = force(speed);
        assert!(
            (found / expected - 1.0).abs() < 0.03,
            "{found} N instead of {expected} N at {speed} a second"
        );
    }
}

#[test]
fn a_click_beyond_the_board_plucks() {
    let mut desk = Desk::new();
    let at = desk.at(BEYOND, 4.0);
    desk.drag(&[at], 0.0);
    desk.wait(0.2);
    let [(4, place, force)] = plucks(&desk)[..] else { panic!("{:?}", desk.played) };
    assert!((place - BEYOND).abs() < 1e-3 && (0.3..0.5).contains(&force), "{place} m, {force} N");
    assert!(peak(&desk.sound) > 0.01);
}

/// The press plucks it, and the way over it does not do so once more.
#[test]
fn a_strum_that_begins_on_a_string_plucks_it_once() {
    for (way, expected) in [
        (&[0.9, 3.5][..], &[1, 2, 3][..]),
        (&[1.1, 3.5], &[1, 2, 3]),
        (&[1.1, -0.5], &[1, 0]),
        // But on the way back.
        (&[0.9, 1.5, 0.5], &[1, 1]),
        (&[1.1, 1.5, 0.5], &[1, 1]),
    ] {
        let mut desk = Desk::new();
        let way: Vec<_> = way.iter().map(|string| desk.at(BEYOND, *string)).collect();
        desk.drag(&way, 0.2);
        let strings: Vec<u8> = plucks(&desk).iter().map(|pluck| pluck.0).collect();
        assert_eq!(strings, expected);
    }
}

/// As a touch pad's, or any where pictures are slow.
#[test]
fn a_tap_between_two_pictures_plays() {
    let mut desk = Desk::new();
    let places = [desk.at(BEYOND, 4.0), desk.at(FIFTH, 2.0)];
    let mut tap = |at| {
        desk.point(at);
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        let press = |pressed| Event::PointerButton { pos: at, button, pressed, modifiers };
        desk.harness.input_mut().events.extend([true, false].map(press));
        desk.picture();
        desk.wait(0.1);
        std::mem::take(&mut desk.played)
    };
    let played = tap(places[0]);
    let [PlayerEvent::Touched { string: 4, deed: StringDeed::Pluck { .. } }] = played[..] else {
        panic!("{played:?}")
    };
    let played = tap(places[1]);
    let [
        PlayerEvent::Touched { string: 2, deed: StringDeed::Press { .. } },
        PlayerEvent::Touched { string: 2, deed: StringDeed::Lift },
    ] = played[..]
    else {
        panic!("{played:?}")
    };
}

/// Some systems say that the mouse has left, and go on telling where it is.
#[test]
fn a_finger_and_a_strum_go_on_when_the_mouse_has_left_the_window() {
    let leave = |desk: &mut Desk, from, to| {
        desk.point(from);
        desk.press(from, true, Modifiers::NONE);
        desk.harness.event(Event::PointerGone);
        desk.wait(0.05);
        desk.played.clear();
        desk.point(to);
    };
    let mut desk = Desk::new();
    let (from, to) = (desk.at(FIFTH, 2.0), desk.at(FIFTH + 0.05, 2.0));
    leave(&mut desk, from, to);
    let [StringDeed::Press { position }] = deeds(&desk, 2)[..] else { panic!("{:?}", desk.played) };
    assert!((position - FIFTH - 0.05).abs() < 1e-3, "{position} m");
    desk.press(to, false, Modifiers::NONE);
    assert_eq!(deeds(&desk, 2).last(), Some(&StringDeed::Lift));
    let mut desk = Desk::new();
    let (from, to) = (desk.at(BEYOND, 0.5), desk.at(BEYOND, 2.5));
    leave(&mut desk, from, to);
    let strings: Vec<u8> = plucks(&desk).iter().map(|pluck| pluck.0).collect();
    assert_eq!(strings, [1, 2]);
}

#[test]
fn a_finger_comes_slides_and_leaves() {
    let mut desk = Desk::new();
    let (from, to) = (desk.at(FIFTH, 2.1), desk.at(FIFTH + 0.05, 2.0));
    desk.drag(&[from, to], 0.2);
    let deeds = deeds(&desk, 2);
    let (StringDeed::Press { position: first }, Some(StringDeed::Lift)) = (deeds[0], deeds.last()) else {
        panic!("{deeds:?}")
    };
    let StringDeed::Press { position: last } = deeds[deeds.len() - 2] else { panic!("{deeds:?}") };
    assert!((first - FIFTH).abs() < 1e-3 && (last - FIFTH - 0.05).abs() < 1e-3, "{first} m to {last} m");
    assert!(deeds.len() > 8, "it slides in {} steps", deeds.len());
    assert_eq!(desk.played.len(), deeds.len(), "another string was touched");
    assert!(plucks(&desk).is_empty());
    assert!(peak(&desk.sound) > 1e-3, "a finger that comes down is heard");
}

#[test]
fn a_finger_stays_over_the_board() {
    let mut desk = Desk::new();
    let way = [desk.at(0.3, 1.0), desk.at(0.64, 1.0), desk.at(-0.02, 1.0)];
    desk.drag(&way, 0.1);
    let place = |deed| if let StringDeed::Press { position } = deed { Some(position) } else { None };
    let places: Vec<f32> = deeds(&desk, 1).into_iter().filter_map(place).collect();
    assert!(places.iter().all(|place| (0.0..0.48).contains(place)), "{places:?}");
    let farthest = largest(places.iter().copied());
    assert!(farthest > 0.46 && places.last() == Some(&0.0), "it is not at the ends: {places:?}");
}

#[test]
fn with_shift_the_finger_stays() {
    let mut desk = Desk::new();
    let at = desk.at(FIFTH, 3.0);
    desk.point(at);
    desk.press(at, true, Modifiers::SHIFT);
    desk.press(at, false, Modifiers::SHIFT);
    desk.wait(0.1);
    assert_eq!(deeds(&desk, 3).len(), 1, "{:?}", desk.played);
    // It is taken up again and leaves.
    desk.drag(&[at], 0.0);
    assert_eq!(deeds(&desk, 3).last(), Some(&StringDeed::Lift));
}

#[test]
fn a_finger_leaves_when_the_window_is_closed() {
    for (modifiers, lifted) in [(Modifiers::NONE, true), (Modifiers::SHIFT, false)] {
        let mut desk = Desk::new();
        let at = desk.at(FIFTH, 2.0);
        desk.point(at);
        desk.press(at, true, modifiers);
        desk.wait(0.1);
        assert_eq!(deeds(&desk, 2).len(), 1, "{:?}", desk.played);
        let lift = PlayerEvent::Touched { string: 2, deed: StringDeed::Lift };
        assert_eq!(desk.close(), if lifted { vec![lift] } else { vec![] }, "{modifiers:?}");
    }
    // One that has left already does so once.
    let mut desk = Desk::new();
    desk.drag(&[desk.at(FIFTH, 2.0)], 0.0);
    assert_eq!(desk.close(), []);
}

/// At once, however long the button is held, and then each that it crosses.
#[test]
fn strings_are_silenced() {
    let mut desk = Desk::new();
    let other = |desk: &mut Desk, at, pressed| {
        let (button, modifiers) = (PointerButton::Secondary, Modifiers::NONE);
        desk.harness.event(Event::PointerButton { pos: at, button, pressed, modifiers });
        desk.picture();
    };
    let damp = |string| PlayerEvent::Touched { string, deed: StringDeed::Damp };
    let at = desk.at(BEYOND, 1.0);
    desk.point(at);
    other(&mut desk, at, true);
    assert_eq!(desk.played, [damp(1)], "before it is let go");
    desk.wait(1.0);
    let to = desk.at(BEYOND, 3.5);
    desk.point(to);
    assert_eq!(desk.played, [1, 2, 3].map(damp));
    other(&mut desk, to, false);
    desk.point(desk.at(BEYOND, 5.5));
    assert_eq!(desk.played, [1, 2, 3].map(damp));
    desk.harness.key_press(Key::Escape);
    desk.wait(0.05);
    assert_eq!(desk.played.last(), Some(&PlayerEvent::AllNotesOff));
}

#[test]
fn escape_silences_only_where_it_does_nothing_else() {
    let mut desk = Desk::new();
    desk.open("Sound");
    let number = desk.control("Type Level").expect("it is there");
    for place in [number, desk.named("Electric")] {
        desk.click(place);
        desk.wait(0.1);
        // A number that is typed, or a list that is open.
        desk.key(Key::Escape);
        assert!(desk.played.is_empty(), "{:?}", desk.played);
        desk.key(Key::Escape);
        assert_eq!(std::mem::take(&mut desk.played), [PlayerEvent::AllNotesOff]);
    }
}
