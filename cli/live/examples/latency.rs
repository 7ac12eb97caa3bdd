// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a command to the first frames that show it: `latency PORT SECONDS`, at a server that runs.
//!
//! A pad without a hand is led to and fro; the frames that show another true place than before count. What a command
//! cannot avoid is the wait for the next frame, half of 16.7 ms on average.

use std::net::TcpStream;
use std::time::{Duration, Instant};

use serde_json::Value;
use tungstenite::{Message, WebSocket};

type Socket = WebSocket<TcpStream>;

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let port: u16 = words.get(1).and_then(|word| word.parse().ok()).expect("latency PORT SECONDS");
    let seconds: f64 = words.get(2).and_then(|word| word.parse().ok()).unwrap_or(10.0);
    let stream = TcpStream::connect(("127.0.0.1", port)).expect("a server");
    let (mut socket, _) =
        tungstenite::client(format!("ws://127.0.0.1:{port}/ws"), stream).expect("a WebSocket");
    let hello = until(&mut socket, |value| value["type"] == "hello");
    let pad = hello["pads"].as_array().map_or(0, Vec::len) - 1;
    let (mut done, mut shown, mut gaps) = (Vec::new(), Vec::new(), Vec::new());
    let (begun, mut id) = (Instant::now(), 0);
    while begun.elapsed().as_secs_f64() < seconds {
        id += 1;
        let x_mm = if id % 2 == 0 { 20.0 } else { -20.0 };
        let before = frames(&mut socket)["pads"]["true_x_mm"][pad].as_f64();
        // Not in step with the frames.
        std::thread::sleep(Duration::from_micros(id * 7919 % 33_000));
        let lead = format!("{{\"id\":{id},\"type\":\"lead\",\"pad\":{pad},\"mm\":[{x_mm},0]}}");
        let sent = Instant::now();
        socket.send(Message::text(lead)).expect("sent");
        until(&mut socket, |value| value["id"] == id);
        done.push(sent.elapsed());
        until(&mut socket, |value| {
            value["type"] == "frames" && value["pads"]["true_x_mm"][pad].as_f64() != before
        });
        shown.push(sent.elapsed());
        let last = Instant::now();
        frames(&mut socket);
        gaps.push(last.elapsed());
        // Until the line has ended and has been seen.
        (0..3).for_each(|_| drop(frames(&mut socket)));
    }
    until(&mut socket, |value| value["type"] == "status");
    let status = until(&mut socket, |value| value["type"] == "status");
    println!("{} · {} · {} commands", hello["scene"], hello["fidelity"], done.len());
    print("command to done", done);
    print("command to frames", shown);
    print("frames to frames", gaps);
    println!("{status}");
}

fn until(socket: &mut Socket, holds: impl Fn(&Value) -> bool) -> Value {
    loop {
        if let Message::Text(text) = socket.read().expect("a message") {
            let value = serde_json::from_str(&text).expect("JSON");
            if holds(&value) {
                return value;
            }
        }
    }
}

fn frames(socket: &mut Socket) -> Value {
    until(socket, |value| value["type"] == "frames")
}

fn print(what: &str, mut times: Vec<Duration>) {
    times.sort();
    let at = |share: f64| 1e3 * times[((times.len() - 1) as f64 * share) as usize].as_secs_f64();
    println!(
        "{what}: p50 {:.1}, p95 {:.1}, p99 {:.1}, max {:.1} ms",
        at(0.5),
        at(0.95),
        at(0.99),
        at(1.0)
    );
}
