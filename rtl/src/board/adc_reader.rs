// SPDX-License-Identifier: MIT OR Apache-2.0
//! ADC reader: eight channels, sampled together, each on a data line of its own, at the core's
//! clock.
//!
//! For an AD7606C-16 or -18 in its serial software mode with eight DOUT lines. C clocks are a
//! conversion's, W the word's bits, P a sample's; a set is read while the next one is being
//! converted.
//!
//! ```text
//! clock   0        C     C+1  C+2        C+W  C+W+1       then, in the core:
//! CONVST  ┐‾‾‾‾‾…
//! BUSY     ┌‾‾‾‾‾┐____________________________             checked at C's end: high is `late`, and so is never having risen
//! CS      ‾‾‾‾‾‾‾‾┐_______________________┌‾‾‾
//! SCLK    ‾‾‾‾‾‾‾‾‾‾‾┐_┌‾┐_┌‾ … ┐_┌‾‾‾‾‾‾‾‾‾‾             high, then low, within each of W clocks
//! DOUTx            ⟨W−1⟩⟨W−2⟩ … ⟨ 0 ⟩                      captured at the end of each of these clocks
//! store                         C+W … C+W+7                one word per clock, channel 0 first; `strobe` follows
//! ```
//!
//! The ADC puts out the first bit at CS, each other one after a *rising* edge of SCLK, and holds it
//! until the next. Rising edges leave the FPGA with the edge of the core's clock that also captures
//! the bit before. So a bit has a whole clock less the output's delay, the ADC's access time and
//! the input's set-up (40 ns less about 5 + 15 + 2 ns at 25 MHz). The hold is the output's delay
//! and more. Falling edges, half a clock away, move nothing; SDI, which the ADC latches with them,
//! changes with the core's clock and so has half a clock on either side.
//!
//! A word for a register of the ADC (16 bits over SDI) is sent while nothing is enabled. It lies
//! with the command that brought it, and `shift` moves that on; the ADC's answer on its first data
//! line comes in behind it. While `shift` is low, SDI is.
//!
//! Once it is no longer enabled, the reader starts no conversion, but reads the set of one that it
//! has started, without a strobe: CS and SCLK end as they always do.
//!
//! | signal     | format     | overflow                  |
//! | phase      | counter P  | wraps at P, by compare    |
//! | line_a … h | u W−1      | shifted out, meant        |
//!
//! Words go to a memory that the board owns (two sets: one is stored while the core reads the
//! other). Latency: C + W + 8 clocks from CONVST to `strobe`. Nothing waits for the ADC, so nothing
//! can hang. Source: data sheets of the AD7606 family, serial interface ("MSB at CS, the others at
//! the rising edges of SCLK") and register map. [`Parameters`] holds the times that the schedule
//! asks of the ADC.

use super::bits::{flag, next, read_as, word};
use super::parameters::Parameters;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{bit, int, zero};
use hapticore_hdl::{block, when};

block! {
    /// The reader of an ADC.
    pub struct AdcReader("adc_reader") {
        /// Cycles per sample.
        period: u64,
        /// Cycles of a conversion.
        conversion: u64,
        /// Cycles by which the pin of SCLK follows.
        latency: u64,
        channels: u64,
        code: Format,
    }
    submodules {}
    inputs(reader) {
        /// Starts a conversion and a read every period while asserted.
        enable: BIT,
        /// Pin: high while the ADC converts.
        busy: BIT,
        /// Pins: one data line per channel, the first channel the least significant bit.
        dout: Format::unsigned(reader.channels as u8, 0),
        /// Writes a register of the ADC, 16 bits over SDI; accepted while nothing is enabled.
        write: BIT,
    }
    outputs(reader) {
        /// Pin: its rising edge samples all channels.
        convst: BIT,
        /// Pin: chip select, low during a read.
        cs_n: BIT,
        /// SCLK has a pulse in this cycle; the pin follows by the latency of its primitive.
        sclk_run: BIT,
        /// The word for a register of the ADC moves on by a bit, one cycle later.
        shift: BIT,
        /// Asserted for each word of a set.
        store: BIT,
        /// Address of the stored word: bank, then channel.
        address: Format::unsigned(reader.index().width + 1, 0),
        /// Stored word: the code of a channel.
        code: reader.code,
        /// Bank of the complete set.
        bank: BIT,
        /// Asserted for one cycle when it is.
        strobe: BIT,
        /// With `strobe`: the ADC was not done in time, and the codes are invalid.
        late: BIT,
    }
    registers(reader) {
        phase: Format::counter(reader.period - 1),
        active: BIT,
        convst: BIT,
        selected: BIT,
        run: BIT,
        capture: BIT,
        unload: BIT,
        index: reader.index(),
        filling: BIT,
        strobe: BIT,
        busy_pin: BIT,
        busy: BIT,
        began: BIT,
        late: BIT,
        configuring: BIT,
        tail: reader.tail(),
        line_a: reader.line(),
        line_b: reader.line(),
        line_c: reader.line(),
        line_d: reader.line(),
        line_e: reader.line(),
        line_f: reader.line(),
        line_g: reader.line(),
        line_h: reader.line(),
    }
}

/// Bits of a register access.
const COMMAND_BITS: u64 = 16;

