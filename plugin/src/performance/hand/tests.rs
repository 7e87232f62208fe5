//! What the hand does with notes that players know.

use super::*;

/// E4 B3 G3 D3 A2 E2 with 22 frets, string 0 the highest.
fn guitar() -> Hand {
    let pitches = [64.0, 59.0, 55.0, 50.0, 45.0, 40.0];
    Hand::new(pitches.map(|open_pitch| Range { open_pitch, frets: 22, coil: None }).to_vec(), true)
}

fn play(hand: &mut Hand, keys: &[u8], uses: &[Use]) -> Vec<Option<(usize, usize)>> {
    let wanted: Vec<Wanted> = keys
        .iter()
        .map(|&key| Wanted { channel: 0, key, pitch: f64::from(key), only: None, harmonic: false })
        .collect();
    let mut placements = vec![None; keys.len()];
    hand.place(&wanted, uses, &mut placements);
    placements.iter().map(|place| place.map(|place| (place.string, place.fret))).collect()
}

const FREE: [Use; 6] = [Use::Free; 6];

#[test]
fn open_chords_take_their_usual_shape() {
    let c_major = play(&mut guitar(), &[48, 52, 55, 60, 64], &FREE);
    assert_eq!(c_major, [Some((4, 3)), Some((3, 2)), Some((2, 0)), Some((1, 1)), Some((0, 0))]);
    let f_major = play(&mut guitar(), &[65, 60, 57, 53, 48, 41], &FREE);
    let barre = [(0, 1), (1, 1), (2, 2), (3, 3), (4, 3), (5, 1)].map(Some);
    assert_eq!(f_major, barre);
}

#[test]
fn an_order_of_arrival_that_traps_a_greedy_hand() {
    // The E4 must leave the first string to the E5.
    let placed = play(&mut guitar(), &[64, 67, 71, 76], &FREE);
    let mut strings: Vec<usize> = placed.iter().map(|place| place.expect("all fit").0).collect();
    strings.dedup();
    assert_eq!(strings.len(), 4, "{placed:?}");
}

#[test]
fn a_melody_stays_in_position() {
    let mut hand = guitar();
    play(&mut hand, &[69], &FREE);
    play(&mut hand, &[72], &FREE);
    let here = hand.position;
    assert_eq!(play(&mut hand, &[67], &FREE), [Some((1, 8))]);
    assert_eq!(hand.position, here);
}

/// A string that sounds with a finger on a fret, or open.
fn held(key: u8, fret: usize) -> Use {
    Use::Taken { channel: 1, key, since: 0, key_down: true, fret }
}

#[test]
fn fingers_that_hold_notes_keep_the_hand() {
    // C5 is held at fret 8 of the first string. Another hand would go to the nut for G3 and E4.
    let mut hand = guitar();
    play(&mut hand, &[72], &FREE);
    let mut uses = FREE;
    uses[0] = held(72, 8);
    assert_eq!(play(&mut hand, &[64], &uses), [Some((1, 5))]);
    assert_eq!(play(&mut hand, &[53], &uses), [Some((4, 8))]);
    assert!(hand.position() <= 8 && hand.position() + SPAN > 8, "{}", hand.position());
    // A note kept by the pedal alone needs no finger.
    uses[0] = Use::Taken { channel: 1, key: 72, since: 0, key_down: false, fret: 8 };
    play(&mut hand, &[42], &uses);
    assert!(hand.position() < 5, "{}", hand.position());
}

#[test]
fn a_bass_is_played_open_under_a_melody_far_up_the_neck() {
    let up_the_neck = || {
        let mut hand = guitar();
        play(&mut hand, &[76], &FREE);
        hand
    };
    let mut uses = FREE;
    uses[0] = held(76, 12);
    assert_eq!(play(&mut up_the_neck(), &[45], &uses), [Some((4, 0))]);
    assert_eq!(play(&mut up_the_neck(), &[76, 45], &FREE), [Some((0, 12)), Some((4, 0))]);
    // Alone, or near to what else sounds, it would stand out.
    assert_eq!(play(&mut up_the_neck(), &[50], &FREE), [Some((5, 10))]);
    uses[4] = held(57, 12);
    assert_eq!(play(&mut up_the_neck(), &[50], &uses), [Some((5, 10))]);
}

#[test]
fn a_pedal_note_gives_way_before_any_held_key() {
    let taken = |key, since, key_down| Use::Taken { channel: 0, key, since, key_down, fret: 0 };
    let mut uses = [
        taken(64, 10, true),
        taken(59, 2, true),
        taken(55, 30, false),
        taken(50, 20, true),
        taken(45, 5, true),
        taken(40, 6, true),
    ];
    // G4 is nearest on string 0, but only the third string's note is kept by the pedal alone.
    assert_eq!(play(&mut guitar(), &[67], &uses), [Some((2, 12))]);
    uses[2] = taken(55, 30, true);
    assert_eq!(play(&mut guitar(), &[67], &uses), [Some((0, 3))]);
    // Of two notes equally near, the older one.
    uses[0] = Use::Untouchable;
    uses[1] = taken(59, 40, false);
    uses[2] = taken(55, 39, false);
    assert_eq!(play(&mut guitar(), &[64], &uses), [Some((1, 5))]);
    uses[1] = Use::Untouchable;
    assert_eq!(play(&mut guitar(), &[64], &uses), [Some((2, 9))]);
}

#[test]
fn a_sounding_key_is_struck_again_where_it_is() {
    let mut uses = FREE;
    uses[2] = Use::Taken { channel: 0, key: 64, since: 0, key_down: true, fret: 9 };
    assert_eq!(play(&mut guitar(), &[64], &uses), [Some((2, 9))]);
}

#[test]
fn of_too_many_notes_the_outer_ones_stay() {
    let keys: Vec<u8> = (45..77).collect();
    let placed = play(&mut guitar(), &keys, &FREE);
    let played: Vec<u8> = keys.iter().zip(&placed).filter_map(|(&key, place)| place.map(|_| key)).collect();
    assert!(played.contains(&76) && played.contains(&45), "{played:?}");
    assert!(played.len() <= 6);
}

#[test]
fn keys_out_of_range_move_by_octaves() {
    let hand = guitar();
    assert_eq!(hand.playable_pitch(60, None, false), Some(60.0));
    assert_eq!(hand.playable_pitch(39, None, false), Some(51.0));
    assert_eq!(hand.playable_pitch(0, None, false), Some(48.0));
    assert_eq!(hand.playable_pitch(127, None, false), Some(79.0));
    assert_eq!(hand.playable_pitch(87, None, false), Some(75.0));
}

#[test]
fn an_instant_never_takes_a_string_twice() {
    let mut uses = FREE;
    uses[0] = Use::Untouchable;
    let placed = play(&mut guitar(), &[86], &uses);
    assert_eq!(placed, [None]);
}

#[test]
fn past_the_neck_is_the_last_fret() {
    for fret in [22, 23, 100, u8::MAX] {
        let mut hand = guitar();
        hand.set_home(Some(fret));
        assert_eq!(play(&mut hand, &[74, 86], &FREE), [Some((2, 19)), Some((0, 22))], "fret {fret}");
    }
}
