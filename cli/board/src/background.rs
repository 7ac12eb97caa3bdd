// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board that a thread of its own polls, for a program that calls when it likes.
//!
//! ```text
//! program ─ act ─[requests]─→ thread ─ Board ─ line
//!    ↑                          │
//!    └─ wait, take_rows ─[Seen]─┘
//! ```
//!
//! The thread sends the signs of life of an armed drive only while the program calls: after [`ALIVE`] without a call it
//! disarms the drive, so that a program that hangs drives nothing. When it ends, drives are at 0 V and the board is
//! disabled.

use std::collections::VecDeque;
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use hapticore_host::link::{Phase, Statistics};
use hapticore_live::protocol::Command;
use hapticore_live::source::Source;
use hapticore_run::record::Row;

use crate::source::Board;
use crate::target::Target;

/// Without a call for this long an armed drive is disarmed.
pub const ALIVE: Duration = Duration::from_secs(1);
/// Rows that wait to be taken: half a minute of the fastest board. Older ones are dropped, and counted.
pub const MOST_ROWS: usize = 1 << 17;
/// Notes that are kept.
const MOST_NOTES: usize = 1000;
/// How often the line is looked at.
const PAUSE: Duration = Duration::from_millis(2);

/// What is done with the board, and returns why not.
type Act = Box<dyn FnOnce(&mut Board) -> Result<(), String> + Send>;

enum Request {
    Act(Act, Sender<Result<(), String>>),
    Release(Sender<()>),
    Resume(Box<Target>),
}

/// What the thread has seen.
#[derive(Debug, Default)]
pub struct Seen {
    /// Rows that were not taken yet, the oldest first.
    rows: VecDeque<Row>,
    /// Rows that were dropped, since they were not taken.
    pub dropped_rows: u64,
    /// What a user should read, the oldest first.
    pub notes: VecDeque<String>,
    /// Where the board is; none while another program part has its line.
    pub phase: Option<Phase>,
    /// What has come so far.
    pub statistics: Statistics,
    /// What the board has said that it is.
    pub identity: Option<String>,
    /// Why it was refused last.
    pub refusal: Option<String>,
    /// The thread has ended.
    pub has_ended: bool,
}

impl Seen {
    /// How many rows were not taken yet.
    pub fn unread(&self) -> usize {
        self.rows.len()
    }

    fn add(&mut self, row: Row) {
        if self.rows.len() == MOST_ROWS {
            self.rows.pop_front();
            self.dropped_rows += 1;
        }
        self.rows.push_back(row);
    }

    fn note(&mut self, note: String) {
        if self.notes.len() == MOST_NOTES {
            self.notes.pop_front();
        }
        self.notes.push_back(note);
    }
}

struct Shared {
    seen: Mutex<Seen>,
    changed: Condvar,
    closes: AtomicBool,
    called_at: Mutex<Instant>,
}

