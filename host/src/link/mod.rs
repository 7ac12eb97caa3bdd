// SPDX-License-Identifier: MIT OR Apache-2.0
//! Link: a line to a board that is kept open, what comes over it, and how much was lost.
//!
//! ```text
//! Line ─ Ends ─ thread that reads ─[bounded]─ Link::poll ─ Event: connected, message, damage, silence, end
//!          └──────────────────────── Link::send
//! ```
//!
//! [`Link`] knows bytes and packets. [`Session`] above it brings a board up, keeps the drive off until it is armed, and
//! sends signs of life while it is.
//!
//! A line that ends is opened again, four times a second. Nothing is sent then until the session has brought the board
//! up anew.

mod line;
mod session;
mod statistics;
mod words;

pub use line::{Ends, Line, SerialPort, Tcp, ends_of_tcp, line};
pub use session::{Phase, Plan, Refusal, Session, SessionEvent};
pub use statistics::Statistics;

use std::io::{ErrorKind, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, TrySendError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::decoder::Decoder;
use crate::line::Damage;
use crate::packet::Message;
use hapticore_contract::profile::Profile;
use statistics::Counter;

/// How often a line is opened again, at most.
const RETRY: Duration = Duration::from_millis(250);
/// Without a packet for this long a board is silent.
pub const SILENT: Duration = Duration::from_millis(1000);
/// Chunks of bytes that wait to be decoded: some seconds.
const CHUNKS: usize = 4096;
/// Bytes of a chunk, at most.
const CHUNK: usize = 4096;
/// How long the reading thread pauses where there is nothing.
const PAUSE: Duration = Duration::from_millis(1);

/// What a link reports.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// The line is open.
    Connected,
    /// The line has ended, or cannot be opened; said once until it changes.
    Disconnected(String),
    /// The board has said nothing for [`SILENT`]; said once.
    Silent,
    /// A packet.
    Message(Message),
    /// A packet that was damaged.
    Damaged(Damage),
}

/// A line to a board that is kept open.
pub struct Link {
    line: Box<dyn Line>,
    decoder: Decoder,
    profile: Profile,
    open: Option<Open>,
    counter: Counter,
    overflowed: Arc<AtomicU64>,
    retry_at: Instant,
    /// When the last packet came, or the line was opened.
    heard_at: Instant,
    is_silent: bool,
    why: Option<String>,
}

/// A line that is open.
struct Open {
    writer: Box<dyn std::io::Write + Send>,
    inbox: Receiver<Chunk>,
    ends: Arc<AtomicBool>,
}

/// What the reading thread passes on.
enum Chunk {
    Bytes(Vec<u8>),
    End(String),
}

impl Drop for Open {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
    }
}

impl Link {
    /// A link to a board of the profile; the line is opened by the first [`Link::poll`].
    pub fn new(line: Box<dyn Line>, profile: &Profile) -> Self {
        let now = Instant::now();
        Link {
            line,
            decoder: Decoder::new(profile),
            profile: profile.clone(),
            open: None,
            counter: Counter::default(),
            overflowed: Arc::default(),
            retry_at: now,
            heard_at: now,
            is_silent: false,
            why: None,
        }
    }

    /// The line's name.
    pub fn name(&self) -> String {
        self.line.name()
    }

    /// The profile of the board.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Whether the line is open.
    pub fn is_connected(&self) -> bool {
        self.open.is_some()
    }

    /// How long ago the last packet came, or the line was opened.
    pub fn age(&self) -> Duration {
        self.heard_at.elapsed()
    }

    /// What has come so far.
    pub fn statistics(&self) -> Statistics {
        let overflowed = self.overflowed.load(Ordering::Relaxed);
        Statistics { overflowed, ..self.counter.counts }
    }

    /// From the next frame on sequence numbers count anew.
    pub fn begin_sequence(&mut self) {
        self.counter.begin();
    }

