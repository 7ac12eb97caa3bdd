// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board that is clocked from its gateware, an ADC and a host at its pins, and a scene's plant behind the ADC.
//!
//! Device time is clocks over the clock's rate, and what was left out while the board was disabled. A slot of the plant
//! begins at a multiple of its length; a board that is enabled begins a slot immediately. So the time until the next slot of
//! the first pad is left out, too.

use std::sync::Arc;

use anyhow::{Context, Result};
use hapticore_board::bench::SteppedBoard;
use hapticore_board::faults::{Faults, Wrong, gains};
use hapticore_board::virtual_board::{VirtualBoard, hold_still};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::Signal;
use hapticore_host::Output;
use hapticore_rtl::board::drive_output::Converter;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::parameters::Drive;
use hapticore_rtl::board::whole::{Inputs, Outputs};
use hapticore_rtl::board::{Board, Parameters};
use hapticore_run::case::Case;
use hapticore_run::engine::Signals;
use hapticore_run::maker::Maker;
use hapticore_scene::Plant;

use crate::dac::Dac;
use crate::pins::{Adc, Host};

/// The converter of a board with a drive.
const CONVERTER: Frame = Frame::AD5664R;
/// Codes of its full scale.
const CODES: f64 = 65_536.0;
/// From the last bit of a command to what it does, and what is to be sent before a board rests.
const ACTS_CLOCKS: u64 = 32;
const RESTS_S: f64 = 2e-3;
/// Inputs of the plant begin so much later than now, s.
const MARGIN_S: f64 = 0.01;

/// A board of gateware.
pub struct ClockedBoard {
    board: Board,
    state: State<Board, i64>,
    formats: Inputs<Format>,
    pub adc: Adc,
    host: Host,
    dac: Dac,
    output: Option<Output>,
    case: Case,
    profile: Arc<Profile>,
    maker: Maker,
    /// Faults of wires and pads; those of data lines are at the ADC's pins.
    wires: Faults,
    clock_s: f64,
    clocks: u64,
    left_out_s: f64,
    enabled: bool,
    /// The plant's slot that is being converted, its samples so far and the codes of its window.
    slot: usize,
    sample: usize,
    codes: Vec<i32>,
    /// Conversions of which the sample was offered.
    seen: usize,
    bytes: Vec<u8>,
}

impl ClockedBoard {
    /// The gateware of a virtual board, just configured, with a device of the same scene.
    pub fn of(other: &VirtualBoard) -> Result<Self> {
        let (case, profile, made) =
            (other.case().clone(), other.case().profile.clone(), other.made());
        let (clock_hz, baud) = (made.clock_hz as u64, u64::from(made.baud));
        let drive = made.output.map(|Output { wave, full_scale_v, .. }| Drive {
            wave,
            converter: Converter::Serial(CONVERTER),
            full_scale_v,
        });
        let parameters = Parameters { clock_hz, baud, sclk_latency: 0, drive };
        let board = Board::new(&profile, &parameters)?;
        let mut plant = case.plant()?.at_first_point();
        if made.output.is_some() {
            (0..plant.served()).try_for_each(|pad| plant.set_drive(pad, 0.0, 0.0))?;
        }
        let maker = Maker::new(plant, &profile, true, false);
        Ok(ClockedBoard {
            state: board.reset(),
            formats: board.inputs(),
            adc: Adc::new([], profile.formats.adc.width, &parameters),
            host: Host::new(parameters.bits().least()),
            dac: Dac::new(),
            output: made.output,
            wires: Faults::none(1),
            clock_s: 1.0 / made.clock_hz,
            clocks: 0,
            left_out_s: 0.0,
            enabled: false,
            slot: 0,
            sample: 0,
            codes: Vec::new(),
            seen: 0,
            bytes: Vec::new(),
            board,
            case,
            profile,
            maker,
        })
    }

    /// Breaks a wire, a pad, or one data line.
    pub fn break_with(&mut self, wrong: Wrong) {
        match wrong {
            Wrong::LineLow(line) => self.adc.broken = Some((line, 0)),
            Wrong::LineHigh(line) => self.adc.broken = Some((line, 1)),
            Wrong::LineShorted(line, other) => self.adc.shorted = Some([other, line]),
            wire => self.wires.wrong.push(wire),
        }
    }

    /// When bytes have to be sent for a command of them to act at a device time, s.
    pub fn lead_s(&self, bytes: usize, bit_clocks: u64) -> f64 {
        (10 * bytes as u64 * bit_clocks + ACTS_CLOCKS) as f64 * self.clock_s
    }

    fn slot_s(&self) -> f64 {
        self.case.clock.seconds(1)
    }

