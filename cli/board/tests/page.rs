// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board behind the live page: measured values only, one client that drives, and a drive that goes with it.

use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use hapticore_board::source::Board;
use hapticore_board::target::{Asked, target};
use hapticore_board::virtual_line::Running;
use hapticore_live::server::Server;
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

const TOKEN: &str = "0123456789abcdef";
const PATIENCE: Duration = Duration::from_secs(60);

/// A server of a virtual board that drives, until the test ends.
struct Page {
    port: u16,
    board: Running,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Page {
    fn new() -> Page {
        let asked = Asked { port: "virtual:fig9".into(), ..Asked::default() };
        let found = target(&asked).expect("bundled");
        let running = found.running.clone().expect("a virtual board");
        let board = Box::new(Board::new(found, &asked.port));
        let server = Server::of_board(board, 0, None, TOKEN.into()).expect("a free port");
        let (port, ends) = (server.port(), Arc::new(AtomicBool::new(false)));
        let stop = ends.clone();
        let run = move || server.run(&|| stop.load(Ordering::Relaxed)).expect("it runs");
        Page { port, board: running, ends, thread: Some(thread::spawn(run)) }
    }

    fn client(&self) -> Client {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        let address = format!("ws://127.0.0.1:{}/ws?token={TOKEN}", self.port);
        Client {
            socket: tungstenite::client(address, stream).expect("a WebSocket").0,
            next: 1,
            has_missed: false,
        }
    }

    fn drive_v(&self) -> f64 {
        self.board.with(|board| board.drive_v())
    }

    fn until(&self, what: &str, holds: impl Fn(f64) -> bool) {
        let begun = Instant::now();
        while !holds(self.drive_v()) {
            assert!(begun.elapsed() < PATIENCE, "{what}: {} V", self.drive_v());
            thread::sleep(Duration::from_millis(2));
        }
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        let joined = self.thread.take().map(JoinHandle::join);
        assert!(thread::panicking() || joined.is_some_and(|joined| joined.is_ok()), "it ends well");
    }
}

struct Client {
    socket: WebSocket<TcpStream>,
    next: u64,
    /// It has been told that a client hangs.
    has_missed: bool,
}

impl Client {
    fn read(&mut self) -> Value {
        loop {
            if let Message::Text(text) = self.socket.read().expect("a message") {
                let message = serde_json::from_str(&text).expect("JSON");
                self.has_missed |= is_hang(&message);
                return message;
            }
        }
    }

    fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        loop {
            let message = self.read();
            if wanted(&message) {
                return message;
            }
            assert!(begun.elapsed() < PATIENCE, "{message}");
        }
    }

    /// Sends a command; the error that it is answered with.
    fn ask(&mut self, mut command: Value) -> Result<(), String> {
        let id = self.next;
        (self.next, command["id"]) = (id + 1, id.into());
        self.socket.send(Message::text(command.to_string())).expect("sent");
        let answer = self.wait(|message| message["id"] == id);
        match answer["type"].as_str() {
            Some("done") => Ok(()),
            _ => Err(answer["message"].as_str().expect("a message").to_string()),
        }
    }

    fn until_phase(&mut self, phase: &str) {
        self.wait(|message| message["type"] == "status" && message["line"]["phase"] == phase);
    }

    /// Arms until a pad is driven: a machine that is too busy for signs of life finds a fault.
    fn drive(&mut self, page: &Page) {
        self.until_phase("measuring");
        let begun = Instant::now();
        while page.drive_v() <= 1.0 {
            assert!(begun.elapsed() < PATIENCE, "not driven");
            let _ = self.ask(json!({"type": "arm", "on": true}));
            let _ = self.ask(json!({"type": "target", "pad": 0, "n": 0.2}));
            thread::sleep(Duration::from_millis(20));
        }
    }
}

#[test]
fn a_page_gets_measured_values_and_the_state_of_the_line() {
    let page = Page::new();
    let mut client = page.client();
    let hello = client.wait(|message| message["type"] == "hello");
    assert_eq!((&hello["source"], &hello["truth"]), (&json!("board"), &json!(false)));
    let frames = client.wait(|message| message["type"] == "frames" && message["slot"] != 0);
    assert!(frames["pads"]["x_mm"][0].is_number() && frames["pads"]["true_x_mm"][0].is_null());
    let status =
        client.wait(|message| message["type"] == "status" && message["line"]["packets"] != 0);
    assert_eq!(status["line"]["lost"], 0);
    for command in ["pace", "step", "open", "record"] {
        let fields =
            json!({"type": command, "speed": 0.5, "slots": 1, "scene": "peg", "to": "scene"});
        let error = client.ask(fields).expect_err(command);
        assert!(
            error.contains("board") || error.contains("expected a scene"),
            "{command}: {error}"
        );
    }
}

#[test]
fn one_client_drives_and_its_leaving_takes_the_drive_to_zero() {
    let page = Page::new();
    let (mut first, mut second) = (page.client(), page.client());
    first.drive(&page);
    for command in [
        json!({"type": "target", "pad": 0, "n": 0.3}),
        json!({"type": "set", "pad": 0, "target_n": 0.3}),
        json!({"type": "arm", "on": true}),
    ] {
        let error = second.ask(command).expect_err("it drives nothing");
        assert!(error.starts_with("another client has armed the drive"), "{error}");
    }
    drop(first);
    page.until("off", |volts| volts == 0.0);
    second.drive(&page);
}

#[test]
fn any_client_can_disable_the_board() {
    let page = Page::new();
    let (mut first, mut second) = (page.client(), page.client());
    first.drive(&page);
    second.ask(json!({"type": "disable"})).expect("anybody may");
    page.until("off", |volts| volts == 0.0);
    assert!(!page.board.with(|board| board.is_enabled()));
    first.until_phase("off");
    let error = first.ask(json!({"type": "arm", "on": true})).expect_err("it is off");
    assert!(error.contains("it is off"), "{error}");
    second.ask(json!({"type": "enable"})).expect("anybody may");
    first.until_phase("measuring");
    assert_eq!(page.drive_v(), 0.0);
}

#[test]
fn a_page_that_hangs_while_it_is_connected_takes_the_drive_to_zero() {
    let page = Page::new();
    let (mut first, mut second) = (page.client(), page.client());
    first.drive(&page);
    let note = second.wait(|message| message["type"] == "note" && is_hang(message));
    page.until("off", |volts| volts == 0.0);
    second.drive(&page);
    assert!(note["text"].as_str().is_some_and(|text| text.contains("until it is armed again")));
}

#[test]
fn signs_of_life_keep_the_drive() {
    let page = Page::new();
    let mut client = page.client();
    client.drive(&page);
    let (begun, mut longest) = (Instant::now(), Duration::ZERO);
    while begun.elapsed() < Duration::from_secs(3) {
        let asked = Instant::now();
        client.ask(json!({"type": "alive"})).expect("anybody may");
        thread::sleep(Duration::from_millis(50));
        longest = longest.max(asked.elapsed());
    }
    assert!(!client.has_missed || longest > Duration::from_millis(500), "{longest:?}");
}

fn is_hang(message: &Value) -> bool {
    message["text"].as_str().is_some_and(|text| text.contains("no sign of life"))
}
