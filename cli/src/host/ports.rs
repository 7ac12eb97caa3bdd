// SPDX-License-Identifier: MIT OR Apache-2.0
//! Serial ports of this machine, and scenes of virtual boards.

use std::fs;
use std::path::Path;

use hapticore_scene::gallery;

use crate::say;

/// Ports of this machine, and scenes of virtual boards.
pub(super) fn list() {
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
