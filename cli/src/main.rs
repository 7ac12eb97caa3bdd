// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `hapticore` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    hapticore::main()
}
