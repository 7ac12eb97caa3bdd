// SPDX-License-Identifier: MIT OR Apache-2.0
//! The board: the core and everything between it and the pins.
//!
//! ```text
//! ADC ═ adc_reader ─[codes: two sets]─ core ─ stream ─ tx
//!           └ strobe ───────────────────┘ ├── sigma_delta ─ carrier
//! rx ─ receiver ─ registers ─ calibration ┘ └ pads ─ select
//! ```
//!
//! Ports are pins; what they need of a device (the clock pulses of SCLK, the reset) is the top's. Codes are numbered as the
//! ADC's channels: the terminals, the sensing voltage, the haptic voltage. Until a host enables it, the board converts
//! nothing, no pad is driven, and the stream tells heartbeats; enabling it begins the first pad's slot. Disabling abandons the
//! slot under way; a frame that the core is already computing is still told.
//! Latency: that of the reader, the core and the stream, one after the other.

use super::adc_reader::{self, AdcReader};
use super::pads::{self, Pads};
use super::parameters::{Parameters, ParametersError};
use super::registers::{self, CommandRegisters};
use super::sigma_delta::{self, SigmaDelta};
use super::stream::{self, Stream};
use super::uart::receiver::{self, Receiver};
use hapticore_model::block::{Block, Cell};
use hapticore_model::blocks::core::{self, Core};
use hapticore_model::format::{BIT, Format};
use hapticore_model::memory::{Memory, Write};
use hapticore_model::profile::Profile;
use hapticore_model::signal::{Signal, Value};
use hapticore_model::{bundle, parts};

bundle! {
    /// The inputs: pins.
    pub struct Inputs {
        /// The ADC's data lines, a bit each.
        dout,
        /// The ADC converts.
        busy,
        /// Serial line in.
        rx,
    }
}

bundle! {
    /// The outputs: pins.
    pub struct Outputs {
        /// The ADC samples.
        convst,
        /// The ADC is read.
        cs_n,
        /// SCLK has a pulse in this clock.
        sclk_run,
        /// To the ADC's registers.
        sdi,
        /// The carrier, one bit a clock.
        carrier,
        /// The switches of the pads, a bit each.
        select,
        /// Serial line out.
        tx,
        /// For a lamp: the board is enabled.
        enabled,
        /// For a lamp: the ADC has been late since the board was enabled.
        late,
        /// The ADC's reset.
        adc_reset,
    }
}

bundle! {
    /// The registers.
    pub struct Registers {
        shift, late,
    }
}

