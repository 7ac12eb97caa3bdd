// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bench on which a block is clocked, and the comparison that tells all when it fails.

use crate::random::Random;
use hapticore_hdl::block::{Block, Inputs, Interpretation, Outputs, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::probe::{Variable, sample, variables};
use hapticore_hdl::signal::Signal;

/// Operations of a test: all of them where code is optimised, a few where it is not.
pub fn operations(all: u64) -> u64 {
    if cfg!(optimised) { all } else { all / 200 }
}

/// A result by the name of its port.
pub type Port = (&'static str, i64);

/// A block under test.
pub struct Bench<B: Block, V: Interpretation = i64> {
    pub block: B,
    pub state: State<B, V>,
    pub clock: u64,
}

impl<B: Block, V: Interpretation> Bench<B, V> {
    /// The block at reset, in some reading.
    pub fn read(block: B) -> Self {
        Bench { state: block.reset(), block, clock: 0 }
    }

    /// Runs one clock and returns the outputs.
    pub fn clock(&mut self, inputs: Inputs<B, i64>) -> Outputs<B, i64> {
        let with_formats = B::Inputs::zip(inputs, self.block.inputs());
        let signals = B::Inputs::map(with_formats, |(code, format)| Signal { value: V::raw(code, format), format });
        self.clock += 1;
        let outputs = self.block.clock(&mut self.state, signals);
        B::Outputs::map(outputs, V::code)
    }

    /// Starts the block, and clocks it until it is done: its outputs, and the clocks it took.
    pub fn operate(&mut self, inputs: Inputs<B, i64>) -> (Outputs<B, i64>, u64) {
        let mut outputs = self.clock(with::<B::Inputs>(inputs, "start", 1));
        let held = with::<B::Inputs>(inputs, "start", 0);
        let begun = self.clock;
        while field::<B::Outputs>(outputs, "done") == 0 {
            assert!(self.clock - begun < 100_000, "{} does not finish\n{}", B::NAME, show::<B::Inputs>(inputs));
            outputs = self.clock(held);
        }
        (outputs, self.clock - begun)
    }

    /// Every register, and what it holds.
    pub fn registers(&self) -> impl Iterator<Item = (Variable, V)> + use<B, V> {
        let mut values = Vec::new();
        sample(&self.block, &self.state, &mut values);
        variables(&self.block, B::NAME).into_iter().zip(values)
    }
}

impl<B: Block> Bench<B> {
    /// The block at reset.
    pub fn new(block: B) -> Self {
        Bench::read(block)
    }

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

/// Random inputs of a block, corners among them.
pub fn cases<B: Block>(block: &B, count: u64, seed: u64) -> impl Iterator<Item = Inputs<B, i64>> + use<B> {
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

/// Every field by name.
pub fn show<S: Bundle>(bundle: S::Of<i64>) -> String {
    let mut text = Vec::new();
    S::each(bundle, |field, code| text.push(format!("{} {code}", field.name)));
    text.join(", ")
}
