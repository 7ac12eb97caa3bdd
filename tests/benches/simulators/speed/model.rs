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
    let (mut channel, mut sum) = (0, Sum::new(core));
    for _ in 0..workload.passes {
        core.samples(state, &constants, &workload.samples, &mut channel, &mut sum);
    }
    sum.sum
}

/// Every output of each clock, as the simulators' program adds them up.
struct Sum {
    sum: u64,
    /// By how many bits each output is moved.
    moved: Outputs<u32>,
}

impl Sum {
    fn new(core: &Core) -> Self {
        let mut present = 0..;
        let moved = Outputs::map(core.outputs(), |format| match format.is_none() {
            true => 0,
            false => moved(present.next().expect("endless")),
        });
        Sum { sum: 0, moved }
    }
}

impl Observer for Sum {
    /// An output that is absent is zero.
    #[inline(always)]
    fn outputs(&mut self, outputs: Outputs<Signal<i64>>) {
        let mut all = 0u64;
        Outputs::map(Outputs::zip(outputs, self.moved), |(output, moved)| {
            all = all.wrapping_add((output.value as u64).wrapping_shl(moved));
        });
        self.sum = self.sum.rotate_left(ROTATED).wrapping_add(all);
    }
}

fn signals(core: &Core, codes: Inputs<i64>) -> Inputs<Signal<i64>> {
    Inputs::map(Inputs::zip(codes, core.inputs()), |(value, format)| Signal { value, format })
}
