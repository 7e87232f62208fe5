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
        self.turn(host.playing, host.pos_samples())
    }

    fn turn(&mut self, runs: bool, at: Option<i64>) -> Option<Turn> {
        let ran = std::mem::replace(&mut self.ran, runs);
        if !runs {
            return ran.then_some(Turn::Stops);
        }
        let before = std::mem::replace(&mut self.at, at);
        let back = before.zip(at).map_or(0, |(before, at)| before.saturating_sub(at));
        let goes_back = back > 0 && back >= self.largest_block;
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
            assert_eq!(transport.turn(runs, at), turn, "{runs}, {at:?}");
        }
    }
}
