// SPDX-License-Identifier: MIT OR Apache-2.0
//! A WAV file being written: RIFF, or RF64 where the samples are too many for sizes of 32 bits.
//!
//! ```text
//!   RIFF size WAVE | JUNK 28 … | fmt 40 … | data size | samples          until it is known how many they are, and if they fit
//!   RF64 −1   WAVE | ds64 28 … | fmt 40 … | data −1   | samples          otherwise (EBU Tech 3306, §3)
//! ```

use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::super::partial_file::PartialFile;
use super::super::stream::{Adc, Recorder};
use super::format::{ELSEWHERE, EXTENSIBLE, GUID, PCM};

/// Bytes before the samples.
const HEAD_BYTES: u64 = 12 + 8 + 28 + 8 + 40 + 8;

/// The most bytes of samples that sizes of 32 bits hold, with the head and a byte that makes their
/// number even.
const MOST_BYTES: u64 = ELSEWHERE as u64 - HEAD_BYTES - 1;

/// A WAV capture being written.
pub struct Writer {
    partial: PartialFile,
    format: Format,
    shift: u32,
    written: u64,
    most: u64,
}

#[derive(Clone, Copy)]
struct Format {
    channels: u16,
    rate: u32,
    bytes: u16,
}

impl Writer {
    /// Creates a capture.
    pub fn create(path: &Path, adc: Adc, sample_rate_hz: f64) -> Result<Self> {
        let bits = adc.format.width.next_multiple_of(8).max(16);
        let rate = sample_rate_hz as u32;
        ensure!(
            f64::from(rate) == sample_rate_hz,
            "{}: expected a whole sample rate for WAV, got {sample_rate_hz} Hz",
            path.display()
        );
        let format =
            Format { channels: adc.channels().len() as u16, rate, bytes: u16::from(bits / 8) };
        let mut partial = PartialFile::create(path)?;
        partial
            .file
            .write_all(&format.head(0, MOST_BYTES))
            .with_context(|| path.display().to_string())?;
        let shift = u32::from(bits - adc.format.width);
        Ok(Writer { partial, format, shift, written: 0, most: MOST_BYTES })
    }

    fn write(&mut self, codes: &[i32]) -> io::Result<()> {
        let bytes = usize::from(self.format.bytes);
        for code in codes {
            self.partial.file.write_all(&(code << self.shift).to_le_bytes()[..bytes])?;
        }
        self.written += (bytes * codes.len()) as u64;
        Ok(())
    }

    /// Makes the number of bytes even and puts the head right.
    fn complete(&mut self) -> io::Result<()> {
        if !self.written.is_multiple_of(2) {
            self.partial.file.write_all(&[0])?;
        }
        self.partial.file.seek(SeekFrom::Start(0))?;
        self.partial.file.write_all(&self.format.head(self.written, self.most))
    }
}

impl Recorder for Writer {
    fn slot(&mut self, _pad: usize, codes: &[i32]) -> Result<()> {
        self.write(codes).with_context(|| self.partial.path().display().to_string())
    }

    fn keep(mut self: Box<Self>) -> Result<()> {
        self.complete().with_context(|| self.partial.path().display().to_string())?;
        self.partial.keep()
    }
}

impl Format {
    /// The head of a file with `samples` bytes of samples: RF64 where they are more than `most`.
    fn head(self, samples: u64, most: u64) -> Vec<u8> {
        let large = samples > most;
        let block = self.channels * self.bytes;
        let riff = HEAD_BYTES - 8 + samples + samples % 2;
        let size = |size: u64| if large { ELSEWHERE } else { size as u32 }.to_le_bytes();
        let mut head = Vec::with_capacity(HEAD_BYTES as usize);
        head.extend(if large { b"RF64" } else { b"RIFF" });
        head.extend(size(riff));
        head.extend(b"WAVE");
        head.extend(if large { b"ds64" } else { b"JUNK" });
        head.extend(28u32.to_le_bytes());
        let sizes =
            [riff, samples, samples / u64::from(block)].map(|size| if large { size } else { 0 });
        sizes.iter().for_each(|size| head.extend(size.to_le_bytes()));
        head.extend(0u32.to_le_bytes());
        head.extend(b"fmt ");
        head.extend(40u32.to_le_bytes());
        [EXTENSIBLE, self.channels].iter().for_each(|word| head.extend(word.to_le_bytes()));
        [self.rate, self.rate * u32::from(block)]
            .iter()
            .for_each(|word| head.extend(word.to_le_bytes()));
        let bits = 8 * self.bytes;
        [block, bits, 22, bits].iter().for_each(|word| head.extend(word.to_le_bytes()));
        head.extend(0u32.to_le_bytes());
        head.extend(PCM.to_le_bytes());
        head.extend(GUID);
        head.extend(b"data");
        head.extend(size(samples));
        head
    }
}

#[cfg(test)]
mod tests {
    use hapticore_hdl::format::Format as Codes;

    use super::*;
    use crate::capture::{Described, open};

    const ADC: Adc = Adc { terminals: 6, format: Codes { width: 18, frac: 17, signed: true } };

    fn codes() -> Vec<i32> {
        (0..800).map(|n| n * 163 - 65_536).collect()
    }

    /// Writes a capture whose sizes are of 64 bits beyond `most` bytes; its bytes, and the codes
    /// that are read back.
    fn round_trip(most: u64) -> (Vec<u8>, Vec<i32>) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.wav");
        let mut writer = Writer::create(&path, ADC, 1e6).unwrap();
        writer.most = most;
        let mut writer = Box::new(writer);
        writer.slot(0, &codes()).unwrap();
        writer.keep().unwrap();
        let mut read = Vec::new();
        let mut source = open(&path, ADC, &Described::default()).unwrap();
        while source.row(&mut read).unwrap().is_some() {}
        (std::fs::read(path).unwrap(), read)
    }

    #[test]
    fn few_samples_are_riff_and_too_many_rf64() {
        let (riff, read) = round_trip(MOST_BYTES);
        assert_eq!((&riff[..4], read), (&b"RIFF"[..], codes()));
        assert_eq!(u32::from_le_bytes(riff[4..8].try_into().unwrap()) as usize, riff.len() - 8);
        let (rf64, read) = round_trip(2399);
        assert_eq!((&rf64[..4], &rf64[12..16], read), (&b"RF64"[..], &b"ds64"[..], codes()));
        let of_64_bits = |at: usize| u64::from_le_bytes(rf64[at..at + 8].try_into().unwrap());
        assert_eq!(
            [of_64_bits(20), of_64_bits(28), of_64_bits(36)],
            [rf64.len() as u64 - 8, 2400, 100]
        );
    }
}
