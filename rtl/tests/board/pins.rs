// SPDX-License-Identifier: MIT OR Apache-2.0
//! What stands at the board's pins: an ADC, and the host's end of the serial line.

use hapticore_host::ad7606c::Part;
use hapticore_rtl::board::Parameters;
use hapticore_rtl::board::drive_output::DacPort;
use hapticore_rtl::board::whole::Outputs;
use std::collections::VecDeque;

/// How the ADC at the pins behaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Health {
    /// As its data sheet says.
    Well,
    /// Each conversion takes longer than it may.
    Slow,
    /// It is not there: BUSY never rises.
    Absent,
}

/// From the end of a reset until the part may be spoken to, by its data sheet.
const SETUP_US: u64 = 253;

/// An ADC that shifts out what was there at the rising edges of CONVST, the samples of a list.
#[derive(Clone)]
pub struct Adc {
    pub health: Health,
    /// A data line that is broken, and the level that it has.
    pub broken: Option<(usize, i64)>,
    /// Two data lines that are at one wire: both have the level of the first.
    pub shorted: Option<[usize; 2]>,
    samples: VecDeque<Vec<i32>>,
    conversion: u64,
    bits: u32,
    before: Outputs<i64>,
    /// SCLK's pulses on their way through the output primitive.
    pulses: VecDeque<i64>,
    converting: Vec<i32>,
    shifting: Vec<i32>,
    left: u64,
    bit: u32,
    /// Clocks from a reset until it may be spoken to, and those that are left of them.
    setup: u64,
    ready: u64,
    /// What came over SDI while CS was low.
    sdi: Vec<i64>,
    /// What the first data line puts out in register mode.
    answer: Option<u16>,
    /// Registers of the modelled ADC.
    pub part: Part,
    /// Conversions that it has begun.
    pub conversions: usize,
    /// Changes of SDI while CS was low.
    pub sdi_changes: u64,
    /// Edges that the data sheet forbids.
    pub wrong: Vec<&'static str>,
}

impl Adc {
    /// An ADC of `bits` on a board with these parameters.
    pub fn new(
        samples: impl IntoIterator<Item = Vec<i32>>,
        bits: u8,
        parameters: &Parameters,
    ) -> Self {
        let (conversion, latency) = (parameters.conversion() - 1, parameters.sclk_latency);
        let setup = SETUP_US * parameters.clock_hz / 1_000_000;
        let before = Outputs {
            convst: 0,
            cs_n: 1,
            sclk_run: 0,
            sdi: 0,
            carrier: 0,
            select: 0,
            tx: 1,
            enabled: 0,
            late: 0,
            adc_reset: 0,
            dac: DacPort::of(0),
        };
        Adc {
            health: Health::Well,
            broken: None,
            shorted: None,
            samples: samples.into_iter().collect(),
            conversion,
            bits: bits.into(),
            before,
            pulses: (0..latency).map(|_| 0).collect(),
            converting: Vec::new(),
            shifting: vec![0; 8],
            left: 0,
            bit: 0,
            setup,
            ready: setup,
            sdi: Vec::new(),
            answer: None,
            part: Part::new(0x31),
            conversions: 0,
            sdi_changes: 0,
            wrong: Vec::new(),
        }
    }

    /// What the next conversion finds.
    pub fn offer(&mut self, sample: Vec<i32>) {
        self.samples.clear();
        self.samples.push_back(sample);
    }

    /// BUSY, and the data lines.
    pub fn pins(&self) -> (i64, i64) {
        let (busy, dout) = self.whole_pins();
        let dout = match self.shorted {
            Some([one, other]) => dout & !(1 << other) | (dout >> one & 1) << other,
            None => dout,
        };
        match self.broken {
            Some((line, level)) => (busy, dout & !(1 << line) | level << line),
            None => (busy, dout),
        }
    }

    fn whole_pins(&self) -> (i64, i64) {
        let busy = self.left > 0 && self.health != Health::Absent;
        if let Some(answer) = self.answer {
            return (busy.into(), i64::from(answer) >> 15u32.saturating_sub(self.bit) & 1);
        }
        let shift = (self.bits - 1).saturating_sub(self.bit);
        let lines = self.shifting.iter().enumerate().take(self.part.lines());
        let dout = lines.map(|(line, &code)| (i64::from(code) >> shift & 1) << line).sum();
        (busy.into(), dout)
    }

