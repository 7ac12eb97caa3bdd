// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore live`: a scene and the core in a browser, in real time.

use std::process::{Command, Stdio};

use anyhow::{Result, ensure};
use hapticore_live::protocol::{Opening, SPEEDS};
use hapticore_live::server::{Config, Server};
use hapticore_run::interrupt;

use crate::args::LiveArgs;
use crate::{console, say};

/// Serves the scene until Ctrl-C.
///
/// # Errors
/// A scene that cannot be run, a port in use, an address without a token.
pub fn run(args: &LiveArgs) -> Result<bool> {
    let [least, most] = SPEEDS;
    let within = args.speed == 0.0 || (least..=most).contains(&args.speed);
    ensure!(within, "--speed: expected 0, or {least} to {most}, got {}", args.speed);
    let listen = args.listen.zip(args.token.clone());
    let opening = Opening {
        scene: args.scene.clone(),
        set: args.set.clone(),
        case: args.case.clone(),
        profile: args.profile.clone(),
        core: Some(hapticore_run::engine::Fidelity::from(args.core).name().into()),
    };
    let server = Server::bind(Config { opening, port: args.port, listen, speed: args.speed })?;
    let url = server.url();
    say!("{url}");
    console::flush();
    console::complain(format_args!("Ctrl-C ends it."));
    if args.open {
        open(&url);
    }
    server.run(&|| interrupt::check().is_err())?;
    Ok(true)
}

/// Opens the page in the browser of the desktop.
pub(crate) fn open(url: &str) {
    let (program, before): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    let quiet = command.args(before).arg(url).stdout(Stdio::null()).stderr(Stdio::null());
    if quiet.spawn().is_err() {
        console::warn(&format!("--open: {program} is not there; open {url} yourself"));
    }
}