impl AdcReader {
    /// The reader of a profile's ADC on a board.
    pub fn new(profile: &Profile, parameters: &Parameters) -> Self {
        AdcReader {
            period: profile.clocks_per_sample,
            conversion: parameters.conversion(),
            latency: parameters.sclk_latency,
            channels: profile.channels() as u64,
            code: profile.formats.adc,
        }
    }

    /// Clocks from CONVST to the strobe of its set.
    pub fn latency(&self) -> u64 {
        self.conversion + self.bits() + self.channels
    }

    fn bits(&self) -> u64 {
        u64::from(self.code.width)
    }

    /// One clock of the schedule. What is set while `phase` is t is there from clock t of the chart
    /// on.
    #[inline(always)]
    fn step<V: Interpretation>(&self, r: Regs<V>, i: &In<V>) -> Regs<V> {
        let at = |clock: u64| r.phase.is(clock % self.period);
        let (cs, first) = (self.conversion, self.conversion + 1);
        let pulses = first - self.latency;
        let over = |from: u64| at(from + self.bits()) | (r.configuring & at(from + COMMAND_BITS));
        let (stored, done) = (r.unload & r.index.is(self.channels - 1), r.selected & over(first));
        let turn = at(self.period - 1) | (r.configuring & done);
        let reads = r.active | r.configuring;
        let converts = at(0) & i.enable & !r.configuring;
        Registers {
            phase: turn.select(int(0), next(r.phase)),
            active: flag(r.active, converts, at(first)),
            convst: flag(r.convst, converts, at(self.period / 2)),
            selected: flag(r.selected, at(cs) & reads, done),
            run: flag(r.run, at(pulses) & reads, over(pulses)),
            capture: flag(r.capture, at(first), at(first + self.bits() - 1)),
            unload: flag(
                r.unload,
                r.capture & at(first + self.bits() - 1) & !r.configuring,
                stored,
            ),
            index: r.unload.select(stored.select(int(0), next(r.index)), int(0)),
            filling: stored.select(!r.filling, r.filling),
            strobe: stored & i.enable,
            // BUSY has risen in clock 0 or 1, and passes two registers: so does its fall, which is
            // due by the end of clock C.
            began: at(4).select(r.busy, r.began),
            late: at(cs + 3).select(r.busy | !r.began, r.late),
            configuring: r.configuring & !done,
            ..self.lines(r, i)
        }
    }

    /// The data lines' words: shifted in bit by bit, then along from channel to channel. The last
    /// bits come straight from the pins, so that storing begins a clock earlier than the words are
    /// complete.
    #[inline(always)]
    fn lines<V: Interpretation>(&self, r: Regs<V>, i: &In<V>) -> Regs<V> {
        let lines =
            [r.line_a, r.line_b, r.line_c, r.line_d, r.line_e, r.line_f, r.line_g, r.line_h];
        let line = |k: usize| {
            if k as u64 >= self.channels {
                return zero(self.line());
            }
            let shifted = lines[k].concat(i.dout.bits(k as u8, 1)).bits(0, self.line().width);
            if k as u64 + 1 == self.channels {
                shifted
            } else {
                r.unload.select(lines[k + 1], shifted)
            }
        };
        let tail = r.index.is(0).select(i.dout, bit(false).concat(r.tail));
        Registers {
            tail: tail.bits(1, self.tail().width),
            line_a: line(0),
            line_b: line(1),
            line_c: line(2),
            line_d: line(3),
            line_e: line(4),
            line_f: line(5),
            line_g: line(6),
            line_h: line(7),
            ..r
        }
    }

    /// Nothing enabled: a register of the ADC may be written.
    #[inline(always)]
    fn rest<V: Interpretation>(&self, r: Regs<V>, i: &In<V>) -> Regs<V> {
        let no = bit(false);
        Registers {
            phase: int(0),
            active: no,
            convst: no,
            selected: no,
            run: no,
            capture: no,
            unload: no,
            index: int(0),
            strobe: no,
            began: no,
            late: no,
            configuring: i.write,
            ..r
        }
    }

    /// All bits of a word but the last.
    fn line(&self) -> Format {
        Format::unsigned(self.code.width - 1, 0)
    }

    /// The last bits of all channels but the first.
    fn tail(&self) -> Format {
        Format::unsigned(self.channels as u8 - 1, 0)
    }

    /// The format of a channel's number.
    pub fn index(&self) -> Format {
        Format::counter(self.channels - 1)
    }
}

impl Block for AdcReader {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let running = i.enable | r.active | r.selected | r.unload | r.configuring;
        let next = when!(running => self.step(r, &i), else self.rest(r, &i));
        state.store(self, Registers { busy_pin: i.busy, busy: r.busy_pin, ..next });
        let last_bit = r.index.is(0).select(i.dout.bits(0, 1), r.tail.bits(0, 1));
        Outputs {
            convst: r.convst,
            cs_n: !r.selected,
            sclk_run: r.run,
            shift: r.selected & r.configuring,
            store: r.unload,
            address: word([r.index, r.filling]),
            code: read_as(r.line_a.concat(last_bit), self.code),
            bank: !r.filling,
            strobe: r.strobe,
            late: r.strobe & r.late,
        }
    }
}
