// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where a capture's bytes come from: a file, or standard input.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result};

use crate::interrupt;

/// Bytes read at once.
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
    /// Whether it begins as a WAV file does.
    pub fn is_wav(&self) -> bool {
        let head = self.bytes.buffer();
        [b"RIFF", b"RF64", b"BW64"].iter().any(|magic| head.starts_with(*magic))
    }
}

/// A file to read a capture from.
///
/// # Errors
/// It cannot be opened.
pub fn file(path: &Path) -> Result<Input> {
    let name = path.display().to_string();
    let file = File::open(path).with_context(|| name.clone())?;
    let data = file.metadata().with_context(|| name.clone())?;
    let length = data.is_file().then_some(data.len());
    Ok(Input { bytes: BufReader::with_capacity(BLOCK, Box::new(file)), name, length })
}

/// Standard input, its first bytes there.
///
/// # Errors
/// It cannot be read.
pub fn standard() -> Result<Input> {
    let (sender, blocks) = sync_channel(4);
    thread::spawn(move || {
        let mut input = io::stdin();
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
    let piped = Piped { blocks, block: io::Cursor::new(Vec::new()) };
    let mut bytes = BufReader::with_capacity(BLOCK, Box::new(piped) as Box<dyn Read>);
    bytes.fill_buf().context("standard input")?;
    Ok(Input { bytes, name: "standard input".into(), length: None })
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
