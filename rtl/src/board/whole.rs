// SPDX-License-Identifier: MIT OR Apache-2.0
//! The board: the core and everything between it and the pins.
//!
//! ```text
//! ADC ═ adc_reader ─[codes: two sets]─ core ─ stream ─ tx
//!           └ strobe ───────────────────┘ ├── sigma_delta ─ carrier
//! rx ─ receiver ─ registers ─ calibration ┘ └ pads ─ select
//!           └ line_test ─ heartbeat
//!
//! with a drive, in place of the core:
//! rx ─ receiver ─ registers ─ drive_registers ─ force_loop ─ drive_output ─ converter of the pads' voltages
//! ```
//!
//! Ports are pins; what they need of a device (the clock pulses of SCLK, the reset) is the top's.
//! Codes are numbered as the ADC's channels: the terminals, the sensing voltage, the haptic
//! voltage. Until a host enables it, the board converts nothing, no pad is driven, and the stream
//! tells heartbeats; enabling it begins the first pad's slot. Disabling abandons the slot under
//! way; a frame that the core is already computing is still told. Latency: that of the reader, the
//! core and the stream, one after the other.

use super::adc_reader::{self, AdcReader};
use super::bits::{previous, word as bits_side_by_side};
use super::drive_output::{self, DacPort, DriveOutput};
use super::drive_registers::{self, DriveRegisters};
use super::framing::{NIBBLE, PLACE, Register};
use super::line_test::{self, LineTest};
use super::pads::{self, Pads};
use super::parameters::{Drive, Parameters, ParametersError};
use super::registers::{self, CommandRegisters};
use super::sigma_delta::{self, SigmaDelta};
use super::stream::{self, DrivenPort, Stream};
use super::uart::receiver::{self, Receiver};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Clocked, Proved, Signal, Wrap, bit, int, zero};
use hapticore_hdl::{block, call};
use hapticore_model::blocks::core::{self, Core};
use hapticore_model::blocks::estimator::Calibration;
use hapticore_model::blocks::force_loop::{self, ForceLoop};
use hapticore_protocol::drive::{status, widest};
use hapticore_protocol::register::LINES;

block! {
    /// The board: the core with its converters, commands and packets.
    pub struct Board("board") {
        /// Clocks of a millisecond.
        tick_clocks: u64,
    }
    submodules {
        receiver: Receiver,
        registers: CommandRegisters,
        adc_reader: AdcReader,
        codes: Memory,
        /// The core of a board without a drive, or its force loop.
        core: Option<Core>,
        force_loop: Option<ForceLoop>,
        drive_registers: Option<DriveRegisters>,
        drive_output: Option<DriveOutput>,
        line_test: LineTest,
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
        dac as DacPort: board.dac(),
    }
    registers(board) {
        shift: BIT,
        late: BIT,
        driven as DrivenPort: board.stream.inputs().driven,
        /// Clocks until the next tick of the time in which a silent host is missed.
        to_tick: board.to_tick(),
        /// The controller's drives begin from zero.
        stale: BIT.where_present(board.force_loop.is_some()),
        /// Frames until a terminal counts as connected again.
        open: board.open(),
    }
}

