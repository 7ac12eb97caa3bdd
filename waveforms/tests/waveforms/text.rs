// SPDX-License-Identifier: MIT OR Apache-2.0
//! Text waveforms of the made-up core.

use crate::common::Fake;
use hapticore_waveforms::text::{History, check};

fn history(clocks: impl IntoIterator<Item = u64>) -> History {
    let mut history = History::of(&Fake { clock: 0 });
    clocks.into_iter().for_each(|clock| history.clock(&Fake { clock }));
    history
}

#[test]
fn bits_states_and_numbers() {
    check(
        &history([0, 1, 49, 50, 99, 248, 249, 250]),
        &["**.state", "core.multiplexer.pad", "**.valid", "core.position.x", "core.force.coarse"],
        0..8,
        "
        clock                   0      1      2      3      4      5      6      7
        core.multiplexer.state  |IDLE                |SETTLE       |READ         |IDLE
        core.multiplexer.pad    |0                                               |1
        core.demodulator.valid  ▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▔▔▔▔▔▔▔▁▁▁▁▁▁▁
        core.position.x         |0                                               |16.828
        core.force.coarse       |-1024                                           |-1016
        ",
    );
}

#[test]
fn a_range_of_clocks() {
    check(
        &history(245..255),
        &["core.demodulator.i", "core.demodulator.valid"],
        3..7,
        "
        clock                   3         4         5         6
        core.demodulator.i      |0.7936001|0.7967999|0        |0.0032001
        core.demodulator.valid  ▁▁▁▁▁▁▁▁▁▁▔▔▔▔▔▔▔▔▔▔▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁▁
        ",
    );
}

#[test]
#[should_panic(expected = "waveforms differ")]
fn another_waveform() {
    check(&history(0..1), &["core.multiplexer.pad"], 0..1, "clock 0");
}

#[test]
#[should_panic(expected = "no signal fits \"core.nothing\"")]
fn a_signal_that_is_not_there() {
    check(&history(0..1), &["core.nothing"], 0..1, "");
}
