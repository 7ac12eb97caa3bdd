// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks: pure functions from (registers, inputs) to (next registers, outputs), and the cells that hold their registers.
//!
//! A block is configuration: formats, counts, tables. What changes from clock to clock lies in its [`Cell`], one per
//! instance and reading. A block calls another by [`Block::call`]; the netlist reading turns that into an instance.

use crate::bundle::Bundle;
use crate::format::Format;
use crate::memory::Memory;
use crate::probe::Variable;
use crate::signal::{Signal, Value};

/// The inputs of a block, each field a `T`.
pub type Inputs<B, T> = <<B as Block>::Inputs as Bundle>::Of<T>;
/// The outputs of a block, each field a `T`.
pub type Outputs<B, T> = <<B as Block>::Outputs as Bundle>::Of<T>;
/// The registers of a block, each field a `T`.
pub type Registers<B, T> = <<B as Block>::Registers as Bundle>::Of<T>;

/// A block of the core.
pub trait Block: Sized + 'static {
    /// Its name: of the Verilog module, too.
    const NAME: &'static str;
    /// Whether its registers take zero at reset in hardware. Where they do not, what they hold before their first operands
    /// matters to nobody.
    const RESETS: bool = true;
    /// Its input ports.
    type Inputs: Bundle;
    /// Its output ports.
    type Outputs: Bundle;
    /// Its registers, zero at reset.
    type Registers: Bundle;
    /// The blocks and memories within it.
    type Parts<V: Value>: Parts<Self, V>;

    /// The formats of the input ports.
    fn inputs(&self) -> Inputs<Self, Format>;
    /// The formats of the output ports.
    fn outputs(&self) -> Outputs<Self, Format>;
    /// The formats of the registers.
    fn registers(&self) -> Registers<Self, Format>;

    /// One clock: reads the cell's registers and the inputs, gives the outputs, and replaces the registers.
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, inputs: Inputs<Self, Signal<V>>) -> Outputs<Self, Signal<V>>;

    /// A cell in its state at reset.
    fn cell<V: Value>(&self) -> Cell<Self, V> {
        let registers = Self::Registers::map(self.registers(), |format| V::literal(0.0, format));
        Cell { registers, parts: Self::Parts::fresh(self) }
    }

    /// One clock of the instance `name` within another block.
    #[inline(always)]
    fn call<V: Value>(
        &self,
        name: &'static str,
        cell: &mut Cell<Self, V>,
        inputs: Inputs<Self, Signal<V>>,
    ) -> Outputs<Self, Signal<V>> {
        V::instance(self, name, cell, inputs)
    }
}

/// The state of one instance of a block in one reading.
pub struct Cell<B: Block, V: Value> {
    /// What the registers hold.
    pub registers: Registers<B, V>,
    /// The states of the blocks and memories within.
    pub parts: B::Parts<V>,
}

impl<B: Block, V: Value> Clone for Cell<B, V> {
    fn clone(&self) -> Self {
        Cell { registers: self.registers, parts: self.parts.clone() }
    }
}

impl<B: Block, V: Value> Cell<B, V> {
    /// The registers as signals.
    #[inline(always)]
    pub fn load(&self, block: &B) -> Registers<B, Signal<V>> {
        let with_formats = B::Registers::zip(self.registers, block.registers());
        B::Registers::map(with_formats, |(value, format)| Signal { value, format })
    }

    /// Replaces the registers.
    ///
    /// # Panics
    /// In debug builds and elaborating readings, where a register's format does not hold that of its signal.
    #[inline(always)]
    pub fn store(&mut self, block: &B, next: Registers<B, Signal<V>>) {
        self.registers = widen::<B::Registers, V>(B::NAME, next, block.registers());
    }
}

/// The values of signals in the formats declared for them, which must hold theirs.
#[inline(always)]
pub fn widen<S: Bundle, V: Value>(block: &str, signals: S::Of<Signal<V>>, formats: S::Of<Format>) -> S::Of<V> {
    if V::ELABORATES || cfg!(debug_assertions) {
        check_formats::<S, V>(block, signals, formats);
    }
    S::map(S::zip(signals, formats), |(signal, format)| {
        if signal.format.frac == format.frac && !V::ELABORATES {
            signal.value
        } else {
            V::fit(signal, format, crate::signal::Exact, crate::signal::Never)
        }
    })
}

fn check_formats<S: Bundle, V: Value>(block: &str, signals: S::Of<Signal<V>>, formats: S::Of<Format>) {
    S::each(S::zip(signals, formats), |name, (signal, format)| {
        let given = signal.format;
        assert!(format.holds(given), "{block}.{name} is declared {format}, which does not hold every {given}");
    });
}

