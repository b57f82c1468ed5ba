//! The other side: a process that speaks protocol 1 on its standard input and output, and everything that can go wrong with it.

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::AsFd;
use std::os::unix::process::{CommandExt as _, ExitStatusExt as _};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};

/// The longest reply that is read, in bytes.
const MAX_REPLY: usize = 8 << 20;

/// How much of what the other side says on standard error is kept: its last bytes.
const MAX_STDERR: usize = 2000;

/// How much longer the first reply of a process may take.
const BEGIN: Duration = Duration::from_secs(8);

/// For how long a process that has closed its output may take to end before it counts as one that goes on.
const END: Duration = Duration::from_millis(700);

/// For how long what a process has said at last may take to be read, on a busy machine.
const LAST_WORDS: Duration = Duration::from_secs(2);

/// What the other side did in place of a reply that can be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Broken {
    /// It could not be started; why.
    NotStarted(String),
    /// It ended; with which exit code or by which signal.
    Ended(String),
    /// It goes on, and its output is closed.
    Closed,
    /// No reply within so many milliseconds.
    Hung(u128),
    /// A line that is not JSON, or too long a line: how it begins.
    Garbage(String),
    /// A reply of another kind: what was due, and what came.
    WrongReply(&'static str, String),
}

impl Broken {
    /// A word for the kind, for reports.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::NotStarted(_) => "not-started",
            Self::Ended(_) => "ended",
            Self::Closed => "closed",
            Self::Hung(_) => "hung",
            Self::Garbage(_) => "garbage",
            Self::WrongReply(..) => "wrong-reply",
        }
    }
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotStarted(why) => write!(f, "it does not start: {why}"),
            Self::Ended(how) => write!(f, "it ended {how} in place of a reply"),
            Self::Closed => f.write_str("it closed its output in place of a reply, and goes on"),
            Self::Hung(patience) => write!(
                f,
                "no reply within {patience} ms; does it write a whole line and flush it after every request? (--timeout gives it longer)"
            ),
            Self::Garbage(line) => write!(f, "a line that is not a reply of protocol 1: {line}"),
            Self::WrongReply(due, line) => write!(f, "a reply \"{due}\" was due, and it says {line}"),
        }
    }
}

/// Somebody who answers requests of protocol 1.
pub trait Answers {
    /// The reply line to a request line.
    ///
    /// # Errors
    /// What was done in place of a reply.
    fn ask(&mut self, line: &str) -> Result<String, Broken>;

    /// Forgets everything: the next request is the first one.
    fn end(&mut self);
}

/// The command of the other side, and its process while one runs.
pub struct Side {
    command: String,
    patience: Duration,
    running: Option<Running>,
    /// How many processes have been started.
    pub starts: u64,
    /// What the last process that ended said on standard error.
    said: String,
}

struct Running {
    child: Child,
    stdin: ChildStdin,
    stdout: ChildStdout,
    stderr: Arc<Mutex<Vec<u8>>>,
    /// Reads it, until nobody holds it open any more.
    keeper: std::thread::JoinHandle<()>,
    /// Whether it has answered: the first reply may take longer, for an interpreter to start.
    answered: bool,
    /// What was read and not yet taken as a line.
    read: Vec<u8>,
}

impl Side {
    /// The other side that this command starts, given to `sh -c`; it has so long for each reply.
    pub const fn new(command: String, patience: Duration) -> Self {
        Self { command, patience, running: None, starts: 0, said: String::new() }
    }

    /// Whether a process runs.
    pub const fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// What it said last on standard error.
    pub fn said(&self) -> String {
        self.running.as_ref().map_or_else(|| self.said.clone(), Running::said)
    }

    fn start(&mut self) -> Result<Running, Broken> {
        self.starts += 1;
        let mut command = Command::new("sh");
        command.arg("-c").arg(&self.command);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // A group of its own: what it starts ends with it.
        let started = command.process_group(0).spawn().and_then(Running::new);
        started.map_err(|error| Broken::NotStarted(error.to_string()))
    }

