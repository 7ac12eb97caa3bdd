// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks: pure functions from (registers, inputs) to (next registers, outputs), and the state of
//! their instances.
//!
//! A block is configuration: formats, counts, tables. What changes from cycle to cycle lies in its
//! [`State`], one per instance and interpretation. [`block!`](crate::block!) declares ports,
//! registers and submodules in one place; the behaviour is [`Block::clock`]. A block uses another
//! by [`call!`](crate::call!), which the netlist turns into an instance.

use crate::bundle::{Bundle, Field};
use crate::claims::Claims;
use crate::format::Format;
use crate::memory::{Memory, Storage};
use crate::signal::{Clocked, Proved, Signal, Value};
use std::marker::PhantomData;
use std::mem::{self, ManuallyDrop};

/// The inputs of a block, each field a `T`.
pub type Inputs<B, T> = <<B as Interface>::Inputs as Bundle>::Of<T>;
/// The outputs of a block, each field a `T`.
pub type Outputs<B, T> = <<B as Interface>::Outputs as Bundle>::Of<T>;
/// The registers of a block, each field a `T`.
pub type Registers<B, T> = <<B as Interface>::Registers as Bundle>::Of<T>;

/// One way to interpret a block: values, memories, instances, names, and when a block may be
/// skipped.
pub trait Interpretation: Storage {
    /// One cycle of a block within another; the netlist makes it an instance of a module.
    ///
    /// In one piece with its caller where speed is asked for. With debug assertions the compiler
    /// decides: a crate whose cores are in one piece takes six times as long to compile.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn instance<B: Block>(
        block: &B,
        _name: &'static str,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        block.clock(state, inputs)
    }

    /// One cycle of a block that is within no other; where values are codes, the block's shared copy.
    #[inline(always)]
    fn step<B: Block>(
        block: &B,
        state: &mut State<B, Self>,
        inputs: Inputs<B, Signal<Self>>,
    ) -> Outputs<B, Signal<Self>> {
        block.clock(state, inputs)
    }

    /// What is done within the instance of a block outside of [`instance`](Self::instance), as where it runs through
    /// its cycles by itself.
    #[inline(always)]
    fn within<T>(_name: &'static str, act: impl FnOnce() -> T) -> T {
        act()
    }

    /// A name for a signal within a block, which the netlist prints.
    #[inline(always)]
    fn name(a: Signal<Self>, _name: &'static str) -> Signal<Self> {
        a
    }

    /// Whether a block may leave this cycle out because `busy` is not set.
    #[inline(always)]
    fn can_skip(_busy: Self) -> bool {
        false
    }
}

impl<V: Interpretation> Signal<V> {
    /// Names the signal in the netlist.
    #[inline(always)]
    pub fn named(self, name: &'static str) -> Self {
        V::name(self, name)
    }

    /// Whether a block may leave this cycle out, this bit (started or busy) not being set.
    #[inline(always)]
    pub fn can_skip(self) -> bool {
        V::can_skip(self.value)
    }
}

/// The declaration of a block: its name, ports, registers and submodules. Made by
/// [`block!`](crate::block!).
pub trait Interface: Sized + 'static {
    /// Its name: of the Verilog module, too.
    const NAME: &'static str;
    /// Whether its registers take zero at reset in hardware. Where they do not, no output depends
    /// on what they hold before their first operands.
    const RESETS: bool = true;
    /// Its input ports.
    type Inputs: Bundle;
    /// Its output ports.
    type Outputs: Bundle;
    /// Its registers, zero at reset.
    type Registers: Bundle;
    /// The states of the blocks and memories within it.
    type Submodules<V: Interpretation>: Submodules<Self, V>;

    /// The formats of the input ports.
    fn inputs(&self) -> Inputs<Self, Format>;
    /// The formats of the output ports.
    fn outputs(&self) -> Outputs<Self, Format>;
    /// The formats of the registers.
    fn registers(&self) -> Registers<Self, Format>;
}

/// A block of hardware.
pub trait Block: Interface {
    /// One cycle: reads the registers and the inputs, gives the outputs, and replaces the
    /// registers.
    fn clock<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        inputs: Inputs<Self, Signal<V>>,
    ) -> Outputs<Self, Signal<V>>;

    /// [`Block::clock`] with codes, for callers that do not need it inlined. A large block has the same out of line, so
    /// that it is compiled once, with its crate:
    ///
    /// ```text
    /// #[inline(never)]
    /// fn step(&self, state: &mut State<Self, Clocked>, inputs: In<Clocked>) -> Out<Clocked> {
    ///     self.clock(state, inputs)
    /// }
    /// ```
    #[inline(always)]
    fn step(
        &self,
        state: &mut State<Self, Clocked>,
        inputs: Inputs<Self, Signal<Clocked>>,
    ) -> Outputs<Self, Signal<Clocked>> {
        self.clock(state, inputs)
    }

    /// What always holds of its registers and inputs, and what its caller keeps to: what a solver
    /// proves, and may use to prove that an `Assumed` narrowing fits. Most blocks claim nothing.
    fn claims<V: Interpretation>(
        &self,
        _registers: Registers<Self, Signal<V>>,
        _inputs: Inputs<Self, Signal<V>>,
    ) -> Claims<V> {
        Claims::default()
    }

    /// The state at reset.
    fn reset<V: Interpretation>(&self) -> State<Self, V> {
        let registers = Self::Registers::map(self.registers(), |format| V::literal(0.0, format));
        State { registers, submodules: Self::Submodules::reset(self) }
    }

    /// One cycle of the instance `name` within another block. See [`call!`](crate::call!).
    #[inline(always)]
    fn call<V: Interpretation>(
        &self,
        name: &'static str,
        state: &mut State<Self, V>,
        inputs: Inputs<Self, Signal<V>>,
    ) -> Outputs<Self, Signal<V>> {
        V::instance(self, name, state, inputs)
    }
}