/// A board that cannot be.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// A number of the board is out of its range, or cannot serve the profile.
    #[error(transparent)]
    Parameters(#[from] ParametersError),
    /// A core, a force loop or a drive that cannot be.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A board without pins for a drive, or for this converter.
    #[error("{0} has no pins for such a drive: expected ulx3s, with ad5664, ad5664r or ad5668")]
    NoPins(&'static str),
    /// A board with fewer pins than the profile asks for.
    #[error("{port}: expected 1 to {most}, for {board} has no more pins for them; got {got}")]
    FewPins {
        /// The board's name.
        board: &'static str,
        /// The port.
        port: &'static str,
        /// Its pins.
        most: u64,
        /// Bits that the profile asks for.
        got: u64,
    },
}

impl Board {
    /// The board of a profile: with a controller, of a force loop and its drive.
    ///
    /// # Errors
    /// Where a number of the board is out of its range, or cannot serve the profile.
    pub fn new(profile: &Profile, parameters: &Parameters) -> Result<Self, BoardError> {
        parameters.check(profile)?;
        let force_loop = match profile.control {
            Some(_) => Some(ForceLoop::try_new(profile)?),
            None => None,
        };
        let core = match &force_loop {
            Some(force_loop) => force_loop.core.clone(),
            None => Core::try_new(profile)?,
        };
        let reader = AdcReader::new(profile, parameters);
        let words = core.estimator().table().words as u64;
        let drive_bits = force_loop.is_some().then(|| widest(profile));
        let registers = CommandRegisters::new(core.inputs().calibration, words, drive_bits);
        let data = registers.outputs().data;
        let drive_output = match parameters.drive {
            Some(Drive { wave, converter, .. }) => {
                Some(DriveOutput::of_profile(profile, wave, converter, parameters.clock_hz)?)
            }
            None => None,
        };
        let sets = 1usize << reader.outputs().address.width;
        Ok(Board {
            tick_clocks: parameters.clock_hz / 1000,
            receiver: Receiver::new(parameters.bits()),
            stream: Stream::new(profile, parameters.bits(), data, parameters.output().as_ref()),
            line_test: LineTest::new(registers.outputs().line, profile.formats.adc),
            registers,
            adc_reader: reader,
            codes: Memory::new("codes", sets, profile.formats.adc).dont_care_on_collision(),
            sigma_delta: SigmaDelta::new(core.outputs().carrier),
            pads: Pads::new(profile.pads, parameters.dead()),
            drive_registers: force_loop.as_ref().map(|of| DriveRegisters::new(of, data)),
            drive_output,
            core: force_loop.is_none().then_some(core),
            force_loop,
        })
    }

    fn to_tick(&self) -> Format {
        Format::counter(self.tick_clocks - 1).where_present(self.force_loop.is_some())
    }

    /// The core's configuration.
    pub fn core(&self) -> &Core {
        let of_loop = self.force_loop.as_ref().map(|force_loop| &force_loop.core);
        self.core.as_ref().or(of_loop).expect("a board has a core")
    }

    /// The force loop of a board that drives its pads.
    pub fn force_loop(&self) -> Option<&ForceLoop> {
        self.force_loop.as_ref()
    }

    /// A frame of an open terminal switches the drive off until every pad has had one without.
    fn open(&self) -> Format {
        Format::counter(self.count()).where_present(self.drive_output.is_some())
    }

    /// Pads of the multiplexer.
    fn count(&self) -> u64 {
        self.pads.outputs().select.width.into()
    }

    fn dac(&self) -> DacPort<Format> {
        let none = DacPort::of(Format::NONE);
        let dac = self.drive_output.as_ref().map_or(none, |output| output.outputs().dac);
        // As many as there are pads: those of channels that are not there stay low.
        let polarity = self.pads.outputs().select.where_present(!dac.dac_polarity.is_none());
        DacPort { dac_polarity: polarity, ..dac }
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
    let registers::Outputs { capacitance_gain, force_gain, contact_capacitance, table, .. } =
        *registers;
    let calibration = Calibration { capacitance_gain, force_gain, contact_capacitance, table };
    core::Inputs { strobe, clear: !registers.enable, code, calibration }
}

/// What a core gives; with a drive, what packets say of it, and the converter's pins.
struct Measured<V: Interpretation> {
    core: core::Out<V>,
    driven: DrivenPort<Signal<V>>,
    dac: DacPort<Signal<V>>,
    stale: Signal<V>,
    open: Signal<V>,
}

impl Board {
    #[inline(always)]
    fn measure<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        inputs: core::In<V>,
        late: Signal<V>,
        registers: &registers::Out<V>,
    ) -> Measured<V> {
        let Some((block, within)) = self.core.as_ref().zip(state.submodules.core.as_mut()) else {
            return self.drive(state, r, inputs, late, registers);
        };
        let core = block.call("core", within, inputs);
        let dac = DacPort::map(DacPort::of(Format::NONE), zero);
        Measured { core, driven: r.driven, dac, stale: r.stale, open: r.open }
    }

    /// Clocks until the next tick, after this clock: the first tick is that of the first clock.
    #[inline(always)]
    fn next_tick<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        if r.to_tick.format.is_none() {
            return r.to_tick;
        }
        let down = (r.to_tick - int(1)).bits(0, r.to_tick.format.width);
        r.to_tick.is(0).select(int(self.tick_clocks - 1), down).resize(r.to_tick.format, Proved)
    }

    /// The force loop, as commands have set it, and its drive.
    #[inline(always)]
    fn drive<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        inputs: core::In<V>,
        late: Signal<V>,
        registers: &registers::Out<V>,
    ) -> Measured<V> {
        let within = &mut state.submodules;
        let given = self.drive_registers.as_ref().zip(within.drive_registers.as_mut());
        let (block, state) = given.expect("a force loop has registers");
        let set = block.call(
            "drive_registers",
            state,
            drive_registers::Inputs {
                write: registers.drive_write,
                place: registers.drive_place,
                data: registers.data,
            },
        );
        let given = self.force_loop.as_ref().zip(within.force_loop.as_mut());
        let (block, state) = given.expect("a board has a core or a force loop");
        let inputs = force_loop::Inputs {
            core: inputs,
            target: set.target,
            tuning: set.tuning,
            wall: set.wall,
            drives_clear: r.stale,
            tick: r.to_tick.is(0),
            extremes_read: bit(false),
        };
        let of_loop = block.call("force_loop", state, inputs);
        let given = self.drive_output.as_ref().zip(within.drive_output.as_mut());
        let (block, state) = given.expect("a force loop has a drive");
        let core = of_loop.core;
        let inputs = drive_output::Inputs {
            drive_valid: of_loop.drive.drive_valid,
            drive_pad: of_loop.drive.drive_pad,
            drive: of_loop.drive.drive,
            serve: core.serve,
            closed: core.closed & registers.enable,
            enable: registers.enable & r.open.is(0),
            faults: of_loop.faults,
        };
        let drive_output::Outputs { dac, drives_clear } = block.call("drive_output", state, inputs);
        let driven = driven(r.driven, &of_loop, dac.dac_live);
        let dac_polarity = dac.dac_polarity.resize(self.dac().dac_polarity, Wrap);
        let dac = DacPort { dac_polarity, ..dac };
        // Codes of an ADC that was late are of no known time, or of no ADC.
        let lost = (core.frames.done & core.frames.lost) | (late & registers.enable);
        let fewer = r.open.is(0).select(r.open, previous(r.open));
        let counted = core.frames.done.select(fewer, r.open);
        let open = lost.select(int(self.count()), counted);
        let open = open.resize(r.open.format, Wrap);
        // What is made while nothing can be driven does not count: the first drive word behind it is the first within slew.
        let stale = drives_clear | lost | !r.open.is(0);
        Measured { core, driven, dac, stale, open }
    }
}

