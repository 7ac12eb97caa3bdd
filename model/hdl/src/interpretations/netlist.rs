// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist interpretation: a value is a node of a graph, and a block within a block is an
//! instance of a module.
//!
//! [`Netlist::of`] elaborates a block once, checking every format on the way, and gives its
//! modules, instances before the modules that hold them. Blocks of the same configuration share one
//! module.

pub mod mutants;
pub mod simulation;
mod start;

use crate::block::{Block, Inputs, Interpretation, Outputs, State, widen};
use crate::bundle::{Bundle, Field};
use crate::format::{BIT, Format, MAX_WIDTH};
use crate::memory::{Collision, Memory, Storage, Write};
use crate::signal::{Overflow, Rounding, Signal, Value};
use std::cell::RefCell;
use std::collections::HashMap;

/// The value of the netlist interpretation: a wire of the module being read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Node(pub u32);

/// What drives a wire.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Op {
    /// A constant code.
    Constant(i64),
    /// The input port of this index.
    Input(usize),
    /// The register of this index.
    Register(usize),
    /// The read register of the memory of this index.
    Data(usize),
    /// The output port of an instance: their indices.
    Output(usize, usize),
    /// Exact sum.
    Add(Node, Node),
    /// Exact difference.
    Sub(Node, Node),
    /// Exact product.
    Mul(Node, Node),
    /// Absolute value; takes the most negative code.
    Abs(Node),
    /// A change of format.
    Fit(Node, Rounding, Overflow),
    /// The same bits with the point moved.
    Scale(Node),
    /// Bits from this one up.
    Bits(Node, u8),
    /// Two words side by side.
    Concat(Node, Node),
    /// Whether the first is less.
    Less(Node, Node),
    /// Whether they are equal.
    Equal(Node, Node),
    /// Bitwise AND.
    And(Node, Node),
    /// Bitwise OR.
    Or(Node, Node),
    /// Bitwise NOT of one bit.
    Not(Node),
    /// The second where the first is set, else the third.
    Select(Node, Node, Node),
}

impl Op {
    /// The wires that it takes.
    pub fn operands(&self) -> Vec<Node> {
        let mut operands = Vec::new();
        self.with_operands(|node| {
            operands.push(node);
            node
        });
        operands
    }

    /// The same operation of other wires.
    pub fn with_operands(&self, mut of: impl FnMut(Node) -> Node) -> Op {
        match *self {
            Op::Add(a, b) => Op::Add(of(a), of(b)),
            Op::Sub(a, b) => Op::Sub(of(a), of(b)),
            Op::Mul(a, b) => Op::Mul(of(a), of(b)),
            Op::Abs(a) => Op::Abs(of(a)),
            Op::Fit(a, rounding, overflow) => Op::Fit(of(a), rounding, overflow),
            Op::Scale(a) => Op::Scale(of(a)),
            Op::Bits(a, low) => Op::Bits(of(a), low),
            Op::Concat(a, b) => Op::Concat(of(a), of(b)),
            Op::Less(a, b) => Op::Less(of(a), of(b)),
            Op::Equal(a, b) => Op::Equal(of(a), of(b)),
            Op::And(a, b) => Op::And(of(a), of(b)),
            Op::Or(a, b) => Op::Or(of(a), of(b)),
            Op::Not(a) => Op::Not(of(a)),
            Op::Select(bit, a, b) => Op::Select(of(bit), of(a), of(b)),
            Op::Constant(_) | Op::Input(_) | Op::Register(_) | Op::Data(_) | Op::Output(..) => {
                self.clone()
            }
        }
    }
}

/// A wire of a module.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Wire {
    /// The operation that drives the node.
    pub op: Op,
    /// The format in which its bits are read.
    pub format: Format,
    /// Its name, where the block gave it one.
    pub name: Option<&'static str>,
}

/// A port or register by name.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Named {
    /// Its name in the bundle.
    pub name: &'static str,
    /// The format in which its bits are read.
    pub format: Format,
    /// The names of its codes, where it is a state.
    pub states: &'static [&'static str],
    /// What its declaration says of it.
    pub about: &'static str,
    /// What drives it: an output, or what a register takes next. An input's own node.
    pub node: Node,
}