    fn clock(&mut self) {
        if self.adc.conversions != self.seen {
            self.seen = self.adc.conversions;
            self.sample += 1;
            self.offer();
        }
        let (busy, dout) = self.adc.pins();
        let outputs = self.step(Inputs { dout, busy, rx: self.host.line() });
        self.adc.clock(&outputs);
        if self.output.is_some() {
            self.dac.serial(&CONVERTER, outputs.dac);
        }
        self.host.clock(outputs.tx);
        self.clocks += 1;
        self.bytes.append(&mut self.host.heard);
        let was_enabled = std::mem::replace(&mut self.enabled, outputs.enabled != 0);
        if self.enabled && !was_enabled {
            self.begin();
        }
    }

    fn step(&mut self, inputs: Inputs<i64>) -> Outputs<i64> {
        let with_formats = Inputs::zip(inputs, self.formats);
        let signals = Inputs::map(with_formats, |(value, format)| Signal { value, format });
        Outputs::map(self.board.step(&mut self.state, signals), |signal| signal.value)
    }

    /// Enabled: the first conversion comes with the next clocks.
    fn begin(&mut self) {
        let pads = self.profile.pads as usize;
        let slots = (self.now_s() / self.slot_s()).ceil() as usize;
        self.slot = slots.max(self.slot + 1).next_multiple_of(pads);
        self.left_out_s += self.slot as f64 * self.slot_s() - self.now_s();
        (self.seen, self.sample) = (self.adc.conversions, 0);
        self.offer();
    }

    /// What the next conversion finds: nothing while a pad settles, then the codes of its window.
    fn offer(&mut self) {
        let slot = &self.profile.slot;
        let (blanking, samples) = (slot.blanking() as usize, slot.samples() as usize);
        if self.sample == samples {
            (self.slot, self.sample) = (self.slot + 1, 0);
        }
        if self.enabled && self.sample == blanking {
            self.look();
        }
        let channels = self.profile.channels();
        let of_window = self.enabled.then(|| self.sample.checked_sub(blanking)).flatten();
        let codes = of_window.and_then(|k| self.codes.get(k * channels..(k + 1) * channels));
        self.adc.offer(codes.map_or_else(|| vec![0; channels], <[i32]>::to_vec));
    }

    /// The converter's voltages since the window before drive the pads: from when the virtual board's do, some
    /// microseconds apart from the converter's own clock.
    fn drive(&mut self) {
        let Some(output) = self.output else { return };
        let latency_s = self.case.drive_latency_s().expect("a case with a controller");
        let at_s = self.slot as f64 * self.slot_s() + latency_s;
        for (pad, code) in std::mem::take(&mut self.dac.updates) {
            let volts = f64::from(output.full_scale_v) * code as f64 / CODES;
            if pad < self.profile.pads as usize {
                self.plant().set_drive(pad, at_s, volts).expect("a pad of the device");
            }
        }
    }

    /// The codes of a slot's window, as wires, pads and ranges of the ADC have them.
    fn look(&mut self) {
        self.drive();
        let (Signals::Samples { codes, .. }, _) = self.maker.signals(self.slot) else { return };
        self.codes = codes;
        let (pad, channels) = (self.slot % self.profile.pads as usize, self.profile.channels());
        let limit = self.profile.formats.adc.max_code() as i32;
        let gains = gains(self.adc.part.inputs().0);
        self.wires.act(pad, &mut self.codes, (channels, limit), &gains);
    }
}

impl SteppedBoard for ClockedBoard {
    fn profile(&self) -> &Profile {
        &self.profile
    }

    fn output(&self) -> Option<Output> {
        self.output
    }

    fn now_s(&self) -> f64 {
        self.clocks as f64 * self.clock_s + self.left_out_s
    }

    fn plant(&mut self) -> &mut Plant {
        self.maker.plant()
    }

    fn hold_still(&mut self) {
        let now_s = self.now_s();
        for pad in 0..self.profile.pads as usize {
            self.plant().set_drive(pad, now_s, 0.0).expect("a pad of the device");
        }
        hold_still(self.plant(), now_s + MARGIN_S);
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<()> {
        self.host.send(bytes.iter().copied());
        while !self.host.can_skip() {
            self.clock();
        }
        (0..ACTS_CLOCKS).for_each(|_| self.clock());
        Ok(())
    }

    fn advance(&mut self, until_s: f64) -> Result<()> {
        while self.now_s() < until_s {
            self.clock();
        }
        Ok(())
    }

    fn rest(&mut self, until_s: f64) -> Result<()> {
        self.advance(until_s.min(self.now_s() + RESTS_S))?;
        (!self.enabled).then_some(()).context("expected a disabled board")?;
        self.left_out_s += (until_s - self.now_s()).max(0.0);
        Ok(())
    }

    fn take_bytes(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }
}
