// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registers: commands in, over the serial line: calibration, the position table's words, the ADC's
//! registers, on and off.
//!
//! ```text
//! bytes ─(links to zeros)─┬─[place, data: as they come]─┬─ registers
//!                         └─[CRC]── right at END? ──────┴─ a word of the position table, or of the ADC
//! ```
//!
//! | signal   | format                   | overflow                                           |
//! | place    | u16                      | shifted out by bytes too many: refused             |
//! | data     | D bytes                  | as above                                           |
//! | count    | counter D + 8            | held at its end, which no command reaches          |
//! | left     | counter D + 7            | bytes to the next link; a link beyond it: refused  |
//! | commands | u4                       | wraps, meant                                       |
//!
//! Nothing is written before a command's END has come with the right length, links and CRC; all else is
//! refused, says so for a clock, and changes nothing. So is a command for the ADC while the board
//! is enabled, or tests a line. The data of a command for the ADC leave at one end of their register while the ADC's
//! answer comes in at the other. Latency: two clocks from the byte END. Source: [`super::framing`].

use super::bits::{next, previous, read_as};
use super::crc32;
use super::framing::{CRC_BYTES, Control, END, NIBBLE, PLACE, Register, command_bytes, data_bytes};
use super::uart::BYTE;
use crate::codes::word_formats;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{Signal, Wrap, bit, code, int};
use hapticore_hdl::{block, when};
use hapticore_model::blocks::estimator::Calibration;
use hapticore_model::blocks::position::TablePort;
use hapticore_protocol::{Constant, WordFormats, drive};

block! {
    /// The registers that commands write.
    pub struct CommandRegisters("registers") {
        calibration: Calibration<Format>,
        words: u64,
        /// There is a drive.
        drives: bool,
        data: Format,
        /// Bytes of a command on the line before its END.
        length: u64,
    }
    submodules {}
    inputs(block) {
        /// Asserted for one cycle with each byte.
        valid: BIT,
        /// Received byte.
        octet: BYTE,
        /// Shifts the command's data by one bit.
        shift: BIT,
        /// The bit that is shifted in behind them.
        answer: BIT,
    }
    outputs(block) {
        /// Calibration register: gain of the capacitance.
        capacitance_gain: block.calibration.capacitance_gain,
        /// Calibration register: gain of the force.
        force_gain: block.calibration.force_gain,
        /// Calibration register: capacitance at or below which a pad is lifted.
        contact_capacitance: block.calibration.contact_capacitance,
        /// The board converts and measures.
        enable: BIT,
        /// The ADC is in reset.
        adc_reset: BIT,
        table as TablePort: block.calibration.table,
        /// Asserted for one cycle to write a register of the ADC.
        adc_write: BIT,
        /// The word for it, bit by bit.
        sdi: BIT,
        /// Commands accepted so far, modulo 16.
        commands: NIBBLE,
        /// Asserted for one cycle when a command is refused.
        refused: BIT,
        /// Asserted for one cycle when a register other than the control register has been written.
        written: BIT,
        /// Asserted for one cycle when the control register is being written.
        controlled: BIT,
        /// The ADC converts for a test of a line.
        line_test: BIT,
        /// Line of the test.
        line: Format::unsigned(LINE_BITS, 0),
        /// Number of the register that the last command addressed.
        place: PLACE,
        /// Data of the last command, or the ADC's answer.
        data: block.data,
        /// The last calibration register was written since reset.
        calibrated: BIT,
        /// Asserted for one cycle to write a word of the drive.
        drive_write: BIT.where_present(block.drives),
        /// Place of the word.
        drive_place: drive::PLACE.where_present(block.drives),
    }
    registers(block) {
        count: Format::counter(block.length + 1),
        left: Format::counter(block.length),
        crc: crc32::CRC,
        place: Format::unsigned(16, 0),
        data: block.data,
        act: BIT,
        refused: BIT,
        commands: NIBBLE,
        capacitance_gain: block.calibration.capacitance_gain,
        force_gain: block.calibration.force_gain,
        contact_capacitance: block.calibration.contact_capacitance,
        control: Control::FORMAT,
        calibrated: BIT,
    }
}

/// Bits of the number of a line of the ADC.
pub const LINE_BITS: u8 = 3;

/// Bits of a register of the ADC.
const ADC_WORD: u8 = 16;

impl CommandRegisters {
    /// The registers of a core with this calibration and a position table of `words` words; of a drive whose widest
    /// word has `drive_bits` bits, where there is one.
    pub fn new(calibration: Calibration<Format>, words: u64, drive_bits: Option<u8>) -> Self {
        let formats =
            WordFormats { drive_bits: drive_bits.unwrap_or(0), ..word_formats(&calibration) };
        CommandRegisters {
            calibration,
            words,
            drives: drive_bits.is_some(),
            data: Format::unsigned(8 * data_bytes(&formats) as u8, 0),
            length: command_bytes(&formats) - 1,
        }
    }

