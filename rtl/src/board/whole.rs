// SPDX-License-Identifier: MIT OR Apache-2.0
//! The board: the core and everything between it and the pins.
//!
//! ```text
//! ADC ═ adc_reader ─[codes: two sets]─ core ─ stream ─ tx
//!           └ strobe ───────────────────┘ ├── sigma_delta ─ carrier
//! rx ─ receiver ─ registers ─ calibration ┘ └ pads ─ select
//! ```
//!
//! Ports are pins; what they need of a device (the clock pulses of SCLK, the reset) is the top's.
//! Codes are numbered as the ADC's channels: the terminals, the sensing voltage, the haptic
//! voltage. Until a host enables it, the board converts nothing, no pad is driven, and the stream
//! tells heartbeats; enabling it begins the first pad's slot. Disabling abandons the slot under
//! way; a frame that the core is already computing is still told. Latency: that of the reader, the
//! core and the stream, one after the other.

use super::adc_reader::{self, AdcReader};
use super::pads::{self, Pads};
use super::parameters::{Parameters, ParametersError};
use super::registers::{self, CommandRegisters};
use super::sigma_delta::{self, SigmaDelta};
use super::stream::{self, Stream};
use super::uart::receiver::{self, Receiver};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::BIT;
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Clocked, Signal};
use hapticore_hdl::{block, call};
use hapticore_model::blocks::core::{self, Core};
use hapticore_model::blocks::estimator::Calibration;

block! {
    /// The board: the core with its converters, commands and packets.
    pub struct Board("board") {}
    submodules {
        receiver: Receiver,
        registers: CommandRegisters,
        adc_reader: AdcReader,
        codes: Memory,
        core: Core,
        sigma_delta: SigmaDelta,
        pads: Pads,
        stream: Stream,
    }
    inputs(board) {
        /// Pins: data lines of the ADC, one bit per channel.
        dout: board.adc_reader.inputs().dout,
        /// Pin: high while the ADC converts.
        busy: BIT,
        /// Pin: serial input.
        rx: BIT,
    }
    outputs(board) {
        /// Pin: its rising edge samples all channels.
        convst: BIT,
        /// Pin: chip select of the ADC, active low.
        cs_n: BIT,
        /// SCLK has a pulse in this cycle.
        sclk_run: BIT,
        /// Pin: serial data to the ADC's registers.
        sdi: BIT,
        /// The carrier, one bit per cycle.
        carrier: BIT,
        /// Pins: one bit per pad, high closes its switch.
        select: board.pads.outputs().select,
        /// Pin: serial output.
        tx: BIT,
        /// LED: the board is enabled.
        enabled: BIT,
        /// LED: the ADC was late since the board was enabled.
        late: BIT,
        /// Pin: reset of the ADC, active high.
        adc_reset: BIT,
    }
    registers(board) {
        shift: BIT,
        late: BIT,
    }
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
        let words = core.estimator().table().words as u64;
        let registers = CommandRegisters::new(core.inputs().calibration, words);
        let sets = 1usize << reader.outputs().address.width;
        Ok(Board {
            receiver: Receiver::new(parameters.divisor()),
            stream: Stream::new(profile, parameters.divisor(), registers.outputs().data),
            registers,
            adc_reader: reader,
            codes: Memory::new("codes", sets, profile.formats.adc).dont_care_on_collision(),
            sigma_delta: SigmaDelta::new(core.outputs().carrier),
            pads: Pads::new(profile.pads, parameters.dead()),
            core,
        })
    }

    /// The core's configuration.
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
fn core_inputs<V: Interpretation>(
    registers: &registers::Out<V>,
    strobe: Signal<V>,
    code: Signal<V>,
) -> core::In<V> {
    let registers::Outputs { capacitance_gain, force_gain, table, .. } = *registers;
    let calibration = Calibration { capacitance_gain, force_gain, table };
    core::Inputs { strobe, clear: !registers.enable, code, calibration }
}

impl Block for Board {
    #[inline(never)]
    fn step(&self, state: &mut State<Self, Clocked>, i: In<Clocked>) -> Out<Clocked> {
        self.clock(state, i)
    }

    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let bytes = call!(self.receiver, state, receiver::Inputs { rx: i.rx });
        let answer = i.dout.bits(0, 1);
        let inputs =
            registers::Inputs { valid: bytes.valid, octet: bytes.octet, shift: r.shift, answer };
        let registers = call!(self.registers, state, inputs);
        let inputs = adc_reader::Inputs {
            enable: registers.enable,
            busy: i.busy,
            dout: i.dout,
            write: registers.adc_write,
        };
        let adc = call!(self.adc_reader, state, inputs);
        // The reader cannot ask the registers in the same clock that it is told by them.
        let shift = adc.shift;
        let inputs =
            core_inputs(&registers, adc.strobe, self.codes.data(&mut state.submodules.codes));
        let core = call!(self.core, state, inputs);
        let write = Write { enable: adc.store, address: adc.address, data: adc.code };
        self.codes.access(&mut state.submodules.codes, adc.bank.concat(core.channel), write);
        let inputs = sigma_delta::Inputs { carrier: core.carrier };
        let carrier = call!(self.sigma_delta, state, inputs);
        let inputs = pads::Inputs { serve: core.serve, closed: core.closed & registers.enable };
        let pads = call!(self.pads, state, inputs);
        let inputs = stream::Inputs {
            frames: core.frames,
            late: adc.late,
            refused: registers.refused,
            commands: registers.commands,
            enable: registers.enable,
            keep: registers.written | (r.shift & !shift),
            place: registers.place,
            data: registers.data,
            calibrated: registers.calibrated,
        };
        let stream = call!(self.stream, state, inputs);
        state.store(self, Registers { shift, late: registers.enable & (r.late | adc.late) });
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
