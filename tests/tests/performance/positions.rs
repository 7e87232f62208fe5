//! The promise: the left hand plays where on the neck it is told to, by a parameter or by controller 28, and any note that it can
//! reach at all.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{Annotation, GestureSink, Performance, PlayerEvent, TimedAnnotation};
use low_action_dsp::TimedGesture;
use low_action_tests::hands::{EXACT, Neck, RATE};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
static BASS: LazyLock<Neck> = LazyLock::new(|| Neck::of("bass"));

/// Strings from 1 on and frets of the notes that hands turn to.
#[derive(Default)]
struct Places(Vec<(usize, usize)>);

impl GestureSink for Places {
    fn gesture(&mut self, _: TimedGesture) {}

    fn annotation(&mut self, told: TimedAnnotation) {
        if let Annotation::Begins(note) = told.annotation {
            self.0.push((told.string + 1, note.fret));
        }
    }
}

fn places(player: &mut Performance, events: &[(u64, PlayerEvent)]) -> Vec<(usize, usize)> {
    let mut places = Places::default();
    for &(time, event) in events {
        player.event(time, event, &mut places);
    }
    player.advance(events.last().map_or(0, |event| event.0) + RATE as u64, &mut places);
    places.0
}

/// Keys one after the other, from a time (samples) on.
fn melody(keys: &[u8], start: u64) -> Vec<(u64, PlayerEvent)> {
    let at = |index: usize| start + 24_000 * index as u64;
    keys.iter().enumerate().flat_map(|(i, &key)| [(at(i), on(key, 90)), (at(i) + 20_000, off(key))]).collect()
}

fn told(hand_position: Option<u8>) -> Touching {
    Touching { hand_position, ..Touching::default() }
}

fn player(neck: &Neck, hand_position: Option<u8>) -> Performance {
    let mut player = neck.player(EXACT);
    player.touch(0, &told(hand_position), &mut Vec::new());
    player
}

/// G major from G3 on.
const SCALE: [u8; 8] = [55, 57, 59, 60, 62, 64, 66, 67];

#[test]
fn a_scale_is_played_where_the_documents_say() {
    let documents = include_str!("../../../docs/gestures.md");
    let documented = documents.split("<!-- begin: hand positions -->").nth(1).expect("it has the table");
    let documented = documented.split("<!-- end -->").next().expect("it ends").trim();
    let mut table = String::from(
        "| `hand_position` | G3 | A3 | B3 | C4 | D4 | E4 | F♯4 | G4 |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for position in [None, Some(3), Some(5), Some(7), Some(12)] {
        let name = position.map_or("anywhere".into(), |fret: u8| fret.to_string());
        let found = places(&mut player(&GUITAR, position), &melody(&SCALE, 0));
        let found: Vec<String> = found.iter().map(|(string, fret)| format!("{string}: {fret}")).collect();
        table += &format!("| {name} | {} |\n", found.join(" | "));
    }
    assert_eq!(table.trim(), documented, "docs/gestures.md should have\n{table}");
}

/// What four fingers reach from there is played there, every note that any string has; open strings are no further away.
#[test]
fn what_the_hand_covers_is_played_there() {
    let open: Vec<f64> = GUITAR.strings.iter().map(|string| string.geometry.open_pitch).collect();
    for fret in 1..=19_u8 {
        let mut player = player(&GUITAR, Some(fret));
        let mut start = 0;
        for key in 40..=86_u8 {
            let covered = |pitch: &f64| {
                let own = f64::from(key) - pitch;
                own >= f64::from(fret) && own < f64::from(fret) + 4.0
            };
            let reached = open.iter().any(covered);
            let found = places(&mut player, &melody(&[key], start));
            start += 60_000;
            let [(string, place)] = found[..] else { panic!("key {key} is played once: {found:?}") };
            assert_eq!(open[string - 1] + place as f64, f64::from(key));
            let inside = (usize::from(fret)..usize::from(fret) + 4).contains(&place);
            assert!(inside || place == 0 || !reached, "key {key} at fret {place}, told to play at {fret}");
        }
    }
}

/// Whatever was played before: the hand goes back.
#[test]
fn the_hand_goes_back() {
    let mut player = player(&GUITAR, Some(7));
    let first = places(&mut player, &melody(&[62, 67], 0));
    places(&mut player, &melody(&[40, 86, 41], 100_000));
    assert_eq!(places(&mut player, &melody(&[62, 67], 400_000)), first);
}

