//! How far a MIDI pitch wheel is turned.

/// The turn, −1 to 1, at a place of the wheel, 0 to 16383.
///
/// The centre of its 14 bits is 8192, not the middle: the upper half is one step shorter, and both ends are full turns.
pub(crate) fn turn(place: f32) -> f32 {
    let steps = place - 8192.0;
    if steps < 0.0 { steps / 8192.0 } else { steps / 8191.0 }
}

#[cfg(test)]
mod tests {
    use super::turn;

    #[test]
    fn both_ends_are_full_turns_and_the_centre_is_none() {
        assert_eq!([0.0, 4096.0, 8192.0, 16383.0].map(turn), [-1.0, -0.5, 0.0, 1.0]);
    }
}
