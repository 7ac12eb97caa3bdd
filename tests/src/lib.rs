// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the tests that cross crates share.
//!
//! | module | does |
//! | --- | --- |
//! | [`devices`] | devices drawn at random, and how well a pad is found on them |
//! | [`faults`] | deliberate faults in printed Verilog |
//! | [`force_loop`] | inputs of a force loop from a plant that its drives move |
//! | [`fuzz`](mod@fuzz) | what fuzzing holds of every reader and of the core, and what it begins with |
//! | [`lockstep`] | the model and its Verilog, every output at every clock |
//! | [`peripherals`] | the blocks of a board, each with a trace |
//! | [`reference_error`] | how far the reference's `f64` is from the equations |
//! | [`rivals`] | force controllers of other projects in a loop with this plant |
//! | [`stability`] | hard cases: what must happen, what happens, and the margin |
//! | [`stimulus`] | what a core receives: random and directed input, whole scenes |
//! | [`tools`] | the HDL tools, and the message where one is missing |
//! | [`tracking`] | how a force loop follows its target |
//! | [`walls`] | hands at a wall: the plant in a loop with a rule, and what the hand feels |

pub mod devices;
pub mod faults;
pub mod force_loop;
pub mod fuzz;
pub mod lockstep;
pub mod peripherals;
pub mod reference_error;
pub mod rivals;
pub mod stability;
pub mod stimulus;
pub mod tools;
pub mod tracking;
pub mod walls;
