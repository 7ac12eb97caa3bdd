// SPDX-License-Identifier: MIT OR Apache-2.0
//! A virtual board that is offered to another program: over TCP, or on standard input and output.

use std::io::{self, Read, Write};
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result};
use hapticore_host::link::{Ends, Line, ends_of_tcp};

use crate::virtual_line::Running;

/// How long a read waits.
const WAIT: Duration = Duration::from_millis(20);

/// Serves a board to one program after the other over TCP, until `stop` says so.
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

/// Passes bytes between a program and the board, until the program leaves. Nothing waits for what the program has not
/// read: a write may last for ever.
fn connect(running: &Running, program: Ends, stop: &dyn Fn() -> bool) -> Result<()> {
    let (board, ended) = (running.clone().open()?, Arc::new(AtomicBool::new(false)));
    let Ends { reader: mut from_program, writer: mut to_program } = program;
    let Ends { reader: mut from_board, writer: mut to_board } = board;
    let writer = ended.clone();
    thread::Builder::new().name("serve".into()).spawn(move || {
        pass(&mut *from_board, &mut *to_program, &|| writer.load(Ordering::Relaxed));
        writer.store(true, Ordering::Relaxed);
    })?;
    let over = || stop() || ended.load(Ordering::Relaxed);
    pass(&mut *from_program, &mut *to_board, &over);
    ended.store(true, Ordering::Relaxed);
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
