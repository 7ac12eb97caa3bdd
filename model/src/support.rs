// SPDX-License-Identifier: MIT OR Apache-2.0
//! What tests of single blocks share; their bench is that of the tests of whole cores
//! (`model/tests/equality/`).

#[path = "../tests/equality/campaign.rs"]
pub mod campaign;
mod comparison;
#[allow(dead_code, reason = "tests of whole cores use the rest")]
#[path = "../tests/equality/device.rs"]
pub mod device;
#[path = "../tests/equality/harness.rs"]
mod harness;
#[path = "../tests/equality/in_place.rs"]
mod in_place;
#[path = "../tests/equality/never_skips.rs"]
pub mod never_skips;
#[path = "../tests/equality/random.rs"]
pub mod random;
#[path = "../tests/equality/tally.rs"]
mod tally;

pub use comparison::{
    MILLION, cases, check, check_latency, check_latency_of, check_rest, check_restart,
    check_run_on, within,
};
pub use harness::{Bench, operations, show};