    /// One clock, with the board's outputs in it.
    pub fn clock(&mut self, outputs: &Outputs<i64>) {
        self.reset(outputs.adc_reset != 0);
        self.pulses.push_back(outputs.sclk_run);
        let pulse = self.pulses.pop_front().expect("one was pushed") != 0;
        self.convert(outputs.convst > self.before.convst);
        if outputs.cs_n + self.before.cs_n == 0 && outputs.sdi != self.before.sdi {
            self.sdi_changes += 1;
        }
        if outputs.cs_n != 0 && pulse {
            self.wrong.push("SCLK without CS");
        }
        if outputs.cs_n < self.before.cs_n {
            self.bit = 0;
            self.sdi.clear();
            self.answer = self.part.register_mode().then(|| self.part.answer());
            if pulse {
                self.wrong.push("SCLK with CS's edge");
            }
        }
        if pulse {
            self.bit += 1;
            self.sdi.push(outputs.sdi);
        }
        if outputs.cs_n > self.before.cs_n {
            self.end_of_read();
        }
        self.before = *outputs;
    }

    fn convert(&mut self, starts: bool) {
        if self.left == 1 {
            // The registers that are read change: no read may be in progress.
            if self.before.cs_n == 0 && self.health == Health::Well {
                self.wrong.push("codes replaced while they are read");
            }
            self.shifting = self.converting.clone();
        }
        self.left = self.left.saturating_sub(1);
        if starts {
            if self.left > 0 {
                self.wrong.push("CONVST while BUSY");
            }
            if self.ready > 0 {
                self.wrong.push("CONVST before it was ready after its reset");
            }
            if self.part.register_mode() {
                self.wrong.push("CONVST in register mode");
            }
            self.conversions += 1;
            let sample = self.samples.pop_front().unwrap_or_else(|| vec![0; 8]);
            self.converting = self.part.fixed_codes(self.bits).unwrap_or(sample);
            self.left =
                if self.health == Health::Slow { self.conversion + 3 } else { self.conversion };
        }
    }

    fn reset(&mut self, reset: bool) {
        self.ready = self.ready.saturating_sub(1);
        if reset {
            self.part.reset();
            (self.ready, self.left) = (self.setup, 0);
        }
    }

    fn end_of_read(&mut self) {
        self.answer = None;
        if self.ready > 0 {
            self.wrong.push("spoken to before it was ready after its reset");
        }
        if !self.part.register_mode()
            && self.sdi.iter().all(|&bit| bit == 0)
            && self.bit != self.bits
        {
            self.wrong.push("a read of another length than the word's");
        }
        self.wrong.extend(self.part.word(&self.sdi).err());
    }
}

/// The host's end of a serial line: bytes in, bytes out, at its own pace. It waits for a start bit
/// as soon as it has sampled a stop bit, and gives a zero byte where that was low, as POSIX
/// terminals do.
#[derive(Clone)]
pub struct Host {
    /// Clocks of the board in a bit of the host.
    bit: f64,
    sending: VecDeque<bool>,
    /// Clocks since the bit that is being sent began.
    sent: f64,
    /// Clocks until the next bit is sampled, and the bits so far.
    hearing: Option<(f64, Vec<bool>)>,
    pub heard: Vec<u8>,
}

impl Host {
    pub fn new(divisor: u64) -> Self {
        Host::with_bit(divisor as f64)
    }

    /// A host whose bits take `bit` clocks of the board.
    pub fn with_bit(bit: f64) -> Self {
        Host { bit, sending: VecDeque::new(), sent: 0.0, hearing: None, heard: Vec::new() }
    }

    pub fn send(&mut self, bytes: impl IntoIterator<Item = u8>) {
        self.send_early(bytes, 0.0);
    }

    /// Sends bytes, the first edge, if none are being sent, so much of a clock before it is seen.
    pub fn send_early(&mut self, bytes: impl IntoIterator<Item = u8>, early: f64) {
        if self.can_skip() {
            self.sent = early;
        }
        for byte in bytes {
            let bits = (0..8).map(|bit| byte >> bit & 1 != 0);
            self.sending.extend(std::iter::once(false).chain(bits).chain([true]));
        }
    }

    /// Whether everything has been sent.
    pub fn can_skip(&self) -> bool {
        self.sending.is_empty()
    }

    /// The line to the board.
    pub fn line(&self) -> i64 {
        self.sending.front().is_none_or(|&bit| bit).into()
    }

    /// One clock, with the line from the board.
    pub fn clock(&mut self, tx: i64) {
        self.sent += 1.0;
        if self.sent >= self.bit {
            self.sent -= self.bit;
            self.sending.pop_front();
        }
        let Some((left, bits)) = &mut self.hearing else {
            self.hearing = (tx == 0).then(|| (1.5 * self.bit, Vec::new()));
            return;
        };
        *left -= 1.0;
        if *left < 1.0 {
            *left += self.bit;
            bits.push(tx != 0);
            if bits.len() == 9 {
                let byte = bits[..8].iter().rev().fold(0, |byte, &bit| byte << 1 | u8::from(bit));
                self.heard.push(if bits[8] { byte } else { 0 });
                self.hearing = None;
            }
        }
    }
}
