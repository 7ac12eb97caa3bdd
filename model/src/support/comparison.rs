// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random operations of a block: their results and their clocks, and the comparison that prints
//! inputs, results and reference when it fails.

use super::harness::{Bench, operations, show};
use super::random::Random;
use hapticore_hdl::block::{Block, Inputs, Interpretation, Outputs, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::Signal;

/// Operations of a block in a test of random ones, over all profiles.
pub const MILLION: u64 = 1_000_000;

/// Clocks that a block runs in all where its latency is measured, about.
const CLOCKS: u64 = 2_000_000;

/// A result by the name of its port.
pub type Port = (&'static str, i64);

impl<B: Block, V: Interpretation> Bench<B, V> {
    /// Starts the block, and clocks it until it is done: its outputs, and the clocks it took.
    pub fn operate(&mut self, inputs: Inputs<B, i64>) -> (Outputs<B, i64>, u64) {
        let mut outputs = self.clock(with::<B::Inputs>(inputs, "start", 1));
        let held = with::<B::Inputs>(inputs, "start", 0);
        let begun = self.clock;
        while field::<B::Outputs>(outputs, "done") == 0 {
            assert!(
                self.clock - begun < 100_000,
                "{} does not finish\n{}",
                B::NAME,
                show::<B::Inputs>(inputs)
            );
            outputs = self.clock(held);
        }
        (outputs, self.clock - begun)
    }
}

impl<B: Block> Bench<B> {
    /// Holds that every register holds a code of its format.
    pub fn check_registers(&self) {
        for (variable, code) in self.registers() {
            let format = variable.format;
            let within = within(code, format);
            let name = variable.scope.join(".") + "." + &variable.name;
            assert!(within, "clock {}: {name} holds {code}, beyond {format}", self.clock);
        }
    }
}

/// Whether a code is one of a format.
pub fn within(code: i64, format: Format) -> bool {
    let bits = format.width - u8::from(format.signed);
    let low = if format.signed { -(1i64 << bits) } else { 0 };
    (low..=(1i64 << bits) - 1).contains(&code)
}

/// Holds that each operation's results are those of the reference, the ports that it names.
pub fn check<B: Block, const N: usize>(
    bench: &mut Bench<B>,
    cases: impl Iterator<Item = Inputs<B, i64>>,
    reference: impl Fn(&Inputs<B, i64>) -> [Port; N],
) {
    for inputs in cases {
        let (outputs, _) = bench.operate(inputs);
        let expected = reference(&inputs);
        if expected.iter().any(|&(name, code)| field::<B::Outputs>(outputs, name) != code) {
            let (block, clock) = (B::NAME, bench.clock);
            panic!(
                "{block}, clock {clock}\ninputs:    {}\ngot:       {}\nreference: {expected:?}",
                show::<B::Inputs>(inputs),
                show::<B::Outputs>(outputs)
            );
        }
    }
}

/// Holds that a block which starts and finishes takes as many clocks as it says, whatever its
/// operands.
pub fn check_latency<B: Block>(block: B, latency: u64) {
    check_latency_of(block, latency, |inputs| inputs);
}

/// As [`check_latency`], for a block that takes only some operands.
pub fn check_latency_of<B: Block>(
    block: B,
    latency: u64,
    legal: impl Fn(Inputs<B, i64>) -> Inputs<B, i64>,
) {
    let (mut bench, operations) = (Bench::new(block), (CLOCKS / latency).clamp(100, 4000));
    for inputs in cases(&bench.block, operations, 1).map(legal) {
        let (_, clocks) = bench.operate(inputs);
        assert_eq!(clocks, latency, "{}: clocks measured, latency()", B::NAME);
    }
}

/// Holds that a block that runs through its clocks in one call has the results of one that is clocked. `run_on` follows
/// the clock of `start`, and gets its inputs.
pub fn check_run_on<B: Block>(
    [clocked, hurried]: [B; 2],
    legal: impl Fn(Inputs<B, i64>) -> Inputs<B, i64>,
    run_on: impl Fn(&B, &mut State<B, i64>, Inputs<B, Signal<i64>>),
) {
    let [mut clocked, mut hurried] = [clocked, hurried].map(Bench::new);
    for inputs in cases(&clocked.block, CLOCKS / 500, 2).map(legal) {
        let started = with::<B::Inputs>(inputs, "start", 1);
        let with_formats = B::Inputs::zip(started, hurried.block.inputs());
        hurried.clock(started);
        let signals = B::Inputs::map(with_formats, |(value, format)| Signal { value, format });
        run_on(&hurried.block, &mut hurried.state, signals);
        let at_once = hurried.clock(with::<B::Inputs>(inputs, "start", 0));
        let (expected, _) = clocked.operate(inputs);
        assert_eq!(field::<B::Outputs>(at_once, "done"), 1, "{}", B::NAME);
        let [at_once, expected] = [at_once, expected].map(show::<B::Outputs>);
        assert_eq!(at_once, expected, "{} of {}", B::NAME, show::<B::Inputs>(inputs));
    }
}

/// Holds that a start during an operation, or in the clock in which it is done, begins anew: results and clocks are
/// those of the same block that was started once. `after` gives, for the latency, the clocks after which the operation
/// before is left.
pub fn check_restart<B: Block>(
    [mut alone, mut restarted]: [Bench<B>; 2],
    after: impl Fn(u64) -> std::ops::RangeInclusive<u64>,
    legal: impl Fn(Inputs<B, i64>) -> Inputs<B, i64>,
) {
    let mut cases = cases(&alone.block, 2 * MILLION, 4).map(legal);
    let mut next = || cases.next().expect("as many as are asked for");
    let (_, latency) = alone.operate(next());
    for clocks in after(latency) {
        let (before, inputs) = (next(), next());
        restarted.clock(with::<B::Inputs>(before, "start", 1));
        for _ in 1..clocks {
            restarted.clock(with::<B::Inputs>(before, "start", 0));
        }
        restarted.clock(with::<B::Inputs>(inputs, "start", 1));
        let held = with::<B::Inputs>(inputs, "start", 0);
        let outputs: Vec<_> = (0..latency).map(|_| restarted.clock(held)).collect();
        let done = outputs.iter().position(|&out| field::<B::Outputs>(out, "done") == 1);
        assert_eq!(done, Some(latency as usize - 1), "{}: after {clocks} clocks", B::NAME);
        let (expected, _) = alone.operate(inputs);
        let got = show::<B::Outputs>(outputs[latency as usize - 1]);
        assert_eq!(got, show::<B::Outputs>(expected), "{}: after {clocks} clocks", B::NAME);
    }
}

/// Clocks in which a block that nothing has started is watched: more than an operation takes that has begun by itself.
const REST: u64 = 3000;

/// Holds that from reset on every output is zero while the inputs of these names are, whatever the others.
pub fn check_rest<B: Block>(block: B, starts: &[&str]) {
    let mut bench = Bench::new(block);
    let (formats, mut random) = (bench.block.inputs(), Random::new(6));
    for _ in 0..REST {
        let any = B::Inputs::map(formats, |format| random.word(format));
        let inputs = starts.iter().fold(any, |inputs, name| with::<B::Inputs>(inputs, name, 0));
        let outputs = bench.clock(inputs);
        let text = show::<B::Outputs>(outputs);
        B::Outputs::each(outputs, |field, code| {
            assert_eq!(code, 0, "{}.{}, clock {}: {text}", B::NAME, field.name, bench.clock);
        });
    }
}

/// Random inputs of a block, corners among them.
pub fn cases<B: Block>(
    block: &B,
    count: u64,
    seed: u64,
) -> impl Iterator<Item = Inputs<B, i64>> + use<B> {
    let formats = block.inputs();
    let mut random = Random::new(seed);
    (0..operations(count)).map(move |_| B::Inputs::map(formats, |format| random.word(format)))
}

/// The code of the field of a name.
pub fn field<S: Bundle>(bundle: S::Of<i64>, name: &str) -> i64 {
    let wanted = S::FIELDS.iter().position(|field| field.name == name);
    let (mut found, mut index) = (None, 0);
    S::map(bundle, |code| {
        if Some(index) == wanted {
            found = Some(code);
        }
        index += 1;
    });
    found.unwrap_or_else(|| panic!("there is no {name} among {:?}", S::FIELDS))
}

/// The bundle with another code in the field of a name.
fn with<S: Bundle>(bundle: S::Of<i64>, name: &str, code: i64) -> S::Of<i64> {
    let wanted = S::FIELDS.iter().position(|field| field.name == name);
    let mut index = 0;
    S::map(bundle, |before| {
        index += 1;
        if Some(index - 1) == wanted { code } else { before }
    })
}
