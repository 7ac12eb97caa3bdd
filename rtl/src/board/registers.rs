// SPDX-License-Identifier: MIT OR Apache-2.0
//! Registers: commands in, over the serial line: calibration, the position table's words, the ADC's registers, on and off.
//!
//! ```text
//! bytes ─(unescape)─┬─[place, data: as they come]─┬─ registers
//!                   └─[CRC]── zero at END? ───────┴─ a word of the position table, or of the ADC
//! ```
//!
//! | signal   | format                   | overflow                                  |
//! | place    | u16                      | shifted out by bytes too many: refused    |
//! | data     | D bytes                  | as above                                  |
//! | count    | counter D + 5            | held at its end, which no command reaches |
//! | commands | u4                       | wraps, meant                              |
//!
//! Nothing is written before a command's END has come with the right length and CRC; all else is refused, says so for a clock,
//! and changes nothing. So is a command for the ADC while the board is enabled. The data of a command for the ADC leave at
//! one end of their register while the ADC's answer comes in at the other. Latency: two clocks from the byte END. Source:
//! [`super::framing`].

use super::bits::{next, read_as};
use super::crc16;
use super::framing::{Control, END, ESC, ESC_END, ESC_ESC, NIBBLE, PLACE, Register, data_bytes};
use super::uart::BYTE;
use hapticore_model::block::{Block, Cell};
use hapticore_model::blocks::core;
use hapticore_model::format::{BIT, Format};
use hapticore_model::signal::{Exact, Signal, Value, Wrap, bit, code, int};
use hapticore_model::{bundle, when};
use hapticore_protocol::Constant;

bundle! {
    /// The inputs.
    pub struct Inputs {
        /// A byte is there.
        valid,
        /// The byte.
        octet,
        /// A command's data move on by a bit.
        shift,
        /// The bit that comes in behind them.
        answer,
    }
}

