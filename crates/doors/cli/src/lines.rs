//! Lines that say how far a long work is where no bar can be drawn: in the log of a test run.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::console::{complain, shows_lines};

/// Time between two lines.
const PERIOD: Duration = Duration::from_secs(10);

/// Prints a line every so often until it is dropped.
#[derive(Debug)]
pub(crate) struct Lines {
    /// Both are there until the end.
    thread: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Lines {
    /// Lines on standard error every ten seconds, if it is no terminal; none with `--quiet`.
    pub(crate) fn begin(words: impl Fn() -> String + Send + 'static) -> Self {
        match shows_lines() {
            true => Self::every(PERIOD, move || complain(&format!("{}\n", words()))),
            false => Self { thread: None },
        }
    }

    fn every(period: Duration, tell: impl Fn() + Send + 'static) -> Self {
        let (stop, stopped) = channel();
        let thread = std::thread::spawn(move || {
            while stopped.recv_timeout(period) == Err(RecvTimeoutError::Timeout) {
                tell();
            }
        });
        Self { thread: Some((stop, thread)) }
    }
}

impl Drop for Lines {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.thread.take() {
            drop(stop);
            // No line after the result. A thread that panicked has told so.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;

    #[test]
    fn lines_come_until_the_end_and_not_after_it() {
        let told = Arc::new(AtomicU64::new(0));
        let count = Arc::clone(&told);
        let lines = Lines::every(Duration::from_millis(1), move || {
            count.fetch_add(1, Ordering::Relaxed);
        });
        while told.load(Ordering::Relaxed) < 3 {
            std::thread::yield_now();
        }
        drop(lines);
        let at_the_end = told.load(Ordering::Relaxed);
        std::thread::sleep(Duration::from_millis(20));
        assert_eq!(told.load(Ordering::Relaxed), at_the_end);
    }
}