    /// What became of a process that answers no more.
    fn gone(&mut self) -> Broken {
        let Some(mut running) = self.running.take() else { return Broken::Closed };
        let since = Instant::now();
        while since.elapsed() < END {
            if let Ok(Some(_)) = running.child.try_wait() {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        let silent = running.read.is_empty();
        let (status, said) = running.end();
        self.said.clone_from(&said);
        match status {
            None => Broken::Closed,
            // What the shell says of a command that it cannot run.
            Some(status) if silent && matches!(status.code(), Some(126 | 127)) => {
                Broken::NotStarted(said.lines().last().unwrap_or("the shell cannot run it").to_owned())
            }
            Some(status) => Broken::Ended(how(status)),
        }
    }
}

impl Answers for Side {
    /// After an error the process is ended; the next request starts another one.
    fn ask(&mut self, line: &str) -> Result<String, Broken> {
        if self.running.is_none() {
            self.running = Some(self.start()?);
        }
        let Some(running) = &mut self.running else { return Err(Broken::Closed) };
        let patience = if running.answered { self.patience } else { self.patience + BEGIN };
        let asked = running.ask(line, patience);
        match asked {
            Ok(reply) => {
                running.answered = true;
                Ok(reply)
            }
            Err(Failed::Gone) => Err(self.gone()),
            Err(Failed::Slow) => {
                self.end();
                Err(Broken::Hung(patience.as_millis()))
            }
            Err(Failed::Long(line)) => {
                self.end();
                Err(Broken::Garbage(line))
            }
        }
    }

    /// Ends the process, if one runs.
    fn end(&mut self) {
        if let Some(running) = self.running.take() {
            self.said = running.end().1;
        }
    }
}

impl Drop for Side {
    fn drop(&mut self) {
        self.end();
    }
}

/// How a process ended.
fn how(status: ExitStatus) -> String {
    match (status.code(), status.signal()) {
        // A shell that waited for a process that a signal ended.
        (Some(code), _) if code > 128 && code < 160 => format!("by signal {} (exit code {code})", code - 128),
        (Some(code), _) => format!("with exit code {code}"),
        (None, Some(signal)) => format!("by signal {signal}"),
        (None, None) => "in an unknown way".to_owned(),
    }
}

enum Failed {
    Gone,
    Slow,
    Long(String),
}

impl From<io::Error> for Failed {
    fn from(_: io::Error) -> Self {
        Self::Gone
    }
}

impl Running {
    fn new(mut child: Child) -> io::Result<Self> {
        let (stdin, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(stdin), Some(stdout), Some(stderr)) = (stdin, stdout, stderr) else {
            return Err(io::Error::other("no pipes"));
        };
        for fd in [stdin.as_fd(), stdout.as_fd()] {
            rustix::io::ioctl_fionbio(fd, true)?;
        }
        let kept = Arc::new(Mutex::new(Vec::new()));
        let keeps = Arc::clone(&kept);
        // Ends with the process: at the end of its output.
        let keeper = std::thread::Builder::new().name("stderr".to_owned()).spawn(move || keep(stderr, &keeps))?;
        Ok(Self { child, stdin, stdout, stderr: kept, keeper, answered: false, read: Vec::new() })
    }

    /// Writes a line and reads one. Both pipes may be full: what can go on, goes on.
    fn ask(&mut self, line: &str, patience: Duration) -> Result<String, Failed> {
        let until = Instant::now() + patience;
        let request = [line.as_bytes(), b"\n"].concat();
        let mut left = request.as_slice();
        loop {
            if left.is_empty()
                && let Some(end) = memchr::memchr(b'\n', &self.read)
            {
                let reply = String::from_utf8_lossy(&self.read[..end]).into_owned();
                self.read.drain(..=end);
                return Ok(reply);
            }
            if self.read.len() > MAX_REPLY {
                return Err(Failed::Long(format!("more than {MAX_REPLY} bytes without an end of line")));
            }
            if !left.is_empty() {
                match self.stdin.write(left) {
                    Ok(0) => return Err(Failed::Gone),
                    Ok(count) => {
                        left = &left[count..];
                        continue;
                    }
                    Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                    Err(error) if error.kind() == ErrorKind::WouldBlock => {}
                    Err(error) => return Err(error.into()),
                }
            }
            self.wait(!left.is_empty(), until)?;
            let mut piece = [0; 1 << 14];
            match self.stdout.read(&mut piece) {
                Ok(0) => return Err(Failed::Gone),
                Ok(count) => self.read.extend_from_slice(&piece[..count]),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// Waits until something can be read, or written if there is something to write.
    fn wait(&self, writing: bool, until: Instant) -> Result<(), Failed> {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(Failed::Slow);
        }
        let left = Timespec::try_from(left).map_err(|_| Failed::Slow)?;
        let mut fds = vec![PollFd::new(&self.stdout, PollFlags::IN)];
        if writing {
            fds.push(PollFd::new(&self.stdin, PollFlags::OUT));
        }
        match poll(&mut fds, Some(&left)) {
            Ok(0) => Err(Failed::Slow),
            Ok(_) | Err(rustix::io::Errno::INTR) => Ok(()),
            Err(_) => Err(Failed::Gone),
        }
    }

    fn said(&self) -> String {
        let kept = self.stderr.lock().unwrap_or_else(PoisonError::into_inner);
        String::from_utf8_lossy(&kept).trim().to_owned()
    }

    /// How it ended, if it did by itself, and what it said on standard error.
    fn end(mut self) -> (Option<ExitStatus>, String) {
        let status = self.child.try_wait().ok().flatten();
        if status.is_none()
            && let Ok(id) = i32::try_from(self.child.id())
            && let Some(group) = rustix::process::Pid::from_raw(id)
        {
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        drop(self.child.kill());
        drop(self.child.wait());
        // The last words may still be on their way. What it has left behind may hold the pipe open: nobody waits for that.
        let since = Instant::now();
        while !self.keeper.is_finished() && since.elapsed() < LAST_WORDS {
            std::thread::sleep(Duration::from_millis(1));
        }
        (status, self.said())
    }
}

/// Keeps the last bytes of what it reads.
fn keep(mut from: ChildStderr, kept: &Mutex<Vec<u8>>) {
    let mut piece = [0; 4096];
    while let Ok(count) = from.read(&mut piece) {
        if count == 0 {
            break;
        }
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend_from_slice(&piece[..count]);
        let over = kept.len().saturating_sub(MAX_STDERR);
        kept.drain(..over);
    }
}