    /// Opens the line where it is not, and reports what has come since. Never waits for the board.
    pub fn poll(&mut self, mut report: impl FnMut(Event)) {
        if self.open.is_none() {
            self.try_open(&mut report);
        }
        self.drain(&mut report);
        if self.open.is_some() && !self.is_silent && self.heard_at.elapsed() > SILENT {
            self.is_silent = true;
            report(Event::Silent);
        }
    }

    /// Sends bytes; false where the line is not open or has just ended.
    pub fn send(&mut self, bytes: &[u8]) -> bool {
        let Some(open) = &mut self.open else { return false };
        match open.writer.write_all(bytes).and_then(|()| open.writer.flush()) {
            Ok(()) => true,
            Err(error) => {
                self.close(error.to_string());
                false
            }
        }
    }

    fn try_open(&mut self, report: &mut impl FnMut(Event)) {
        // A write that has failed has closed the line.
        if let Some(why) = self.why.take() {
            report(Event::Disconnected(why));
        }
        if Instant::now() < self.retry_at {
            return;
        }
        self.retry_at = Instant::now() + RETRY;
        match self.line.open().and_then(|ends| self.start(ends)) {
            Ok(open) => {
                self.open = Some(open);
                self.decoder = Decoder::new(&self.profile);
                self.counter.begin();
                self.counter.counts.connections += 1;
                (self.heard_at, self.is_silent) = (Instant::now(), false);
                report(Event::Connected);
            }
            Err(error) => report(Event::Disconnected(error.to_string())),
        }
    }

    fn start(&self, ends: Ends) -> std::io::Result<Open> {
        let (outbox, inbox) = sync_channel(CHUNKS);
        let (told_to_end, overflowed) = (Arc::new(AtomicBool::new(false)), self.overflowed.clone());
        let told = told_to_end.clone();
        let thread = thread::Builder::new().name("line".into());
        thread.spawn(move || read(ends.reader, &outbox, &told, &overflowed))?;
        Ok(Open { writer: ends.writer, inbox, ends: told_to_end })
    }

    fn drain(&mut self, report: &mut impl FnMut(Event)) {
        while let Some(open) = &self.open {
            match open.inbox.try_recv() {
                Ok(Chunk::Bytes(bytes)) => self.decode(&bytes, report),
                Ok(Chunk::End(why)) => self.close(why),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => self.close("the line has ended".into()),
            }
        }
        if let Some(why) = self.why.take() {
            report(Event::Disconnected(why));
        }
    }

    fn decode(&mut self, bytes: &[u8], report: &mut impl FnMut(Event)) {
        self.counter.counts.bytes += bytes.len() as u64;
        for heard in bytes.iter().filter_map(|byte| self.decoder.push(*byte)) {
            match heard {
                Ok(message) => {
                    self.counter.add(&message);
                    (self.heard_at, self.is_silent) = (Instant::now(), false);
                    report(Event::Message(message));
                }
                Err(damage) => {
                    self.counter.counts.damaged += 1;
                    report(Event::Damaged(damage));
                }
            }
        }
    }

    fn close(&mut self, why: String) {
        self.open = None;
        self.why = Some(why);
        self.retry_at = Instant::now() + RETRY;
    }
}

/// Reads until the line ends, or the link is closed.
fn read(
    mut reader: Box<dyn Read + Send>,
    outbox: &SyncSender<Chunk>,
    told_to_end: &AtomicBool,
    overflowed: &AtomicU64,
) {
    let mut buffer = [0; CHUNK];
    while !told_to_end.load(Ordering::Relaxed) {
        match reader.read(&mut buffer) {
            Ok(0) => {
                let _ = outbox.send(Chunk::End("the line has ended".into()));
                return;
            }
            Ok(count) => match outbox.try_send(Chunk::Bytes(buffer[..count].to_vec())) {
                Ok(()) => (),
                Err(TrySendError::Full(_)) => {
                    overflowed.fetch_add(count as u64, Ordering::Relaxed);
                }
                Err(TrySendError::Disconnected(_)) => return,
            },
            Err(error) => match error.kind() {
                ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted => {
                    thread::sleep(PAUSE);
                }
                _ => {
                    let _ = outbox.send(Chunk::End(error.to_string()));
                    return;
                }
            },
        }
    }
}
