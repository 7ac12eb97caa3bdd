// SPDX-License-Identifier: MIT OR Apache-2.0
//! The head of a WAV file, chunk by chunk. Nothing is asked for twice, so that it may come through
//! a pipe.

use std::io::{self, Read};

use anyhow::{Context, Result, anyhow, bail, ensure};

use super::super::columns::Columns;
use super::super::input::Input;
use super::super::raw::{Layout, Reader};
use super::super::stream::{Adc, Described};
use super::format::{ELSEWHERE, EXTENSIBLE, FLOAT, GUID, PCM};

/// Chunks beyond this size have no place in a head.
const MOST_BYTES: u64 = 1 << 16;

/// What the head says.
struct Head {
    tag: u16,
    channels: usize,
    sample_rate: u32,
    block_bytes: usize,
    bits: u32,
}

/// Opens a capture and reads its head.
pub fn open(mut input: Input, adc: Adc, described: &Described) -> Result<Reader> {
    let name = input.name.clone();
    ensure!(input.length != Some(0), "{name}: expected a WAV file, got an empty file");
    let (head, length) =
        read_head(&mut input).map_err(|error| anyhow!("{name}: expected a WAV file: {error:#}"))?;
    let columns = Columns::counted(head.channels, described.channels.as_deref(), adc)
        .with_context(|| name.clone())?;
    let layout = layout(&head, described).with_context(|| name.clone())?;
    let block = head.block_bytes as u64;
    // A recorder that writes into a pipe cannot know the length: sox names 0x7fffeff0 bytes or so.
    let is_short_taken = described.truncated || input.length.is_none();
    if let Some(length) = length.filter(|_| !is_short_taken) {
        ensure!(
            length % block == 0,
            "{name}: expected whole samples of {block} bytes, got {length} bytes: it is cut short; --truncated takes what is there"
        );
    }
    let reader = Reader::new(
        input,
        adc,
        layout,
        columns,
        f64::from(head.sample_rate),
        length.map(|length| length / block),
    );
    Ok(reader.taking_short(is_short_taken))
}

fn layout(head: &Head, described: &Described) -> Result<Layout> {
    let bytes = head.block_bytes / head.channels;
    ensure!(
        bytes * head.channels == head.block_bytes,
        "expected whole bytes a sample, got {} bits",
        head.bits
    );
    match head.tag {
        PCM if (2..=4).contains(&bytes) => {
            ensure!(
                described.full_scale_v.is_none(),
                "--full-scale-v: expected floats in volts, got integer codes"
            );
            Layout::integer(bytes, head.bits, described.bits, false)
        }
        FLOAT if bytes == 4 || bytes == 8 => {
            ensure!(described.bits.is_none(), "--bits: expected integer codes, got floats");
            Ok(Layout::float(bytes, described.full_scale_v, false))
        }
        tag => bail!(
            "expected integer samples of 16, 24 or 32 bits or floats of 32 or 64, got samples of {} bits (format {tag})",
            head.bits
        ),
    }
}

/// The head, and how many bytes of samples follow it where it says so.
fn read_head(input: &mut Input) -> Result<(Head, Option<u64>)> {
    let riff = chunk(input)?;
    let mut wave = [0; 4];
    input.bytes.read_exact(&mut wave)?;
    let large = matches!(&riff.0, b"RF64" | b"BW64");
    ensure!((large || &riff.0 == b"RIFF") && &wave == b"WAVE", "it does not begin as one");
    let (mut head, mut large_bytes) = (None, None);
    loop {
        let (id, size) = chunk(input).context("it has no samples")?;
        match &id {
            b"ds64" if large => large_bytes = Some(u64_at(&body(input, size)?, 8)?),
            b"fmt " => head = Some(format(&body(input, size)?)?),
            b"data" => {
                let head = head.context("it has no format before its samples")?;
                return Ok((head, samples_bytes(input, size, large_bytes)?));
            }
            _ => skip(input, u64::from(size) + u64::from(size % 2))?,
        }
    }
}

/// How many bytes the samples have.
fn samples_bytes(input: &Input, size: u32, large: Option<u64>) -> Result<Option<u64>> {
    match (size, large) {
        (ELSEWHERE, Some(large)) => Ok(Some(large)),
        (0 | ELSEWHERE, None) => Ok(None),
        (size, _) => {
            let too_long = input.length.is_some_and(|length| length > u64::from(ELSEWHERE) + 8);
            ensure!(!too_long, "its size does not fit a head of RIFF; expected RF64");
            Ok(Some(u64::from(size)))
        }
    }
}

fn format(body: &[u8]) -> Result<Head> {
    let u16_at = |at: usize| {
        body.get(at..at + 2)
            .map(|b| u16::from_le_bytes([b[0], b[1]]))
            .context("its format is cut short")
    };
    let u32_at = |at: usize| {
        Ok::<u32, anyhow::Error>(u32::from(u16_at(at)?) | u32::from(u16_at(at + 2)?) << 16)
    };
    let (channels, block_bytes, bits) =
        (usize::from(u16_at(2)?), usize::from(u16_at(12)?), u32::from(u16_at(14)?));
    ensure!(channels > 0 && block_bytes > 0, "it has no channels");
    let mut head = Head { tag: u16_at(0)?, channels, sample_rate: u32_at(4)?, block_bytes, bits };
    if head.tag == EXTENSIBLE {
        head.tag = u16_at(24)?;
        ensure!(body.get(26..40) == Some(&GUID), "its format is neither integer nor float");
        let valid = u32::from(u16_at(18)?);
        head.bits = if valid == 0 { bits } else { valid };
    }
    Ok(head)
}

/// The name and the size of the next chunk.
fn chunk(input: &mut Input) -> io::Result<([u8; 4], u32)> {
    let (mut id, mut size) = ([0; 4], [0; 4]);
    input.bytes.read_exact(&mut id)?;
    input.bytes.read_exact(&mut size)?;
    Ok((id, u32::from_le_bytes(size)))
}

/// A chunk's content; one of odd size is followed by a byte that is none of it.
fn body(input: &mut Input, size: u32) -> Result<Vec<u8>> {
    ensure!(u64::from(size) <= MOST_BYTES, "its head is too long");
    let mut body = vec![0; size as usize];
    input.bytes.read_exact(&mut body)?;
    skip(input, u64::from(size % 2))?;
    Ok(body)
}

fn skip(input: &mut Input, bytes: u64) -> Result<()> {
    let skipped = io::copy(&mut (&mut input.bytes).take(bytes), &mut io::sink())?;
    ensure!(skipped == bytes, "it is cut short");
    Ok(())
}

fn u64_at(body: &[u8], at: usize) -> Result<u64> {
    let bytes = body.get(at..at + 8).and_then(|bytes| bytes.try_into().ok());
    Ok(u64::from_le_bytes(bytes.context("its sizes of 64 bits are cut short")?))
}
