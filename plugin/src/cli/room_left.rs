//! How much a disk still takes.

use std::fs::File;

/// How many bytes may still be written where a file is; nothing where that cannot be asked.
#[cfg(unix)]
#[allow(clippy::useless_conversion, reason = "on some systems these numbers are of 32 bits")]
pub(super) fn room_left(file: &File) -> Option<u64> {
    use std::mem::MaybeUninit;
    use std::os::fd::AsRawFd;

    let mut found = MaybeUninit::<libc::statvfs>::zeroed();
    // SAFETY: the file is open as long as this takes, and there is room for what is found out.
    let asked = unsafe { libc::fstatvfs(file.as_raw_fd(), found.as_mut_ptr()) };
    // SAFETY: it consists of numbers, for which zeros are values too.
    let found = unsafe { found.assume_init() };
    // (Some file systems that have no size of their own say that they have no blocks at all.)
    let is_known = asked == 0 && found.f_blocks > 0;
    is_known.then(|| u64::from(found.f_bavail).saturating_mul(found.f_frsize.into()))
}

#[cfg(not(unix))]
pub(super) fn room_left(_file: &File) -> Option<u64> {
    None
}
