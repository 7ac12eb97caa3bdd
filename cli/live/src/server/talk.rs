// SPDX-License-Identifier: MIT OR Apache-2.0
//! A WebSocket: one thread takes requests, another writes what the client is sent.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::SyncSender;
use std::thread;

use anyhow::{Result, anyhow};
use tungstenite::protocol::{Role, WebSocket, WebSocketConfig};
use tungstenite::{Error, Message as Received};

use super::Shared;
use crate::client::{Outbox, text_frame};
use crate::hub::{ClientId, Message};
use crate::protocol::{Answer, BadRequest, LONGEST, Request};

/// A message of this size ends its connection, bytes; a shorter one that is too long gets an error.
const ENDS: usize = 1 << 20;

/// Takes a client's requests until it leaves; another thread writes what it is sent.
pub(super) fn talk(stream: TcpStream, rest: Vec<u8>, shared: &Arc<Shared>) -> Result<()> {
    let client = shared.next_client.fetch_add(1, Ordering::Relaxed);
    let outbox = Arc::new(Outbox::default());
    stream.set_read_timeout(None)?;
    let (writing, to_write) = (stream.try_clone()?, outbox.clone());
    let writer = thread::Builder::new().name("write".into());
    let writer = writer.spawn(move || write(writing, &to_write))?;
    let hub = &shared.hub;
    if hub.send(Message::Join(client, outbox.clone())).is_ok() {
        let duplex = Duplex { stream, outbox: outbox.clone(), unsent: Vec::new() };
        listen(duplex, rest, (client, &outbox), hub);
        let _ = hub.send(Message::Leave(client));
    }
    outbox.close();
    writer.join().map_err(|_| anyhow!("the writer has panicked"))
}

fn write(mut stream: TcpStream, outbox: &Outbox) {
    while let Some(bytes) = outbox.next() {
        if stream.write_all(&bytes).is_err() {
            break;
        }
    }
    outbox.close();
    let _ = stream.shutdown(Shutdown::Both);
}

/// Takes requests until the connection ends.
fn listen(
    duplex: Duplex,
    rest: Vec<u8>,
    (client, outbox): (ClientId, &Outbox),
    hub: &SyncSender<Message>,
) {
    let config = WebSocketConfig::default()
        .read_buffer_size(8 << 10)
        .write_buffer_size(0)
        .max_message_size(Some(ENDS))
        .max_frame_size(Some(ENDS));
    let mut socket = WebSocket::from_partially_read(duplex, rest, Role::Server, Some(config));
    let complain = |id, message| outbox.answer(text_frame(&Answer::Error { id, message }.text()));
    loop {
        let text = match socket.read() {
            Ok(Received::Text(text)) => text,
            Ok(Received::Binary(_)) => {
                complain(None, "message: expected JSON text, got a binary message".into());
                continue;
            }
            Ok(_) => continue,
            Err(Error::Capacity(_)) => {
                let message =
                    format!("message: expected at most {LONGEST} bytes; connection closed");
                return complain(None, message);
            }
            Err(_) => return,
        };
        match Request::parse(&text) {
            Ok(request) => {
                if hub.send(Message::Request(client, request)).is_err() {
                    return;
                }
            }
            Err(BadRequest { id, message }) => complain(id, message),
        }
    }
}

/// Reads from a socket; what a WebSocket answers by itself, pongs and its close, is written by the thread that writes
/// all else.
struct Duplex {
    stream: TcpStream,
    outbox: Arc<Outbox>,
    unsent: Vec<u8>,
}

impl Read for Duplex {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.read(buffer)
    }
}

impl Write for Duplex {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.unsent.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if !self.unsent.is_empty() {
            self.outbox.answer(std::mem::take(&mut self.unsent).into());
        }
        Ok(())
    }
}