/// What packets say of the drive: its last word, and what was said of that; faults as they are.
#[inline(always)]
fn driven<V: Interpretation>(
    held: DrivenPort<Signal<V>>,
    of_loop: &force_loop::Out<V>,
    live: Signal<V>,
) -> DrivenPort<Signal<V>> {
    let (drive, faults) = (&of_loop.drive, &of_loop.faults);
    let old = |bit: u8| held.driven_status.bits(bit, 1);
    let given = |now: Signal<V>, bit: u8| drive.drive_valid.select(now, old(bit));
    let free = match drive.drive_free.format.is_none() {
        true => bit(false),
        false => given(drive.drive_free, status::FREE),
    };
    let bits = [
        faults.silence_fault,
        faults.sensor_fault,
        faults.force_fault,
        given(drive.drive_low, status::LOW),
        given(drive.drive_high, status::HIGH),
        free,
        live,
        bit(false),
    ];
    let pad = drive.drive_valid.select(
        drive.drive_pad.resize(NIBBLE, Wrap),
        held.driven_status.bits(status::PAD, NIBBLE.width),
    );
    DrivenPort {
        driven: drive.drive_valid.select(drive.drive, held.driven),
        driven_status: pad.concat(bits_side_by_side(bits)),
    }
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
            enable: registers.enable | registers.line_test,
            busy: i.busy,
            dout: i.dout,
            write: registers.adc_write,
        };
        let adc = call!(self.adc_reader, state, inputs);
        // The registers receive `shift` a clock later: the reader uses their outputs of this clock.
        let shift = adc.shift;
        let inputs = core_inputs(
            &registers,
            adc.strobe & registers.enable,
            self.codes.data(&mut state.submodules.codes),
        );
        let Measured { core, driven, dac, stale, open } =
            self.measure(state, &r, inputs, adc.late, &registers);
        let write = Write { enable: adc.store, address: adc.address, data: adc.code };
        self.codes.access(&mut state.submodules.codes, adc.bank.concat(core.channel), write);
        let inputs = sigma_delta::Inputs { carrier: core.carrier };
        let carrier = call!(self.sigma_delta, state, inputs);
        let inputs = pads::Inputs { serve: core.serve, closed: core.closed & registers.enable };
        let pads = call!(self.pads, state, inputs);
        let number = adc.address.bits(0, self.adc_reader.index().width);
        let inputs = line_test::Inputs {
            start: registers.controlled,
            enable: registers.line_test,
            line: registers.line,
            store: adc.store,
            channel: number.resize(registers.line.format, Wrap),
            code: adc.code,
            late: adc.late,
        };
        let tested = call!(self.line_test, state, inputs);
        // Of a test the last command is that which began it.
        let of_test = registers.place.is(Register::Control.number() as u64);
        let code = tested.result.bits(0, tested.result.format.width);
        let code = code.resize(registers.data.format, Wrap);
        let inputs = stream::Inputs {
            frames: core.frames,
            late: adc.late,
            refused: registers.refused,
            commands: registers.commands,
            enable: registers.enable,
            keep: registers.written | (r.shift & !shift) | tested.changed,
            place: of_test.select(int(LINES as u64), registers.place).resize(PLACE, Wrap),
            data: of_test.select(code, registers.data),
            calibrated: registers.calibrated,
            driven: r.driven,
        };
        let stream = call!(self.stream, state, inputs);
        let late = registers.enable & (r.late | adc.late);
        let to_tick = self.next_tick(&r);
        state.store(self, Registers { shift, late, driven, to_tick, stale, open });
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
            dac,
        }
    }
}
