// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `hapticore` command as a library, so that tests can run it whole.

pub mod record;
