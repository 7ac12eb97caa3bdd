// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a line has brought: packets, losses, damage.

use crate::packet::{Message, Packet};

/// Counts since the line was opened first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Bytes that have come.
    pub bytes: u64,
    /// Frames that have come whole.
    pub frames: u64,
    /// Heartbeats that have come whole.
    pub heartbeats: u64,
    /// Frames that were sent and have not come: gaps of the sequence number.
    pub lost: u64,
    /// Frames that the board has dropped, since its line was busy.
    pub dropped: u64,
    /// Packets that were damaged on the way.
    pub damaged: u64,
    /// Packets that report a command that the board has refused.
    pub refused: u64,
    /// Packets that report that the ADC was late.
    pub late: u64,
    /// How often the line was opened.
    pub connections: u64,
    /// Bytes that were left out, since this program did not keep up.
    pub overflowed: u64,
}

/// The last frame: its number, and whether it has reported dropped ones.
type Last = (u16, bool);

/// Counts messages.
#[derive(Debug, Clone, Default)]
pub(super) struct Counter {
    pub counts: Statistics,
    last: Option<Last>,
}

impl Counter {
    /// Frames before now are not missed: the board was reset or enabled anew, or the line opened.
    pub fn begin(&mut self) {
        self.last = None;
    }

    /// Counts a message.
    pub fn add(&mut self, message: &Message) {
        let status = match message {
            Message::Heartbeat(heartbeat) => {
                self.counts.heartbeats += 1;
                heartbeat.status
            }
            Message::Frame(packet) => {
                self.counts.frames += 1;
                self.gap(packet);
                packet.status
            }
        };
        self.counts.refused += u64::from(status.refused);
        self.counts.late += u64::from(status.late);
    }

    /// A gap is the board's where a packet beside it reports one, else the line's.
    fn gap(&mut self, Packet { status, .. }: &Packet) {
        let now = (status.sequence, status.overrun);
        let Some((before, dropped_before)) = self.last.replace(now) else { return };
        let missing = u64::from(status.sequence.wrapping_sub(before).wrapping_sub(1));
        // A sequence number that stands or goes back is a board that was reset.
        if missing >= 1 << 15 {
            return;
        }
        let by = if status.overrun || dropped_before {
            &mut self.counts.dropped
        } else {
            &mut self.counts.lost
        };
        *by += missing;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet::Status;
    use hapticore_contract::frame::{Flags, Frame};

    fn frame(sequence: u16, overrun: bool) -> Message {
        let frame = Frame { pad: 0, codes: [0; 8], flags: Flags::default() };
        Message::Frame(Packet { status: Status { sequence, overrun, ..Status::default() }, frame })
    }

    #[test]
    fn gaps_are_the_lines_or_the_boards() {
        let mut counter = Counter::default();
        let sequence = [(65_533, false), (65_534, false), (1, false), (2, true), (5, false)];
        for (number, overrun) in sequence {
            counter.add(&frame(number, overrun));
        }
        let Statistics { frames, lost, dropped, .. } = counter.counts;
        assert_eq!((frames, lost, dropped), (5, 2, 2), "65,535 and 0; 3 and 4");
        counter.add(&frame(1, false));
        assert_eq!(counter.counts.lost, 2, "a board that was reset has lost nothing");
        counter.begin();
        counter.add(&frame(100, false));
        assert_eq!(counter.counts.lost, 2);
    }
}