bundle! {
    /// The outputs.
    pub struct Outputs {
        /// The register of the same name.
        capacitance_gain,
        /// The register of the same name.
        force_gain,
        /// Whether the board converts and measures.
        enable,
        /// Whether the ADC is in reset.
        adc_reset,
        /// Writes a word of the position table.
        write,
        /// Where.
        address,
        /// What.
        word,
        /// Writes a register of the ADC.
        adc_write,
        /// What, bit by bit.
        sdi,
        /// Commands taken so far, modulo 16.
        commands,
        /// Set for a clock when a command is refused.
        refused,
        /// Set for a clock when a register other than the control register has been written.
        written,
        /// The number of the register that the last command named.
        place,
        /// Its data, or the ADC's answer.
        data,
        /// All calibration may be there: since reset its last register has been written.
        calibrated,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        escaped, count, crc, place, data, act, refused, commands,
        capacitance_gain, force_gain, control, calibrated,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct CommandRegisters {
    core: core::Inputs<Format>,
    words: u64,
    data: Format,
    /// Bytes of a command, CRC included.
    length: u64,
}

/// Bits of a register of the ADC.
const ADC_WORD: u8 = 16;
/// Bytes of a command's place and of its CRC.
const AROUND: u64 = 4;

impl CommandRegisters {
    /// The registers of a core with these inputs, whose position table has so many words.
    pub fn new(core: core::Inputs<Format>, words: u64) -> Self {
        let bytes = data_bytes(&core);
        CommandRegisters { core, words, data: Format::unsigned(8 * bytes as u8, 0), length: bytes + AROUND }
    }

    /// A byte that is no END: part of a command, or the escape before one.
    #[inline(always)]
    fn part<V: Value>(&self, r: Registers<Signal<V>>, byte: Signal<V>) -> Registers<Signal<V>> {
        let is = |value: u8| byte.is(value.into());
        let (escape, known) = (is(ESC) & !r.escaped, is(ESC_END) | is(ESC_ESC));
        let meant = is(ESC_END).select(code(END.into(), BYTE), code(ESC.into(), BYTE));
        let byte = r.escaped.select(meant, byte);
        let payload = r.count.less_than(int(self.length - 2));
        let full = r.count.is(self.length + 1);
        let bad = r.escaped & !known;
        let shifted = r.place.concat(r.data).concat(byte);
        let taken = Registers {
            escaped: bit(false),
            count: bad.select(int(self.length + 1), full.select(r.count, next(r.count))).fit(
                r.count.format,
                Exact,
                Wrap,
            ),
            crc: crc16::with(r.crc, byte),
            place: payload.select(shifted.bits(self.data.width, 16), r.place),
            data: payload.select(shifted.bits(0, self.data.width), r.data),
            ..r
        };
        let escaped = Registers { escaped: bit(true), ..r };
        when!(V, Registers, escape, escaped, taken)
    }

    /// END: the command counts, or it does not.
    #[inline(always)]
    fn end<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let forbidden = self.is(&r, Register::Adc) & r.control.bits(Control::ENABLE, 1);
        let good = r.count.is(self.length) & r.crc.is(0) & !r.escaped & !forbidden;
        // END twice is nothing, not a command: a sender may clear the line with it.
        let nothing = r.count.is(0) & !r.escaped;
        let commands = good.select(next(r.commands), r.commands);
        let refused = !(good | nothing);
        Registers { act: good, refused, commands, escaped: bit(false), count: int(0), ..r }
    }

    /// The registers that a command writes.
    #[inline(always)]
    fn written<V: Value>(&self, r: Registers<Signal<V>>) -> Registers<Signal<V>> {
        let write = |register: Register, before: Signal<V>| {
            let here = r.act & self.is(&r, register);
            here.select(read_as(r.data, before.format), before)
        };
        Registers {
            capacitance_gain: write(Register::Constant(Constant::CapacitanceGain), r.capacitance_gain),
            force_gain: write(Register::Constant(Constant::ForceGain), r.force_gain),
            control: write(Register::Control, r.control),
            calibrated: r.calibrated | (r.act & self.is(&r, Register::LAST_CONSTANT)),
            ..r
        }
    }

    /// Whether the place is this register.
    #[inline(always)]
    fn is<V: Value>(&self, r: &Registers<Signal<V>>, register: Register) -> Signal<V> {
        r.place.msb() & r.place.bits(0, PLACE.width).is(register.number() as u64)
    }
}

impl Block for CommandRegisters {
    const NAME: &'static str = "registers";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = ();

    fn inputs(&self) -> Inputs<Format> {
        Inputs { valid: BIT, octet: BYTE, shift: BIT, answer: BIT }
    }

    fn outputs(&self) -> Outputs<Format> {
        let core::Inputs { capacitance_gain, force_gain, address, word, .. } = self.core;
        Outputs {
            capacitance_gain,
            force_gain,
            enable: BIT,
            adc_reset: BIT,
            write: BIT,
            address,
            word,
            adc_write: BIT,
            sdi: BIT,
            commands: NIBBLE,
            refused: BIT,
            written: BIT,
            place: PLACE,
            data: self.data,
            calibrated: BIT,
        }
    }

    fn registers(&self) -> Registers<Format> {
        let of = self.outputs();
        Registers {
            escaped: BIT,
            count: Format::counter(self.length + 1),
            crc: crc16::CRC,
            place: Format::unsigned(16, 0),
            data: self.data,
            act: BIT,
            refused: BIT,
            commands: NIBBLE,
            capacitance_gain: of.capacitance_gain,
            force_gain: of.force_gain,
            control: Control::FORMAT,
            calibrated: BIT,
        }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let of = self.outputs();
        // The CRC begins anew with a command's first octet: a register is zero at reset, a CRC is not at its beginning.
        let crc = r.count.is(0).select(crc16::begin(), r.crc);
        let data = i.shift.select(r.data.concat(i.answer).bits(0, self.data.width), r.data);
        let quiet = Registers { act: bit(false), refused: bit(false), data, ..self.written(r) };
        let fresh = Registers { crc, ..quiet };
        let got = when!(V, Registers, i.octet.is(END.into()), self.end(quiet), self.part(fresh, i.octet));
        let next = when!(V, Registers, i.valid, got, quiet);
        cell.store(self, next);
        let address = r.place.bits(0, of.address.width);
        let of_table = !r.place.msb() & address.less_than(int(self.words));
        Outputs {
            capacitance_gain: r.capacitance_gain,
            force_gain: r.force_gain,
            enable: r.control.bits(Control::ENABLE, 1),
            adc_reset: r.control.bits(Control::ADC_RESET, 1),
            write: r.act & of_table,
            address,
            word: read_as(r.data, of.word),
            adc_write: r.act & self.is(&r, Register::Adc),
            sdi: r.data.bits(ADC_WORD - 1, 1),
            commands: r.commands,
            refused: r.refused,
            written: r.act & r.place.msb() & !self.is(&r, Register::Control),
            place: r.place.bits(0, PLACE.width),
            data: r.data,
            calibrated: r.calibrated,
        }
    }
}
