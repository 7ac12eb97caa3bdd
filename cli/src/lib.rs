// SPDX-License-Identifier: MIT OR Apache-2.0
//! The `hapticore` command as a library, so that tests can run it whole.
//!
//! | module | does |
//! | --- | --- |
//! | [`args`] | the command line |
//! | [`simulate`], [`replay`], [`hdl`], [`codes`](mod@codes), [`lab`], [`scenes`] | one command each |
//! | [`inputs`] | scenes and profiles from names and files |
//! | [`digitiser`] | the one place where fractions of full scale meet codes |
//! | [`calibrate`] | the calibration of a simulated device |
//! | [`engine`] | the core at its three fidelities behind one trait |
//! | [`session`] | slots in, rows out: the core, the reference beside it, rounding errors |
//! | [`case`] | a case of a scene, its samples made while the core works |
//! | [`criteria`] | what a scene claims, measured |
//! | [`capture`] | ADC samples in CSV and WAV files |
//! | [`haptic`] | whether the core's window is long enough for the haptic voltage |
//! | [`record`] | what a run leaves |
//! | [`report`] | the page with the figures |
//! | [`output`], [`print`](mod@print) | the same written into a folder and on the terminal |
//! | [`folder`], [`console`] | which folder; standard output that may be closed |

pub mod args;
pub mod calibrate;
pub mod capture;
pub mod case;
pub mod codes;
pub mod console;
pub mod criteria;
pub mod digitiser;
pub mod engine;
pub mod errors;
pub mod folder;
pub mod haptic;
pub mod hdl;
pub mod inputs;
pub mod interrupt;
pub mod lab;
pub mod output;
pub mod print;
pub mod progress;
pub mod provenance;
pub mod record;
pub mod replay;
pub mod report;
pub mod scenes;
pub mod session;
pub mod simulate;
pub mod waves;

use std::process::ExitCode;

use args::{Args, Command};
use clap::Parser;

/// Runs the command line. The exit code is 0 where all criteria hold, 1 where one fails, 2 on bad input, and 130 where the
/// run was told to stop.
pub fn main() -> ExitCode {
    let args = Args::parse();
    interrupt::listen();
    let outcome = match args.command {
        Command::Scenes(args) => scenes::run(&args),
        Command::Simulate(args) => simulate::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Hdl(args) => hdl::run(&args),
        Command::Codes(args) => codes::run(&args),
        Command::Calibrate(args) => lab::run(&args),
    };
    match outcome.and_then(|holds| console::finish().map(|()| holds)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(_) if interrupt::check().is_err() => {
            console::complain(format_args!("{}", interrupt::Interrupted));
            ExitCode::from(130)
        }
        Err(error) => {
            console::complain(format_args!("error: {}", one_line(&error)));
            ExitCode::from(2)
        }
    }
}

/// The error and its causes, joined by colons.
fn one_line(error: &anyhow::Error) -> String {
    format!("{error:#}").lines().map(str::trim).collect::<Vec<_>>().join(" ")
}
