// SPDX-License-Identifier: MIT OR Apache-2.0
//! Traces a made-up core into a folder: `cargo run -p hapticore-waveforms --example trace -- DIR`,
//! then `gtkwave DIR/waves.gtkw`, to see what the viewer makes of it.

#[path = "../tests/waveforms/common/mod.rs"]
#[allow(dead_code, reason = "the example uses a part")]
mod common;

use std::path::Path;

use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::view::View;
use hapticore_waveforms::{Error, gtkwave};

fn main() -> Result<(), Error> {
    let folder = std::env::args().nth(1).expect("usage: trace DIR");
    let folder = Path::new(&folder);
    common::trace(folder, Kind::Fst, &common::settings(), 2000);
    let (_, trace) = common::trace(folder, Kind::Vcd, &common::settings(), 2000);
    gtkwave::save(
        &View::bundled("slot")?,
        &trace,
        "waves.vcd",
        &trace.ticks,
        &folder.join("waves.gtkw"),
    )
}
