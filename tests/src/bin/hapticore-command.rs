// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `hapticore` command, built beside the tests so that they can run it as a process.

use std::process::ExitCode;

fn main() -> ExitCode {
    hapticore::main()
}
