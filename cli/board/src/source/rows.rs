// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rows of a board: from packets, to a CSV file.

use std::io::Write;

use hapticore_host::link::Phase;
use hapticore_host::{Packet, SlotClock};
use hapticore_run::record::{Driven, Row};

use super::Board;

impl Board {
    pub(super) fn row(&mut self, packet: &Packet) -> Row {
        let Packet { status, frame } = packet;
        let base = *self.base.get_or_insert(status.sequence);
        let number = status.sequence.wrapping_sub(base).wrapping_add(1);
        self.time_s = self.clock.time_of(number);
        let profile = &self.session.plan().profile;
        let measurement = frame.measurement(profile);
        let (measured, flags) = self.readout.convert(&measurement);
        let driven = status.driven.map(|driven| {
            let full_scale_v =
                self.session.plan().output.map_or(0.0, |output| f64::from(output.full_scale_v));
            let format = profile.control.as_ref().map(|control| control.drive);
            let fraction = format.map_or(0.0, |format| format.real(driven.word));
            Driven {
                target_n: self.session.target_n(usize::from(driven.pad)),
                drive_v_rms: full_scale_v * fraction,
                limited: driven.low || driven.high,
                // A board whose drive is off misses its host.
                fault: driven.faults.any() && self.session.phase() == Phase::Armed,
                free: profile.wall.map(|_| driven.free),
                core_n: None,
            }
        });
        Row {
            case: 0,
            time_s: self.time_s,
            pad: frame.pad,
            measured,
            flags,
            laws: None,
            truth: None,
            driven,
            game: None,
            reference: None,
        }
    }

    pub(super) fn write(&mut self, row: &Row) {
        let Some(csv) = &mut self.csv else { return };
        let numbers = row.measured.values().map(|number| number.to_string());
        let numbers: Vec<_> = numbers.into_iter().collect();
        let written =
            writeln!(csv, "{},{},{},{}", row.time_s, row.pad, numbers.join(","), row.flags);
        if let Err(error) = written {
            (self.csv, self.csv_error) = (None, Some(error.to_string()));
        }
    }

    /// Frames count anew: the board was brought up.
    pub(super) fn begin(&mut self) {
        let rate_hz = self.device.device.sample_rate_hz;
        let start_s = if self.base.is_some() { self.time_s } else { 0.0 };
        self.clock = SlotClock::new(&self.session.plan().profile, rate_hz, start_s);
        self.base = None;
    }

    pub(super) fn flush(&mut self) {
        if let Some(csv) = &mut self.csv
            && let Err(error) = csv.flush()
        {
            (self.csv, self.csv_error) = (None, Some(error.to_string()));
        }
    }
}
