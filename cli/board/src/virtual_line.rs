// SPDX-License-Identifier: MIT OR Apache-2.0
//! A virtual board in real time, as a line within this process.
//!
//! What the host writes waits in a box of its own, from which the board takes it as it runs. A writer that waited for a board
//! behind its time would be silent for too long. For the same reason the board pauses for whoever acts on it.
//!
//! Device time is wall time, times a factor for a clock that is off. A machine that is too slow leaves time out, so that
//! what comes is late and never wrong.

use std::io::{self, Read, Write};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::Result;
use hapticore_host::link::{Ends, Line};

use crate::faults::Faults;
use crate::virtual_board::VirtualBoard;

/// How long a read waits.
const WAIT: Duration = Duration::from_millis(20);
/// How often it looks meanwhile.
const PAUSE: Duration = Duration::from_millis(1);
/// How long the reader leaves the board to who acts on it.
const YIELD: Duration = Duration::from_micros(50);
/// A board that is further behind leaves time out, s.
const BEHIND_S: f64 = 0.05;
/// How long it runs until it looks for what was written, s.
const CHUNK_S: f64 = 0.005;

/// A virtual board that runs, shared by its line and by who acts on it.
#[derive(Clone)]
pub struct Running {
    name: String,
    shared: Arc<Mutex<Shared>>,
    written: Arc<Written>,
}

/// What hosts have written and the board has not taken yet.
#[derive(Default)]
struct Written {
    /// Counts ends of the line, so that the ends of an earlier one are dead.
    line: AtomicU64,
    bytes: Mutex<Vec<u8>>,
    /// How many wait to act on the board: the lock alone would leave it to the line's reader.
    acting: AtomicUsize,
}

impl Written {
    fn line(&self) -> u64 {
        self.line.load(Ordering::SeqCst)
    }

    fn is_acted_on(&self) -> bool {
        self.acting.load(Ordering::SeqCst) > 0
    }

    fn bytes(&self) -> MutexGuard<'_, Vec<u8>> {
        self.bytes.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// What has been written to a line that has ended is lost.
    fn end_line(&self) {
        let mut bytes = self.bytes();
        self.line.fetch_add(1, Ordering::SeqCst);
        bytes.clear();
    }
}

struct Shared {
    board: VirtualBoard,
    begun: Instant,
    /// Device time by wall time.
    speed: f64,
    /// Device time when `speed` was set.
    from_s: f64,
    /// Time that was left out, s.
    skipped_s: f64,
    unplugged: bool,
    written: Arc<Written>,
    failed: Option<String>,
}

impl Running {
    /// Lets a board run from now on.
    pub fn new(name: &str, board: VirtualBoard) -> Running {
        let written = Arc::<Written>::default();
        let shared = Shared {
            from_s: board.now_s(),
            board,
            begun: Instant::now(),
            speed: 1.0,
            skipped_s: 0.0,
            unplugged: false,
            written: written.clone(),
            failed: None,
        };
        Running { name: name.into(), shared: Arc::new(Mutex::new(shared)), written }
    }

    /// Acts on the board between two slots.
    pub fn with<T>(&self, act: impl FnOnce(&mut VirtualBoard) -> T) -> T {
        act(&mut self.acting().board)
    }

    /// Changes what is wrong with it.
    pub fn break_with(&self, change: impl FnOnce(&mut Faults)) {
        self.with(|board| change(&mut board.faults));
    }

    /// Leads a pad to a place, mm from the sheet's centre, within a time, s.
    ///
    /// # Errors
    /// No such pad, a place off the sheet.
    pub fn lead(&self, pad: usize, to_mm: [f64; 2], within_s: f64) -> Result<()> {
        self.with(|board| {
            let now_s = board.now_s() + 0.01;
            Ok(board.plant().lead(pad, to_mm, now_s, now_s + within_s)?)
        })
    }

