// SPDX-License-Identifier: MIT OR Apache-2.0
//! Isolation of pads, for all inputs: the netlist that the Verilog is printed from, run on what is
//! known of each signal.
//!
//! Think of two runs of the core that differ in what other pads' slots brought, in any way at all.
//! Of a signal it is known
//!
//! | [`Seen`] | in both runs |
//! | --- | --- |
//! | `Known` | it is this code |
//! | `Same` | it is some code, the same in both |
//! | `Other` | it may differ: something of another pad reaches it |
//!
//! Every operator is followed conservatively, and control never depends on data, so that the
//! schedule stays known. If no word and no flag of a pad's frame is ever `Other`, no other pad can
//! change it. Once a round leaves the same knowledge as the round before, this holds for all rounds
//! to come. Widths play no part: a run takes one pass over the clocks, not one over the codes.

use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::{Module, Netlist, Node, Op};
use hapticore_hdl::signal::{Overflow, Rounding};

/// What is known of a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// A constant code.
    Known(i64),
    /// The same code in both runs.
    Same,
    /// Any code; may differ between the two runs.
    Other,
}

use Seen::{Known, Other, Same};

/// What is known of a module's registers and memories, and of the modules within.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct State {
    registers: Vec<Seen>,
    /// The words of each memory, and its read register.
    memories: Vec<(Vec<Seen>, Seen)>,
    within: Vec<State>,
}

impl Seen {
    /// Either of two, with the choice unknown; `by` is what decides.
    fn either(self, other: Seen, by: Seen) -> Seen {
        match (self, other) {
            (a, b) if a == b && matches!(a, Known(_)) => a,
            _ if by == Other => Other,
            (Other, _) | (_, Other) => Other,
            _ => Same,
        }
    }

    /// What an operator gives that is known only for known operands.
    fn with(self, other: Seen, code: impl FnOnce(i128, i128) -> i128) -> Seen {
        match (self, other) {
            (Known(a), Known(b)) => Known(code(a.into(), b.into()) as i64),
            (Other, _) | (_, Other) => Other,
            _ => Same,
        }
    }

    /// The same number in a format with at least as many fractional bits.
    fn to(self, from: Format, to: Format) -> Seen {
        self.with(Known(0), |code, _| code << i32::from(to.frac - from.frac).max(0))
    }
}

impl State {
    /// After reset. What has none, a read register among it, may hold anything.
    pub fn new(netlist: &Netlist, module: &Module) -> State {
        let memory = |words: &Vec<i64>| (words.iter().map(|&code| Known(code)).collect(), Other);
        State {
            registers: vec![if module.resets { Known(0) } else { Other }; module.registers.len()],
            memories: module.memories.iter().map(|memory_| memory(&memory_.initial)).collect(),
            within: module
                .instances
                .iter()
                .map(|part| State::new(netlist, &netlist.modules[part.module]))
                .collect(),
        }
    }

    /// Makes the same of every word of the memories of a name: what a host has written before.
    pub fn calibrate(&mut self, netlist: &Netlist, module: &Module, owner: &str, memory: &str) {
        for (ram, (words, _)) in module.memories.iter().zip(&mut self.memories) {
            if module.name == owner && ram.name == memory {
                words.fill(Same);
            }
        }
        for (part, state) in module.instances.iter().zip(&mut self.within) {
            state.calibrate(netlist, &netlist.modules[part.module], owner, memory);
        }
    }

    /// A clock: what is known of the outputs, in their order.
    pub fn clock(&mut self, netlist: &Netlist, module: &Module, inputs: &[Seen]) -> Vec<Seen> {
        let mut wires: Vec<Seen> = Vec::with_capacity(module.wires.len());
        let mut of_parts: Vec<Option<Vec<Seen>>> = vec![None; module.instances.len()];
        for wire in &module.wires {
            let seen = match wire.op {
                Op::Input(index) => inputs[index],
                Op::Register(index) => self.registers[index],
                Op::Data(index) => self.memories[index].1,
                Op::Output(index, port) => {
                    let outputs = of_parts[index].get_or_insert_with(|| {
                        let part = &module.instances[index];
                        let within = &netlist.modules[part.module];
                        let given = part.inputs.iter().zip(&within.inputs);
                        let given: Vec<_> = given
                            .map(|(node, port)| {
                                wires[node.0 as usize].to(format(module, *node), port.format)
                            })
                            .collect();
                        self.within[index].clock(netlist, within, &given)
                    });
                    outputs[port]
                }
                ref op => operator(module, op, wire.format, &wires),
            };
            wires.push(seen);
        }
        let at = |node: Node, to: Format| wires[node.0 as usize].to(format(module, node), to);
        let outputs = module.outputs.iter().map(|output| at(output.node, output.format)).collect();
        let next =
            module.registers.iter().map(|register| at(register.node, register.format)).collect();
        for (memory, (words, data)) in module.memories.iter().zip(&mut self.memories) {
            *data = memory.address.map_or(*data, |address| read(words, wires[address.0 as usize]));
            if let Some((enable, address, word)) = memory.write {
                let word = at(word, memory.format);
                write(words, wires[enable.0 as usize], wires[address.0 as usize], word);
            }
        }
        self.registers = next;
        outputs
    }
}

