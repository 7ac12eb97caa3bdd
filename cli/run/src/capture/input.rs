// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a capture's bytes come from: a file, or standard input.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, ensure};

use crate::interrupt;

/// Bytes per read.
const BLOCK: usize = 1 << 18;

/// How often a reader that waits asks whether to go on.
const PATIENCE: Duration = Duration::from_millis(100);

/// A capture's bytes.
pub struct Input {
    /// Content of the file or stream.
    pub bytes: BufReader<Box<dyn Read>>,
    /// What messages call it.
    pub name: String,
    /// How many bytes there are, where that is known.
    pub length: Option<u64>,
}

impl Input {
    /// Bytes that messages call `name`.
    pub fn new(bytes: Box<dyn Read>, name: String, length: Option<u64>) -> Self {
        let bytes: Box<dyn Read> = Box::new(Interruptible(bytes));
        Input { bytes: BufReader::with_capacity(BLOCK, bytes), name, length }
    }

    /// Whether it begins as a WAV file does.
    pub(super) fn is_wav(&self) -> bool {
        let head = self.bytes.buffer();
        [b"RIFF", b"RF64", b"BW64"].iter().any(|magic| head.starts_with(*magic))
    }
}

/// A file to read a capture from. What is no plain file (a device, a named pipe) is read on a thread
/// of its own, for even opening it may take until somebody writes.
///
/// # Errors
/// It cannot be opened.
pub(super) fn file(path: &Path) -> Result<Input> {
    let name = path.display().to_string();
    let data = fs::metadata(path).with_context(|| name.clone())?;
    ensure!(!data.is_dir(), "{name}: expected a file, got a folder");
    if !data.is_file() {
        let path = path.to_owned();
        return Ok(Input::new(Box::new(piped(move || File::open(path))), name, None));
    }
    let file = File::open(path).with_context(|| name.clone())?;
    Ok(Input::new(Box::new(file), name, Some(data.len())))
}

/// Standard input, its first bytes there.
///
/// # Errors
/// It cannot be read.
pub(super) fn standard() -> Result<Input> {
    let mut input = Input::new(Box::new(piped(|| Ok(io::stdin()))), "standard input".into(), None);
    input.bytes.fill_buf().context("standard input")?;
    Ok(input)
}

/// What opens and reads on another thread.
fn piped<R: Read>(open: impl FnOnce() -> io::Result<R> + Send + 'static) -> Piped {
    let (sender, blocks) = sync_channel(4);
    thread::spawn(move || {
        let mut input = match open() {
            Ok(input) => input,
            Err(error) => return drop(sender.send(Err(error))),
        };
        loop {
            let mut block = vec![0; BLOCK];
            let read = input.read(&mut block).map(|length| {
                block.truncate(length);
                block
            });
            let last = read.as_ref().map_or(true, Vec::is_empty);
            if sender.send(read).is_err() || last {
                return;
            }
        }
    });
    Piped { blocks, block: io::Cursor::new(Vec::new()) }
}

/// What another thread reads, so that a run that waits can be told to stop.
struct Piped {
    blocks: Receiver<io::Result<Vec<u8>>>,
    block: io::Cursor<Vec<u8>>,
}

impl Read for Piped {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.block.position() == self.block.get_ref().len() as u64 {
            match self.blocks.recv_timeout(PATIENCE) {
                Ok(block) => {
                    self.block = io::Cursor::new(block?);
                    if self.block.get_ref().is_empty() {
                        return Ok(0);
                    }
                }
                Err(RecvTimeoutError::Timeout) => interrupt::check().map_err(io::Error::other)?,
                Err(RecvTimeoutError::Disconnected) => return Ok(0),
            }
        }
        self.block.read(into)
    }
}

/// Bytes whose reader can be interrupted: comments, empty lines and skipped chunks may be endless.
struct Interruptible(Box<dyn Read>);

impl Read for Interruptible {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        interrupt::check().map_err(io::Error::other)?;
        self.0.read(into)
    }
}
