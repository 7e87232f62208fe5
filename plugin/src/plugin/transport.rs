//! What the host's transport means to those who play: that the music stops, or begins once more.

/// How it has run so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Transport {
    /// The host's largest block, samples. Where a host tells of its transport within a block, the framework (nice-plug 0.4.2) adds
    /// the time since the block began to the position that is told, and is ahead by less than a block.
    largest_block: i64,
    /// Whether it ran at the last block.
    ran: bool,
    /// Where it was when it last ran, samples, if the host says so.
    at: Option<i64>,
    /// The same in beats.
    beats: Option<f64>,
}

/// What happens to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Turn {
    /// It stops.
    Stops,
    /// It starts, or goes back by a block or more, as in a loop. Where a host has let the plugin sleep meanwhile, only that it is farther back tells of
    /// a start.
    Begins,
}

impl Transport {
    /// That of a host whose blocks have up to so many samples.
    pub fn of_blocks(largest: u32) -> Self {
        Self { largest_block: largest.into(), ..Self::default() }
    }

    /// Follows the host's into another block.
    pub fn follow(&mut self, host: &nice_plug::prelude::Transport) -> Option<Turn> {
        self.turn(host.playing, host.pos_samples(), host.pos_beats())
    }

    /// Of a host that tells of samples or beats only the framework makes the others by the tempo of the moment, so that these go back
    /// where the tempo changes. What goes back does so in both.
    fn turn(&mut self, runs: bool, at: Option<i64>, beats: Option<f64>) -> Option<Turn> {
        let ran = std::mem::replace(&mut self.ran, runs);
        if !runs {
            return ran.then_some(Turn::Stops);
        }
        let before = std::mem::replace(&mut self.at, at);
        let back = before.zip(at).map_or(0, |(before, at)| before.saturating_sub(at));
        let in_beats =
            std::mem::replace(&mut self.beats, beats).zip(beats).is_none_or(|(before, at)| at < before);
        let goes_back = back > 0 && back >= self.largest_block && in_beats;
        (!ran || goes_back).then_some(Turn::Begins)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_music_begins_where_it_starts_or_goes_back() {
        let mut transport = Transport::of_blocks(512);
        for (runs, at, turn) in [
            (false, Some(0), None),
            (true, Some(0), Some(Turn::Begins)),
            (true, Some(512), None),
            (true, Some(4096), None),
            // A host that has told of its transport at a block's last sample.
            (true, Some(4607 + 511), None),
            (true, Some(4608), None),
            (true, Some(5120), None),
            // A loop, or a start that nobody has told of.
            (true, Some(512), Some(Turn::Begins)),
            (true, None, None),
            (false, None, Some(Turn::Stops)),
            (false, None, None),
            (true, None, Some(Turn::Begins)),
            (true, None, None),
        ] {
            assert_eq!(transport.turn(runs, at, None), turn, "{runs}, {at:?}");
        }
    }

    /// The third tells of samples and the tempo, the others of beats.
    #[test]
    fn another_tempo_is_no_way_back() {
        let mut transport = Transport::of_blocks(512);
        for (at, beats, turn) in [
            (480_000, 20.0, Some(Turn::Begins)),
            // Twice as fast: as if it had been so from the beginning.
            (240_000, 20.01, None),
            (240_512, 10.02, None),
            (120_000, 10.03, None),
            // Back by both.
            (48_000, 2.0, Some(Turn::Begins)),
        ] {
            assert_eq!(transport.turn(true, Some(at), Some(beats)), turn, "{at} samples, {beats} beats");
        }
    }
}
