// SPDX-License-Identifier: MIT OR Apache-2.0
//! The loop: one thread that owns the source, lets it advance as device time does, and shares it among all clients.
//!
//! ```text
//! requests ─[apply, between slots]─ source ─[slots that are due]─ rows ─┬─ latest frame of each pad, 60 Hz ─ all clients
//! answers ──────────┘                                                   └─ every slot ─ clients that have subscribed
//! ```
//!
//! The loop never waits for a client. Requests are carried out in `hub/requests.rs`.

mod requests;

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::{Duration, Instant};

use crate::client::{Bytes, Outbox, text_frame};
use crate::pace::{Histogram, Pace};
use crate::protocol::{Answer, Opening, Request, Status};
use crate::rows::Subscriber;
use crate::setup::Setup;
use crate::source::Source;

/// How often the loop wakes up at most, s.
const TICK_S: f64 = 0.004;
/// How often frames are sent, s: 60 times a second.
const FRAME_S: f64 = 1.0 / 60.0;
/// How often the status is sent, s.
const STATUS_S: f64 = 1.0;
/// A client that has armed a drive and says nothing for this long hangs, s.
const HANGS_S: f64 = 1.0;
/// How long slots are run before requests are looked at, s.
const BATCH_S: f64 = 0.008;
/// The longest wait, so that an end is noticed, s.
const WAIT_S: f64 = 0.1;
/// Requests that are carried out before the source advances.
const REQUESTS: usize = 256;
/// Messages to the loop that wait; beyond, whoever sends one waits.
const INBOX: usize = 1024;

/// What clients are told apart by.
pub type ClientId = u64;

/// A message to the loop.
pub enum Message {
    /// A client has come.
    Join(ClientId, Arc<Outbox>),
    /// A client has gone.
    Leave(ClientId),
    /// A client asks.
    Request(ClientId, Request),
    /// A scene has been set up, or not.
    Opened(Box<Opened>),
}

/// The outcome of an `open`.
pub struct Opened {
    client: ClientId,
    id: Option<u64>,
    opening: Opening,
    source: Result<Box<dyn Source>, String>,
}

struct Client {
    outbox: Arc<Outbox>,
    subscriber: Option<Subscriber>,
}

/// The client that has armed a board's drive. No other one drives; when it leaves or hangs, the drive goes to 0 V.
struct Driver {
    client: ClientId,
    /// When it said something last, s.
    heard_s: f64,
}

/// The loop's state.
pub struct Hub {
    setup: Arc<Setup>,
    source: Box<dyn Source>,
    opening: Opening,
    /// The scene that is being set up.
    next: Option<String>,
    /// Why the source has stopped.
    stopped: Option<String>,
    pace: Pace,
    clients: BTreeMap<ClientId, Client>,
    /// The client for which time stands.
    stepper: Option<ClientId>,
    driver: Option<Driver>,
    sender: SyncSender<Message>,
    inbox: Receiver<Message>,
    begun: Instant,
    /// There are rows that no frame has had.
    is_new: bool,
    framed_s: f64,
    reported: Reported,
    late: Histogram,
}

/// When the status was sent last, and what the device time was.
#[derive(Default)]
struct Reported {
    wall_s: f64,
    device_s: f64,
}

impl Hub {
    /// A loop over a source that has been set up.
    pub fn new(setup: Setup, opening: Opening, source: Box<dyn Source>, speed: f64) -> Hub {
        let (sender, inbox) = sync_channel(INBOX);
        Hub {
            setup: Arc::new(setup),
            source,
            opening,
            next: None,
            stopped: None,
            pace: Pace::new(0.0, speed),
            clients: BTreeMap::new(),
            stepper: None,
            driver: None,
            sender,
            inbox,
            begun: Instant::now(),
            is_new: false,
            framed_s: 0.0,
            reported: Reported::default(),
            late: Histogram::default(),
        }
    }

    /// Where messages to the loop go.
    pub fn sender(&self) -> SyncSender<Message> {
        self.sender.clone()
    }

    /// Runs until told to stop, then lets all clients go.
    pub fn run(&mut self, stop: &dyn Fn() -> bool) {
        while !stop() {
            self.wait();
            self.miss_driver();
            self.advance();
            self.publish();
        }
        self.clients.values().for_each(|client| client.outbox.close());
    }

