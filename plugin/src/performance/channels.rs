//! Sets of channels, which of them are notes of MPE, and which one speaks for others.

use super::channel::Channel;
use super::control::{MPE_MANAGER, MPE_UPPER_MANAGER};
use super::{InputMode, Performance, PlayerEvent, seven_bits};

/// Some of the 16 channels, a bit for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Channels(u16);

impl Channels {
    /// None of them.
    pub const NONE: Self = Self(0);
    /// All of them.
    pub const ALL: Self = Self(u16::MAX);
    /// All but the one that acts on all in MPE.
    pub const MEMBERS: Self = Self(!(1 << MPE_MANAGER));

    /// Members of MPE if so many were announced on the first channel, and so many on the last for an upper zone: all of both are
    /// the first one's, which alone makes MPE of it.
    pub fn announced(lower: Option<u8>, upper: Option<u8>) -> Self {
        let bits = |count: Option<u8>| u16::MAX.unbounded_shl(count.map_or(0, u32::from)) ^ u16::MAX;
        let (lower, upper) = (bits(lower) << 1, (bits(upper) << 1).reverse_bits());
        if lower == 0 { Self::NONE } else { Self((lower | upper) & Self::MEMBERS.0) }
    }

    /// One alone.
    pub fn one(channel: u8) -> Self {
        Self(1_u16.unbounded_shl(u32::from(channel)))
    }

    /// Whether a channel is one of them.
    pub fn has(self, channel: u8) -> bool {
        self.0 & Self::one(channel).0 != 0
    }

    /// These and others.
    pub fn and(self, others: Self) -> Self {
        Self(self.0 | others.0)
    }

    /// These without others.
    pub fn without(self, others: Self) -> Self {
        Self(self.0 & !others.0)
    }
}

/// A channel that speaks for others, beside what they say themselves: in MPE the first one for its members, where each string has a
/// channel the one below these for all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Spoken {
    /// The channel.
    pub by: u8,
    /// Those that it speaks for; none where it has nobody to speak for.
    pub of: Channels,
}

impl Spoken {
    /// Those that a channel speaks for.
    pub fn with(self, channel: u8) -> Channels {
        if channel == self.by { self.of } else { Channels::NONE }
    }
}

/// All channels that are announced as members of MPE by any of these events, which are in order of time.
pub(crate) fn announced_members(events: impl Iterator<Item = PlayerEvent>) -> Channels {
    let [mut lower, mut upper] = [MPE_MANAGER, MPE_UPPER_MANAGER].map(|_| Channel::new(0.0));
    let mut members = Channels::NONE;
    for event in events {
        let PlayerEvent::Controller { channel, number, value } = event else { continue };
        let sender = match channel {
            MPE_MANAGER => &mut lower,
            MPE_UPPER_MANAGER => &mut upper,
            _ => continue,
        };
        sender.set_controller(number, seven_bits(value));
        members = members.and(Channels::announced(lower.members, upper.members));
    }
    members
}

impl Performance {
    /// The channels that are notes of MPE: those that were announced, or all where the player has chosen it and nobody has said how
    /// many there are. The first channel acts on them.
    pub(crate) fn members(&self) -> Channels {
        let [lower, upper] =
            [MPE_MANAGER, MPE_UPPER_MANAGER].map(|own| self.channels[usize::from(own)].members);
        match (self.input, Channels::announced(lower, upper)) {
            (InputMode::Mpe, Channels::NONE) => Channels::MEMBERS,
            (InputMode::Mpe | InputMode::Auto, announced) => announced,
            _ => Channels::NONE,
        }
    }

    /// Which channel speaks for which others.
    pub(crate) fn spoken(&self) -> Spoken {
        let of_mpe = || Spoken { by: MPE_MANAGER, of: self.members() };
        self.input.spoken(self.strings.len()).unwrap_or_else(of_mpe)
    }

    /// The channel that speaks for another, if one does.
    pub(super) fn speaker(&self, channel: u8) -> Option<&Channel> {
        let Spoken { by, of } = self.spoken();
        of.has(channel).then(|| &self.channels[usize::from(by)])
    }

    /// Whether channel 0 acts on the notes of others.
    pub(super) fn is_mpe(&self) -> bool {
        self.members() != Channels::NONE
    }

    /// Whether it does so on those of a channel.
    pub(super) fn is_member(&self, channel: u8) -> bool {
        self.members().has(channel)
    }

    /// The members' channels themselves.
    pub(super) fn each_of(&mut self, which: Channels) -> impl Iterator<Item = &mut Channel> {
        self.channels.iter_mut().zip(0..).filter(move |&(_, own)| which.has(own)).map(|(channel, _)| channel)
    }

    /// A channel with those whose notes are of one player's hand with its: in MPE all that are of it.
    pub(super) fn of_one_hand(&self, channel: u8) -> Channels {
        let all = self.members().and(Channels::one(MPE_MANAGER));
        if self.is_mpe() && all.has(channel) { all } else { Channels::one(channel) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_counted_from_the_second_channel_up_and_from_the_last_but_one_down() {
        let members = |lower, upper| {
            let announced = Channels::announced(lower, upper);
            (0..16_u8).filter(|&channel| announced.has(channel)).collect::<Vec<_>>()
        };
        assert_eq!(members(Some(5), None), [1, 2, 3, 4, 5]);
        assert_eq!(members(Some(3), Some(2)), [1, 2, 3, 13, 14]);
        assert_eq!(members(Some(15), None), (1..16).collect::<Vec<_>>());
        assert_eq!(members(Some(1), Some(15)), (1..15).collect::<Vec<_>>());
        for lower in [None, Some(0)] {
            assert!(members(lower, Some(7)).is_empty(), "an upper zone alone is none");
        }
        assert_eq!(Channels::announced(Some(15), None), Channels::MEMBERS);
    }
}
