// SPDX-License-Identifier: MIT OR Apache-2.0
//! A workload in the clocked model.

use std::time::Instant;

use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::core::{Core, Inputs, Observer, Outputs};
use hapticore_model::blocks::estimator::{self, FramePort, PromptPort};
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

/// Every output of each clock.
struct Sum {
    sum: u64,
    /// By how many bits each output is moved; by as many as there are, where it is absent.
    moved: Outputs<u32>,
    /// The share of what the estimator holds.
    held: u64,
}

impl Sum {
    fn new(core: &Core) -> Sum {
        let mut index = 0;
        let moved = Outputs::map(core.outputs(), |format| {
            let present = !format.is_none();
            index += usize::from(present);
            if present { moved(index - 1) } else { u64::BITS }
        });
        Sum { sum: 0, moved, held: 0 }
    }

    #[inline(always)]
    fn add(&mut self, share: u64) {
        self.sum = self.sum.rotate_left(ROTATED).wrapping_add(share);
    }
}

impl Observer for Sum {
    #[inline(always)]
    fn outputs(&mut self, outputs: Outputs<Signal<i64>>) {
        let mut all = 0u64;
        Outputs::map(Outputs::zip(outputs, self.moved), |(output, moved)| {
            all = all.wrapping_add(share(output, moved));
        });
        self.add(all);
    }

    fn holds(&mut self, estimator: &estimator::Outputs<Signal<i64>>) {
        let mut held = 0u64;
        let mut add = |(output, moved)| held = held.wrapping_add(share(output, moved));
        FramePort::map(FramePort::zip(estimator.frames, self.moved.frames), &mut add);
        PromptPort::map(PromptPort::zip(estimator.prompt, self.moved.prompt), &mut add);
        self.held = held;
    }

    #[inline(always)]
    fn without_results(&mut self, outputs: Outputs<Signal<i64>>) {
        let Outputs { channel, serve, closed, carrier, overrun, .. } = outputs;
        let moved = self.moved;
        let changing = [
            share(channel, moved.channel),
            share(serve, moved.serve),
            share(closed, moved.closed),
            share(carrier, moved.carrier),
            share(overrun, moved.overrun),
        ];
        self.add(changing.into_iter().fold(self.held, u64::wrapping_add));
    }
}

#[inline(always)]
fn share(output: Signal<i64>, moved: u32) -> u64 {
    (output.value as u64).checked_shl(moved).unwrap_or(0)
}

fn signals(core: &Core, codes: Inputs<i64>) -> Inputs<Signal<i64>> {
    Inputs::map(Inputs::zip(codes, core.inputs()), |(value, format)| Signal { value, format })
}