    /// A byte that is no END: part of a command, or a link, which stands for a zero byte unless it is
    /// the first.
    #[inline(always)]
    fn part<V: Interpretation>(&self, r: Regs<V>, byte: Signal<V>) -> Regs<V> {
        let (first, link) = (r.count.is(0), r.left.is(0));
        let full = r.count.is(self.length + 1);
        let (low, high) = (r.left.format.width, 8 - r.left.format.width);
        let beyond = link & !byte.bits(low, high).is(0);
        let left = link.select(byte.bits(0, low), r.left);
        let byte = link.select(code(0, BYTE), byte);
        // The first moves on, too: it is gone when the data have come.
        let payload = r.count.less_than(int(self.length - CRC_BYTES));
        let shifted = r.place.concat(r.data).concat(byte);
        Registers {
            count: beyond
                .select(int(self.length + 1), full.select(r.count, next(r.count)))
                .resize(r.count.format, Wrap),
            left: previous(left),
            crc: first.select(crc32::begin(), crc32::with(r.crc, byte)),
            place: payload.select(shifted.bits(self.data.width, 16), r.place),
            data: payload.select(shifted.bits(0, self.data.width), r.data),
            ..r
        }
    }

    /// END: the command counts, or it does not.
    #[inline(always)]
    fn end<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let converts = r.control.bits(Control::ENABLE, 1) | r.control.bits(Control::LINE_TEST, 1);
        let forbidden = self.is(&r, Register::Adc) & converts;
        let whole = r.count.is(self.length) & r.left.is(0) & r.crc.is(crc32::RESIDUE);
        let good = whole & !forbidden;
        // END twice is nothing, not a command: a sender may clear the line with it.
        let nothing = r.count.is(0);
        let commands = good.select(next(r.commands), r.commands);
        let refused = !(good | nothing);
        Registers { act: good, refused, commands, count: int(0), left: int(0), ..r }
    }

    /// The registers that a command writes.
    #[inline(always)]
    fn written<V: Interpretation>(&self, r: Regs<V>) -> Regs<V> {
        let write = |register: Register, before: Signal<V>| {
            let here = r.act & self.is(&r, register);
            here.select(read_as(r.data, before.format), before)
        };
        Registers {
            capacitance_gain: write(
                Register::Constant(Constant::CapacitanceGain),
                r.capacitance_gain,
            ),
            force_gain: write(Register::Constant(Constant::ForceGain), r.force_gain),
            contact_capacitance: write(
                Register::Constant(Constant::ContactCapacitance),
                r.contact_capacitance,
            ),
            control: write(Register::Control, r.control),
            calibrated: r.calibrated | (r.act & self.is(&r, Register::LAST_CONSTANT)),
            ..r
        }
    }

    /// Whether the place is this register.
    #[inline(always)]
    fn is<V: Interpretation>(&self, r: &Regs<V>, register: Register) -> Signal<V> {
        r.place.msb() & r.place.bits(0, PLACE.width).is(register.number() as u64)
    }
}

impl Block for CommandRegisters {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let table = self.calibration.table;
        let data = i.shift.select(r.data.concat(i.answer).bits(0, self.data.width), r.data);
        let quiet = Registers { act: bit(false), refused: bit(false), data, ..self.written(r) };
        // A model takes the CRC of a byte in the clock in which there is one, and in no other.
        let next = when!(
            i.valid => when!(i.octet.is(END.into()) => self.end(quiet), else self.part(quiet, i.octet)),
            else quiet,
        );
        state.store(self, next);
        let address = r.place.bits(0, table.address.width);
        let of_table = !r.place.msb() & address.less_than(int(self.words));
        let of_drive = match self.drives {
            true => !r.place.msb() & r.place.bits(drive::PLACE.width, 1),
            false => bit(false),
        };
        let of_table = if self.drives { of_table & !of_drive } else { of_table };
        Outputs {
            capacitance_gain: r.capacitance_gain,
            force_gain: r.force_gain,
            contact_capacitance: r.contact_capacitance,
            enable: r.control.bits(Control::ENABLE, 1),
            adc_reset: r.control.bits(Control::ADC_RESET, 1),
            table: TablePort {
                write: r.act & of_table,
                address,
                word: read_as(r.data, table.word),
            },
            adc_write: r.act & self.is(&r, Register::Adc),
            sdi: r.data.bits(ADC_WORD - 1, 1),
            commands: r.commands,
            refused: r.refused,
            written: r.act & r.place.msb() & !self.is(&r, Register::Control),
            controlled: r.act & self.is(&r, Register::Control),
            line_test: r.control.bits(Control::LINE_TEST, 1) & !r.control.bits(Control::ENABLE, 1),
            line: r.control.bits(Control::LINE, LINE_BITS),
            place: r.place.bits(0, PLACE.width),
            data: r.data,
            calibrated: r.calibrated,
            drive_write: (r.act & of_drive).where_present(BIT.where_present(self.drives)),
            drive_place: r
                .place
                .bits(0, drive::PLACE.width)
                .where_present(drive::PLACE.where_present(self.drives)),
        }
    }
}
