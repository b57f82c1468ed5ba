//! The two sides of the lock step: processes that speak protocol 1, and when their replies are the same.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::thread;

use atc_tests::device;
use serde_json::Value;
use tempfile::TempDir;

/// The folder of the implementations.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../foreign")
}

pub fn oracle() -> Command {
    let mut command = Command::new(device::oracle());
    command.arg("serve");
    command
}

/// What a command printed. What a failure printed, if it fails.
pub fn run(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("{}: {error}", command.get_program().display()))?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(said);
    }
    Err(format!("{command:?}: {}\n{said}{}", output.status, String::from_utf8_lossy(&output.stderr)))
}

/// The sessions of the oracle's examples.
pub fn examples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../oracle/examples");
    let paths = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let sessions: Vec<_> = paths.filter(|path| path.extension().is_some_and(|end| end == "jsonl")).collect();
    assert!(sessions.len() >= 10, "only {} sessions", sessions.len());
    sessions
}

/// Compiles `NAME.c` without a warning.
pub fn compiled(name: &str, into: &TempDir) -> PathBuf {
    let program = into.path().join(name);
    let mut gcc = Command::new("gcc");
    gcc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-O1", "-o"]).arg(&program);
    let output = gcc.arg(folder().join(name).with_extension("c")).output().expect("gcc runs");
    assert!(output.status.success(), "{name}.c: {}", String::from_utf8_lossy(&output.stderr));
    program
}

/// `python3 NAME.py`, or why it cannot run here.
pub fn python(name: &str) -> Result<Command, String> {
    let version = Command::new("python3").arg("--version").output();
    match version {
        Ok(output) if output.status.success() => {
            let mut command = Command::new("python3");
            // Nothing compiled is left beside the source.
            command.arg("-B").arg(folder().join(name).with_extension("py"));
            Ok(command)
        }
        Ok(output) => Err(format!("python3 ends with {}", output.status)),
        Err(error) => Err(format!("python3: {error}")),
    }
}

/// A process that is asked line by line.
pub struct Asked {
    child: Child,
    requests: Option<ChildStdin>,
    replies: BufReader<ChildStdout>,
}

impl Asked {
    pub fn new(mut command: Command) -> Self {
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the process starts");
        let requests = child.stdin.take();
        let replies = BufReader::new(child.stdout.take().expect("a pipe"));
        Self { child, requests, replies }
    }

    pub fn ask(&mut self, request: &str) -> String {
        let requests = self.requests.as_mut().expect("it is open");
        requests.write_all(format!("{request}\n").as_bytes()).expect("it listens");
        self.reply().expect("a reply to each line")
    }

    fn reply(&mut self) -> Option<String> {
        let mut line = String::new();
        let read = self.replies.read_line(&mut line).expect("text");
        (read > 0).then(|| line.trim_end().to_owned())
    }
}

impl Drop for Asked {
    fn drop(&mut self) {
        drop(self.requests.take());
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What the oracle replies to these lines.
pub fn expected(requests: &[String]) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut asked = Asked::new(fed(&oracle(), requests, &folder));
    let replies: Vec<String> = std::iter::from_fn(|| asked.reply()).collect();
    assert_eq!(replies.len(), requests.len(), "one reply to each line");
    replies
}

/// The command with these lines as its input. They are in a file: nobody has to write while the replies are read.
fn fed(command: &Command, requests: &[String], folder: &TempDir) -> Command {
    let path = folder.path().join("requests.jsonl");
    fs::write(&path, requests.join("\n") + "\n").expect("it is written");
    let mut shell = Command::new("sh");
    shell.args(["-c", "exec \"$@\" < \"$0\""]).arg(path).arg(command.get_program()).args(command.get_args());
    shell
}

/// The first line to which the command replies otherwise, if there is one, with both replies.
pub fn difference(command: &Command, requests: &[String], expected: &[String]) -> Option<(usize, String)> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut asked = Asked::new(fed(command, requests, &folder));
    for (at, line) in expected.iter().enumerate() {
        let reply = asked.reply().unwrap_or_default();
        if !same(line, &reply) {
            return Some((at, format!("{}\n  kernel:  {line}\n  foreign: {reply}", requests[at])));
        }
    }
    None
}

/// Whether two replies say the same: what an implementation may leave out or word freely is not looked at.
pub fn same(kernel: &str, foreign: &str) -> bool {
    kernel == foreign || matches!((spoken(kernel), spoken(foreign)), (Some(kernel), Some(foreign)) if kernel == foreign)
}

fn spoken(line: &str) -> Option<Value> {
    let mut value: Value = serde_json::from_str(line).ok()?;
    for kind in ["malformed", "rejected", "started"] {
        if value.get(kind).is_some() {
            return Some(Value::from(kind));
        }
    }
    if let Some(output) = value.get_mut("output") {
        // Sets of names, in whatever order.
        for name in ["proceed", "permits", "confirmed", "silent"] {
            if let Some(Value::Array(names)) = output.get_mut(name) {
                names.sort_by(|a, b| a.as_str().cmp(&b.as_str()));
            }
        }
        if let Some(Value::Object(answer)) = output.get_mut("answer") {
            answer.remove("because");
        }
    }
    Some(value)
}

/// The implementation agrees on every line, and with each of its faults it does not.
pub fn holds(name: &str, faults: u32, requests: &[String], replies: &[String], run: impl Fn() -> Command + Sync) {
    let steps = requests.iter().filter(|line| line.starts_with(r#"{"step""#)).count();
    let (unfound, faithful) = thread::scope(|scope| {
        let faithful = scope.spawn(|| difference(&run(), requests, replies));
        let mut unfound = Vec::new();
        for fault in 1..=faults {
            let mut faulty = run();
            faulty.args(["--fault", &fault.to_string()]);
            if difference(&faulty, requests, replies).is_none() {
                unfound.push(fault);
            }
        }
        (unfound, faithful.join().expect("it ends"))
    });
    if let Some((at, both)) = faithful {
        panic!("{name}: line {}: {both}", at + 1);
    }
    assert!(unfound.is_empty(), "{name}: {steps} steps find no difference with fault {unfound:?}");
    println!("{name}: {steps} steps without a difference, {faults} faults found");
}
