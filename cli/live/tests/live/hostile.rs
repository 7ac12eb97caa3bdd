// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clients that mean no good, or are gone: none ends the server, or keeps it from others.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use tungstenite::Message;

use crate::client::Live;

/// Random numbers (xorshift64*).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % n
    }

    fn pick<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }
}

const TYPES: [&str; 13] = [
    "lead",
    "release",
    "set",
    "target",
    "wall",
    "serve",
    "pace",
    "step",
    "slot",
    "record",
    "open",
    "subscribe",
    "fly",
];
const KEYS: [&str; 18] = [
    "pad",
    "mm",
    "within_s",
    "load_g",
    "push_x_n",
    "haptic_v_rms",
    "target_n",
    "n",
    "x_mm",
    "off",
    "speed",
    "slots",
    "to",
    "scene",
    "set",
    "columns",
    "every",
    "case",
];
const VALUES: [&str; 26] = [
    "0",
    "1",
    "99",
    "-1",
    "4294967296",
    "18446744073709551616",
    "1e308",
    "-1e308",
    "1e-320",
    "1e999",
    "NaN",
    "null",
    "true",
    "\"peg\"",
    "\"/etc/passwd\"",
    "\"start\"",
    "\"slot\"",
    "[]",
    "[0,0]",
    "[1e300,-1e300]",
    "[\"a\",{}]",
    "{\"gap\":false}",
    "{\"duration_s\":-1,\"pad.0.load_g\":1e30}",
    "{\"a\":{\"b\":[]}}",
    "\"\\ud800\"",
    "\"\u{202e}\"",
];

/// A message that looks like one, random text, or a valid one with some bytes changed.
fn message(random: &mut Random, id: usize) -> Message {
    let fields: Vec<String> = (0..random.below(5))
        .map(|_| format!("\"{}\":{}", random.pick(&KEYS), random.pick(&VALUES)))
        .collect();
    let text = format!("{{\"id\":{id},\"type\":\"{}\",{}}}", random.pick(&TYPES), fields.join(","));
    match random.below(8) {
        0 => {
            let bytes: Vec<u8> = (0..random.below(200)).map(|_| random.below(256) as u8).collect();
            Message::binary(bytes)
        }
        1 => Message::text(
            (0..random.below(300)).map(|_| char::from(random.below(128) as u8)).collect::<String>(),
        ),
        2 => Message::text("[".repeat(random.below(3000))),
        3 => Message::text(format!("{{\"type\":\"{}\"}}", "x".repeat(random.below(100_000)))),
        4 => {
            let mut bytes = text.into_bytes();
            let at = random.below(bytes.len());
            bytes[at] = random.below(128) as u8;
            Message::text(String::from_utf8_lossy(&bytes).into_owned())
        }
        _ => Message::text(text.replace(",}", "}")),
    }
}

#[test]
fn ten_thousand_hostile_messages_end_nothing() {
    let live = Live::of("hockey");
    let mut watcher = live.client();
    let mut random = Random(0x5EED_0053);
    let mut answers = 0;
    for round in 0..20 {
        let mut client = live.client();
        for n in 0..500 {
            let message = loop {
                let message = message(&mut random, 1000 + n);
                // Steps and openings that are valid take their time; they have tests of their own.
                let text = message.to_text().unwrap_or_default();
                if !(text.contains("\"step\"") && text.contains("slots")) {
                    break message;
                }
            };
            client.socket.send(message).expect("the connection holds");
            if n % 50 == 49 {
                // The answer to this one says that all before have been answered.
                client.send("{\"id\":7,\"type\":\"pace\",\"speed\":1}");
                client.until(|value| {
                    answers += usize::from(value["type"] == "error");
                    value["id"] == 7 && value["type"] == "done"
                });
            }
        }
        assert!(answers > 300 * (round + 1), "errors are answered: {answers}");
    }
    // The scene may have been replaced, or be about to be; it runs, and takes inputs.
    let begun = Instant::now();
    while watcher.ask("\"type\":\"open\",\"scene\":\"hockey\"")["type"] != "done" {
        assert!(begun.elapsed() < Duration::from_secs(60), "another scene is still being set up");
        std::thread::sleep(Duration::from_millis(100));
    }
    watcher.done("\"type\":\"set\",\"pad\":0,\"load_g\":50");
    watcher.done("\"type\":\"pace\",\"speed\":1");
    watcher.until(|value| value["type"] == "frames" && value["pads"]["x_mm"][3].is_number());
}

#[test]
fn a_message_that_is_much_too_long_ends_its_own_connection_alone() {
    let live = Live::of("hockey");
    let (mut client, mut other) = (live.client(), live.client());
    client.send(&"x".repeat(100_000));
    let answer = client.next("error");
    assert_eq!(answer["message"], "message: expected at most 65536 bytes, got 100000");
    client.done("\"type\":\"pace\",\"speed\":1");
    let _ = client.socket.send(Message::text("x".repeat(3 << 20)));
    let begun = Instant::now();
    while client.socket.read().is_ok() {
        assert!(begun.elapsed() < Duration::from_secs(10), "the connection ends");
    }
    other.done("\"type\":\"pace\",\"speed\":1");
}

