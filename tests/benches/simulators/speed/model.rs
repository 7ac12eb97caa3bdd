// SPDX-License-Identifier: MIT OR Apache-2.0
//! A workload in the clocked model.

use std::time::Instant;

use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::core::{Core, Inputs, Observer, Outputs};
use hapticore_model::blocks::position::TablePort;

use super::{Lap, ROTATED, Workload, moved};

/// Runs a workload from reset.
pub fn run(core: &Core, workload: &Workload) -> Lap {
    let mut state = core.reset();
    for &(address, word) in &workload.table {
        core.step(
            &mut state,
            signals(core, workload.constants.with_table(TablePort { write: 1, address, word })),
        );
    }
    let start = Instant::now();
    let sum = timed(core, &mut state, workload);
    Lap { seconds: start.elapsed().as_secs_f64(), sum }
}

#[inline(never)]
fn timed(core: &Core, state: &mut State<Core, i64>, workload: &Workload) -> u64 {
    let constants = signals(core, workload.constants);
    let (mut channel, mut sum) = (0, Sum(0));
    for _ in 0..workload.passes {
        core.samples(state, &constants, &workload.samples, &mut channel, &mut sum);
    }
    sum.0
}

/// Every output of each clock.
struct Sum(u64);

impl Observer for Sum {
    #[inline(always)]
    fn outputs(&mut self, outputs: Outputs<Signal<i64>>) {
        self.0 = added(self.0, outputs);
    }
}

fn signals(core: &Core, codes: Inputs<i64>) -> Inputs<Signal<i64>> {
    Inputs::map(Inputs::zip(codes, core.inputs()), |(value, format)| Signal { value, format })
}

#[inline(always)]
fn added(sum: u64, outputs: Outputs<Signal<i64>>) -> u64 {
    let mut sum = sum.rotate_left(ROTATED);
    let mut index = 0;
    Outputs::map(outputs, |output| {
        if output.format.is_none() {
            return;
        }
        sum = sum.wrapping_add((output.value as u64) << moved(index));
        index += 1;
    });
    sum
}
