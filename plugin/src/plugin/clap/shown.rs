//! The host goes on when the editor is shown, and need not when it is hidden.
//!
//! While the editor is open the plugin never says that it rests, so that what is done there is heard. A host that had
//! stopped before has to be asked to go on, which the framework (nice-plug 0.4.2) never does. And one that is only hidden is open to
//! the framework: nobody looks at it.

use std::ffi::c_char;

use clap_sys::ext::gui::{clap_plugin_gui, clap_window};
use clap_sys::plugin::clap_plugin;

use super::Instance;
use super::around::Around;

static FUNCTIONS: Around<clap_plugin_gui> = Around::new();

/// The extension for windows, with the host woken by what shows one; nothing for nothing.
///
/// # Safety
/// It must be null or the framework's, whose functions are the same each time.
pub(super) unsafe fn around(extension: *const clap_plugin_gui) -> *const clap_plugin_gui {
    // SAFETY: as above.
    unsafe {
        FUNCTIONS.around(extension, |inner| clap_plugin_gui {
            create: Some(create),
            set_parent: Some(set_parent),
            show: Some(show),
            hide: Some(hide),
            ..*inner
        })
    }
}

unsafe extern "C" fn create(plugin: *const clap_plugin, api: *const c_char, is_floating: bool) -> bool {
    let Some(inner) = FUNCTIONS.inner().and_then(|gui| gui.create) else { return false };
    // SAFETY: the host gives back what it was given, and names a kind of windows.
    unsafe { inner(plugin, api, is_floating) && is_hidden(plugin) }
}

unsafe extern "C" fn set_parent(plugin: *const clap_plugin, window: *const clap_window) -> bool {
    let Some(inner) = FUNCTIONS.inner().and_then(|gui| gui.set_parent) else { return false };
    // SAFETY: the host gives back what it was given, and a window.
    unsafe { inner(plugin, window) && is_shown(plugin) }
}

unsafe extern "C" fn show(plugin: *const clap_plugin) -> bool {
    let Some(inner) = FUNCTIONS.inner().and_then(|gui| gui.show) else { return false };
    // SAFETY: as above.
    unsafe { inner(plugin) && is_shown(plugin) }
}

unsafe extern "C" fn hide(plugin: *const clap_plugin) -> bool {
    let Some(inner) = FUNCTIONS.inner().and_then(|gui| gui.hide) else { return false };
    // SAFETY: as above.
    unsafe { inner(plugin) && is_hidden(plugin) }
}

/// It is there and nobody sees it: it has just been made, or hidden.
///
/// # Safety
/// The plugin must be an [`Instance`].
unsafe fn is_hidden(plugin: *const clap_plugin) -> bool {
    // SAFETY: as above.
    unsafe { (*plugin.cast::<Instance>()).door.hide(true) };
    true
}

/// It is shown: also by hosts that put it into a window of theirs and say no more.
///
/// # Safety
/// The plugin must be an [`Instance`].
unsafe fn is_shown(plugin: *const clap_plugin) -> bool {
    // SAFETY: as above.
    unsafe {
        (*plugin.cast::<Instance>()).door.hide(false);
        Instance::wake(plugin)
    }
}