#[test]
fn half_open_connections_and_slow_heads_stop_nobody() {
    let live = Live::of("hockey");
    let connect = || TcpStream::connect(("127.0.0.1", live.port)).expect("a connection");
    // Nothing, half a head, a byte now and then, a WebSocket that is silent, half a frame.
    let _silent: Vec<TcpStream> = (0..10).map(|_| connect()).collect();
    let mut half = connect();
    half.write_all(b"GET /ws HTTP/1.1\r\nHost: ").unwrap();
    let mut bad_frame = live.client();
    bad_frame.socket.get_mut().write_all(&[0x81, 0xFE, 0xFF]).unwrap();
    let _idle: Vec<_> = (0..5).map(|_| live.client()).collect();
    let mut gone = live.client();
    gone.send("{\"type\":\"pace\",\"speed\":1}");
    drop(gone);
    let mut client = live.client();
    let begun = Instant::now();
    for _ in 0..20 {
        client.done("\"type\":\"set\",\"pad\":0,\"load_g\":50");
    }
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
}

#[test]
fn connections_have_a_bound_and_places_become_free() {
    let live = Live::of("hockey");
    let mut clients: Vec<_> = (0..64).map(|_| live.client()).collect();
    let refusal = live.http("GET / HTTP/1.1\r\n\r\n");
    assert!(refusal.starts_with("HTTP/1.1 503"), "{refusal}");
    clients.truncate(60);
    let own = format!("GET / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", live.port);
    let begun = Instant::now();
    while !live.http(&own).starts_with("HTTP/1.1 200") {
        assert!(begun.elapsed() < Duration::from_secs(10), "places become free");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_client_that_does_not_read_loses_frames_and_no_answer() {
    let live = Live::of("hockey");
    let (mut slow, mut quick) = (live.client(), live.client());
    let names: Vec<String> = hapticore_live::rows::names().into_iter().take(32).collect();
    let columns = serde_json::to_string(&names).unwrap();
    slow.done(&format!(
        "\"type\":\"subscribe\",\"columns\":{columns},\"every\":\"slot\",\"format\":\"json\""
    ));
    // More than sockets hold, while the other one is served.
    let mut longest = Duration::ZERO;
    for n in 0..40 {
        slow.send(&format!(
            "{{\"id\":{},\"type\":\"set\",\"pad\":0,\"load_g\":{}}}",
            100 + n,
            20 + n
        ));
        let begun = Instant::now();
        quick.done("\"type\":\"step\",\"slots\":1000");
        longest = longest.max(begun.elapsed());
    }
    assert!(longest < Duration::from_secs(5), "{longest:?}");
    let mut answers = 0;
    let last = slow.until(|value| {
        answers += usize::from(value["type"] == "done");
        value["type"] == "status" && value["dropped"].as_u64() > Some(0) && answers == 40
    });
    assert!(last["dropped"].as_u64().unwrap() > 0);
}

#[test]
fn a_page_of_another_site_is_refused() {
    let live = Live::of("hockey");
    let port = live.port;
    let head = |path: &str, lines: &str| {
        format!(
            "GET {path} HTTP/1.1\r\n{lines}Connection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        )
    };
    let own = format!("Host: 127.0.0.1:{port}\r\n");
    for (path, lines) in [
        ("/ws", format!("{own}Origin: http://evil.example\r\n")),
        ("/ws", format!("{own}Origin: null\r\n")),
        ("/ws", format!("{own}Origin: http://127.0.0.1:1\r\n")),
        ("/ws", format!("Host: evil.example:{port}\r\nOrigin: http://evil.example:{port}\r\n")),
        ("/ws", "Host: evil.example\r\n".into()),
        ("/ws", String::new()),
        ("/", format!("Host: evil.example:{port}\r\n")),
    ] {
        let answer = live.http(&head(path, &lines));
        assert!(answer.starts_with("HTTP/1.1 403 Forbidden\r\n"), "{path} {lines}: {answer}");
    }
    let answer = live.http(&format!("GET /ws HTTP/1.1\r\n{own}\r\n"));
    assert!(answer.starts_with("HTTP/1.1 426"), "{answer}");
    // Its own page, and a program without an origin.
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    let origin = format!("{own}Origin: http://127.0.0.1:{port}\r\n");
    stream.write_all(head("/ws", &origin).as_bytes()).unwrap();
    let mut answer = [0; 200];
    let read = stream.read(&mut answer).unwrap();
    let answer = String::from_utf8_lossy(&answer[..read]).into_owned();
    assert!(answer.starts_with("HTTP/1.1 101 "), "{answer}");
    assert!(answer.contains("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), "the key of RFC 6455: {answer}");
}

#[test]
fn files_are_served_and_nothing_else() {
    let live = Live::of("hockey");
    let get = |path: &str| {
        live.http(&format!("GET {path} HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", live.port))
    };
    assert!(get("/").contains("<!doctype html>") || get("/").contains("<!DOCTYPE html>"));
    assert!(get("/?preset=wall").starts_with("HTTP/1.1 200"));
    let script = get("/page.mjs");
    assert!(
        script.contains("Content-Type: text/javascript")
            && script.contains("Content-Security-Policy")
    );
    for path in ["/../Cargo.toml", "/etc/passwd", "//", "/page.mjs/", "/%2e%2e/Cargo.toml"] {
        assert!(get(path).starts_with("HTTP/1.1 404"), "{path}");
    }
    let post = live.http(&format!("POST / HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", live.port));
    assert!(post.starts_with("HTTP/1.1 405"), "{post}");
}
