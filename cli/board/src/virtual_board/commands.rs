// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a command of the host does to a virtual board.

use hapticore_host::{Command, DriveWord, Register};
use hapticore_protocol::Control;

use super::core::Core;
use super::words::DriveWords;
use super::{PAUSE_CLOCKS, VirtualBoard};

/// Samples of the test of a data line.
const TEST_SAMPLES: f64 = 67.0;

impl VirtualBoard {
    pub(super) fn command(&mut self, command: Option<Command>) {
        let is_adc = matches!(command, Some(Command::Register(Register::Adc, _)));
        if is_adc && (self.is_enabled() || self.state.is_test()) {
            self.state.refused = true;
            return;
        }
        self.state.commands = (self.state.commands + 1) % 16;
        match command {
            Some(Command::Register(Register::Control, code)) => self.control(code),
            Some(Command::Register(register, code)) => self.register(register, code),
            Some(Command::Table { address, code }) => self.table(address, code),
            Some(Command::Drive(word, code)) => self.drive_word(word, code),
            None => (),
        }
    }

    pub(super) fn register(&mut self, register: Register, code: i64) {
        let state = &mut self.state;
        state.told[register.number()] = Some(code as u64);
        match register {
            Register::Constant(constant) => {
                state.sensor.constants[constant as usize] = code;
                state.calibrated |= register == Register::LAST_CONSTANT;
                self.calibrate();
            }
            Register::Adc => {
                let answer = self.faults.answer(state.part.answer());
                let bits: Vec<_> = (0..16).rev().map(|bit| code >> bit & 1).collect();
                // The part refuses it silently, as it does at its pins.
                let _ = state.part.word(&bits);
                state.told[register.number()] = None;
                state.answer = Some((answer, code as u16));
            }
            Register::Control => (),
        }
    }

    pub(super) fn table(&mut self, address: u16, code: i64) {
        let address_bits = usize::BITS - (self.state.sensor.table.len() - 1).leading_zeros();
        let address = usize::from(address) & ((1 << address_bits) - 1);
        if let Some(word) = self.state.sensor.table.get_mut(address) {
            *word = code;
            self.calibrate();
        }
    }

    /// Words of the calibration hold immediately.
    pub(super) fn calibrate(&mut self) {
        self.state.is_core_old = true;
    }

    pub(super) fn drive_word(&mut self, word: DriveWord, code: i64) {
        let Some(drive) = &mut self.state.drive else { return };
        self.state.is_core_old |= drive.write(word, code);
        let pad = match word {
            DriveWord::Target(pad) | DriveWord::Surface { pad, .. } => usize::from(pad),
            _ => 0,
        };
        let (state, profile) = (&mut self.state, &self.profile);
        if let (Some(drive), Some(core)) =
            (&state.drive, state.core.as_mut().and_then(Core::driven))
            && pad < drive.targets.len()
        {
            core.hear(pad, drive, profile);
        }
    }

    pub(super) fn control(&mut self, code: i64) {
        let was_enabled = self.is_enabled();
        self.state.control = code;
        if code >> Control::ADC_RESET & 1 != 0 {
            self.state.part.reset();
        }
        if self.state.is_test() {
            let samples_s = TEST_SAMPLES / self.case.clock.sample_rate_hz();
            let line = (code >> Control::LINE & 7) as usize;
            self.state.test = Some((self.now_s + samples_s, line));
            (self.state.told[Register::Adc.number()], self.state.answer) = (Some(0), None);
        } else {
            self.state.test = None;
        }
        match (was_enabled, self.is_enabled()) {
            (false, true) => {
                // Enabling begins with a slot of the first pad, the plant's slots are at fixed times.
                let slots = (self.now_s / self.case.clock.seconds(1)).ceil() as usize;
                let served = self.profile.pads as usize;
                self.slot = slots.next_multiple_of(served).max(self.slot.next_multiple_of(served));
                self.state.is_core_old = true;
            }
            (true, false) => self.disable(),
            (false, false) => self.state.drive.iter_mut().for_each(DriveWords::disable),
            (true, true) => (),
        }
    }

    pub(super) fn disable(&mut self) {
        self.state.core = None;
        self.state.drive.iter_mut().for_each(DriveWords::disable);
        self.state.next_heartbeat_s =
            self.state.busy_until_s.max(self.now_s) + PAUSE_CLOCKS / self.made.clock_hz;
        self.quieten();
    }

    pub(super) fn end_test(&mut self) {
        let Some((_, line)) = self.state.test.filter(|(at_s, _)| *at_s <= self.now_s) else {
            return;
        };
        self.state.test = None;
        let bits = u32::from(self.profile.formats.adc.width);
        // Samples of a display at work are not the same 64 times.
        let Some(mut codes) = self.state.part.fixed_codes(bits) else { return };
        codes.truncate(self.profile.channels());
        self.faults.on_lines(&mut codes);
        let code = codes.get(line).copied().unwrap_or(0);
        let code = u64::from(code as u32) & ((1 << bits) - 1);
        self.state.told[Register::Adc.number()] = Some(code);
    }
}