#[test]
fn a_controller_and_the_parameter_say_the_same() {
    for fret in [1, 5, 9, 12] {
        let by_parameter = places(&mut player(&GUITAR, Some(fret)), &melody(&SCALE, 4_800));
        let score = [vec![(0, cc(28, fret))], melody(&SCALE, 4_800)].concat();
        assert_eq!(places(&mut player(&GUITAR, None), &score), by_parameter);
        // At the note's own sample, before it; what comes after it is for the next.
        let score = [vec![(4_800, cc(28, fret))], melody(&SCALE, 4_800)].concat();
        assert_eq!(places(&mut player(&GUITAR, None), &score), by_parameter);
        let after_it = vec![(4_800, on(67, 90)), (4_800, cc(28, fret)), (9_600, off(67))];
        let both = places(&mut player(&GUITAR, None), &[after_it, melody(&[60], 96_000)].concat());
        let alone = |told, key| places(&mut player(&GUITAR, told), &melody(&[key], 0))[0];
        assert_eq!(both, [alone(None, 67), alone(Some(fret), 60)]);
    }
}

/// Reset controllers puts it where the parameter has it; 0 leaves it to the hand, which then stays where it is.
#[test]
fn it_can_be_taken_back() {
    let mut told = player(&GUITAR, Some(5));
    let fifth = places(&mut told, &melody(&SCALE, 0));
    let twelfth = places(&mut told, &[vec![(300_000, cc(28, 12))], melody(&SCALE, 300_000)].concat());
    assert_ne!(fifth, twelfth);
    assert_eq!(places(&mut told, &[vec![(600_000, cc(121, 0))], melody(&SCALE, 600_000)].concat()), fifth);

    let mut free = player(&GUITAR, None);
    let anywhere = places(&mut free, &melody(&SCALE, 0));
    places(&mut free, &[vec![(300_000, cc(28, 12))], melody(&SCALE, 300_000)].concat());
    let left = places(&mut free, &[vec![(600_000, cc(28, 0))], melody(&SCALE, 600_000)].concat());
    assert_eq!(left, twelfth, "it has no reason to go");
    places(&mut free, &melody(&[41], 900_000));
    assert_eq!(places(&mut free, &melody(&SCALE, 1_000_000)), anywhere);
}

/// No fret is too high for it to be asked for, also on another neck and over a capo.
#[test]
fn past_the_neck_is_the_last_fret() {
    let last = u8::try_from(GUITAR.setup.neck.frets).expect("few");
    let beyond = [melody(&SCALE, 0), melody(&[86], 200_000)].concat();
    let at_last = places(&mut player(&GUITAR, Some(last)), &beyond);
    for fret in [last + 1, 100, 127, u8::MAX] {
        assert_eq!(places(&mut player(&GUITAR, Some(fret)), &beyond), at_last);
    }
    // Under a capo it plays beside that.
    for fret in 1..=127 {
        let capo = [(0, cc(26, 7)), (0, cc(28, fret))];
        let found = places(&mut player(&GUITAR, None), &[&capo[..], &melody(&[47, 60, 71], 4_800)].concat());
        assert!(found.len() == 3 && found.iter().all(|place| place.1 >= 7), "{found:?}");
    }
}

/// It belongs to the player and not to the music: who starts again has it, and who takes another instrument.
#[test]
fn it_is_announced_once() {
    let mut told = player(&GUITAR, None);
    let score = [vec![(0, cc(28, 9))], melody(&SCALE, 4_800)].concat();
    let ninth = places(&mut told, &score);
    told.restart();
    assert_eq!(places(&mut told, &melody(&SCALE, 4_800)), ninth);
    let keys = [43, 45, 47, 48];
    let on_the_bass = places(&mut player(&BASS, Some(9)), &melody(&keys, 0));
    assert_ne!(places(&mut player(&BASS, None), &melody(&keys, 0)), on_the_bass);
    let mut bass = player(&BASS, None);
    bass.take_over(&told, false);
    assert_eq!(places(&mut bass, &melody(&keys, 400_000)), on_the_bass);
    told.reset();
    assert_ne!(places(&mut told, &melody(&SCALE, 4_800)), ninth, "all is forgotten where that is asked for");
}
