// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a session says, in words: cause, then cure.

use super::Statistics;
use crate::packet::Heartbeat;
use hapticore_contract::control::Faults;

/// What a board says that it is.
pub(super) fn identity(heartbeat: &Heartbeat) -> String {
    format!(
        "board found: protocol {}, digest {:04x}, {}",
        heartbeat.version,
        heartbeat.digest(),
        heartbeat.output()
    )
}

/// Why the drives are off, and what to do.
pub(super) fn faults(faults: Faults) -> String {
    let named = [
        (faults.silence, "this host was silent for too long"),
        (faults.sensor, "estimates of a pad were invalid for too long: check its wires"),
        (faults.force, "a force was beyond its cap"),
    ];
    let named: Vec<_> = named.iter().filter(|(is, _)| *is).map(|(_, words)| *words).collect();
    format!("fault: {}; drives are off until they are armed again", named.join("; "))
}

/// Why frames do not come.
pub(super) fn dropped(counts: &Statistics, baud: u32) -> String {
    format!(
        "the board has dropped {} of {} frames: its line of {baud} baud carries no more; print it for a faster \
         line, and connect at that rate",
        counts.dropped,
        counts.dropped + counts.frames
    )
}

/// Why no packet of a board that is connected can be read.
pub(super) fn unheard(counts: &Statistics, damaged: u64, baud: u32) -> String {
    match counts.bytes {
        0 => "no bytes come: check the board's power, its configuration (DONE or CDONE high), and the port".into(),
        bytes => format!(
            "{bytes} bytes, {damaged} damaged packets and no whole one: the board was printed for another profile or drive \
             (--profile, --control), its line does not run at {baud} baud (--baud), or this is another device's port"
        ),
    }
}
