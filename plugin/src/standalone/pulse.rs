//! Whether anybody asks for sound.
//!
//! The framework opens the device in a thread of its own. Where that fails, or the device goes away, only that thread
//! ends, and a window would stay that plays to nobody. And where nobody asks for a last block once the window has gone, it would
//! wait for that for ever.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::window;
use crate::cli::say;

/// Time from one look to the next.
const BETWEEN: Duration = Duration::from_millis(500);
/// Looks without a first block after which none is expected any more: wireless outputs take some seconds to open.
const NONE_AT_ALL: u32 = 20;
/// Looks without another block after which the sound has stopped.
const NO_OTHER: u32 = 6;
/// The same once the window has gone, after which nobody waits for a last one.
const NO_LAST: u32 = 3;

/// What there is to say.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sign {
    /// Nothing new.
    Nothing,
    /// Sound was never asked for.
    Dead,
    /// It was, and is no more.
    Stopped,
    /// It is again.
    Back,
    /// The window has gone, and nobody will ask for the last block.
    Over,
}

/// What has been seen of the blocks asked for.
#[derive(Debug, Default)]
struct Pulse {
    blocks: u64,
    /// Looks since there was another.
    still: u32,
    /// Of those, the ones since the window has gone.
    gone: u32,
}

impl Pulse {
    /// Looks again; so many blocks have been asked for by now, and the window may have gone. Looks are counted and not time: a
    /// computer that slept has not missed any.
    fn look(&mut self, blocks: u64, is_gone: bool) -> Sign {
        let stopped = self.blocks > 0 && self.still >= NO_OTHER;
        if std::mem::replace(&mut self.blocks, blocks) != blocks {
            (self.still, self.gone) = (0, 0);
            return if stopped { Sign::Back } else { Sign::Nothing };
        }
        self.still = self.still.saturating_add(1);
        if is_gone {
            self.gone += 1;
            return if self.gone >= NO_LAST { Sign::Over } else { Sign::Nothing };
        }
        match (blocks, self.still) {
            (0, NONE_AT_ALL) => Sign::Dead,
            (1.., NO_OTHER) => Sign::Stopped,
            _ => Sign::Nothing,
        }
    }
}

/// Watches from now on how many blocks are asked for, by a way named so. Where there never is one the program ends with an
/// error; where they stop, which may be for a while, it says so, and where the window has gone then, the program ends.
pub(super) fn watch(blocks: Arc<AtomicU64>, way: &str) {
    let way = way.to_owned();
    std::thread::spawn(move || {
        let mut pulse = Pulse::default();
        loop {
            std::thread::sleep(BETWEEN);
            match pulse.look(blocks.load(Ordering::Relaxed), window::is_gone()) {
                Sign::Nothing => {}
                Sign::Dead => {
                    let help = "`low-action --list-devices` shows what there is";
                    say("error", &format!("no sound can be played by {way}: {help}"));
                    std::process::exit(1);
                }
                Sign::Stopped => {
                    say("warning", &format!("{way} asks for no more sound: is the device gone?"))
                }
                Sign::Back => say("low-action", &format!("{way} asks for sound again")),
                Sign::Over => std::process::exit(0),
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_asks_for_is_told_once() {
        let mut pulse = Pulse::default();
        let mut looks = |blocks, times| -> Vec<_> { (0..times).map(|_| pulse.look(blocks, false)).collect() };
        assert_eq!(looks(0, NONE_AT_ALL - 1), vec![Sign::Nothing; NONE_AT_ALL as usize - 1]);
        assert_eq!(looks(0, 1), [Sign::Dead]);
        assert_eq!(looks(1, NO_OTHER), vec![Sign::Nothing; NO_OTHER as usize]);
        assert_eq!(looks(1, 3), [Sign::Stopped, Sign::Nothing, Sign::Nothing]);
        assert_eq!(looks(2, 2), [Sign::Back, Sign::Nothing]);
    }

    /// However long nobody has asked for anything by then.
    #[test]
    fn who_waits_for_a_last_block_in_vain_ends() {
        for before in [0, 1, NO_OTHER + NONE_AT_ALL] {
            let mut pulse = Pulse::default();
            pulse.look(1, false);
            for _ in 0..before {
                pulse.look(1, false);
            }
            // The framework may be at its end already, which takes a moment.
            let mut looks =
                |blocks, times| -> Vec<_> { (0..times).map(|_| pulse.look(blocks, true)).collect() };
            looks(2, 1);
            assert_eq!(looks(2, NO_LAST - 1), vec![Sign::Nothing; NO_LAST as usize - 1]);
            assert_eq!(looks(2, 1), [Sign::Over]);
        }
        let mut never_asked = Pulse::default();
        let signs: Vec<_> = (0..NO_LAST).map(|_| never_asked.look(0, true)).collect();
        assert_eq!(signs, [Sign::Nothing, Sign::Nothing, Sign::Over]);
    }
}
