// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a client still has to receive: a queue between the loop, which never waits, and the thread that writes to the
//! client's socket.
//!
//! Messages that a later one replaces are dropped, the oldest first. Answers are never dropped: a client that asks and
//! does not read is disconnected.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};

use tungstenite::protocol::frame::Frame;
use tungstenite::protocol::frame::coding::{Data, OpCode};

/// The most messages of a client that a later one replaces.
pub const FRAMES: usize = 16;

/// The most answers of a client that wait.
pub const ANSWERS: usize = 4096;

/// A WebSocket frame, as it is written.
pub type Bytes = Arc<[u8]>;

/// A text message of a server as a WebSocket frame.
pub fn text_frame(text: &str) -> Bytes {
    frame(text.as_bytes().to_vec(), Data::Text)
}

/// A binary message of a server as a WebSocket frame.
pub fn binary_frame(bytes: Vec<u8>) -> Bytes {
    frame(bytes, Data::Binary)
}

fn frame(payload: Vec<u8>, kind: Data) -> Bytes {
    let mut bytes = Vec::with_capacity(payload.len() + 10);
    let frame = Frame::message(payload, OpCode::Data(kind), true);
    frame.format(&mut bytes).expect("a Vec takes all bytes");
    bytes.into()
}

/// A client's queue.
#[derive(Default)]
pub struct Outbox {
    queue: Mutex<Queue>,
    changed: Condvar,
}

#[derive(Default)]
struct Queue {
    /// Each message, and whether a later one replaces it.
    messages: VecDeque<(bool, Bytes)>,
    frames: usize,
    dropped: u64,
    /// No message is added any more.
    closed: bool,
}

impl Outbox {
    /// Adds a message that a later one replaces.
    pub fn frame(&self, bytes: Bytes) {
        self.add(true, bytes);
    }

    /// Adds a message that is never dropped.
    pub fn answer(&self, bytes: Bytes) {
        self.add(false, bytes);
    }

    fn add(&self, replaceable: bool, bytes: Bytes) {
        let mut queue = self.lock();
        if queue.closed {
            return;
        }
        if !replaceable && queue.messages.len() - queue.frames >= ANSWERS {
            queue.messages.clear();
            (queue.frames, queue.closed) = (0, true);
        } else {
            queue.push(replaceable, bytes);
        }
        self.changed.notify_one();
    }

    /// The next message to be written; waits for it. None once the queue is closed and empty.
    pub fn next(&self) -> Option<Bytes> {
        let mut queue = self.lock();
        loop {
            if let Some((replaceable, bytes)) = queue.messages.pop_front() {
                queue.frames -= usize::from(replaceable);
                return Some(bytes);
            }
            if queue.closed {
                return None;
            }
            queue = self.changed.wait(queue).unwrap_or_else(|poisoned| poisoned.into_inner());
        }
    }

    /// Takes no more messages; what is there is still written.
    pub fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_one();
    }

    /// Whether it is closed.
    pub fn is_closed(&self) -> bool {
        self.lock().closed
    }

    /// Messages that have been dropped.
    pub fn dropped(&self) -> u64 {
        self.lock().dropped
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl Queue {
    fn push(&mut self, replaceable: bool, bytes: Bytes) {
        if replaceable && self.frames == FRAMES {
            let oldest = self.messages.iter().position(|(replaceable, _)| *replaceable);
            oldest.map(|oldest| self.messages.remove(oldest));
            (self.frames, self.dropped) = (self.frames - 1, self.dropped + 1);
        }
        self.messages.push_back((replaceable, bytes));
        self.frames += usize::from(replaceable);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(n: u8) -> Bytes {
        vec![n].into()
    }

    #[test]
    fn the_oldest_frames_are_dropped_and_no_answer() {
        let outbox = Outbox::default();
        outbox.answer(bytes(200));
        (0..FRAMES as u8 + 3).for_each(|n| outbox.frame(bytes(n)));
        outbox.answer(bytes(201));
        outbox.close();
        let left: Vec<u8> = std::iter::from_fn(|| outbox.next()).map(|bytes| bytes[0]).collect();
        let expected: Vec<u8> = [200].into_iter().chain(3..FRAMES as u8 + 3).chain([201]).collect();
        assert_eq!((left, outbox.dropped()), (expected, 3));
    }

    #[test]
    fn a_client_that_asks_and_never_reads_is_disconnected() {
        let outbox = Outbox::default();
        (0..ANSWERS).for_each(|_| outbox.answer(bytes(0)));
        assert!(!outbox.is_closed());
        outbox.answer(bytes(0));
        assert!(outbox.is_closed() && outbox.next().is_none());
    }
}
