//! The `models` command as somebody calls it.

use atc_models::Outcome;
use std::fs;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

fn models(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_models")).args(arguments).output().expect("the command runs")
}

#[test]
fn list_names_every_model() {
    let output = models(&["list"]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).expect("text");
    for entry in atc_models::catalogue() {
        assert!(text.lines().any(|line| line == entry.name), "{}", entry.name);
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_read_enough_is_no_error() {
    let (reader, writer) = std::os::unix::net::UnixStream::pair().expect("a pair of sockets");
    drop(reader);
    let mut command = Command::new(env!("CARGO_BIN_EXE_models"));
    let output = command.arg("list").stdout(std::os::fd::OwnedFd::from(writer)).output().expect("the command runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn check_writes_what_it_found() {
    let file = std::env::temp_dir().join(format!("atc-models-{}.json", std::process::id()));
    let name = file.to_str().expect("a path in UTF-8");
    let output = models(&["check", "--json", name, "misread", "change-heard"]);
    let text = fs::read_to_string(&file).expect("the file");
    fs::remove_file(&file).expect("removed");
    assert!(output.status.success());
    let outcomes: Vec<Outcome> = serde_json::from_str(&text).expect("outcomes");
    let names: Vec<_> = outcomes.iter().map(|outcome| outcome.model.as_str()).collect();
    assert_eq!(names, ["change-heard", "misread"]);
    assert!(outcomes.iter().all(Outcome::ok));
}

#[test]
fn an_unknown_name_is_an_error_and_nothing_is_checked() {
    for arguments in [&["check", "misread", "misred"] as &[_], &["explore", "misred"]] {
        let output = models(arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(output.stdout.is_empty());
        let message = String::from_utf8(output.stderr).expect("text");
        assert!(message.contains("there is no model misred; there are any-detections, "), "{message}");
    }
}

#[test]
fn a_file_that_cannot_be_written_is_an_error() {
    let output = models(&["check", "--json", "/nonexistent/outcomes.json", "change-heard"]);
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).expect("text");
    assert!(message.contains("cannot write /nonexistent/outcomes.json"), "{message}");
}

#[test]
fn an_address_that_cannot_be_used_is_an_error() {
    let taken = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let taken = taken.local_addr().map(|address| (taken, address.to_string())).expect("an address");
    for address in ["nowhere", &taken.1] {
        let output = models(&["explore", "change-heard", address]);
        assert_eq!(output.status.code(), Some(2));
        let message = String::from_utf8(output.stderr).expect("text");
        assert!(message.contains(address), "{message}");
    }
}

#[test]
fn explore_serves_the_explorer() {
    let port = TcpListener::bind("127.0.0.1:0").and_then(|free| free.local_addr()).expect("a free port");
    let mut server = Command::new(env!("CARGO_BIN_EXE_models"))
        .args(["explore", "change-heard", &port.to_string()])
        .stdout(Stdio::null())
        .spawn()
        .expect("the command runs");
    let deadline = Instant::now() + Duration::from_secs(20);
    let mut page = String::new();
    while !page.contains("exposure-bounded") && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(50));
        let Ok(mut stream) = TcpStream::connect(port) else { continue };
        page.clear();
        let request = b"GET /.status HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
        let _ = stream.write_all(request).and_then(|()| stream.read_to_string(&mut page));
    }
    server.kill().and_then(|()| server.wait()).expect("ended");
    assert!(page.contains("exposure-bounded"), "{page}");
}
