// SPDX-License-Identifier: MIT OR Apache-2.0
//! What usually breaks a force loop.
//!
//! | module | holds |
//! | --- | --- |
//! | `words` | cases of the controller's block around a plant whose state comes back |
//! | `device` | cases of the whole loop around a simulated device |
//! | `scenes` | the loop of a scene, slot by slot |
//! | `rig` | the block and its plant |
//! | `wall` | a wall that holds a hand |
//! | `rivals` | laws of other controllers around the same plant |

mod device;
mod rig;
mod rivals;
mod scenes;
mod wall;
mod words;

use super::{Case, Group};

/// The group on the page.
pub const GROUP: Group = Group {
    name: "force_loop",
    title: "Force loop",
    about: "The controller in the words of `standard`. Where a case says *for ever*, the whole state of loop and plant has come back: of the same state and the same inputs the same \
            follows for any number of frames, 10 million or more. Its plant is then a gap that follows the square of the drive, in words; the other cases run scene `fig9` (slots of 1 ms).",
    cases: &[
        Case {
            name: "rounding_bias",
            stimulus: "five targets from 11 to 244 mN at rest",
            must: "the mean force within half a step of the force's word of the law in real numbers, for ever",
            run: words::rounding_bias,
        },
        Case {
            name: "limit_cycle",
            stimulus: "the same targets, every law",
            must: "the drive word toggles by one at most, for ever",
            run: words::limit_cycle,
        },
        Case {
            name: "one_sided_rail",
            stimulus: "a target beyond what the rail gives, then 0.1 N",
            must: "no wind-up: back within 20 frames more than a start from rest takes",
            run: words::one_sided_rail,
        },
        Case {
            name: "largest_error_and_gain",
            stimulus: "errors from -1.4 N to the largest target with gains up to the largest",
            must: "the drive saturates; it never goes the wrong way",
            run: words::largest_error_and_gain,
        },
        Case {
            name: "rail_for_a_million_frames",
            stimulus: "a target at the rail for any time",
            must: "a state that no longer changes",
            run: words::rail_for_a_million_frames,
        },
        Case {
            name: "sensor_invalid",
            stimulus: "invalid estimates (of a large force) with every law at rest",
            must: "the drive is held, then zero at frame 8 and latched; what an invalid frame measured is in no drive word",
            run: words::sensor_invalid,
        },
        Case {
            name: "host_silent",
            stimulus: "no sign of life from the host, frames of a millisecond",
            must: "the drive zero with the 100th millisecond since it was heard, latched",
            run: words::host_silent,
        },
        Case {
            name: "gains_changed_in_mid_frame",
            stimulus: "gains, rail and slew limit rewritten in each clock of a frame, every law",
            must: "a drive within its word, then at rest as if always so tuned",
            run: words::gains_changed_in_mid_frame,
        },
        Case {
            name: "plant_half_off",
            stimulus: "friction, spring, insulator or load half as large or half as large again as calibrated, 0.3 N",
            must: "stable: the drive at rest moves by at most 200 of 131,072 LSB; the force error is that of the sensor's calibration",
            run: device::plant_half_off,
        },
        Case {
            name: "pull_in_under_control",
            stimulus: "steps to 0.3 and 0.6 N through the pull-in, 50 g",
            must: "overshoot below 50 mN",
            run: device::pull_in_under_control,
        },
        Case {
            name: "line_lost_under_load",
            stimulus: "all lines at zero for 30 ms while 0.3 N is asked for",
            must: "the safe side: never more drive than before, zero at frame 8, latched",
            run: device::line_lost_under_load,
        },
        Case {
            name: "sensor_invalid_in_mid_wall",
            stimulus: "all lines at zero for 30 ms while a hand rests in a wall (scene `fig15`, rule A)",
            must: "the safe side, which is no wall: never more drive than before, zero at frame 8, latched",
            run: wall::sensor_invalid_in_mid_wall,
        },
    ],
};
