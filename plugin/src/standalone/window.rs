//! The window of the stand-alone instrument: whether there can be one, how it was left, and that signals close it.

use std::path::PathBuf;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(all(unix, feature = "editor"))]
use nice_plug_egui::RepaintNotifier;

use crate::cli::say;
use crate::params::Start;
use crate::plugin::layout::Layout;
use crate::setups;

/// What the window of this program shows, if it has one.
static SHOWN: OnceLock<Layout> = OnceLock::new();
/// Whether it has gone.
static GONE: AtomicBool = AtomicBool::new(false);
/// Whether it is to go.
#[cfg(all(unix, feature = "editor"))]
static LEAVING: AtomicBool = AtomicBool::new(false);

/// Gets ready for a window as it was left the last time; says why if there can be none.
pub(super) fn prepare(start: &mut Start) -> bool {
    if let Err(cause) = find_display() {
        say("warning", &format!("plays without a window: {cause}"));
        start.windowless = true;
        return false;
    }
    if let Some(Err(error)) = place().map(|path| start.layout.load(&path)) {
        say("warning", &format!("{error:#}"));
    }
    SHOWN.get_or_init(|| start.layout.clone());
    true
}

/// The window has gone: how it was left is kept at once, since the framework goes on until it is asked for a last block.
#[cfg(feature = "editor")]
pub(crate) fn gone() {
    if let Some(layout) = SHOWN.get() {
        keep(layout);
        GONE.store(true, Ordering::Relaxed);
    }
}

/// Whether it has.
pub(super) fn is_gone() -> bool {
    GONE.load(Ordering::Relaxed)
}

/// Keeps how the window was left for the next time.
pub(super) fn keep(layout: &Layout) {
    if let Some(Err(error)) = place().map(|path| layout.save(&path)) {
        say("warning", &format!("{error:#}"));
    }
}

/// Where that is kept; nothing if the system knows no such place.
fn place() -> Option<PathBuf> {
    Some(setups::data_folder()?.join("window.json"))
}

#[cfg(all(unix, not(target_os = "macos")))]
fn find_display() -> Result<(), String> {
    let name = std::env::var("DISPLAY").unwrap_or_default();
    let is = if name.is_empty() { "not set".to_owned() } else { format!("{name:?}") };
    let describe = |error| format!("DISPLAY is {is}, and must name a display that can be reached ({error})");
    x11rb::connect(None).map(drop).map_err(describe)
}

#[cfg(not(all(unix, not(target_os = "macos"))))]
fn find_display() -> Result<(), String> {
    Ok(())
}

/// Has what ends other programs, such as Ctrl+C in the terminal, close the window, which is drawn once more for that; a
/// second time ends the program at once.
///
/// The framework takes Ctrl+C for itself, and then does not look at it while there is a window. This is to be called
/// once that has happened: when the window opens. (Whoever held the window itself would keep all of it from going.)
#[cfg(all(unix, feature = "editor"))]
pub(crate) fn close_on_signals(repaint: RepaintNotifier) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let watch = move |mut signals: Signals| {
        for signal in signals.forever() {
            if LEAVING.swap(true, Ordering::Relaxed) {
                emulate_default_handler(signal).ok();
            }
            repaint.request_repaint();
        }
    };
    match Signals::new([SIGHUP, SIGINT, SIGTERM]) {
        Ok(signals) => {
            std::thread::spawn(move || watch(signals));
        }
        Err(error) => say("warning", &format!("Ctrl+C will not close the window: {error}")),
    }
}

/// Whether a signal has come that is to close it.
#[cfg(all(unix, feature = "editor"))]
pub(crate) fn is_leaving() -> bool {
    LEAVING.load(Ordering::Relaxed)
}