#[cfg(test)]
mod tests {
    use std::ffi::{CStr, c_void};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};

    use clap_sys::ext::gui::CLAP_EXT_GUI;
    use clap_sys::host::clap_host;
    use clap_sys::version::CLAP_VERSION;

    use super::super::{Modulated, descriptor};
    use super::*;

    static ASKED: AtomicU32 = AtomicU32::new(0);

    unsafe extern "C" fn request_process(_: *const clap_host) {
        ASKED.fetch_add(1, Ordering::Relaxed);
    }
    unsafe extern "C" fn shows(_: *const clap_plugin) -> bool {
        true
    }
    unsafe extern "C" fn makes(_: *const clap_plugin, _: *const c_char, _: bool) -> bool {
        true
    }
    unsafe extern "C" fn refuses(_: *const clap_plugin, _: *const clap_window) -> bool {
        false
    }
    unsafe extern "C" fn extension(_: *const clap_plugin, id: *const c_char) -> *const c_void {
        static GUI: clap_plugin_gui = clap_plugin_gui {
            is_api_supported: None,
            get_preferred_api: None,
            create: Some(makes),
            destroy: None,
            set_scale: None,
            get_size: None,
            can_resize: None,
            get_resize_hints: None,
            adjust_size: None,
            set_size: None,
            set_parent: Some(refuses),
            set_transient: None,
            suggest_title: None,
            show: Some(shows),
            hide: Some(shows),
        };
        // SAFETY: only the test below asks.
        if unsafe { CStr::from_ptr(id) } == CLAP_EXT_GUI { (&raw const GUI).cast() } else { std::ptr::null() }
    }

    unsafe extern "C" fn knows_windows(_: *const clap_host, id: *const c_char) -> *const c_void {
        // SAFETY: only the test below asks.
        if unsafe { CStr::from_ptr(id) } == CLAP_EXT_GUI { c"one".as_ptr().cast() } else { std::ptr::null() }
    }
    unsafe extern "C" fn knows_nothing(_: *const clap_host, _: *const c_char) -> *const c_void {
        std::ptr::null()
    }

    #[test]
    fn a_host_is_woken_when_the_window_is_shown_until_it_is_hidden() {
        let mut host = clap_host {
            clap_version: CLAP_VERSION,
            host_data: std::ptr::null_mut(),
            name: c"a host".as_ptr(),
            vendor: c"".as_ptr(),
            url: c"".as_ptr(),
            version: c"".as_ptr(),
            get_extension: Some(knows_windows),
            request_restart: None,
            request_process: Some(request_process),
            request_callback: None,
        };
        let inside = clap_plugin {
            desc: descriptor().clap_plugin_descriptor(),
            plugin_data: std::ptr::null_mut(),
            init: None,
            destroy: None,
            activate: None,
            deactivate: None,
            start_processing: None,
            stop_processing: None,
            reset: None,
            process: None,
            get_extension: Some(extension),
            on_main_thread: None,
        };
        let outside = clap_plugin { get_extension: Some(Instance::get_extension), ..inside };
        let host = &raw mut host;
        let instance = Instance::new(outside, &inside, host, Modulated::default(), Arc::default());
        let plugin = (&raw const instance).cast::<clap_plugin>();
        // SAFETY: all of them are alive.
        unsafe {
            assert!(Instance::get_extension(plugin, c"clap.tail".as_ptr()).is_null());
            let gui = Instance::get_extension(plugin, CLAP_EXT_GUI.as_ptr()).cast::<clap_plugin_gui>();
            let gui = gui.as_ref().expect("there is a window");
            assert!(gui.create.expect("it can be made")(plugin, c"x11".as_ptr(), false));
            assert!(instance.door.is_hidden(), "it is only made");
            assert!(!gui.set_parent.expect("it can be put into another")(plugin, std::ptr::null()));
            assert_eq!(ASKED.load(Ordering::Relaxed), 0, "it could not be");
            assert!(gui.show.expect("it can be shown")(plugin));
            assert!(!instance.door.is_hidden());
            assert!(gui.hide.expect("it can be hidden")(plugin));
            assert!(instance.door.is_hidden(), "nobody sees it");
        }
        assert_eq!(ASKED.load(Ordering::Relaxed), 1);
        // SAFETY: as above.
        let show = unsafe {
            Instance::get_extension(plugin, CLAP_EXT_GUI.as_ptr()).cast::<clap_plugin_gui>().as_ref()
        };
        let show = show.and_then(|gui| gui.show).expect("it can be shown");
        // SAFETY: as above.
        assert!(unsafe { show(plugin) } && !instance.door.is_hidden(), "it is seen again");
        // The framework would take it at its word, and panic.
        for knows in [Some(knows_nothing as _), None] {
            // SAFETY: as above.
            unsafe {
                (*host).get_extension = knows;
                let gui = Instance::get_extension(plugin, CLAP_EXT_GUI.as_ptr());
                assert!(gui.is_null(), "a host that knows of no windows is told of none");
            }
        }
    }
}