    /// Device time by wall time from now on: 1.03 is a clock that is 3 % fast.
    pub fn set_speed(&self, speed: f64) {
        let mut shared = self.acting();
        let _ = shared.catch_up();
        (shared.from_s, shared.begun, shared.speed) = (shared.board.now_s(), Instant::now(), speed);
        shared.skipped_s = 0.0;
    }

    /// Unplugs the line, or plugs it in again.
    pub fn unplug(&self, unplugged: bool) {
        let mut shared = self.acting();
        shared.unplugged = unplugged;
        self.written.end_line();
    }

    /// Presses the board's reset button.
    pub fn reboot(&self) {
        self.with(VirtualBoard::reboot);
    }

    /// The board, which pauses.
    fn acting(&self) -> MutexGuard<'_, Shared> {
        self.written.acting.fetch_add(1, Ordering::SeqCst);
        let shared = self.lock();
        self.written.acting.fetch_sub(1, Ordering::SeqCst);
        shared
    }

    fn lock(&self) -> MutexGuard<'_, Shared> {
        let mut shared = self.shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        shared.take_written();
        shared
    }

    /// The board's bytes up to now; none where the line that was `line` has ended.
    fn read(&self, line: u64) -> io::Result<Option<Vec<u8>>> {
        while self.written.is_acted_on() {
            thread::sleep(YIELD);
        }
        let mut shared = self.lock();
        if shared.unplugged || self.written.line() != line {
            return Ok(None);
        }
        shared.catch_up()?;
        Ok(Some(shared.board.take_bytes()))
    }
}

impl Shared {
    /// The board takes what has been written.
    fn take_written(&mut self) {
        let bytes = std::mem::take(&mut *self.written.bytes());
        self.board.receive(&bytes);
    }

    /// Lets the board run up to now.
    fn catch_up(&mut self) -> io::Result<()> {
        if let Some(why) = &self.failed {
            return Err(io::Error::other(why.clone()));
        }
        let due_s = self.from_s + self.speed * self.begun.elapsed().as_secs_f64() - self.skipped_s;
        let until_s = due_s.min(self.board.now_s() + BEHIND_S);
        self.skipped_s += due_s - until_s;
        while self.board.now_s() < until_s && !self.written.is_acted_on() {
            let next_s = until_s.min(self.board.now_s() + CHUNK_S);
            self.board.advance(next_s).map_err(|error| {
                let why = format!("the virtual board has stopped: {error:#}");
                self.failed = Some(why.clone());
                io::Error::other(why)
            })?;
            self.take_written();
        }
        Ok(())
    }
}

impl Line for Running {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn open(&mut self) -> io::Result<Ends> {
        let line = {
            let mut shared = self.lock();
            if shared.unplugged {
                return Err(io::Error::new(io::ErrorKind::NotFound, "unplugged"));
            }
            let _ = shared.catch_up();
            shared.board.lose_bytes();
            self.written.line()
        };
        let reader = End { running: self.clone(), line, rest: Vec::new() };
        let writer = End { running: self.clone(), line, rest: Vec::new() };
        Ok(Ends { reader: Box::new(reader), writer: Box::new(writer) })
    }
}

/// An end of the line.
struct End {
    running: Running,
    line: u64,
    /// What has been read and did not fit.
    rest: Vec<u8>,
}

impl Read for End {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let begun = Instant::now();
        while self.rest.is_empty() {
            let Some(bytes) = self.running.read(self.line)? else { return Ok(0) };
            self.rest = bytes;
            if self.rest.is_empty() {
                if begun.elapsed() > WAIT {
                    return Err(io::ErrorKind::TimedOut.into());
                }
                thread::sleep(PAUSE);
            }
        }
        let count = self.rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.rest[..count]);
        self.rest.drain(..count);
        Ok(count)
    }
}

impl Write for End {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = &self.running.written;
        let mut waiting = written.bytes();
        if written.line() != self.line {
            return Err(io::Error::new(io::ErrorKind::BrokenPipe, "unplugged"));
        }
        waiting.extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
