// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore host`: a board, real or virtual, from its start-up to rows, a page, or its wiring checked.

use std::fs;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail, ensure};
use hapticore_board::check::{RealTime, check};
use hapticore_board::source::Board;
use hapticore_board::target::{Asked, Target, target};
use hapticore_board::virtual_line::{serve_standard, serve_tcp};
use hapticore_host::link::Phase;
use hapticore_live::protocol::{Command, Frames};
use hapticore_live::server::Server;
use hapticore_live::source::Source;
use hapticore_run::interrupt;
use hapticore_scene::gallery;

use crate::args::HostArgs;
use crate::{console, live, say};

/// How often the line is looked at.
const PAUSE: Duration = Duration::from_millis(3);
/// How often the state is printed.
const STATE: Duration = Duration::from_secs(1);
/// A board that is not brought up within this time is given up, where the command ends by itself.
const PATIENCE: Duration = Duration::from_secs(30);

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
    ensure!(
        !args.arm || found.plan.output.is_some(),
        "--arm: expected a board with a drive: a virtual one of a scene with [control], or --control and --dac"
    );
    let mut board = Board::new(found, &args.port);
    if let Some(file) = output(args)? {
        board = board.with_csv(file).context("CSV")?;
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

/// Where rows go.
fn output(args: &HostArgs) -> Result<Option<Box<dyn Write + Send>>> {
    if args.csv.is_some() {
        return Ok(Some(Box::new(BufWriter::new(io::stdout()))));
    }
    let Some(path) = &args.record else { return Ok(None) };
    let file = fs::File::create(path).with_context(|| format!("--record: {}", path.display()))?;
    Ok(Some(Box::new(BufWriter::new(file))))
}

/// Ports of this machine, and scenes of virtual boards.
fn list() {
    let ports = ports();
    if ports.is_empty() {
        say!("no serial port found");
    }
    ports.iter().for_each(|port| say!("{port}"));
    let scenes: Vec<_> = gallery::all().iter().map(|(name, _)| *name).collect();
    say!("virtual:SCENE, a simulated board, with SCENE one of {}", scenes.join(", "));
}

/// Paths of serial ports, those with names of devices first.
fn ports() -> Vec<String> {
    let of = |folder: &str, begins: &[&str]| {
        let entries = fs::read_dir(Path::new(folder)).into_iter().flatten().flatten();
        let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
        let named = names.filter(|name| begins.iter().any(|begin| name.starts_with(begin)));
        let mut paths: Vec<_> = named.map(|name| format!("{folder}/{name}")).collect();
        paths.sort();
        paths
    };
    let mut ports = of("/dev/serial/by-id", &[""]);
    ports.extend(of("/dev", &["ttyUSB", "ttyACM", "cu.usb"]));
    ports
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

/// Checks the wiring; whether nothing was found.
fn check_wiring(found: Target) -> Result<bool> {
    let device = found.device.clone();
    let stop = || interrupt::check().is_err();
    let ask = |what: &str| {
        say!("{what}, then press Enter");
        console::flush();
        let mut line = String::new();
        let read = io::stdin().read_line(&mut line).context("standard input")?;
        ensure!(read > 0, "standard input has ended");
        Ok(())
    };
    let tell = |text: &str| {
        say!("{text}");
        console::flush();
    };
    let mut bench = RealTime::new(found, ask, tell, &stop);
    let report = check(&mut bench, &device)?;
    report.compared.iter().for_each(|compared| say!("{compared}"));
    report.findings.iter().for_each(|finding| say!("found: {finding}"));
    if report.is_sound() {
        say!("nothing is wrong: data lines, wires and pads are as the calibration expects");
    }
    Ok(report.is_sound())
}

/// A board with what the command line wants of it.
struct Watched<'a> {
    board: Board,
    args: &'a HostArgs,
    begun: Instant,
    measuring_since: Option<Instant>,
    wants_arm: bool,
    printed: Instant,
}

impl<'a> Watched<'a> {
    fn new(board: Board, args: &'a HostArgs) -> Self {
        let now = Instant::now();
        Watched {
            board,
            args,
            begun: now,
            measuring_since: None,
            wants_arm: args.arm,
            printed: now,
        }
    }

    /// Runs without a page.
    fn run(&mut self, quiet: bool) -> Result<bool> {
        loop {
            while self.step()? {}
            if let Some(outcome) = self.outcome() {
                self.print_state();
                return Ok(outcome);
            }
            if !quiet && self.printed.elapsed() > STATE {
                self.printed = Instant::now();
                self.print_state();
            }
            thread::sleep(PAUSE);
        }
    }

    /// A step of the board; whether more has happened already.
    fn step(&mut self) -> Result<bool> {
        let step = self.board.advance().map_err(anyhow::Error::msg)?;
        if let Some(note) = &step.note {
            console::complain(format_args!("{note}"));
        }
        if let Some(event) = &step.event {
            console::complain(format_args!(
                "{:.2} s: pad {}: {}",
                event.time_s, event.pad, event.what
            ));
        }
        if let Some(why) = self.board.csv_error() {
            // A reader that has gone wants no more.
            ensure!(self.args.csv.is_some(), "--record: {why}");
            bail!("standard output: {why}");
        }
        let is_measuring = matches!(self.board.phase(), Phase::Measuring | Phase::Armed);
        if is_measuring && self.measuring_since.is_none() {
            self.measuring_since = Some(Instant::now());
        }
        if self.wants_arm && self.board.phase() == Phase::Measuring {
            self.arm()?;
        }
        Ok(step.more)
    }

    fn arm(&mut self) -> Result<()> {
        self.wants_arm = false;
        self.board.apply(&Command::Arm { on: true }).map_err(|why| anyhow!("--arm: {why}"))?;
        for (pad, newtons) in &self.args.target {
            self.board.set_target(*pad, *newtons).map_err(|why| anyhow!("--target: {why}"))?;
        }
        console::complain(format_args!("armed: the drive follows its targets; Ctrl-C ends it"));
        Ok(())
    }

    /// Whether it is over, and how.
    fn outcome(&self) -> Option<bool> {
        if interrupt::check().is_err() {
            return Some(self.measuring_since.is_some());
        }
        let seconds = Duration::from_secs_f64(self.args.seconds?);
        match self.measuring_since {
            Some(since) => (since.elapsed() >= seconds).then_some(true),
            None => (self.begun.elapsed() >= PATIENCE.max(seconds)).then_some(false),
        }
    }

    /// A line with state, losses and pads, on standard error where rows go to standard output.
    fn print_state(&self) {
        let counts = self.board.statistics();
        let pads: Vec<_> = pads(&self.board.frames());
        let line = format!(
            "{}: {} frames, {} lost, {} dropped, {} damaged{}{}",
            self.board.phase().word(),
            counts.frames,
            counts.lost,
            counts.dropped,
            counts.damaged,
            if pads.is_empty() { "" } else { "; " },
            pads.join("; ")
        );
        match self.args.csv {
            Some(_) => console::complain(format_args!("{line}")),
            None => {
                say!("{line}");
                console::flush();
            }
        }
    }
}

/// Each pad in words.
fn pads(frames: &Frames) -> Vec<String> {
    let value = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "–".to_string(), |value| format!("{value:.digits$}"))
    };
    let words = |row: &hapticore_live::protocol::PadRow| {
        format!(
            "pad {} {} at {}, {} mm, {} pF, {} N",
            row.pad,
            row.state.word(),
            value(row.x_mm, 1),
            value(row.y_mm, 1),
            value(row.capacitance_pf, 0),
            value(row.force_n, 3)
        )
    };
    frames.pads.iter().map(words).collect()
}

/// Serves the page, with a token that nobody guesses.
fn page(mut watched: Watched, args: &HostArgs) -> Result<bool> {
    if args.arm {
        // The page has not asked for it.
        bail!("--arm: expected no --page: arm the drive on the page");
    }
    for (pad, newtons) in &args.target {
        watched.board.set_target(*pad, *newtons).map_err(|why| anyhow!("--target: {why}"))?;
    }
    let server = Server::of_board(Box::new(watched.board), args.page_port, None, token())?;
    let url = server.url();
    say!("{url}");
    console::flush();
    console::complain(format_args!(
        "Ctrl-C ends it and disables the board; Escape on the page disables it."
    ));
    if args.open {
        live::open(&url);
    }
    let (begun, seconds) = (Instant::now(), args.seconds.map(Duration::from_secs_f64));
    server.run(&|| {
        interrupt::check().is_err() || seconds.is_some_and(|seconds| begun.elapsed() > seconds)
    })?;
    Ok(true)
}

/// 128 bits of the keys with which the standard library's hash tables are seeded by the system.
fn token() -> String {
    let number = |_| RandomState::new().build_hasher().finish();
    [0, 1].map(number).map(|number| format!("{number:016x}")).concat()
}
