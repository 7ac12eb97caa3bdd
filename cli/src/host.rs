// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore host`: a board, real or virtual, from its start-up to rows, a page, or its wiring checked.

mod ports;
mod watched;
mod wiring;

use std::fs;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, BufWriter};
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail, ensure};
use hapticore_board::recording::{Csv, Mcap, Recorder};
use hapticore_board::serve::{serve_standard, serve_tcp};
use hapticore_board::source::Board;
use hapticore_board::target::{Asked, Target, target};
use hapticore_live::server::Server;
use hapticore_run::interrupt;

use crate::args::HostArgs;
use crate::{console, live, say};
use ports::list;
use watched::Watched;
use wiring::{calibrate, check_wiring};

/// Runs the command.
///
/// # Errors
/// A port, a file or an option that cannot be used.
pub fn run(args: &HostArgs) -> Result<bool> {
    if args.port == "list" {
        list();
        return Ok(true);
    }
    let found = target(&asked(args))?;
    if let Some(address) = &args.serve {
        return serve(&found, address);
    }
    if args.check {
        return check_wiring(found);
    }
    if let Some(file) = &args.calibrate {
        calibrate(found, file)?;
        return Ok(true);
    }
    ensure!(
        !args.arm || found.plan.output.is_some(),
        "--arm: expected a board with a drive: a virtual one of a scene with [control], or --control and --dac"
    );
    let mut board = Board::new(found, &args.port);
    for (pad, newtons) in &args.target {
        board.check_target(*pad, *newtons).map_err(|why| anyhow!("--target: {why}"))?;
    }
    if let Some(recorder) = recorder(&board, args)? {
        board = board.with_recorder(recorder);
    }
    let mut session = Watched::new(board, args);
    match args.page {
        true => page(session, args),
        false => session.run(args.csv.is_some()),
    }
}

fn asked(args: &HostArgs) -> Asked {
    Asked {
        port: args.port.clone(),
        set: args.set.clone(),
        faults: args.fault.clone(),
        calibration: args.calibration.clone(),
        profile: args.profile.clone(),
        baud: args.baud,
        control: args.control.clone(),
        dac: args.dac.clone(),
        wave: args.wave.clone(),
        full_scale_v: args.full_scale_v,
        tuning: args.tuning.clone(),
    }
}

/// What the board's rows are written to: the end of a file's name says how.
fn recorder(board: &Board, args: &HostArgs) -> Result<Option<Box<dyn Recorder>>> {
    let columns = board.columns();
    if args.csv.is_some() {
        let csv = Csv::new(columns, BufWriter::new(io::stdout())).context("standard output")?;
        return Ok(Some(Box::new(csv)));
    }
    let Some(path) = &args.record else { return Ok(None) };
    let context = || format!("--record: {}", path.display());
    let file = BufWriter::new(fs::File::create(path).with_context(context)?);
    let is_mcap = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("mcap"));
    Ok(Some(match is_mcap {
        true => Box::new(Mcap::new(columns, board.pads(), file).with_context(context)?),
        false => Box::new(Csv::new(columns, file).with_context(context)?),
    }))
}

/// Offers a virtual board to another program.
fn serve(found: &Target, address: &str) -> Result<bool> {
    let Some(running) = &found.running else {
        bail!("--serve: expected virtual or virtual:SCENE");
    };
    let stop = || interrupt::check().is_err();
    console::complain(format_args!("{}; Ctrl-C ends it.", found.described.title));
    match address {
        "-" => serve_standard(running, &stop)?,
        address => serve_tcp(running, address, &stop)?,
    }
    Ok(true)
}

/// Serves the page, with a token that nobody guesses.
fn page(watched: Watched, args: &HostArgs) -> Result<bool> {
    let board = watched.board.with_listener(|note| console::complain(format_args!("{note}")));
    let server = Server::of_board(Box::new(board), args.page_port, None, token())?;
    let url = server.url();
    say!("{url}");
    console::flush();
    console::complain(format_args!(
        "Ctrl-C ends it and disables the board; Escape on the page disables it."
    ));
    if args.open {
        live::open(&url);
    }
    let begun = Instant::now();
    let is_over = |seconds: f64| begun.elapsed().as_secs_f64() > seconds;
    server.run(&|| interrupt::check().is_err() || args.seconds.is_some_and(is_over))?;
    Ok(true)
}

/// 128 bits of the keys with which the standard library's hash tables are seeded by the system.
fn token() -> String {
    let number = |_| RandomState::new().build_hasher().finish();
    [0, 1].map(number).map(|number| format!("{number:016x}")).concat()
}
