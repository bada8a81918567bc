//! Runs a candidate's command: with a limit of time, and so that nothing of it is left, however this program ends.
//!
//! The command and all that it starts are a process group of their own. A small shell, the *warden*, holds the read end of a pipe
//! whose other end only this process has. The pipe ends when this process closes it, or when this process ends in whatever way: by
//! Ctrl-C, by a signal, by `kill -9`. Then the warden interrupts the group, kills it a moment later, and removes the temporary
//! folder of the scene. So no code runs in this process when a signal comes, and no signal is caught.
//!
//! A program that leaves the group on purpose (`setsid`) is out of reach. Where there are no process groups, on Windows, the shell
//! of the command alone is ended, and a temporary folder may be left.

use std::collections::VecDeque;
use std::io::{Read, Write as _};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two looks at whether the command has ended: short at first, for programs that answer at once.
const POLLS: [Duration; 2] = [Duration::from_millis(2), Duration::from_millis(50)];

/// Bytes of the end of what a command says that are kept; the rest is read and dropped.
const MAX_MESSAGE_BYTES: usize = 2000;

/// How long the last words of a command are waited for once all of it has ended.
const MAX_WAIT: Duration = Duration::from_millis(500);

/// How a command ended.
pub(super) enum Ended {
    /// By itself.
    With(ExitStatus),
    /// It took too long.
    TooLate,
}

/// What a warden does: `$1` is the process group, `$2` the folder. With a line on the pipe this process still needs the folder.
///
/// A signal only asks for an end: `gone` waits until the group has no process any more, for at most so many hundredths of a second.
/// Ended processes that nobody collects, as in a container without an init, count as there until then.
#[cfg(unix)]
const WARDEN: &str = "gone() { n=0; while kill -s 0 -- \"-$1\" 2>/dev/null; do\n\
        [ $n -lt $2 ] || return 1; n=$((n + 1)); sleep 0.01; done; }\n\
    read line; got=$?\n\
    kill -s INT -- \"-$1\" 2>/dev/null && ! gone \"$1\" 20 && kill -s KILL -- \"-$1\" 2>/dev/null && gone \"$1\" 100\n\
    [ \"$got\" -eq 0 ] || rm -rf -- \"$2\"";

/// A process group, which ends when this value goes.
struct Warden(Option<Child>);

impl Warden {
    #[cfg(unix)]
    fn of(group: u32, folder: &Path) -> std::io::Result<Self> {
        use std::os::unix::process::CommandExt as _;
        Command::new("sh")
            .args(["-c", WARDEN, "sh", &group.to_string()])
            .arg(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            // Ctrl-C is not for it.
            .process_group(0)
            .spawn()
            .map(|child| Self(Some(child)))
    }

    #[cfg(not(unix))]
    fn of(_group: u32, _folder: &Path) -> std::io::Result<Self> {
        Ok(Self(None))
    }
}

impl Drop for Warden {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            if let Some(mut pipe) = child.stdin.take() {
                let _ = pipe.write_all(b"end\n");
            }
            // Then there is nothing left of the group.
            let _ = child.wait();
        }
    }
}