/// A memory of a module.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Ram {
    /// Its name among the submodules of its block.
    pub name: &'static str,
    /// The format of a word.
    pub format: Format,
    /// What a word reads as that is written in the same cycle.
    pub collision: Collision,
    /// Whether it shall be a block RAM however small.
    pub block: bool,
    /// The words at reset.
    pub initial: Vec<i64>,
    /// What its read port asks for.
    pub address: Option<Node>,
    /// Enable, address and data of its write port.
    pub write: Option<(Node, Node, Node)>,
}

/// A block within a module.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Instance {
    /// Name in Verilog and waveforms.
    pub name: &'static str,
    /// The index of its module.
    pub module: usize,
    /// What drives its inputs, in their order.
    pub inputs: Vec<Node>,
}

/// A block, read as a netlist.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Module {
    /// The name of the block.
    pub name: &'static str,
    /// The path of its type in the model.
    pub path: &'static str,
    /// Its input ports.
    pub inputs: Vec<Named>,
    /// Its output ports.
    pub outputs: Vec<Named>,
    /// Whether its registers take zero at reset.
    pub resets: bool,
    /// Registers of the module.
    pub registers: Vec<Named>,
    /// Memories of the module.
    pub memories: Vec<Ram>,
    /// Instances of other modules.
    pub instances: Vec<Instance>,
    /// Its wires; each depends only on wires before it, on registers and on ports.
    pub wires: Vec<Wire>,
    /// Bits that the block claims to be set at every clock, by name. No output depends on them.
    pub invariants: Vec<(&'static str, Node)>,
    /// A bit, and the input ports that a caller leaves as they were in the clock before where it is
    /// set.
    pub held: Option<(Node, Vec<usize>)>,
}

/// A design: its modules, the top one last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Netlist {
    /// Every module, after those that it instantiates.
    pub modules: Vec<Module>,
}

/// A module while its block is read.
#[derive(Default)]
struct Open {
    module: Module,
    known: HashMap<(Op, Format), Node>,
}

#[derive(Default)]
struct Reader {
    open: Vec<Open>,
    done: Vec<Module>,
}

thread_local! {
    static READER: RefCell<Reader> = RefCell::default();
}

fn with_module<T>(f: impl FnOnce(&mut Open) -> T) -> T {
    READER.with_borrow_mut(|reader| f(reader.open.last_mut().expect("a netlist is being read")))
}

/// A wire; the one that is there already where it is the same.
fn wire(op: Op, format: Format) -> Node {
    assert!(format.width <= MAX_WIDTH, "{format} is wider than {MAX_WIDTH} bits");
    with_module(|open| {
        *open.known.entry((op.clone(), format)).or_insert_with(|| {
            open.module.wires.push(Wire { op, format, name: None });
            Node(open.module.wires.len() as u32 - 1)
        })
    })
}

/// The code of a wire that a profile has settled.
fn settled(node: Node) -> Option<i64> {
    with_module(|open| match open.module.wires[node.0 as usize].op {
        Op::Constant(code) => Some(code),
        _ => None,
    })
}

/// The least and the largest code that a signal may have, over a point. Linters refuse an order that these decide.
fn range(signal: Signal<Node>, frac: i8) -> [i128; 2] {
    let Signal { value, format } = signal;
    let ends = [format.min_code(), format.max_code()];
    settled(value).map_or(ends, |code| [code.into(); 2]).map(|code| code << (frac - format.frac))
}

fn ports<S: Bundle>(formats: S::Of<Format>, op: impl Fn(usize) -> Op) -> (S::Of<Node>, Vec<Named>) {
    let mut index = 0;
    let nodes = S::map(formats, |format| {
        if format.is_none() {
            return wire(Op::Constant(0), format);
        }
        index += 1;
        wire(op(index - 1), format)
    });
    (nodes, named::<S>(nodes, formats))
}

fn named<S: Bundle>(nodes: S::Of<Node>, formats: S::Of<Format>) -> Vec<Named> {
    let mut all = Vec::new();
    S::each(S::zip(nodes, formats), |&Field { name, states, doc }, (node, format)| {
        if !format.is_none() {
            all.push(Named { name, format, states, about: doc.trim(), node });
        }
    });
    all
}

