//! Which registered parameter a channel's data entry sets.

use super::controller;

/// The parameter that controllers have chosen, by the halves of its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ChosenParameter {
    upper: u8,
    lower: u8,
}

impl ChosenParameter {
    /// No parameter is chosen: both halves are 127.
    pub const NONE: Self = Self { upper: 127, lower: 127 };
    /// How far the wheel reaches: semitones in the upper half of data entry, cents in the lower.
    pub const WHEEL: u16 = 0;
    /// How far off a channel is tuned, within a semitone either way.
    pub const FINE_TUNING: u16 = 1;
    /// By how many whole semitones.
    pub const COARSE_TUNING: u16 = 2;
    /// How many channels MPE has.
    pub const MEMBERS: u16 = 6;

    /// Hears a controller and its value, 0 to 127; one that chooses nothing leaves the choice as it is. A non-registered
    /// parameter takes data entry away from the registered one, as does a reset of all controllers.
    pub fn hear(&mut self, number: u8, value: u8) {
        match number {
            controller::PARAMETER_LOWER => self.lower = value,
            controller::PARAMETER_UPPER => self.upper = value,
            controller::RESET => *self = Self::NONE,
            _ if controller::OTHER_PARAMETER.contains(&number) => *self = Self::NONE,
            _ => {}
        }
    }

    /// The number of the parameter, if there is one.
    pub fn number(self) -> Option<u16> {
        (self != Self::NONE).then_some(u16::from(self.upper) * 128 + u16::from(self.lower))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_is_chosen_by_both_halves_and_taken_back_by_another_kind() {
        let mut chosen = ChosenParameter::NONE;
        assert_eq!(chosen.number(), None);
        chosen.hear(100, 6);
        assert_ne!(chosen.number(), Some(ChosenParameter::MEMBERS), "by its lower half alone");
        chosen.hear(101, 0);
        chosen.hear(6, 15);
        assert_eq!(chosen.number(), Some(ChosenParameter::MEMBERS));
        for other in [98, 99, 121] {
            let mut taken = chosen;
            taken.hear(other, 0);
            assert_eq!(taken.number(), None, "controller {other}");
        }
    }
}