impl Shared {
    fn seen(&self) -> MutexGuard<'_, Seen> {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn called_at(&self) -> MutexGuard<'_, Instant> {
        self.called_at.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A board and its thread.
pub struct Background {
    shared: Arc<Shared>,
    requests: Sender<Request>,
    thread: Mutex<Option<JoinHandle<()>>>,
}

impl Background {
    /// Connects to a board, and brings it up; `name` is that of its port.
    ///
    /// # Errors
    /// No thread can be started.
    pub fn start(target: Target, name: &str) -> io::Result<Background> {
        let shared = Arc::new(Shared {
            seen: Mutex::new(Seen { phase: Some(Phase::Disconnected), ..Seen::default() }),
            changed: Condvar::new(),
            closes: AtomicBool::new(false),
            called_at: Mutex::new(Instant::now()),
        });
        let (requests, inbox) = channel();
        let (of_thread, name) = (Ended(shared.clone()), name.to_string());
        let thread = thread::Builder::new().name("board".into()).spawn(move || {
            run(Some(Board::new(target, &name)), &name, &of_thread.0, &inbox);
        })?;
        Ok(Background { shared, requests, thread: Mutex::new(Some(thread)) })
    }

    /// What the thread has seen.
    pub fn seen(&self) -> MutexGuard<'_, Seen> {
        self.shared.seen()
    }

    /// A sign of life of the program.
    pub fn alive(&self) {
        *self.shared.called_at() = Instant::now();
    }

    /// Waits until something is so, at most this long; whether it is.
    pub fn wait(&self, most: Duration, is_so: impl Fn(&Seen) -> bool) -> bool {
        let seen = self.shared.seen();
        let waits = |seen: &mut Seen| !is_so(seen);
        let (seen, _) = self
            .shared
            .changed
            .wait_timeout_while(seen, most, waits)
            .unwrap_or_else(PoisonError::into_inner);
        is_so(&seen)
    }

    /// Takes all rows, the oldest first.
    pub fn take_rows(&self) -> Vec<Row> {
        self.shared.seen().rows.drain(..).collect()
    }

    /// Takes so many rows, the oldest first; none where fewer are there. Another thread may take some between a look
    /// at how many there are and this.
    pub fn take_exactly(&self, count: usize) -> Option<Vec<Row>> {
        let mut seen = self.shared.seen();
        (count <= seen.rows.len()).then(|| seen.rows.drain(..count).collect())
    }

    /// Does something with the board, between two looks at its line; what it returns comes over the channel. That of a
    /// thread that has ended is disconnected.
    pub fn act(
        &self,
        act: impl FnOnce(&mut Board) -> Result<(), String> + Send + 'static,
    ) -> Receiver<Result<(), String>> {
        let (done, is_done) = channel();
        let _ = self.requests.send(Request::Act(Box::new(act), done));
        is_done
    }

    /// Disables the board and closes its line; said over the channel once it is done.
    pub fn release(&self) -> Receiver<()> {
        let (done, is_done) = channel();
        let _ = self.requests.send(Request::Release(done));
        is_done
    }

    /// Connects to the board again after [`Background::release`].
    pub fn resume(&self, target: Target) {
        let _ = self.requests.send(Request::Resume(Box::new(target)));
    }

    /// Adds something that a user should read.
    pub fn note(&self, note: &str) {
        self.shared.seen().note(note.into());
    }

    /// Takes drives to 0 V, disables the board and ends the thread; later calls do nothing.
    pub fn close(&self) {
        self.shared.closes.store(true, Ordering::Relaxed);
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
        thread.map(JoinHandle::join);
    }
}

impl Drop for Background {
    fn drop(&mut self) {
        self.shared.closes.store(true, Ordering::Relaxed);
    }
}

/// Tells all who wait that the thread has ended, however it does.
struct Ended(Arc<Shared>);

impl Drop for Ended {
    fn drop(&mut self) {
        let mut seen = self.0.seen();
        (seen.has_ended, seen.phase) = (true, None);
        self.0.changed.notify_all();
    }
}

fn run(mut board: Option<Board>, name: &str, shared: &Shared, requests: &Receiver<Request>) {
    while !shared.closes.load(Ordering::Relaxed) {
        if let Some(board) = &mut board {
            look(board, shared);
        }
        match requests.recv_timeout(PAUSE) {
            Ok(Request::Act(act, done)) => {
                *shared.called_at() = Instant::now();
                let result = match &mut board {
                    Some(board) => act(board),
                    None => Err("expected a board that is not being checked".into()),
                };
                publish(board.as_ref(), shared);
                let _ = done.send(result);
            }
            Ok(Request::Release(done)) => {
                board = None;
                publish(None, shared);
                let _ = done.send(());
            }
            Ok(Request::Resume(target)) => board = Some(Board::new(*target, name)),
            Err(RecvTimeoutError::Timeout) => (),
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}

/// Takes what has come, and disarms a drive whose program does not call any more.
fn look(board: &mut Board, shared: &Shared) {
    let mut more = true;
    while more {
        let step = match board.advance() {
            Ok(step) => step,
            Err(why) => return shared.seen().note(why),
        };
        let mut seen = shared.seen();
        // With what is noted of it: who sees the one sees the other.
        seen.phase = Some(board.phase());
        if let Some((_, row)) = step.row {
            seen.add(row);
        }
        if let Some(note) = step.note {
            seen.note(note);
        }
        more = step.more;
    }
    if board.phase() == Phase::Armed && shared.called_at().elapsed() > ALIVE {
        let _ = board.apply(&Command::Arm { on: false });
        let s = ALIVE.as_secs();
        let why = format!(
            "this program made no call for {s} s: the drive is off until it is armed again"
        );
        shared.seen().note(why);
    }
    publish(Some(board), shared);
}

/// Lets others see where the board is.
fn publish(board: Option<&Board>, shared: &Shared) {
    let mut seen = shared.seen();
    seen.phase = board.map(Board::phase);
    if let Some(board) = board {
        seen.statistics = board.statistics();
        seen.identity = board.identity().map(Into::into);
        seen.refusal = board.refusal();
    }
    shared.changed.notify_all();
}
