// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore hdl`: Verilog from the model.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::Design;
use hapticore_rtl::board::Target;
use hapticore_rtl::board::parameters::Drive;
use hapticore_rtl::board::target::Printed;
use hapticore_rtl::header;
use serde_json::json;

use crate::args::HdlArgs;
use crate::output::Output;
use crate::say;
use hapticore_host::DeviceCalibration;
use hapticore_host::Output as DriveOutput;
use hapticore_run::inputs;

/// The profile where neither it nor a board is named.
const PROFILE: &str = "standard";

/// Prints the core, or a whole board, into the folder.
///
/// # Errors
/// No such profile or board, a board that cannot serve the profile, or a folder that cannot be
/// written.
pub fn run(args: &HdlArgs) -> Result<bool> {
    let board = args.board.as_deref().map(str::parse::<Target>).transpose().context("--board")?;
    let name = board.map_or(PROFILE, Target::profile_name);
    let profile = inputs::profile(args.profile.as_deref().unwrap_or(name))?;
    let device = args.calibration.as_deref().map(DeviceCalibration::read).transpose()?;
    let profile = match device {
        Some(device) => inputs::buildable(device.profile(&profile)?)?,
        None => profile,
    };
    let profile = match args.control.as_deref() {
        Some(law) => with_controller(profile, law)?,
        None => profile,
    };
    let drive = args.dac.as_deref().map(|dac| drive(&profile, dac, args)).transpose()?;
    let printed = board.map(|board| print_board(board, &profile, drive)).transpose()?;
    let options = format!("--dac {} --wave {}", args.dac.as_deref().unwrap_or(""), args.wave);
    let pins = drive.filter(|_| board.is_none());
    let clock_hz = args.clock_hz;
    let pins =
        pins.map(|of| header::drive_output(&profile, of.wave, of.converter, clock_hz, &options));
    let pins = pins.transpose().context("--dac")?;
    let output = Output::new(&args.out)?;
    let top = match (board, printed) {
        (Some(board), Some(printed)) => write_board(&output, (board, drive.is_some()), &printed)?,
        _ => write_core(&output, &profile)?,
    };
    pins.iter().try_for_each(|design| write_modules(&output, design))?;
    let told = drive.map(|drive| drive.output(board.map_or(args.clock_hz, Target::clock_hz)));
    print_result(args, &profile, (&top, told), &output.keep()?)
}

/// What the converter has to be, and what a host has to expect.
fn print_drive(output: &DriveOutput) {
    say!("converter: {}", output.dac.advice());
    say!(
        "output: {output}; zero volts are code 0; a pin per channel has the polarity (docs/boards.md)"
    );
}

/// The profile with a controller of a law.
fn with_controller(profile: Profile, name: &str) -> Result<Profile> {
    let law = Law::ALL.into_iter().find(|law| law.name() == name);
    let law = law.with_context(|| {
        let names = Law::ALL.map(Law::name).join(", ");
        format!("--control: expected one of {names}, got \"{name}\"")
    })?;
    let control = Control { law, ..profile.control.clone().unwrap_or(Control::of(&profile, law)) };
    inputs::buildable(Profile { control: Some(control), ..profile })
}

/// What drives the pads of a profile's force loop.
fn drive(profile: &Profile, dac: &str, args: &HdlArgs) -> Result<Drive> {
    let (wave, converter) = (args.wave.parse().context("--wave")?, dac.parse().context("--dac")?);
    ensure!(profile.control.is_some(), "--dac: expected a force controller too: --control LAW");
    Ok(Drive { wave, converter, full_scale_v: args.full_scale_v })
}

/// The core, and what a bench must know of it.
fn write_core(output: &Output, profile: &Profile) -> Result<String> {
    let design = header::design(profile);
    write_modules(output, &design)?;
    output.write(header::NAME, header::of_core(profile, &design))?;
    Ok(design.top().to_owned())
}

/// A file for each module.
fn write_modules(output: &Output, design: &Design) -> Result<()> {
    let mut files = design.modules.iter();
    files.try_for_each(|file| output.write(&format!("{}.v", file.name), &file.text))
}

/// A board with the core of a profile, or its force loop and drive.
fn print_board(board: Target, profile: &Profile, drive: Option<Drive>) -> Result<Printed> {
    let converts = drive.is_some() || profile.control.is_none();
    ensure!(
        converts,
        "--board: expected a converter for the controller's drives too: --dac ad5664r"
    );
    let of = || format!("board {}, profile {}", board.name(), profile.name);
    board.printed(profile, drive).with_context(of)
}

/// A board: its Verilog, its constraints, and the script that makes its bitstream.
fn write_board(
    output: &Output,
    (board, drives): (Target, bool),
    printed: &Printed,
) -> Result<String> {
    let (name, constraints) = &printed.constraints;
    output.write("top.v", &printed.verilog)?;
    output.write(name, constraints)?;
    output.write_script("build.sh", &script(board, drives))?;
    Ok("top".to_owned())
}

/// The script of a board's bitstream. A force loop is slower than the core alone; twice the board's clock is left.
fn script(board: Target, drives: bool) -> String {
    let script = match board {
        Target::Ulx3s => include_str!("../../synth/scripts/ulx3s.sh"),
        Target::Icebreaker => include_str!("../../synth/scripts/icebreaker.sh"),
    };
    if drives { script.replace("--freq 100", "--freq 50") } else { script.to_owned() }
}

fn print_result(
    args: &HdlArgs,
    profile: &Profile,
    (top, output): (&str, Option<DriveOutput>),
    files: &[PathBuf],
) -> Result<bool> {
    if args.json {
        let told = json!({
            "profile": profile.name,
            "board": args.board,
            "top": top,
            "output": output.map(|output| output.to_string()),
            "converter": output.map(|output| output.dac.advice()),
            "files": files,
        });
        say!("{}", serde_json::to_string_pretty(&told)?);
        return Ok(true);
    }
    say!("{}: top {top}, {} files in {}", profile.name, files.len(), args.out.display());
    if args.board.is_some() {
        say!("bitstream: {}", args.out.join("build.sh").display());
    }
    output.iter().for_each(print_drive);
    Ok(true)
}
