// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line of `hapticore host`.

use std::path::PathBuf;

use hapticore_board::faults::Request;

use super::{above_zero, key_value};

pub(super) const HOST: &str = "PORT is a serial port (/dev/ttyUSB1), tcp:ADDRESS:PORT, or virtual[:SCENE]: a simulated board in this process.
`hapticore host list` lists ports and scenes. A board's drive is off until it is armed; Ctrl-C disables the board.
docs/first-light.md leads through a first session.

Examples:
  hapticore host virtual --page
  hapticore host virtual:fig9 --target 0=0.2 --arm --seconds 5
  hapticore host /dev/ttyUSB1 --calibration mine.toml --check
  hapticore host tcp:192.168.0.7:4000 --calibration mine.toml --csv - | recorder
  hapticore host virtual:hockey --serve 127.0.0.1:4000

Exit status: 0 done, 1 the board was not brought up or --check has found something, 2 bad input.";

/// Arguments of `host`.
#[derive(Debug, Clone, clap::Args)]
pub struct HostArgs {
    /// list, a serial port, tcp:ADDRESS:PORT, virtual or virtual:SCENE
    #[arg(value_name = "PORT")]
    pub port: String,
    /// The device's calibration [default of a virtual board: its device's]
    #[arg(long, value_name = "FILE")]
    pub calibration: Option<PathBuf>,
    /// The profile that the board was printed for: a bundled name (small, standard, fine, fast) or a TOML file
    /// [default: standard, or the scene's]
    #[arg(long, value_name = "PROFILE")]
    pub profile: Option<String>,
    /// Bits a second of the line [default: 1000000; 3000000 of a virtual board whose frames need more]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1200..=12_000_000))]
    pub baud: Option<u32>,
    /// Set a key of a virtual board's scene: sensor.noise_ppm_rms=40
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set: Vec<(String, String)>,
    /// Break a virtual board: open=3 (the wire of terminal 3), swapped=1,4, pad-missing=2, line-low=5, lost=0.01, clock=1.03
    /// and more, see docs/first-light.md; may be given several times
    #[arg(long, value_name = "FAULT", value_parser = str::parse::<Request>)]
    pub fault: Vec<Request>,
    /// Show the board in a browser, at the printed address with its token
    #[arg(long)]
    pub page: bool,
    /// The port of the page; 0 takes a free one
    #[arg(long, value_name = "PORT", default_value_t = 8092, requires = "page")]
    pub page_port: u16,
    /// Open the page in a browser
    #[arg(long, requires = "page")]
    pub open: bool,
    /// Print rows as CSV to standard output: the columns of frames.csv, without the true ones
    #[arg(long, value_name = "-", value_parser = ["-"])]
    pub csv: Option<String>,
    /// Write rows to a file: CSV, or MCAP with notes of the session where its name ends with .mcap
    #[arg(long, value_name = "FILE", conflicts_with = "csv")]
    pub record: Option<PathBuf>,
    /// The target force of a pad, N, as soon as the drive is armed; may be given several times
    #[arg(long, value_name = "PAD=N", value_parser = target, requires = "arm")]
    pub target: Vec<(usize, f64)>,
    /// Arm the drive as soon as the board measures; a page arms it by its button
    #[arg(long, conflicts_with = "page")]
    pub arm: bool,
    /// Check data lines, wires and pads step by step, the drive off: pads are put where the check asks for them
    #[arg(long, conflicts_with_all = ["page", "csv", "record", "target", "arm", "serve"])]
    pub check: bool,
    /// Correct the calibration by what the board reads of its first pad, which is put at 24 places one after the other,
    /// and write it to a file; the drive stays off
    #[arg(long, value_name = "FILE", conflicts_with_all = ["page", "csv", "record", "target", "arm", "serve", "check"])]
    pub calibrate: Option<PathBuf>,
    /// End after this time of measuring, s
    #[arg(long, value_name = "SECONDS", value_parser = above_zero)]
    pub seconds: Option<f64>,
    /// Offer a virtual board to another program, at a TCP address or on standard input and output
    #[arg(long, value_name = "ADDRESS:PORT|-", conflicts_with_all = ["page", "csv", "record", "target", "arm"])]
    pub serve: Option<String>,
    /// The law of the controller that the board was printed with
    #[arg(long, value_name = "open|proportional|integral|inverse")]
    pub control: Option<String>,
    /// The converter that the board was printed for
    #[arg(long, value_name = "ad5664|ad5664r|ad5668|parallel|pulses")]
    pub dac: Option<String>,
    /// The wave that the board was printed for [default: square]
    #[arg(long, value_name = "dc|square[:SLOTS]|sine:CLOCKS", requires = "dac")]
    pub wave: Option<String>,
    /// The voltage of a drive word of full scale that the board was printed for [default: 500]
    #[arg(long, value_name = "VOLTS", requires = "dac", value_parser = clap::value_parser!(u16).range(1..))]
    pub full_scale_v: Option<u16>,
    /// The tuning of the board's force controller, as simulate writes it; without one the drive cannot be armed
    /// [default of a virtual board: its scene's]
    #[arg(long, value_name = "FILE")]
    pub tuning: Option<PathBuf>,
}

fn target(text: &str) -> Result<(usize, f64), String> {
    let split = text.split_once('=');
    let read = split.and_then(|(pad, n)| Some((pad.trim().parse().ok()?, n.trim().parse().ok()?)));
    read.filter(|(_, newtons): &(usize, f64)| newtons.is_finite())
        .ok_or_else(|| "expected PAD=N, the number of a pad and a force in newtons".into())
}
