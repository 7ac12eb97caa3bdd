// SPDX-License-Identifier: MIT OR Apache-2.0
//! What core, reference, host and boards agree on.

pub mod calibration;
pub mod frame;
pub mod profile;
