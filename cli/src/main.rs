// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `hapticore` command.
fn main() {}