fn format(module: &Module, node: Node) -> Format {
    module.wires[node.0 as usize].format
}

fn read(words: &[Seen], address: Seen) -> Seen {
    match address {
        Known(address) => words.get(address as usize).copied().unwrap_or(Same),
        by => words
            .iter()
            .copied()
            .reduce(|a, b| a.either(b, by))
            .map_or(by, |seen| if by == Other { Other } else { seen }),
    }
}

fn write(words: &mut [Seen], enable: Seen, address: Seen, word: Seen) {
    match (enable, address) {
        (Known(0), _) => (),
        (Known(_), Known(address)) => {
            if let Some(place) = words.get_mut(address as usize) {
                *place = word;
            }
        }
        (enable, address) => {
            let by = if enable == Other || address == Other { Other } else { Same };
            for place in words {
                *place = place.either(word, by);
            }
        }
    }
}

fn truth(bit: bool) -> i128 {
    bit.into()
}

/// The code of a format's width that these bits are.
fn wrapped(code: i128, to: Format) -> i128 {
    let low = code & ((1 << to.width) - 1);
    if to.signed && low >> (to.width - 1) == 1 { low - (1 << to.width) } else { low }
}

fn operator(module: &Module, op: &Op, to: Format, wires: &[Seen]) -> Seen {
    let seen = |node: Node| wires[node.0 as usize];
    // Both with the point of the finer.
    let aligned = |a: Node, b: Node, code: &dyn Fn(i128, i128) -> i128| {
        let (from_a, from_b) = (format(module, a).frac, format(module, b).frac);
        let most = from_a.max(from_b);
        seen(a).with(seen(b), |x, y| {
            code(x << i32::from(most - from_a), y << i32::from(most - from_b))
        })
    };
    match *op {
        Op::Constant(code) => Known(code),
        Op::Add(a, b) => aligned(a, b, &|a, b| a + b),
        Op::Sub(a, b) => aligned(a, b, &|a, b| a - b),
        Op::Mul(a, b) => seen(a).with(seen(b), |a, b| a * b),
        Op::Abs(a) => seen(a).with(Known(0), |a, _| a.abs()),
        Op::Fit(a, rounding, overflow) => fit(seen(a), format(module, a), to, rounding, overflow),
        Op::Scale(a) => seen(a),
        Op::Bits(a, low) => seen(a).with(Known(0), |a, _| wrapped(a >> low, to)),
        Op::Concat(high, low) => {
            let width = format(module, low).width;
            seen(high)
                .with(seen(low), |high, low| wrapped(high << width | low & ((1 << width) - 1), to))
        }
        Op::Less(a, b) => aligned(a, b, &|a, b| truth(a < b)),
        Op::Equal(a, b) => aligned(a, b, &|a, b| truth(a == b)),
        Op::And(a, b) => match (seen(a), seen(b)) {
            (Known(0), _) | (_, Known(0)) => Known(0),
            (a, b) => a.with(b, |a, b| a & b),
        },
        Op::Or(a, b) => match (seen(a), seen(b)) {
            (Known(1), _) | (_, Known(1)) => Known(1),
            (a, b) => a.with(b, |a, b| a | b),
        },
        Op::Not(a) => seen(a).with(Known(0), |a, _| 1 - a),
        Op::Select(bit, a, b) => {
            let (yes, no) = (seen(a).to(format(module, a), to), seen(b).to(format(module, b), to));
            match seen(bit) {
                Known(0) => no,
                Known(_) => yes,
                by => yes.either(no, by),
            }
        }
        Op::Input(_) | Op::Register(_) | Op::Data(_) | Op::Output(..) => {
            unreachable!("sources are the caller's")
        }
    }
}

/// A known code stays known where nothing is rounded; elsewhere only that it is the same in both
/// runs.
fn fit(seen: Seen, from: Format, to: Format, rounding: Rounding, overflow: Overflow) -> Seen {
    let Known(code) = seen else { return seen };
    let shift = i32::from(to.frac - from.frac);
    let code = match (shift >= 0, rounding) {
        (true, _) => i128::from(code) << shift,
        (false, Rounding::Exact | Rounding::Floor) => i128::from(code) >> -shift,
        (false, _) => return Same,
    };
    Known(match overflow {
        Overflow::Saturate => code.clamp(to.min_code(), to.max_code()),
        _ => wrapped(code, to),
    } as i64)
}
