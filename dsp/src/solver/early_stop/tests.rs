//! What becomes of answers to one contact with losses, from whatever forces the iteration was stopped at.

use super::super::{ARRAYS, EnergyScale, Room, place};
use super::*;
use crate::contact::{Before, ContactLaw};
use crate::response::Few;

/// Numbers from 0 to 1 that look random (the constants of Knuth's MMIX generator).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// The energy that the solver gives beyond what the law has the string get, before and after an iteration is stopped early at a
/// force that creates nothing.
fn given(contact: Active, force: f64) -> Option<(f64, f64)> {
    let mut contacts = [contact];
    let mut few = Few::gather(&contacts, 0.0);
    let mut numbers = [0.0; ARRAYS];
    let mut room = Room::new(&mut numbers, 1);
    room.start[0] = force;
    place(&mut contacts, &few, &mut room, 0.0);
    let before = 0.5 * demanded(&contacts, room.forces);
    if created(&contacts, room.forces) > 0.0 || before.abs() < 1e-15 {
        return None;
    }
    let scale = EnergyScale { present: 1e-3, credit: 0.0 };
    let gain = stop_early(&mut contacts, &mut few, &mut room, true, scale, &mut Convergence::default());
    assert!(gain <= 0.0, "{gain:e} J are created");
    Some((before, 0.5 * demanded(&contacts, room.forces)))
}

/// From both sides: a force too small for what the law loses is brought as near to nothing as one that takes too much. (Where the
/// change of penetration passes 0 nothing is given either, and sixteen tries may go there: in one of 500.)
#[test]
fn an_early_stop_neither_takes_nor_gives() {
    let mut state = 1;
    let (mut took, mut gave, mut far) = (0, 0, 0);
    for _ in 0..20_000 {
        let exponent = [1.0, 1.5, 2.0, 2.3][(random(&mut state) * 4.0) as usize];
        let law = ContactLaw::new("test", 1e7, exponent).expect("it is in range");
        let penetration = 1e-4 * (random(&mut state) - 0.2);
        let contact = Active {
            law,
            before: Before::new(&law, penetration),
            lossy: 1e5 * random(&mut state),
            centre: 2e-4 * (random(&mut state) - 0.5),
            own_mobility: 1e-5 * random(&mut state),
            ..Active::NOTHING
        };
        // Up to twice what stops it.
        let force = 2.0 * random(&mut state) * contact.centre.abs() / contact.own_mobility;
        let Some((before, after)) = given(contact, force) else { continue };
        *if before < 0.0 { &mut took } else { &mut gave } += 1;
        let missed = after.abs() > NEUTRAL * before.abs();
        far += usize::from(missed);
        assert!(
            !missed || after.abs() <= 0.1 * before.abs(),
            "{before:e} J, then {after:e} J: {contact:?} at {force} N"
        );
    }
    assert!(took > 500 && gave > 500, "{took} took and {gave} gave");
    assert!(far * 100 < took + gave, "{far} of {took} + {gave} are not brought near");
}
