//! What asks the program to stop: Ctrl+C, and where there are such things a request to end, a terminal that is closed, and all
//! else that ends programs which do not mind it.

use std::process;
#[cfg(unix)]
use std::{sync::mpsc, thread};

/// The exit code of programs that were told to stop where no signal tells it: 128 and the number of Ctrl+C's, as shells
/// have it.
const STOPPED: i32 = 130;

/// That the program was asked to stop, and by what.
#[derive(Debug)]
pub(super) struct Stop {
    #[cfg(unix)]
    signal: libc::c_int,
}

impl Stop {
    /// Ends the program as what asked for it ends programs that do not mind it. Only from that do shells see that a loop
    /// is to end, too: from an exit code they would go on with the next song.
    pub fn end_program(self) -> ! {
        #[cfg(unix)]
        if process::id() != FIRST_PROCESS {
            signal_hook::low_level::emulate_default_handler(self.signal).ok();
        }
        process::exit(STOPPED)
    }
}

/// The number of the first process of a system or a container. No signal that it sends to itself ends it.
#[cfg(unix)]
const FIRST_PROCESS: u32 = 1;

/// Has all of them call `stop`, once. That a file may not get longer is no such thing: who writes it is told, and can say so.
///
/// Each is left as it is if the program was started with something else for it than the usual: nohup has one ignored,
/// and shells have Ctrl+C ignored in the background. All are left where the system has no room for the thread that waits for them.
#[cfg(unix)]
pub(super) fn when_asked(stop: impl FnOnce(Stop) + Send + 'static) {
    use signal_hook::consts::{
        SIGALRM, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ,
    };
    use signal_hook::iterator::Signals;

    let all = [SIGHUP, SIGINT, SIGTERM, SIGQUIT, SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ];
    // The thread comes first: signals that nobody waits for would do nothing any more.
    let (sender, receiver) = mpsc::channel::<Signals>();
    let wait = move || {
        let signals = receiver.recv().ok();
        let first = signals.and_then(|mut signals| signals.forever().find(|&signal| signal != SIGXFSZ));
        first.map(|signal| stop(Stop { signal }))
    };
    if thread::Builder::new().spawn(wait).is_ok()
        && let Ok(signals) = Signals::new(all.into_iter().filter(|&signal| is_usual(signal)))
    {
        sender.send(signals).ok();
    }
}

/// Whether a signal does what signals do unless somebody has said otherwise.
#[cfg(unix)]
fn is_usual(signal: libc::c_int) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
    // SAFETY: without a new action this only reads the present one, into a place that has room for it.
    let read = unsafe { libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) };
    // SAFETY: it consists of numbers and of a function that may be absent, for which zeros are values too.
    read == 0 && unsafe { action.assume_init() }.sa_sigaction == libc::SIG_DFL
}

/// Has Ctrl+C call `stop`, once.
#[cfg(not(unix))]
pub(super) fn when_asked(stop: impl FnOnce(Stop) + Send + 'static) {
    let mut stop = Some(stop);
    ctrlc::try_set_handler(move || {
        if let Some(stop) = stop.take() {
            stop(Stop {});
        }
    })
    .ok();
}