parts! {
    /// The blocks and the memory within.
    pub struct Parts of Board {
        receiver: Receiver,
        registers: CommandRegisters,
        adc_reader: AdcReader,
        codes: Memory,
        core: Core,
        sigma_delta: SigmaDelta,
        pads: Pads,
        stream: Stream,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct Board {
    receiver: Receiver,
    registers: CommandRegisters,
    adc_reader: AdcReader,
    codes: Memory,
    core: Core,
    sigma_delta: SigmaDelta,
    pads: Pads,
    stream: Stream,
}

impl Board {
    /// The board of a profile.
    ///
    /// # Errors
    /// Where a number of the board is out of its range, or cannot serve the profile.
    pub fn new(profile: &Profile, parameters: &Parameters) -> Result<Self, ParametersError> {
        parameters.check(profile)?;
        let core = Core::new(profile);
        let reader = AdcReader::new(profile, parameters);
        let words = core.estimator().position().table().words as u64;
        let registers = CommandRegisters::new(core.inputs(), words);
        let sets = 1usize << reader.outputs().address.width;
        Ok(Board {
            receiver: Receiver::new(parameters.divisor()),
            stream: Stream::new(profile, parameters.divisor(), registers.outputs().data),
            registers,
            adc_reader: reader,
            codes: Memory::new("codes", sets, profile.formats.adc).never_colliding(),
            sigma_delta: SigmaDelta::new(core.outputs().carrier),
            pads: Pads::new(profile.pads, parameters.dead()),
            core,
        })
    }

    /// The core.
    pub fn core(&self) -> &Core {
        &self.core
    }

    /// The reader of the ADC.
    pub fn adc_reader(&self) -> &AdcReader {
        &self.adc_reader
    }
}

/// The core's inputs: what has been calibrated, and a set of codes.
#[inline(always)]
fn core_inputs<V: Value>(
    registers: &registers::Outputs<Signal<V>>,
    strobe: Signal<V>,
    code: Signal<V>,
) -> core::Inputs<Signal<V>> {
    core::Inputs {
        strobe,
        clear: !registers.enable,
        code,
        capacitance_gain: registers.capacitance_gain,
        force_gain: registers.force_gain,
        write: registers.write,
        address: registers.address,
        word: registers.word,
    }
}

impl Block for Board {
    const NAME: &'static str = "board";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    fn inputs(&self) -> Inputs<Format> {
        Inputs { dout: self.adc_reader.inputs().dout, busy: BIT, rx: BIT }
    }

    fn outputs(&self) -> Outputs<Format> {
        Outputs {
            convst: BIT,
            cs_n: BIT,
            sclk_run: BIT,
            sdi: BIT,
            carrier: BIT,
            select: self.pads.outputs().select,
            tx: BIT,
            enabled: BIT,
            late: BIT,
            adc_reset: BIT,
        }
    }

    fn registers(&self) -> Registers<Format> {
        Registers { shift: BIT, late: BIT }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let parts = &mut cell.parts;
        let bytes = self.receiver.call("receiver", &mut parts.receiver, receiver::Inputs { rx: i.rx });
        let answer = i.dout.bits(0, 1);
        let inputs = registers::Inputs { valid: bytes.valid, octet: bytes.octet, shift: r.shift, answer };
        let registers = self.registers.call("registers", &mut parts.registers, inputs);
        let inputs =
            adc_reader::Inputs { enable: registers.enable, busy: i.busy, dout: i.dout, write: registers.adc_write };
        let adc = self.adc_reader.call("adc_reader", &mut parts.adc_reader, inputs);
        // The reader cannot ask the registers in the same clock that it is told by them.
        let shift = adc.shift;
        let inputs = core_inputs(&registers, adc.strobe, self.codes.data(&mut parts.codes));
        let core = self.core.call("core", &mut parts.core, inputs);
        let write = Write { enable: adc.store, address: adc.address, data: adc.code };
        self.codes.access(&mut parts.codes, adc.bank.concat(core.channel), write);
        let inputs = sigma_delta::Inputs { carrier: core.carrier };
        let carrier = self.sigma_delta.call("sigma_delta", &mut parts.sigma_delta, inputs);
        let inputs = pads::Inputs { serve: core.serve, closed: core.closed & registers.enable };
        let pads = self.pads.call("pads", &mut parts.pads, inputs);
        let inputs = stream::Inputs {
            valid: core.valid,
            index: core.index,
            frame: core.frame,
            done: core.done,
            pad: core.pad,
            clipped: core.clipped,
            saturated: core.saturated,
            invalid: core.invalid,
            lost: core.lost,
            late: adc.late,
            refused: registers.refused,
            commands: registers.commands,
            enable: registers.enable,
            keep: registers.written | (r.shift & !shift),
            place: registers.place,
            data: registers.data,
            calibrated: registers.calibrated,
        };
        let stream = self.stream.call("stream", &mut parts.stream, inputs);
        cell.store(self, Registers { shift, late: registers.enable & (r.late | adc.late) });
        Outputs {
            convst: adc.convst,
            cs_n: adc.cs_n,
            sclk_run: adc.sclk_run,
            sdi: registers.sdi & shift,
            carrier: carrier.pulse,
            select: pads.select,
            tx: stream.tx,
            enabled: registers.enable,
            late: r.late,
            adc_reset: registers.adc_reset,
        }
    }
}
