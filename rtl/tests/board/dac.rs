// SPDX-License-Identifier: MIT OR Apache-2.0
//! What stands at the pins of a drive: a converter as its data sheet describes it.

use hapticore_rtl::board::drive_output::DacPort;
use hapticore_rtl::board::drive_output::serial::Frame;

/// What a converter's pins have told it.
#[derive(Clone)]
pub struct Dac {
    /// Its pins in the last clock.
    pub pins: DacPort<i64>,
    clocks: u64,
    bits: u64,
    taken: u8,
    high_since: u64,
    /// The last code of each channel.
    pub codes: [Option<i64>; 8],
    /// Its reference was switched on so often.
    pub references: u64,
    /// Channels and codes, as they were updated.
    pub updates: Vec<(usize, i64)>,
}

impl Dac {
    /// A converter that was told nothing yet.
    pub fn new() -> Dac {
        let pins = DacPort::of(0);
        Dac {
            pins,
            clocks: 0,
            bits: 0,
            taken: 0,
            high_since: 0,
            codes: [None; 8],
            references: 0,
            updates: Vec::new(),
        }
    }

    /// AD5664 and AD5668: bits are taken at falling edges, the last of a frame updates its channel.
    pub fn serial(&mut self, frame: &Frame, now: DacPort<i64>) {
        let before = std::mem::replace(&mut self.pins, now);
        self.clocks += 1;
        if before.dac_sync_n > now.dac_sync_n {
            assert!(self.clocks - self.high_since >= 1, "sync_n rests for 15 ns");
            self.taken = 0;
        }
        if now.dac_sync_n == 0 && before.dac_sclk > now.dac_sclk {
            assert_eq!(before.dac_sdi, now.dac_sdi, "data is stable around the edge");
            (self.bits, self.taken) = (self.bits << 1 | now.dac_sdi as u64, self.taken + 1);
            if self.taken == frame.bits() {
                self.update(frame);
            }
        }
        if now.dac_sync_n > before.dac_sync_n && self.clocks > 1 {
            assert_eq!(self.taken, frame.bits(), "no frame is cut short");
            self.high_since = self.clocks;
        }
    }

    /// A clock in which the board is reset: a frame in progress is cut short, which the converter ignores.
    pub fn is_reset(&mut self, now: DacPort<i64>) {
        self.pins = now;
        self.clocks += 1;
        (self.taken, self.high_since) = (0, self.clocks);
    }

    fn update(&mut self, frame: &Frame) {
        let bits = self.bits & ((1 << frame.bits()) - 1);
        if Some(bits) == frame.reference {
            self.references += 1;
            return;
        }
        assert!(frame.reference.is_none() || self.references > 0, "the reference comes first");
        let field = |low: u8, width: u8| self.bits >> low & ((1 << width) - 1);
        let address = frame.tail_bits + frame.word_bits;
        assert_eq!(field(address + frame.address_bits, 3), 0b011, "write and update a channel");
        let channel = field(address, frame.address_bits) as usize;
        let code = field(frame.tail_bits, frame.word_bits) as i64;
        self.codes[channel] = Some(code);
        self.updates.push((channel, code));
    }

    /// The voltage of a channel in codes, with the sign of its pin; none where it was never written.
    pub fn voltage(&self, channel: usize) -> Option<i64> {
        let negative = self.pins.dac_polarity >> channel & 1 != 0;
        self.codes[channel].map(|code| if negative { -code } else { code })
    }

    /// A word is taken as the strobe ends.
    pub fn parallel(&mut self, now: DacPort<i64>) {
        let before = std::mem::replace(&mut self.pins, now);
        self.clocks += 1;
        let line = |pins: DacPort<i64>| (pins.dac_word, pins.dac_address);
        if before.dac_write_n != now.dac_write_n && self.clocks > 1 {
            assert_eq!(line(before), line(now), "word and address are stable around the strobe");
        }
        if before.dac_write_n < now.dac_write_n && self.clocks > 1 {
            self.codes[now.dac_address as usize] = Some(now.dac_word);
        }
    }
}