/// Reads a block into a module, and gives its index.
fn read<B: Block>(block: &B, state: &mut State<B, Node>) -> usize {
    READER.with_borrow_mut(|reader| reader.open.push(Open::default()));
    let (inputs, input_ports) = ports::<B::Inputs>(block.inputs(), Op::Input);
    let (registers, _) = ports::<B::Registers>(block.registers(), Op::Register);
    state.registers = registers;
    let signals = B::Inputs::map(B::Inputs::zip(inputs, block.inputs()), |(value, format)| {
        Signal { value, format }
    });
    let outputs = widen::<B::Outputs, Node>(B::NAME, block.clock(state, signals), block.outputs());
    let before =
        B::Registers::map(B::Registers::zip(registers, block.registers()), |(value, format)| {
            Signal { value, format }
        });
    let claims = block.claims(before, signals);
    READER.with_borrow_mut(|reader| {
        let mut module = reader.open.pop().expect("opened above").module;
        module.name = B::NAME;
        module.resets = B::RESETS;
        module.path = std::any::type_name::<B>();
        module.invariants =
            claims.invariants.iter().map(|&(name, bit)| (name, bit.value)).collect();
        module.held = claims.held.map(|held| {
            let port = |name: &&str| input_ports.iter().position(|port| port.name == *name);
            let ports = held.inputs.iter().map(|name| port(name).expect("a held input is a port"));
            (held.when.value, ports.collect())
        });
        module.inputs = input_ports;
        module.outputs = named::<B::Outputs>(outputs, block.outputs());
        module.registers = named::<B::Registers>(state.registers, block.registers());
        let known = reader.done.iter().position(|done| *done == module);
        known.unwrap_or_else(|| {
            reader.done.push(module);
            reader.done.len() - 1
        })
    })
}

impl Netlist {
    /// Elaborates a block.
    ///
    /// # Panics
    /// Where a width is beyond [`MAX_WIDTH`], or a register, port or memory is given what its
    /// format does not hold.
    pub fn of<B: Block>(block: &B) -> Netlist {
        READER.with_borrow_mut(|reader| *reader = Reader::default());
        // The state's own constants need a module to lie in; they are replaced by registers as each
        // block is read.
        READER.with_borrow_mut(|reader| reader.open.push(Open::default()));
        read(block, &mut block.reset());
        READER.with_borrow_mut(|reader| Netlist { modules: std::mem::take(reader).done })
    }

    /// The module of the block itself.
    pub fn top(&self) -> &Module {
        self.modules.last().expect("a design has a module")
    }
}

impl Value for Node {
    const ELABORATES: bool = true;

    fn literal(real: f64, format: Format) -> Self {
        wire(Op::Constant(format.code_saturating(real)), format)
    }

    fn add(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        wire(Op::Add(a.value, b.value), to)
    }

    fn sub(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        wire(Op::Sub(a.value, b.value), to)
    }

    fn mul(a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        wire(Op::Mul(a.value, b.value), to)
    }

    fn abs(a: Signal<Self>, to: Format) -> Self {
        wire(Op::Abs(a.value), to)
    }

    #[inline(never)]
    fn quantize(a: Signal<Self>, to: Format, rounding: Rounding, overflow: Overflow) -> Self {
        if a.format == to { a.value } else { wire(Op::Fit(a.value, rounding, overflow), to) }
    }

    fn scale(a: Self, by: i8) -> Self {
        let format = with_module(|open| open.module.wires[a.0 as usize].format);
        wire(Op::Scale(a), Format { frac: format.frac - by, ..format })
    }

    fn bits(a: Signal<Self>, low: u8, to: Format) -> Self {
        wire(Op::Bits(a.value, low), to)
    }

    fn concat(high: Signal<Self>, low: Signal<Self>, to: Format) -> Self {
        wire(Op::Concat(high.value, low.value), to)
    }

    fn less(a: Signal<Self>, b: Signal<Self>) -> Self {
        let frac = a.format.frac.max(b.format.frac);
        let [[least_a, most_a], [least_b, most_b]] = [a, b].map(|signal| range(signal, frac));
        if least_a >= most_b {
            return wire(Op::Constant(0), BIT);
        }
        if most_a < least_b {
            return wire(Op::Constant(1), BIT);
        }
        wire(Op::Less(a.value, b.value), BIT)
    }

