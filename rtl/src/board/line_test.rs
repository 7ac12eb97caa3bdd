// SPDX-License-Identifier: MIT OR Apache-2.0
//! Line test: whether a data line of the ADC brings the same code each time.
//!
//! ```text
//! codes of the line ─[first two ignored]─[first]─(=?)─ after 64: the code, or zero
//! ```
//!
//! A command before the test has the ADC put out a fixed code per channel (its interface check). The host judges the
//! code: neither all zeros nor all ones, as an open or shorted line has, and no other line's.
//!
//! | signal | format    | overflow                       |
//! | count  | counter 67 | held at its end, by compare   |
//! | result | the ADC's | –                              |
//!
//! Latency: 67 samples from the beginning of a test to its result. Source: AD7606C-16 and -18 data sheets, register 21 (hex),
//! bit 7; <https://ez.analog.com/data_converters/precision_adcs/f/q-a/575145>: the first code behind a write may be zero.

use super::bits::next;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{bit, int, zero};
use hapticore_hdl::{block, when};

/// Codes that are ignored at the beginning of a test.
const IGNORED: u64 = 2;
/// Codes that are compared.
const COMPARED: u64 = 64;
/// The count of a test that is over.
const OVER: u64 = IGNORED + COMPARED + 1;

block! {
    /// The test of a line.
    pub struct LineTest("line_test") {
        channel: Format,
        code: Format,
    }
    submodules {}
    inputs(block) {
        /// Asserted for one cycle before a test may begin: the control register is written.
        start: BIT,
        /// There is a test.
        enable: BIT,
        /// Its line.
        line: block.channel,
        /// Asserted for each code.
        store: BIT,
        /// Channel of the code.
        channel: block.channel,
        /// The code.
        code: block.code,
        /// Asserted for one cycle when the ADC was late.
        late: BIT,
    }
    outputs(block) {
        /// Asserted for one cycle when the result changes.
        changed: BIT,
        /// The code of the line, the same each time; zero before there is one.
        result: block.code,
    }
    registers(block) {
        began: BIT,
        count: Format::counter(OVER),
        first: block.code,
        differs: BIT,
        result: block.code,
        changed: BIT,
    }
}

impl LineTest {
    /// The test of lines with these codes.
    pub fn new(channel: Format, code: Format) -> Self {
        LineTest { channel, code }
    }
}

impl Block for LineTest {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let takes = i.enable & i.store & i.channel.equals(i.line) & !r.count.is(OVER);
        let (is_first, is_last) = (r.count.is(IGNORED), r.count.is(OVER - 1));
        let compares = takes & !r.count.less_than(int(IGNORED + 1));
        let differs = r.differs | (compares & !i.code.equals(r.first)) | (i.enable & i.late);
        let ends = takes & is_last;
        let judged = differs.select(zero(self.code), r.first);
        let running = Registers {
            began: i.start,
            count: takes.select(next(r.count), r.count),
            first: (takes & is_first).select(i.code, r.first),
            differs,
            result: ends.select(judged, r.result),
            changed: ends,
        };
        let begun = Registers {
            count: int(0),
            differs: bit(false),
            result: zero(self.code),
            changed: bit(true),
            ..running
        };
        state.store(self, when!(r.began & i.enable => begun, else running));
        Outputs { changed: r.changed, result: r.result }
    }
}
