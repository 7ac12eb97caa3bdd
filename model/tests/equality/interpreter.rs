// SPDX-License-Identifier: MIT OR Apache-2.0
//! An interpreter of netlists: what the captured graph does, clock by clock, with arithmetic of its
//! own.
//!
//! Codes are `i128`, so that no word is short of bits; a wire that leaves its format fails
//! immediately.

use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::netlist::{Module, Named, Netlist, Node, Op, Ram};
use hapticore_hdl::signal::{Overflow, Rounding};

/// What a module holds.
#[derive(Debug, Clone)]
pub struct State {
    registers: Vec<i128>,
    memories: Vec<(Vec<i128>, i128)>,
    instances: Vec<State>,
}

impl State {
    /// A module at reset.
    pub fn new(netlist: &Netlist, module: &Module) -> State {
        let words = |ram: &Ram| (ram.initial.iter().map(|&code| code.into()).collect(), 0);
        State {
            registers: vec![0; module.registers.len()],
            memories: module.memories.iter().map(words).collect(),
            instances: module
                .instances
                .iter()
                .map(|i| State::new(netlist, &netlist.modules[i.module]))
                .collect(),
        }
    }

    /// One clock: inputs to outputs, in the order of the ports.
    pub fn clock(&mut self, netlist: &Netlist, module: &Module, inputs: &[i128]) -> Vec<i128> {
        let mut wires: Vec<i128> = Vec::with_capacity(module.wires.len());
        let mut instances: Vec<Option<Vec<i128>>> = vec![None; module.instances.len()];
        for wire in &module.wires {
            let code = match wire.op {
                Op::Input(port) => inputs[port],
                Op::Register(index) => self.registers[index],
                Op::Data(index) => self.memories[index].1,
                Op::Output(index, port) => {
                    let instance = &module.instances[index];
                    let run = || {
                        let inputs: Vec<i128> =
                            instance.inputs.iter().map(|node| wires[node.0 as usize]).collect();
                        self.instances[index].clock(
                            netlist,
                            &netlist.modules[instance.module],
                            &inputs,
                        )
                    };
                    instances[index].get_or_insert_with(run)[port]
                }
                ref op => evaluate(op, wire.format, &|node| {
                    (wires[node.0 as usize], module.wires[node.0 as usize].format)
                }),
            };
            assert!(
                holds(wire.format, code),
                "{}: {:?} gives {code}, beyond {}",
                module.name,
                wire.op,
                wire.format
            );
            wires.push(code);
        }
        assert!(
            instances.iter().all(Option::is_some),
            "{}: every instance has an output",
            module.name
        );
        self.advance(module, &wires);
        module.outputs.iter().map(|port| wires[port.node.0 as usize]).collect()
    }

    /// The end of a clock: registers and memories take what is there.
    fn advance(&mut self, module: &Module, wires: &[i128]) {
        let wire = |node: Node| wires[node.0 as usize];
        for (register, Named { node, .. }) in self.registers.iter_mut().zip(&module.registers) {
            *register = wire(*node);
        }
        for ((words, data), ram) in self.memories.iter_mut().zip(&module.memories) {
            if let Some(address) = ram.address {
                *data = words.get(wire(address) as usize).copied().unwrap_or(0);
            }
            if let Some((enable, address, word)) = ram.write
                && wire(enable) != 0
            {
                words[wire(address) as usize] = wire(word);
            }
        }
    }

    /// Every register by its path, in no particular order.
    pub fn registers(
        &self,
        netlist: &Netlist,
        module: &Module,
        path: &str,
        into: &mut Vec<(String, i128)>,
    ) {
        let own = module.registers.iter().zip(&self.registers);
        into.extend(own.map(|(named, &code)| (format!("{path}.{}", named.name), code)));
        for (instance, state) in module.instances.iter().zip(&self.instances) {
            let path = format!("{path}.{}", instance.name);
            state.registers(netlist, &netlist.modules[instance.module], &path, into);
        }
    }
}

/// Whether a format holds a code.
fn holds(format: Format, code: i128) -> bool {
    let bits = format.width - u8::from(format.signed);
    (if format.signed { -(1i128 << bits) } else { 0 }..1i128 << bits).contains(&code)
}

/// A code of a signal over a finer point.
fn over(code: i128, format: Format, frac: i8) -> i128 {
    code << (i32::from(frac) - i32::from(format.frac))
}

fn evaluate(op: &Op, to: Format, of: &dyn Fn(Node) -> (i128, Format)) -> i128 {
    let aligned = |a: Node, b: Node| {
        let ((a, a_format), (b, b_format)) = (of(a), of(b));
        let frac = a_format.frac.max(b_format.frac);
        (over(a, a_format, frac), over(b, b_format, frac))
    };
    let at_point = |node: Node| {
        let (code, format) = of(node);
        over(code, format, to.frac)
    };
    match *op {
        Op::Constant(code) => code.into(),
        Op::Add(a, b) => at_point(a) + at_point(b),
        Op::Sub(a, b) => at_point(a) - at_point(b),
        Op::Mul(a, b) => of(a).0 * of(b).0,
        Op::Abs(a) => of(a).0.abs(),
        Op::Scale(a) => of(a).0,
        Op::Fit(a, rounding, overflow) => fit(of(a), to, rounding, overflow),
        Op::Bits(a, low) => (of(a).0 >> low) & ((1 << to.width) - 1),
        Op::Concat(a, b) => of(a).0 << of(b).1.width | of(b).0,
        Op::Less(a, b) => (aligned(a, b).0 < aligned(a, b).1).into(),
        Op::Equal(a, b) => (aligned(a, b).0 == aligned(a, b).1).into(),
        Op::And(a, b) => of(a).0 & of(b).0,
        Op::Or(a, b) => of(a).0 | of(b).0,
        Op::Not(a) => 1 - of(a).0,
        Op::Select(bit, a, b) => at_point(if of(bit).0 != 0 { a } else { b }),
        Op::Input(_) | Op::Register(_) | Op::Data(_) | Op::Output(..) => {
            unreachable!("known to the module")
        }
    }
}

/// The code in another format. A narrowing that cannot overflow keeps the low bits, as its wire
/// does; it may overflow where the wire is unused (an operation that is not in progress).
fn fit((code, from): (i128, Format), to: Format, rounding: Rounding, overflow: Overflow) -> i128 {
    let drop = i32::from(from.frac) - i32::from(to.frac);
    let rounded = match rounding {
        _ if drop <= 0 => code << -drop,
        Rounding::HalfEven => half_even(code, 1 << drop),
        _ => code.div_euclid(1 << drop),
    };
    let bits = to.width - u8::from(to.signed);
    let (low, high) = (if to.signed { -(1i128 << bits) } else { 0 }, (1i128 << bits) - 1);
    match overflow {
        Overflow::Saturate => rounded.clamp(low, high),
        _ => (rounded - low).rem_euclid(1 << to.width) + low,
    }
}

fn half_even(code: i128, unit: i128) -> i128 {
    let (floor, rest) = (code.div_euclid(unit), code.rem_euclid(unit));
    let up = 2 * rest > unit || (2 * rest == unit && floor % 2 != 0);
    floor + i128::from(up)
}