    fn equal(a: Signal<Self>, b: Signal<Self>) -> Self {
        wire(Op::Equal(a.value, b.value), BIT)
    }

    fn and(a: Self, b: Self) -> Self {
        match (settled(a), settled(b)) {
            (Some(0), _) | (_, Some(1)) => a,
            (Some(_), _) | (_, Some(_)) => b,
            _ => wire(Op::And(a, b), BIT),
        }
    }

    fn or(a: Self, b: Self) -> Self {
        match (settled(a), settled(b)) {
            (Some(1), _) | (_, Some(0)) => a,
            (Some(_), _) | (_, Some(_)) => b,
            _ => wire(Op::Or(a, b), BIT),
        }
    }

    fn not(a: Self) -> Self {
        if let Some(code) = settled(a) {
            return wire(Op::Constant(1 - code), BIT);
        }
        wire(Op::Not(a), BIT)
    }

    fn select(bit: Self, a: Signal<Self>, b: Signal<Self>, to: Format) -> Self {
        if let Some(code) = settled(bit) {
            return Self::quantize(
                if code == 1 { a } else { b },
                to,
                Rounding::Exact,
                Overflow::Proved,
            );
        }
        if to.is_none() || (a.value == b.value && a.format == b.format) {
            return Self::quantize(a, to, Rounding::Exact, Overflow::Proved);
        }
        wire(Op::Select(bit, a.value, b.value), to)
    }

    fn code(_a: Signal<Self>) -> i64 {
        unreachable!("a wire has no code before the circuit runs")
    }

    fn known_bit(_bit: Self) -> Option<bool> {
        None
    }
}

impl Storage for Node {
    type Words = Option<usize>;

    fn words(_memory: &Memory) -> Option<usize> {
        None
    }

    fn data(memory: &Memory, words: &mut Option<usize>) -> Self {
        wire(Op::Data(ram(memory, words)), memory.format)
    }

    fn access(
        memory: &Memory,
        words: &mut Option<usize>,
        address: Signal<Self>,
        write: Option<Write<Self>>,
    ) {
        let index = ram(memory, words);
        let write = write.map(|write| {
            let data = write.data.resize(memory.format, Overflow::Proved);
            (write.enable.value, write.address.value, data.value)
        });
        with_module(|open| {
            let ram = &mut open.module.memories[index];
            assert!(
                ram.address.is_none(),
                "{} has one read port, and is accessed once a clock",
                memory.name
            );
            ram.address = Some(address.value);
            ram.write = write;
        });
    }
}

impl Interpretation for Node {
    fn instance<B: Block>(
        block: &B,
        name: &'static str,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        let driven = widen::<B::Inputs, Node>(B::NAME, inputs, block.inputs());
        let mut inputs = Vec::new();
        B::Inputs::each(B::Inputs::zip(driven, block.inputs()), |_, (node, format)| {
            inputs.extend((!format.is_none()).then_some(node));
        });
        let module = read(block, state);
        let index = with_module(|open| {
            open.module.instances.push(Instance { name, module, inputs });
            open.module.instances.len() - 1
        });
        let (nodes, _) = ports::<B::Outputs>(block.outputs(), |port| Op::Output(index, port));
        B::Outputs::map(B::Outputs::zip(nodes, block.outputs()), |(value, format)| Signal {
            value,
            format,
        })
    }

    fn name(a: Signal<Self>, name: &'static str) -> Signal<Self> {
        with_module(|open| {
            open.module.wires[a.value.0 as usize].name.get_or_insert(name);
        });
        a
    }
}

/// The index of a memory in the module being read, which it joins when first asked for.
fn ram(memory: &Memory, index: &mut Option<usize>) -> usize {
    *index.get_or_insert_with(|| {
        with_module(|open| {
            let &Memory { name, format, collision, block, .. } = memory;
            let initial = memory.codes();
            open.module.memories.push(Ram {
                name,
                format,
                collision,
                block,
                initial,
                address: None,
                write: None,
            });
            open.module.memories.len() - 1
        })
    })
}

#[cfg(test)]
mod tests;