/// The states of the blocks and memories within a block. Made by [`parts!`](crate::parts!).
pub trait Parts<B, V: Value>: Clone {
    /// The states at reset.
    fn fresh(block: &B) -> Self;
    /// Shows a visitor each block within.
    fn visit(&self, block: &B, visitor: &mut impl Visitor<V>);
}

/// Someone who looks at every register of a hierarchy.
pub trait Visitor<V: Value> {
    /// An instance begins.
    fn enter(&mut self, name: &'static str);
    /// A register of it.
    fn register(&mut self, name: &'static str, states: &'static [&'static str], format: Format, value: V);
    /// A memory of it.
    fn memory(&mut self, _memory: &Memory, _words: &V::Words) {}
    /// The instance ends.
    fn leave(&mut self);
}

/// What a block is made of: other blocks, and memories.
pub trait Element {
    /// Its state in a reading.
    type State<V: Value>: Clone;
    /// Its state at reset.
    fn fresh<V: Value>(&self) -> Self::State<V>;
    /// Shows a visitor what is in it.
    fn visit<V: Value>(&self, name: &'static str, state: &Self::State<V>, visitor: &mut impl Visitor<V>);
}

impl<B: Block> Element for B {
    type State<V: Value> = Cell<B, V>;

    fn fresh<V: Value>(&self) -> Cell<B, V> {
        self.cell()
    }

    fn visit<V: Value>(&self, name: &'static str, cell: &Cell<B, V>, visitor: &mut impl Visitor<V>) {
        visitor.enter(name);
        let mut states = B::Registers::STATES.iter();
        B::Registers::each(B::Registers::zip(self.registers(), cell.registers), |name, (format, value)| {
            visitor.register(name, states.next().expect("as many as fields"), format, value);
        });
        cell.parts.visit(self, visitor);
        visitor.leave();
    }
}

impl Element for Memory {
    type State<V: Value> = V::Words;

    fn fresh<V: Value>(&self) -> V::Words {
        V::words(self)
    }

    fn visit<V: Value>(&self, _name: &'static str, words: &V::Words, visitor: &mut impl Visitor<V>) {
        visitor.memory(self, words);
    }
}

/// A block with no block or memory within.
impl<B, V: Value> Parts<B, V> for () {
    fn fresh(_block: &B) -> Self {}
    fn visit(&self, _block: &B, _visitor: &mut impl Visitor<V>) {}
}

/// Declares the [`Parts`] of a block: for each a field of the same name in the block's configuration.
#[macro_export]
macro_rules! parts {
    ($(#[$meta:meta])* $vis:vis struct $name:ident of $block:ty {
        $($(#[$part_meta:meta])* $part:ident: $element:ty),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Clone)]
        $vis struct $name<V: $crate::signal::Value> {
            $($(#[$part_meta])* #[allow(missing_docs)] pub $part: <$element as $crate::block::Element>::State<V>,)*
        }

        impl<V: $crate::signal::Value> $crate::block::Parts<$block, V> for $name<V> {
            fn fresh(block: &$block) -> Self {
                $name { $($part: <$element as $crate::block::Element>::fresh::<V>(&block.$part)),* }
            }

            fn visit(&self, block: &$block, visitor: &mut impl $crate::block::Visitor<V>) {
                $(<$element as $crate::block::Element>::visit::<V>(&block.$part, stringify!($part), &self.$part, visitor);)*
            }
        }
    };
}

/// The variables of a block and all within it, the block itself being the scope `name`.
pub fn variables<B: Block>(block: &B, name: &'static str) -> Vec<Variable> {
    struct Names {
        scope: Vec<String>,
        found: Vec<Variable>,
    }
    impl Visitor<i64> for Names {
        fn enter(&mut self, name: &'static str) {
            self.scope.push(name.into());
        }
        fn register(&mut self, name: &'static str, states: &'static [&'static str], format: Format, _value: i64) {
            self.found.push(Variable { scope: self.scope.clone(), name: name.into(), format, states });
        }
        fn leave(&mut self) {
            self.scope.pop();
        }
    }
    let mut names = Names { scope: Vec::new(), found: Vec::new() };
    block.visit(name, &block.cell(), &mut names);
    names.found
}

/// Appends what the registers of a block and of all within it hold, in the order of [`variables`].
pub fn sample<B: Block, V: Value>(block: &B, cell: &Cell<B, V>, into: &mut Vec<V>) {
    struct Codes<'a, V>(&'a mut Vec<V>);
    impl<V: Value> Visitor<V> for Codes<'_, V> {
        fn enter(&mut self, _name: &'static str) {}
        fn register(&mut self, _: &'static str, _: &'static [&'static str], _: Format, value: V) {
            self.0.push(value);
        }
        fn leave(&mut self) {}
    }
    block.visit("", cell, &mut Codes(into));
}
