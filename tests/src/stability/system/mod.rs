// SPDX-License-Identifier: MIT OR Apache-2.0
//! What happens to the device, and to the core itself.
//!
//! | module | holds |
//! | --- | --- |
//! | `pads` | cases of pads: none, at the limits, dropped, beside others, changing within a slot |
//! | `events` | cases of the core: `clear`, reset, another calibration, upsets |
//! | `upsets` | a bit inverted in some clock, and whether the core recovers |
//! | `device` | a core and the device that answers it, clock by clock |
//! | `bits` | the interpretation of a core whose registers may hold anything |

mod bits;
mod device;
mod events;
mod pads;
mod upsets;

use super::{Case, Group};

/// The group on the page.
pub const GROUP: Group = Group {
    name: "system",
    title: "System",
    about: "Pads, terminals and the core's own inputs and registers. Cases of the core's clocks run with slots cut to what the estimator needs, two pads, beside a device that \
            answers the carrier that the core makes and the pad that it selects. Once the state after a disturbance is that of the same frame without it, all later frames are \
            the same for ever; this is what *recovers* means.",
    cases: &[
        Case {
            name: "no_pad",
            stimulus: "currents of 1 LSB of noise, 200 slots",
            must: "flag *invalid* or *lost*, or a capacitance of nothing (below 0.1 pF)",
            run: pads::no_pad,
        },
        Case {
            name: "vanishing_capacitance",
            stimulus: "currents from half of full scale down by 3 dB a slot, 48 slots",
            must: "right (0.1 % and 0.1 pF) until flagged: never a wrong number",
            run: pads::vanishing_capacitance,
        },
        Case {
            name: "pad_near_each_terminal",
            stimulus: "a pad three quarters of the way to each corner of the sheet and to the middle of each long edge",
            must: "no flag, within 2 mm of its place and 0.5 mm of floating point",
            run: pads::pad_near_each_terminal,
        },
        Case {
            name: "terminal_dropped",
            stimulus: "each terminal's current lost in mid-window, for a slot more, then back",
            must: "flag *lost* from the next frame on, and right again with the first whole slot",
            run: pads::terminal_dropped,
        },
        Case {
            name: "no_haptic_voltage",
            stimulus: "a haptic voltage of zero codes, four capacitances",
            must: "a force of exactly zero",
            run: pads::no_haptic_voltage,
        },
        Case {
            name: "haptic_voltage_skewed",
            stimulus: "capacitance and haptic voltage each rise by half in mid-window, a quarter of a window apart or together",
            must: "no more error than floating point; the next frame right to the bit",
            run: pads::haptic_voltage_skewed,
        },
        Case {
            name: "pull_in_inside_a_slot",
            stimulus: "the capacitance trebles at an eighth, a quarter and half of the window",
            must: "no more error than floating point; the next frame right to the bit",
            run: pads::pull_in_inside_a_slot,
        },
        Case {
            name: "switching_before_settling",
            stimulus: "a decaying tail of 1, 10 and 40 % of full scale is left in the currents where the window begins",
            must: "no more error than floating point; the next frame right to the bit",
            run: pads::switching_before_settling,
        },
        Case {
            name: "neighbours_at_full_swing",
            stimulus: "a pad of 1 % of full scale between slots whose every code is at full scale",
            must: "isolation: its frames are those beside quiet neighbours",
            run: pads::neighbours_at_full_swing,
        },
        Case {
            name: "pads_swapped",
            stimulus: "two pads in each other's slots",
            must: "frames change places to the bit: nothing is left in a slot of its pad",
            run: pads::pads_swapped,
        },
        Case {
            name: "clear_in_mid_frame",
            stimulus: "input `clear` in 100 clocks of a round at random",
            must: "no wrong frame after it; recovers",
            run: events::clear_in_mid_frame,
        },
        Case {
            name: "reset_in_mid_frame",
            stimulus: "all registers to zero, memories as they were, in 100 clocks of a round at random",
            must: "no wrong frame after it; recovers",
            run: events::reset_in_mid_frame,
        },
        Case {
            name: "calibration_changed_in_mid_frame",
            stimulus: "other gains and every word of the position table rewritten while slots go on, from 100 clocks at random",
            must: "at most one frame of each pad that is of neither calibration; recovers",
            run: events::calibration_changed_in_mid_frame,
        },
        Case {
            name: "upset_registers",
            stimulus: "600 bits of the registers of all profiles, inverted in a clock of a round at random (with `UPSETS=all` every bit of `small` and 1,200 of the others)",
            must: "right again within a round and a half, at most one wrong frame of each pad, none for good",
            run: events::upset_registers,
        },
        Case {
            name: "upset_memories",
            stimulus: "60 bits of each profile's memories, inverted likewise (`UPSETS=all`: 500)",
            must: "working memories recover; tables stay wrong until they are written again, and are named",
            run: events::upset_memories,
        },
    ],
};

/// Checks that a core of a profile in whole slots, and the device around it, are after a round of
/// all pads as they were before. Returns the number of their words.
///
/// # Panics
/// Where the state does not come back.
pub fn recurring_state(name: &str) -> usize {
    let device = device::Device::with(super::bench::Bench::of(name));
    upsets::Steady::of(&device).words()
}
