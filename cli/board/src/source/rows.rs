// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rows of a board: from packets, to a recording.

use std::io;

use hapticore_host::link::SessionEvent;
use hapticore_host::{Packet, SlotClock};
use hapticore_run::record::{Driven, Row};

use super::Board;
use crate::recording::Recorder;

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
                fault: driven.faults.any() && self.session.drives(),
                free: profile.wall.map(|_| driven.free),
                ..Driven::default()
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

    pub(super) fn record_row(&mut self, row: &Row) {
        self.record(|recorder| recorder.row(row));
    }

    pub(super) fn record_note(&mut self, note: &str) {
        let time_s = self.time_s;
        self.record(|recorder| recorder.note(time_s, note));
    }

    pub(super) fn flush_record(&mut self) {
        self.record(|recorder| recorder.flush());
    }

    /// A recorder that fails is asked no more.
    fn record(&mut self, write: impl FnOnce(&mut dyn Recorder) -> io::Result<()>) {
        let Some(recorder) = &mut self.recorder else { return };
        if let Err(error) = write(recorder.as_mut()) {
            let note = format!("the recording has ended: {error}");
            self.queue.push_back(SessionEvent::Note(note));
            (self.recorder, self.record_error) = (None, Some(error));
        }
    }

    /// Frames count anew: the board was brought up.
    pub(super) fn begin(&mut self) {
        let rate_hz = self.device.device.sample_rate_hz;
        self.clock = SlotClock::new(&self.session.plan().profile, rate_hz, self.time_s);
        self.base = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::{Asked, target};

    #[test]
    fn time_never_goes_back_however_often_a_board_is_brought_up() {
        let asked = Asked { port: "virtual".into(), ..Asked::default() };
        let mut board = Board::new(target(&asked).expect("a bundled scene"), "virtual");
        board.begin();
        assert_eq!(board.clock.start_s(), 0.0);
        board.time_s = 5.0;
        (0..2).for_each(|_| board.begin());
        assert_eq!(board.clock.start_s(), 5.0);
    }
}
