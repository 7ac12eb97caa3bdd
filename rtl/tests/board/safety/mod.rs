// SPDX-License-Identifier: MIT OR Apache-2.0
//! The drive's safety on the complete board: what may be at a pad in each state, and after what time it is 0 V
//! (docs/safety.md). Names of tests are the table's rows.

mod random;
mod rig;
mod rows;
