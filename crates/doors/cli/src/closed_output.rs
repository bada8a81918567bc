//! Whether standard output was closed when the process began (`>&-`).
//!
//! Before `main` the standard library opens /dev/null in the place of a closed standard output, and what is written there seems to
//! arrive. Afterwards nothing tells it from an output that somebody sent to /dev/null on purpose, which is no error. So it is asked
//! earlier, where the system starts programs by a list of functions that run before everything else.

#[cfg(target_os = "linux")]
mod at_start {
    use std::sync::atomic::{AtomicBool, Ordering};

    static WAS_CLOSED: AtomicBool = AtomicBool::new(false);

    #[allow(unsafe_code, reason = "the loader runs what this section lists")]
    #[used]
    #[unsafe(link_section = ".init_array")]
    static LOOK: extern "C" fn() = look;

    extern "C" fn look() {
        #[allow(unsafe_code, reason = "asks for the flags of a file descriptor, which needs no open file")]
        let flags = unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) };
        WAS_CLOSED.store(flags == -1, Ordering::Relaxed);
    }

    /// The error of a write to standard output, if that was closed.
    pub(crate) fn error() -> Option<std::io::Error> {
        WAS_CLOSED.load(Ordering::Relaxed).then(|| std::io::Error::from_raw_os_error(libc::EBADF))
    }
}

/// Other systems are not asked: there a closed standard output is as good as /dev/null.
#[cfg(not(target_os = "linux"))]
mod at_start {
    pub(crate) fn error() -> Option<std::io::Error> {
        None
    }
}

pub(crate) use at_start::error;
