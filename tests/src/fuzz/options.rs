// SPDX-License-Identifier: MIT OR Apache-2.0
//! Words of a command line, one a line: the parser, and the readers of what options hold. Nothing is run.

use std::io::Cursor;

use anyhow::Result;
use clap::Parser;
use hapticore::args::{Args, Command, HdlArgs, ReplayArgs, SimulateArgs, SweepStep};
use hapticore_contract::format::Format;
use hapticore_rtl::board;
use hapticore_rtl::board::drive_output::{Converter, Wave};
use hapticore_run::capture::{self, Adc, Content, Described, Input};
use hapticore_scene::{Scene, gallery};
use hapticore_sweep::work::Chunk;
use hapticore_tradeoff::target::Target;

pub(super) fn check(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    let Ok(args) = Args::try_parse_from(std::iter::once("hapticore").chain(text.lines())) else {
        return false;
    };
    let read = match args.command {
        Command::Simulate(args) => simulate(&args),
        Command::Replay(args) => replay(&args),
        Command::Hdl(args) => hdl(&args),
        Command::Tradeoff(args) => target(args.target.as_deref()),
        Command::Sweep(args) => match args.step {
            Some(SweepStep::Run { line, .. }) => chunk(&line),
            _ => Ok(()),
        },
        Command::Reference(args) => {
            args.key.as_deref().map(hapticore::reference::markdown).transpose().map(drop)
        }
        // No option of theirs has a reader of its own.
        Command::Scenes(_)
        | Command::New(_)
        | Command::Codes(_)
        | Command::Calibrate(_)
        | Command::Live(_)
        | Command::Host(_) => Ok(()),
    };
    read.inspect_err(|error| {
        let line = hapticore::one_line(error);
        assert!(
            !line.is_empty() && !line.chars().any(char::is_control),
            "more than a line: {line:?}"
        );
    })
    .is_ok()
}

/// Keys of a bundled scene. Its cases' documents are scenes again.
fn simulate(args: &SimulateArgs) -> Result<()> {
    let Some(text) = gallery::find(&args.scene) else { return Ok(()) };
    let scene = Scene::parse(text, &args.scene, &args.set)?;
    for case in scene.cases.iter().take(4) {
        let again = Scene::parse(&case.document, &args.scene, &[]);
        let again = again.unwrap_or_else(|error| panic!("{error} of {}", case.document));
        assert_eq!(again.cases[0].document, case.document);
    }
    Ok(())
}

/// What the options say of a capture whose columns have no names, and its first row.
fn replay(args: &ReplayArgs) -> Result<()> {
    const ADC: Adc = Adc { terminals: 3, format: Format { signed: true, width: 18, frac: 17 } };
    const ROWS: &str = "1,2,3,4,5,0\n6,7,8,9,10,1\n";
    let described = Described {
        channels: args.channels.clone(),
        bits: args.bits,
        full_scale_v: args.full_scale_v,
        sample_rate_hz: None,
        truncated: args.truncated,
    };
    let rows = Cursor::new(ROWS.as_bytes().to_vec());
    let input = Input::new(Box::new(rows), "c.csv".into(), Some(ROWS.len() as u64));
    let mut source = capture::read(Content::Csv(input), ADC, &described)?;
    let mut codes = Vec::new();
    source.row(&mut codes)?;
    let range = ADC.format.min_code()..=ADC.format.max_code();
    assert!(codes.iter().all(|code| range.contains(&i128::from(*code))), "{codes:?}");
    Ok(())
}

fn hdl(args: &HdlArgs) -> Result<()> {
    let _ = args.board.as_deref().map(str::parse::<board::Target>).transpose()?;
    let _ = args.dac.as_deref().map(str::parse::<Converter>).transpose()?;
    let _: Wave = args.wave.parse()?;
    Ok(())
}

fn target(text: Option<&str>) -> Result<()> {
    let _ = text.map(str::parse::<Target>).transpose()?;
    Ok(())
}

/// A chunk of a sweep, written again.
fn chunk(line: &str) -> Result<()> {
    let chunk = Chunk::read(line)?;
    let again = Chunk::read(&chunk.text())?;
    assert_eq!(again.text(), chunk.text());
    Ok(())
}
