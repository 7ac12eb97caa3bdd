// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore live`: how it starts, what it refuses, how it ends. What it serves, cli/live/tests shows.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use crate::{command, expect};

/// A server; its address, such as `127.0.0.1:8091`.
fn start(args: &[&str]) -> (Child, String) {
    let folder = tempfile::tempdir().unwrap();
    let mut child = command(folder.path(), &[&["live", "hockey"], args].concat())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut line = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    let address = line.trim().strip_prefix("http://").and_then(|rest| rest.split('/').next());
    (child, address.expect("an address").to_string())
}

fn interrupt(child: Child) -> std::process::Output {
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill is there").success());
    child.wait_with_output().unwrap()
}

#[test]
fn live_serves_the_page_until_ctrl_c() {
    let (child, address) = start(&["--port", "0"]);
    let mut stream = TcpStream::connect(&address).unwrap();
    write!(stream, "GET / HTTP/1.1\r\nHost: {address}\r\n\r\n").unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200 OK\r\n") && answer.contains("page.mjs"), "{answer}");
    let output = interrupt(child);
    assert_eq!(
        (output.status.code(), &*String::from_utf8_lossy(&output.stderr)),
        (Some(0), "Ctrl-C ends it.\n")
    );
}

#[test]
fn a_port_in_use_is_one_line_that_says_what_helps() {
    let folder = tempfile::tempdir().unwrap();
    let (child, address) = start(&["--port", "0"]);
    let port = address.rsplit(':').next().unwrap();
    let help = format!("port {port} is in use; --port 0 takes a free one");
    let log = expect(folder.path(), &["live", "hockey", "--port", port], 2).stderr;
    assert_eq!(String::from_utf8_lossy(&log), format!("error: {help}\n"));
    interrupt(child);
}

#[test]
fn live_refuses_what_it_cannot_serve() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &str); 6] = [
        (&["cricket"], "expected a file or a scene among"),
        (&["peg", "--set", "pad.0.load=5"], "pad.0.load"),
        (&["peg", "--case", "7"], "case: expected a number below 1"),
        (&["peg", "--speed", "-1"], "--speed"),
        (&["peg", "--listen", "0.0.0.0"], "--token"),
        (&["peg", "--listen", "0.0.0.0", "--token", "short"], "at least 16 letters"),
    ];
    for (args, expected) in cases {
        let log = expect(folder.path(), &[&["live", "--port", "0"], args].concat(), 2).stderr;
        let log = String::from_utf8_lossy(&log).into_owned();
        assert!(log.contains(expected), "{args:?}: {log}");
    }
}
