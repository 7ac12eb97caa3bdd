// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore host`: what it prints, refuses and records, over a line in the process, over TCP and over a pseudo terminal.
//! What a session does with a board, cli/board/tests shows.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use hapticore_tests::tools::have;

use crate::{command, expect, finish};

fn start(args: &[&str]) -> Child {
    let folder = tempfile::tempdir().unwrap();
    command(folder.path(), args)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts")
}

fn interrupt(child: Child) -> std::process::Output {
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill is there").success());
    child.wait_with_output().unwrap()
}

#[test]
fn a_virtual_board_is_recorded_as_frames() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["host", "virtual", "--record", "frames.csv", "--seconds", "0.5"];
    let output = expect(folder.path(), &args, 0);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let last = said.lines().last().unwrap_or_default();
    assert!(last.starts_with("measuring: ") && last.contains("0 lost, 0 dropped"), "{said}");
    let text = std::fs::read_to_string(folder.path().join("frames.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(hapticore_host::COLUMNS.join(",").as_str()));
    let rows: Vec<_> = lines.collect();
    let columns = hapticore_host::COLUMNS.len();
    assert!(rows.len() > 50, "{} rows", rows.len());
    assert!(rows.iter().all(|row| row.split(',').count() == columns), "{}", rows[0]);
}

#[test]
fn a_driven_board_is_recorded_as_mcap_with_its_drive_and_notes() {
    let folder = tempfile::tempdir().unwrap();
    let set = "control.law=inverse";
    let args = ["host", "virtual:fig9", "--set", set, "--target", "0=0.2", "--arm"];
    let record = ["--record", "frames.mcap", "--seconds", "0.5"];
    expect(folder.path(), &[&args[..], &record].concat(), 0);
    let file = std::fs::read(folder.path().join("frames.mcap")).unwrap();
    let magic = b"\x89MCAP0\r\n";
    assert!(file.starts_with(magic) && file.ends_with(magic), "a whole file");
    let text = String::from_utf8_lossy(&file);
    for expected in ["/pad/0", "/notes", "start-up passed", "\"target_n\":0.2,"] {
        assert!(text.contains(expected), "{expected}");
    }
}

#[test]
fn a_pipe_that_ends_ends_the_command() {
    let mut child = start(&["host", "virtual", "--csv", "-"]);
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert_eq!(lines.next().unwrap().unwrap(), hapticore_host::COLUMNS.join(","));
    assert!(lines.next().unwrap().unwrap().starts_with("0."));
    drop(lines);
    let status = child.wait().unwrap();
    assert!(status.code().is_some_and(|code| code <= 2), "{status}");
}

#[test]
fn the_page_of_a_board_needs_its_token() {
    let mut child = start(&["host", "virtual", "--page", "--page-port", "0"]);
    let mut line = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    let (address, token) =
        line.trim().strip_prefix("http://").unwrap().split_once("/?token=").unwrap();
    assert!(token.len() == 32, "{token}");
    let status = |query: &str, origin: &str| {
        let mut stream = TcpStream::connect(address).unwrap();
        write!(
            stream,
            "GET /ws{query} HTTP/1.1\r\nHost: {address}\r\n{origin}Connection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        )
        .unwrap();
        let mut answer = [0; 12];
        stream.read_exact(&mut answer).unwrap();
        String::from_utf8_lossy(&answer[9..]).into_owned()
    };
    assert_eq!(status("", ""), "403", "no token");
    assert_eq!(status("?token=0123456789abcdef0123456789abcdef", ""), "403", "another");
    assert_eq!(status(&format!("?token={token}"), ""), "101");
    let foreign = "Origin: http://evil.example\r\n";
    assert_eq!(status(&format!("?token={token}"), foreign), "403", "another site's page");
    assert_eq!(interrupt(child).status.code(), Some(0));
}

#[test]
fn a_board_in_another_process_is_reached_over_tcp() {
    // A port that was free a moment ago.
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let address = format!("127.0.0.1:{port}");
    let board = start(&["host", "virtual", "--profile", "small", "--serve", &address]);
    let folder = tempfile::tempdir().unwrap();
    let calibration =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../host/recordings/hockey.calibration.toml");
    let port = format!("tcp:{address}");
    let args =
        ["host", &port, "--profile", "small", "--calibration", calibration, "--seconds", "0.5"];
    let output = expect(folder.path(), &args, 0);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("0 lost"), "{said}");
    assert_eq!(interrupt(board).status.code(), Some(0));
}

/// Opens a pseudo terminal, gives its one side to a virtual board and its other to a host.
const PTY: &str = r#"
import os, pty, subprocess, sys, tty
hapticore, calibration = sys.argv[1:3]
board_end, host_end = pty.openpty()
tty.setraw(board_end)
board = subprocess.Popen([hapticore, "host", "virtual", "--profile", "small", "--serve", "-"], stdin=board_end, stdout=board_end)
host = subprocess.run([hapticore, "host", os.ttyname(host_end), "--profile", "small", "--calibration", calibration,
                       "--seconds", "1"], capture_output=True, text=True)
# Once nobody has the other side open, the board ends.
os.close(host_end)
os.close(board_end)
board.wait(timeout=60)
print(host.stdout)
print(host.stderr, file=sys.stderr)
sys.exit(host.returncode)
"#;

#[test]
fn a_board_behind_a_pseudo_terminal_loses_nothing() {
    if !have(&["python3"]) {
        return;
    }
    let calibration =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../host/recordings/hockey.calibration.toml");
    let folder = tempfile::tempdir().unwrap();
    let program = command(folder.path(), &[]).get_program().to_owned();
    let output = Command::new("python3")
        .args(["-c", PTY])
        .arg(program)
        .arg(calibration)
        .output()
        .expect("python3 starts");
    let (said, log) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{said}{log}");
    let last = said.trim().lines().last().unwrap_or_default();
    assert!(last.starts_with("measuring: ") && last.contains(" 0 lost, 0 dropped"), "{said}{log}");
}

#[test]
fn host_refuses_what_it_cannot_use() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &str); 8] = [
        (&["/dev/ttyUSB9"], "--calibration: expected the device's calibration"),
        (&["virtual:none"], "expected a file or a scene among"),
        (&["virtual", "--calibrate", "nowhere/mine.toml"], "--calibrate: expected a file"),
        (&["virtual", "--dac", "ad5664r"], "--dac: expected none with a virtual board"),
        (&["virtual", "--arm"], "--arm: expected a board with a drive"),
        (&["virtual:fig9", "--target", "9=0.1", "--arm"], "--target: pad: expected below"),
        (&["virtual:fig9", "--page", "--arm"], "cannot be used with"),
        (&["tcp:127.0.0.1:1", "--serve", "-", "--calibration", "none.toml"], "none.toml"),
    ];
    // A calibration of four terminals, for a board of six.
    let four = ["simulate", "minimal-sheet", "--set", "sheet.terminals=4", "--capture", "four.wav"];
    finish(folder.path(), &four);
    let of_four = ["virtual:hockey", "--check", "--calibration", "four.wav.calibration.toml"];
    let four = [(&of_four[..], "expected a calibration of 6 terminals")];
    for (args, expected) in cases.into_iter().chain(four) {
        let log = expect(folder.path(), &[&["host"], args].concat(), 2).stderr;
        let log = String::from_utf8_lossy(&log).into_owned();
        assert!(log.contains(expected), "{args:?}: {log}");
    }
}

#[test]
fn ports_and_scenes_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let output = expect(folder.path(), &["host", "list"], 0);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("virtual:SCENE") && said.contains("hockey"), "{said}");
}

#[test]
fn a_time_beyond_all_clocks_lasts_until_ctrl_c() {
    // A row behind the columns; the page's address.
    for (way, lines) in [(&["--csv", "-"][..], 2), (&["--page", "--page-port", "0"], 1)] {
        let mut child = start(&[&["host", "virtual", "--seconds", "1e300"], way].concat());
        let said = BufReader::new(child.stdout.as_mut().unwrap()).lines().take(lines);
        assert_eq!(said.flatten().count(), lines, "{way:?}");
        let output = interrupt(child);
        let log = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() != Some(101) && !log.contains("panic"), "{way:?}: {log}");
    }
}