/// Runs a line of a shell for at most so long, whose files are in `folder`: how it ended, and the end of what it said.
pub(super) fn run(line: &str, most: Duration, folder: &Path) -> std::io::Result<(Ended, String)> {
    let (shell, flag) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let mut command = Command::new(shell);
    command.args([flag, line]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let mut child = command.spawn()?;
    let warden = match Warden::of(child.id(), folder) {
        Ok(warden) => warden,
        Err(error) => {
            let _ = child.kill();
            let _ = child.wait();
            return Err(error);
        }
    };
    let said = Arc::new(Mutex::new(VecDeque::new()));
    let reader = child.stderr.take().map(|stream| {
        let said = Arc::clone(&said);
        std::thread::spawn(move || keep_end(stream, &said))
    });
    let start = Instant::now();
    let ended = loop {
        if let Some(status) = child.try_wait()? {
            break Ended::With(status);
        }
        if start.elapsed() > most {
            break Ended::TooLate;
        }
        std::thread::sleep(if start.elapsed() < 20 * POLLS[0] { POLLS[0] } else { POLLS[1] });
    };
    // Children that outlive the command, too. What a warden removes is only needed if this process ends.
    drop(warden);
    if matches!(ended, Ended::TooLate) {
        // Where there is no group.
        let _ = child.kill();
        let _ = child.wait();
    }
    let end = Instant::now();
    // Somebody who left the group may hold the stream for ever.
    while reader.as_ref().is_some_and(|reader| !reader.is_finished()) && end.elapsed() < MAX_WAIT {
        std::thread::sleep(POLLS[0]);
    }
    let said: Vec<u8> = said.lock().unwrap_or_else(PoisonError::into_inner).iter().copied().collect();
    Ok((ended, String::from_utf8_lossy(&said).into_owned()))
}

/// Reads a stream to its end and keeps the last bytes.
fn keep_end(mut stream: impl Read, said: &Mutex<VecDeque<u8>>) {
    let mut buffer = [0; 1 << 13];
    while let Ok(count @ 1..) = stream.read(&mut buffer) {
        let mut said = said.lock().unwrap_or_else(PoisonError::into_inner);
        said.extend(&buffer[..count]);
        let surplus = said.len().saturating_sub(MAX_MESSAGE_BYTES);
        said.drain(..surplus);
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Whether a process is there and is more than an entry of its parent.
    fn lives(pid: &str) -> bool {
        let stat = std::fs::read_to_string(format!("/proc/{pid}/stat"));
        match stat {
            Ok(stat) => !stat.contains(") Z "),
            // Not Linux.
            Err(_) if Path::new("/proc/self").exists() => false,
            Err(_) => Command::new("kill").args(["-0", pid]).status().is_ok_and(|it| it.success()),
        }
    }

    fn ran(line: &str, most: Duration) -> (Option<i32>, String) {
        let folder = tempfile::tempdir().unwrap();
        let (ended, said) = run(line, most, folder.path()).unwrap();
        // It is still needed: the answers are there.
        assert!(folder.path().exists());
        match ended {
            Ended::With(status) => (status.code(), said),
            Ended::TooLate => (None, said),
        }
    }

    const LONG: Duration = Duration::from_secs(60);

    #[test]
    fn a_command_ends_by_itself_and_its_last_words_are_kept() {
        assert_eq!(ran("exit 3", LONG), (Some(3), String::new()));
        assert_eq!(ran("echo out; echo why >&2", LONG), (Some(0), "why\n".into()));
        let (code, said) =
            ran("i=0; while [ $i -lt 20000 ]; do echo line $i >&2; i=$((i+1)); done; exit 1", LONG);
        assert_eq!((code, said.len()), (Some(1), MAX_MESSAGE_BYTES));
        assert!(said.ends_with("line 19999\n"), "{said}");
    }

    #[test]
    fn nothing_that_a_command_starts_outlives_it() {
        // One child that ends when it is asked to, and one that does not listen.
        let start = "sleep 300 & echo $! >&2; (trap '' INT TERM; exec sleep 300) & echo $! >&2;";
        for (line, most, code) in [
            (format!("{start} exit 0"), LONG, Some(0)),
            (format!("{start} wait"), Duration::from_millis(50), None),
        ] {
            let (found, said) = ran(&line, most);
            assert_eq!(found, code, "{line}");
            let pids: Vec<&str> = said.lines().collect();
            assert_eq!(pids.len(), 2, "{said}");
            assert!(!pids.iter().any(|pid| lives(pid)), "{line}: {said}");
        }
    }

    /// It left the process group, and keeps the stream of what the command says.
    #[cfg(target_os = "linux")]
    #[test]
    fn who_left_the_group_is_not_waited_for() {
        let start = Instant::now();
        assert_eq!(ran("setsid sleep 20 & exit 0", LONG).0, Some(0));
        assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    }
}
