//! What asks the program to stop: Ctrl+C, and where there are such things a request to end and a terminal that is closed.

/// Has all of them call `stop`, once.
///
/// Each is left as it is if the program was started with something else for it than the usual: nohup has one ignored,
/// and shells have Ctrl+C ignored in the background.
#[cfg(unix)]
pub(super) fn when_asked(stop: impl FnOnce() + Send + 'static) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    let usual = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|&signal| is_usual(signal));
    if let Ok(mut signals) = Signals::new(usual) {
        std::thread::spawn(move || signals.forever().next().map(|_| stop()));
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
pub(super) fn when_asked(stop: impl FnOnce() + Send + 'static) {
    let mut stop = Some(stop);
    ctrlc::try_set_handler(move || {
        if let Some(stop) = stop.take() {
            stop();
        }
    })
    .ok();
}
