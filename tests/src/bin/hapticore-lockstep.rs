// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs the model's traces against Verilog that somebody else has written, or changed.

use std::process::ExitCode;

use hapticore_contract::profile::Profile;
use hapticore_tests::lockstep::Bench;
use hapticore_tests::lockstep::external::{Simulator, check};

const USAGE: &str = "usage: hapticore-lockstep [--icarus] PROFILE FILE.v…\n\
    PROFILE is the name of a bundled profile. The files hold the module `hapticore_PROFILE` with the ports of that profile's core.\n\
    Exit status: 0 every output at every clock is the model's, 1 one is not, 2 bad input.";

/// The simulator, the profile and the Verilog of the arguments.
fn arguments(mut given: Vec<String>) -> Result<(Simulator, String, String), String> {
    let icarus = given.first().is_some_and(|first| first == "--icarus");
    let files = given.split_off(usize::from(icarus));
    let (profile, files) =
        files.split_first().filter(|(_, files)| !files.is_empty()).ok_or(USAGE)?;
    Profile::bundled(profile).map_err(|error| error.to_string())?;
    let read =
        |path: &String| std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"));
    let verilog: Result<String, String> = files.iter().map(read).collect();
    Ok((if icarus { Simulator::Icarus } else { Simulator::Verilator }, profile.clone(), verilog?))
}

fn main() -> ExitCode {
    let (simulator, profile, verilog) = match arguments(std::env::args().skip(1).collect()) {
        Ok(arguments) => arguments,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    match check(&Bench::new(&profile), &verilog, simulator) {
        Ok(clocks) => println!("{profile}: {clocks} clocks equal"),
        Err((stimulus, mismatch)) => {
            println!("{profile}, {stimulus}: {mismatch}");
            return ExitCode::from(1);
        }
    }
    ExitCode::SUCCESS
}