/// The state of one instance of a block in one interpretation.
pub struct State<B: Interface, V: Interpretation> {
    /// What the registers hold.
    pub registers: Registers<B, V>,
    /// The states of the blocks and memories within.
    pub submodules: B::Submodules<V>,
}

impl<B: Interface, V: Interpretation> Clone for State<B, V> {
    fn clone(&self) -> Self {
        State { registers: self.registers, submodules: self.submodules.clone() }
    }
}

impl<B: Interface, V: Interpretation> State<B, V> {
    /// The registers as signals.
    #[inline(always)]
    pub fn load(&self, block: &B) -> Registers<B, Signal<V>> {
        let with_formats = B::Registers::zip(self.registers, block.registers());
        B::Registers::map(with_formats, |(value, format)| Signal { value, format })
    }

    /// Replaces the registers.
    ///
    /// # Panics
    /// Where blocks are elaborated, and in debug builds without optimisation, where a register's
    /// format cannot represent its signal's.
    #[inline(always)]
    pub fn store(&mut self, block: &B, next: Registers<B, Signal<V>>) {
        self.registers = widen::<B::Registers, V>(B::NAME, next, block.registers());
    }
}

impl<B: Interface> State<B, Clocked> {
    /// The state as a value that the caller clocks many times, until it is [put back](Self::put_back).
    ///
    /// The compiler then keeps registers in those of the processor. Behind a reference it writes each of them into
    /// memory in every clock, for a word that is written into a block's memory might be one of them. A value with a
    /// destructor has an address, and lies in memory, too; so this one has none: where it is not put back, its memories
    /// are lost.
    #[inline(always)]
    pub fn take_out(&mut self) -> ManuallyDrop<Self> {
        ManuallyDrop::new(self.take())
    }

    /// Puts back what has been [taken out](Self::take_out).
    #[inline(always)]
    pub fn put_back(&mut self, own: ManuallyDrop<Self>) {
        mem::forget(mem::replace(self, ManuallyDrop::into_inner(own)));
    }
}

impl<B: Interface, V: Interpretation> State<B, V> {
    /// The state, of which nothing that is used again need be left behind.
    #[inline(always)]
    fn take(&mut self) -> Self {
        State { registers: self.registers, submodules: self.submodules.take() }
    }
}

/// The values of signals in the formats declared for them, which must be able to represent theirs.
#[inline(always)]
pub fn widen<S: Bundle, V: Value>(
    block: &str,
    signals: S::Of<Signal<V>>,
    formats: S::Of<Format>,
) -> S::Of<V> {
    if V::ELABORATES || cfg!(all(debug_assertions, not(optimised))) {
        check_formats::<S, V>(block, signals, formats);
    }
    S::map(S::zip(signals, formats), stored)
}

/// The value of a signal in a register's format.
#[inline(always)]
fn stored<V: Value>((signal, format): (Signal<V>, Format)) -> V {
    if signal.format.frac == format.frac && !V::ELABORATES {
        signal.value
    } else if cfg!(debug_assertions) {
        moved(signal, format)
    } else {
        signal.resize(format, Proved).value
    }
}

/// With checks this is much code for each register: out of line.
#[inline(never)]
fn moved<V: Value>(signal: Signal<V>, format: Format) -> V {
    signal.resize(format, Proved).value
}

fn check_formats<S: Bundle, V: Value>(
    block: &str,
    signals: S::Of<Signal<V>>,
    formats: S::Of<Format>,
) {
    S::each(S::zip(signals, formats), |field, (signal, format)| {
        let (name, given) = (field.name, signal.format);
        assert!(
            format.holds(given),
            "{block}.{name} is declared {format}, which cannot represent every {given}"
        );
    });
}

/// The states of the blocks and memories within a block.
pub trait Submodules<B, V: Interpretation>: Clone {
    /// The states at reset.
    fn reset(block: &B) -> Self;
    /// The states, as [`State::take_out`] takes them.
    fn take(&mut self) -> Self;
    /// Shows a visitor each block within.
    fn visit(&self, block: &B, visitor: &mut impl Visitor<V>);
    /// Lets `edit` change what each block and memory within holds.
    fn edit(&mut self, block: &B, edit: &mut impl Edit<V>);
}