    fn wall_s(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// The end of the next slot, s of device time.
    fn next_end_s(&self) -> f64 {
        (self.source.slot() + 1) as f64 * self.source.slot_s()
    }

    /// Waits until slots are due or somebody asks, and carries out what is asked.
    fn wait(&mut self) {
        let due_in_s = match self.is_idle() {
            true => WAIT_S,
            false => self.pace.wait_s(self.next_end_s()),
        };
        // Behind, there is no time to wait.
        let wait_s = if due_in_s > 0.0 { due_in_s.clamp(TICK_S, WAIT_S) } else { 0.0 };
        let planned_s = self.wall_s() + wait_s;
        match self.inbox.recv_timeout(Duration::from_secs_f64(wait_s)) {
            Ok(message) => {
                if self.is_idle() {
                    // Until now: the message may let time run.
                    self.pace.stand(self.wall_s());
                }
                self.take(message);
                let more: Vec<Message> = self.inbox.try_iter().take(REQUESTS).collect();
                more.into_iter().for_each(|message| self.take(message));
            }
            Err(RecvTimeoutError::Timeout) => self.late.add(self.wall_s() - planned_s),
            Err(RecvTimeoutError::Disconnected) => unreachable!("the loop holds a sender"),
        }
    }

    /// Whether no slot becomes due: nobody watches, time stands, or the source has stopped.
    fn is_idle(&self) -> bool {
        if self.source.is_real() {
            return self.stopped.is_some();
        }
        self.clients.is_empty() || self.pace.stands() || self.stopped.is_some()
    }

    /// Runs the slots that are due, for a while.
    fn advance(&mut self) {
        let begun_s = self.wall_s();
        if self.is_idle() {
            self.pace.stand(begun_s);
            return;
        }
        let due_s = self.pace.due_s(begun_s, self.next_end_s());
        while self.next_end_s() <= due_s && self.wall_s() - begun_s < BATCH_S {
            if !self.run_slot() {
                return;
            }
        }
    }

    /// Runs the next slot; false where the source has stopped.
    fn run_slot(&mut self) -> bool {
        loop {
            match self.run_step() {
                Some(more) if more => (),
                other => return other.is_some(),
            }
        }
    }

    /// Lets the source advance once, and says whether more has happened already; none where it has stopped.
    fn run_step(&mut self) -> Option<bool> {
        let slot = self.source.slot();
        let source = &mut self.source;
        // An assertion that fails is the end of this source, but not of the server.
        let outcome = catch_unwind(AssertUnwindSafe(|| source.advance()));
        let outcome = outcome.unwrap_or_else(|panic| {
            Err(format!("internal error in slot {slot}: {}", panic_message(&*panic)))
        });
        let step = match outcome {
            Ok(step) => step,
            Err(message) => {
                self.stop(format!("the source has stopped: {message}; open a scene again"));
                return None;
            }
        };
        if let Some((slot, row)) = step.row {
            self.is_new = true;
            for client in self.clients.values_mut() {
                let full = client.subscriber.as_mut().and_then(|of| of.add(slot, &row));
                full.into_iter().for_each(|bytes| client.outbox.frame(bytes));
            }
        }
        if let Some(event) = step.event {
            self.tell_all(&Answer::Event(event));
        }
        if let Some(text) = step.note {
            self.tell_all(&Answer::Note { text });
        }
        Some(step.more)
    }

    fn stop(&mut self, message: String) {
        self.tell_all(&Answer::Error { id: None, message: message.clone() });
        self.stopped = Some(message);
    }

    /// Sends frames and status when it is time.
    fn publish(&mut self) {
        let now_s = self.wall_s();
        if self.is_new && now_s - self.framed_s >= FRAME_S {
            self.send_frames(now_s);
        }
        if now_s - self.reported.wall_s >= STATUS_S {
            self.send_status(now_s);
        }
    }

    fn send_frames(&mut self, now_s: f64) {
        self.is_new = false;
        // A schedule, since the loop wakes up some milliseconds after a frame is due.
        self.framed_s = (self.framed_s + FRAME_S).max(now_s - FRAME_S);
        let bytes = frames(&*self.source);
        for client in self.clients.values_mut() {
            client.outbox.frame(bytes.clone());
            let rows = client.subscriber.as_mut().and_then(Subscriber::take);
            rows.into_iter().for_each(|bytes| client.outbox.frame(bytes));
        }
    }

    fn send_status(&mut self, now_s: f64) {
        let device_s = self.source.slot() as f64 * self.source.slot_s();
        let speed = (device_s - self.reported.device_s) / (now_s - self.reported.wall_s);
        self.reported = Reported { wall_s: now_s, device_s };
        let late = std::mem::take(&mut self.late);
        let ms = |share| (1e5 * late.quantile_s(share)).round() / 100.0;
        let status = Status {
            speed: (1e4 * speed).round() / 1e4,
            asked_speed: self.pace.speed(),
            stepped: self.pace.is_stepped(),
            late_ms: [0.5, 0.99, 1.0].map(ms),
            skipped_s: (1e3 * self.pace.skipped_s()).round() / 1e3,
            clients: self.clients.len(),
            dropped: 0,
            inputs: self.source.inputs(),
            opening: self.next.clone(),
            stopped: self.stopped.clone(),
            line: self.source.line(),
        };
        for client in self.clients.values() {
            let status = Status { dropped: client.outbox.dropped(), ..status.clone() };
            client.outbox.frame(text_frame(&Answer::Status(status).text()));
        }
    }

    fn tell_all(&self, answer: &Answer) {
        let bytes = text_frame(&answer.text());
        self.clients.values().for_each(|client| client.outbox.answer(bytes.clone()));
    }
}

fn frames(source: &dyn Source) -> Bytes {
    text_frame(&Answer::Frames(source.frames()).text())
}

fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown").to_string()
}
