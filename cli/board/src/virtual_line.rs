// SPDX-License-Identifier: MIT OR Apache-2.0
//! A virtual board in real time: as a line within this process, or served to another one.
//!
//! Device time is wall time, times a factor for a clock that is off. A machine that is too slow leaves time out, so that
//! what comes is late and never wrong.

use std::io::{self, Read, Write};
use std::net::TcpListener;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use hapticore_host::link::{Ends, Line, ends_of_tcp};

use crate::faults::Faults;
use crate::virtual_board::VirtualBoard;

/// How long a read waits.
const WAIT: Duration = Duration::from_millis(20);
/// How often it looks meanwhile.
const PAUSE: Duration = Duration::from_millis(1);
/// A board that is further behind leaves time out, s.
const BEHIND_S: f64 = 0.05;

/// A virtual board that runs, shared by its line and by who acts on it.
#[derive(Clone)]
pub struct Running {
    name: String,
    shared: Arc<Mutex<Shared>>,
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
    /// Counts ends of the line, so that the ends of an earlier one are dead.
    line: u64,
    failed: Option<String>,
}

impl Running {
    /// Lets a board run from now on.
    pub fn new(name: &str, board: VirtualBoard) -> Running {
        let shared = Shared {
            from_s: board.now_s(),
            board,
            begun: Instant::now(),
            speed: 1.0,
            skipped_s: 0.0,
            unplugged: false,
            line: 0,
            failed: None,
        };
        Running { name: name.into(), shared: Arc::new(Mutex::new(shared)) }
    }

    /// Acts on the board between two slots.
    pub fn with<T>(&self, act: impl FnOnce(&mut VirtualBoard) -> T) -> T {
        act(&mut self.lock().board)
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
        let mut shared = self.lock();
        let _ = shared.catch_up();
        (shared.from_s, shared.begun, shared.speed) = (shared.board.now_s(), Instant::now(), speed);
        shared.skipped_s = 0.0;
    }

    /// Unplugs the line, or plugs it in again.
    pub fn unplug(&self, unplugged: bool) {
        let mut shared = self.lock();
        shared.unplugged = unplugged;
        shared.line += 1;
    }

    /// Presses the board's reset button.
    pub fn reboot(&self) {
        self.with(VirtualBoard::reboot);
    }

    fn lock(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// The board's bytes up to now; none where the line that was `line` has ended.
    fn read(&self, line: u64) -> io::Result<Option<Vec<u8>>> {
        let mut shared = self.lock();
        if shared.unplugged || shared.line != line {
            return Ok(None);
        }
        shared.catch_up()?;
        Ok(Some(shared.board.take_bytes()))
    }
}

impl Shared {
    /// Lets the board run up to now.
    fn catch_up(&mut self) -> io::Result<()> {
        if let Some(why) = &self.failed {
            return Err(io::Error::other(why.clone()));
        }
        let due_s = self.from_s + self.speed * self.begun.elapsed().as_secs_f64() - self.skipped_s;
        let until_s = due_s.min(self.board.now_s() + BEHIND_S);
        self.skipped_s += due_s - until_s;
        self.board.advance(until_s).map_err(|error| {
            let why = format!("the virtual board has stopped: {error:#}");
            self.failed = Some(why.clone());
            io::Error::other(why)
        })
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
            shared.line
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
        let mut shared = self.running.lock();
        if shared.unplugged || shared.line != self.line {
            return Err(io::Error::new(io::ErrorKind::BrokenPipe, "unplugged"));
        }
        shared.catch_up()?;
        shared.board.receive(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Serves a board to one program after the other over TCP, until told to stop.
///
/// # Errors
/// An address that is in use or none of this machine's.
pub fn serve_tcp(running: &Running, address: &str, stop: &dyn Fn() -> bool) -> Result<()> {
    let listener = TcpListener::bind(address).with_context(|| format!("--serve: {address}"))?;
    listener.set_nonblocking(true)?;
    while !stop() {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false)?;
                let ends = ends_of_tcp(stream)?;
                // A program that leaves is no error.
                let _ = connect(running, ends, stop);
            }
            Err(_) => thread::sleep(WAIT),
        }
    }
    Ok(())
}

/// Serves a board on standard input and output, as a pseudo terminal has them, until they end.
///
/// # Errors
/// A line that has ended.
pub fn serve_standard(running: &Running, stop: &dyn Fn() -> bool) -> Result<()> {
    let ends = Ends { reader: Box::new(Waiting::new()?), writer: Box::new(io::stdout()) };
    connect(running, ends, stop)
}

/// Passes bytes between a program and the board, until the program leaves.
fn connect(running: &Running, mut program: Ends, stop: &dyn Fn() -> bool) -> Result<()> {
    let mut board = running.clone().open()?;
    let ended = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| {
            pass(&mut *board.reader, &mut *program.writer, &|| ended.load(Ordering::Relaxed));
            ended.store(true, Ordering::Relaxed);
        });
        let over = || stop() || ended.load(Ordering::Relaxed);
        pass(&mut *program.reader, &mut *board.writer, &over);
        ended.store(true, Ordering::Relaxed);
    });
    Ok(())
}

/// Passes bytes on, until either end is gone or it is told to stop.
fn pass(from: &mut (dyn Read + Send), to: &mut (dyn Write + Send), over: &dyn Fn() -> bool) {
    let mut buffer = [0; 4096];
    while !over() {
        let count = match from.read(&mut buffer) {
            Ok(0) => return,
            Ok(count) => count,
            Err(error) => match error.kind() {
                io::ErrorKind::WouldBlock
                | io::ErrorKind::TimedOut
                | io::ErrorKind::Interrupted => continue,
                _ => return,
            },
        };
        if to.write_all(&buffer[..count]).and_then(|()| to.flush()).is_err() {
            return;
        }
    }
}

/// Standard input, read by a thread of its own, so that a read ends after a while.
struct Waiting(std::sync::mpsc::Receiver<Vec<u8>>, Vec<u8>);

impl Waiting {
    fn new() -> Result<Self> {
        let (sender, receiver) = std::sync::mpsc::sync_channel(64);
        thread::Builder::new().name("stdin".into()).spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(count @ 1..) = io::stdin().lock().read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    break;
                }
            }
        })?;
        Ok(Waiting(receiver, Vec::new()))
    }
}

impl Read for Waiting {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        use std::sync::mpsc::RecvTimeoutError;
        if self.1.is_empty() {
            match self.0.recv_timeout(WAIT) {
                Ok(bytes) => self.1 = bytes,
                Err(RecvTimeoutError::Timeout) => return Err(io::ErrorKind::TimedOut.into()),
                Err(RecvTimeoutError::Disconnected) => return Ok(0),
            }
        }
        let count = self.1.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.1[..count]);
        self.1.drain(..count);
        Ok(count)
    }
}