/// The states within a block that has no other block or memory.
#[derive(Clone)]
pub struct NoSubmodules<V>(PhantomData<V>);

impl<B, V: Interpretation> Submodules<B, V> for NoSubmodules<V> {
    fn reset(_block: &B) -> Self {
        NoSubmodules(PhantomData)
    }
    fn take(&mut self) -> Self {
        NoSubmodules(PhantomData)
    }
    fn visit(&self, _block: &B, _visitor: &mut impl Visitor<V>) {}
    fn edit(&mut self, _block: &B, _edit: &mut impl Edit<V>) {}
}

/// What may be within a block: another block, or a memory.
pub trait Submodule {
    /// Its state in an interpretation.
    type State<V: Interpretation>: Clone;
    /// Its state at reset.
    fn reset_state<V: Interpretation>(&self) -> Self::State<V>;
    /// Its state, as [`State::take_out`] takes it.
    fn take_state<V: Interpretation>(state: &mut Self::State<V>) -> Self::State<V>;
    /// Shows a visitor what is in it.
    fn visit<V: Interpretation>(
        &self,
        name: &'static str,
        state: &Self::State<V>,
        visitor: &mut impl Visitor<V>,
    );
    /// Lets `edit` change what it holds.
    fn edit<V: Interpretation>(&self, state: &mut Self::State<V>, edit: &mut impl Edit<V>);
}

impl<B: Block> Submodule for B {
    type State<V: Interpretation> = State<B, V>;

    fn reset_state<V: Interpretation>(&self) -> State<B, V> {
        self.reset()
    }

    #[inline(always)]
    fn take_state<V: Interpretation>(state: &mut State<B, V>) -> State<B, V> {
        state.take()
    }

    fn visit<V: Interpretation>(
        &self,
        name: &'static str,
        state: &State<B, V>,
        visitor: &mut impl Visitor<V>,
    ) {
        visitor.enter(name);
        let registers = B::Registers::zip(self.registers(), state.registers);
        B::Registers::each(registers, |field, (format, value)| {
            if !format.is_none() {
                visitor.register(field, format, value);
            }
        });
        state.submodules.visit(self, visitor);
        visitor.leave();
    }

    fn edit<V: Interpretation>(&self, state: &mut State<B, V>, edit: &mut impl Edit<V>) {
        let registers = B::Registers::zip(self.registers(), state.registers);
        state.registers = B::Registers::map(registers, |(format, value)| {
            if format.is_none() { value } else { edit.word(format, value) }
        });
        state.submodules.edit(self, edit);
    }
}

/// A block or memory that only some configurations have.
impl<S: Submodule> Submodule for Option<S> {
    type State<V: Interpretation> = Option<S::State<V>>;

    fn reset_state<V: Interpretation>(&self) -> Self::State<V> {
        self.as_ref().map(S::reset_state)
    }

    #[inline(always)]
    fn take_state<V: Interpretation>(state: &mut Self::State<V>) -> Self::State<V> {
        state.as_mut().map(S::take_state)
    }

    fn visit<V: Interpretation>(
        &self,
        name: &'static str,
        state: &Self::State<V>,
        visitor: &mut impl Visitor<V>,
    ) {
        if let Some((submodule, state)) = self.as_ref().zip(state.as_ref()) {
            submodule.visit(name, state, visitor);
        }
    }

    fn edit<V: Interpretation>(&self, state: &mut Self::State<V>, edit: &mut impl Edit<V>) {
        if let Some((submodule, state)) = self.as_ref().zip(state.as_mut()) {
            submodule.edit(state, edit);
        }
    }
}

impl Submodule for Memory {
    type State<V: Interpretation> = V::Words;

    fn reset_state<V: Interpretation>(&self) -> V::Words {
        V::words(self)
    }

    #[inline(always)]
    fn take_state<V: Interpretation>(words: &mut V::Words) -> V::Words {
        V::take(words)
    }

    fn visit<V: Interpretation>(
        &self,
        _name: &'static str,
        words: &V::Words,
        visitor: &mut impl Visitor<V>,
    ) {
        visitor.memory(self, words);
    }

    fn edit<V: Interpretation>(&self, words: &mut V::Words, edit: &mut impl Edit<V>) {
        edit.memory(self, words);
    }
}

/// Looks at every register of a hierarchy.
pub trait Visitor<V: Interpretation> {
    /// An instance begins.
    fn enter(&mut self, name: &'static str);
    /// A register of it.
    fn register(&mut self, field: &'static Field, format: Format, value: V);
    /// A memory of it.
    fn memory(&mut self, _memory: &Memory, _words: &V::Words) {}
    /// The instance ends.
    fn leave(&mut self);
}

/// Changes what a hierarchy holds, in the order in which a [`Visitor`] sees it.
pub trait Edit<V: Interpretation> {
    /// What a register shall hold.
    fn word(&mut self, format: Format, value: V) -> V;
    /// The words of a memory, and what it reads.
    fn memory(&mut self, memory: &Memory, words: &mut V::Words);
}

#[cfg(test)]
mod tests;
