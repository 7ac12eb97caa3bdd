// SPDX-License-Identifier: MIT OR Apache-2.0
//! A server of its own for each test, and a client of it.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use hapticore_live::protocol::Opening;
use hapticore_live::server::{Config, Server};
use serde_json::Value;
use tungstenite::{Message, WebSocket};

/// How long a test waits for what must come.
const PATIENCE: Duration = Duration::from_secs(20);

/// A server that ends with its test.
pub struct Live {
    pub port: u16,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Live {
    pub fn new(opening: Opening) -> Live {
        let config = Config { opening, port: 0, listen: None, speed: 1.0 };
        let server = Server::bind(config).expect("a server");
        let (port, ends) = (server.port(), Arc::new(AtomicBool::new(false)));
        let stop = ends.clone();
        let run = move || server.run(&|| stop.load(Ordering::Relaxed)).expect("a run");
        Live { port, ends, thread: Some(thread::spawn(run)) }
    }

    pub fn of(scene: &str) -> Live {
        Live::new(opening(scene, &[]))
    }

    pub fn client(&self) -> Client {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        let address = format!("ws://127.0.0.1:{}/ws", self.port);
        let (socket, _) = tungstenite::client(address, stream).expect("a WebSocket");
        Client { socket, next_id: 1 }
    }

    /// What a server answers to these bytes, up to the end of the connection.
    pub fn http(&self, request: &str) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("a connection");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        stream.write_all(request.as_bytes()).expect("written");
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
        let joined = self.thread.take().map(JoinHandle::join);
        assert!(thread::panicking() || joined.is_some_and(|joined| joined.is_ok()), "it ends well");
    }
}

pub fn opening(scene: &str, set: &[(&str, &str)]) -> Opening {
    let set = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    Opening { scene: scene.into(), set, ..Opening::default() }
}

/// A client that waits for what it wants.
pub struct Client {
    pub socket: WebSocket<TcpStream>,
    next_id: u64,
}

impl Client {
    pub fn send(&mut self, text: &str) {
        self.socket.send(Message::text(text)).expect("sent");
    }

    /// The next message.
    pub fn read(&mut self) -> Message {
        self.socket.read().expect("a message")
    }

    /// The next message in JSON of this type; others are left out.
    pub fn next(&mut self, kind: &str) -> Value {
        self.until(|value| value["type"] == kind)
    }

    /// The next message in JSON for which this holds.
    pub fn until(&mut self, mut holds: impl FnMut(&Value) -> bool) -> Value {
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            if let Message::Text(text) = self.read() {
                let value: Value = serde_json::from_str(&text).expect("JSON");
                if holds(&value) {
                    return value;
                }
            }
        }
        panic!("no such message in {PATIENCE:?}");
    }

    /// Sends a command, without its braces and `id`; the answer to it.
    pub fn ask(&mut self, command: &str) -> Value {
        let id = self.next_id;
        self.next_id += 1;
        self.send(&format!("{{\"id\":{id},{command}}}"));
        self.until(|value| value["id"] == id)
    }

    /// Sends a command that must be carried out.
    pub fn done(&mut self, command: &str) -> u64 {
        let answer = self.ask(command);
        assert_eq!(answer["type"], "done", "{command}: {answer}");
        answer["slot"].as_u64().expect("a slot")
    }

    /// Sends a command that must be refused; why.
    pub fn refused(&mut self, command: &str) -> String {
        let answer = self.ask(command);
        assert_eq!(answer["type"], "error", "{command}: {answer}");
        answer["message"].as_str().expect("a message").into()
    }
}
