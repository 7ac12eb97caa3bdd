// SPDX-License-Identifier: MIT OR Apache-2.0
//! How a block is declared: [`block!`](crate::block!), and [`call!`](crate::call!) for the blocks
//! within.

/// Declares a block: configuration, submodules, ports and registers, each once, with the format
/// beside the name.
///
/// ```
/// use hapticore_hdl::block::{Block, Interface, Interpretation, State};
/// use hapticore_hdl::format::{BIT, Format};
/// use hapticore_hdl::signal::{Proved, Signal, bit, code};
///
/// hapticore_hdl::block! {
///     /// Adds up what comes in.
///     pub struct Accumulator("accumulator") {
///         /// The format of the sum.
///         sum: Format,
///     }
///     submodules {}
///     inputs(accumulator) {
///         /// Adds `sample`.
///         enable: BIT,
///         sample: Format::signed(8, 7),
///     }
///     outputs(accumulator) {
///         sum: accumulator.sum,
///     }
///     registers(accumulator) {
///         sum: accumulator.sum,
///     }
/// }
///
/// impl Block for Accumulator {
///     fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
///         let r = state.load(self);
///         let sum = (r.sum + i.sample).resize(self.sum, hapticore_hdl::signal::Wrap);
///         state.store(self, Registers { sum: i.enable.select(sum, r.sum) });
///         Outputs { sum: r.sum }
///     }
/// }
///
/// let block = Accumulator { sum: Format::signed(12, 7) };
/// let mut state = block.reset::<i64>();
/// for _ in 0..3 {
///     block.clock(&mut state, Inputs { enable: bit(true), sample: code(-100, Format::signed(8, 7)) });
/// }
/// assert_eq!(state.registers.sum, -300);
/// ```
///
/// The formats in `inputs(accumulator) { … }` are expressions in which `accumulator` is the block.
/// A register that holds the state of a state machine is written `step in Step`, with
/// [`States`](crate::states::States); a bundle within is written `group as Group: formats`.
/// `struct Name("module", reset: false)` says that registers have no reset in hardware. The macro
/// declares the configuration, the bundles `Inputs`, `Outputs` and `Registers`, their signals
/// `In<V>`, `Out<V>` and `Regs<V>`, and `Submodules`: one block per Rust module.
#[macro_export]
macro_rules! block {
    (
        $(#[doc = $about:literal])*
        $vis:vis struct $name:ident($module:literal $(, reset: $resets:literal)?) {
            $($(#[$config_meta:meta])* $config_vis:vis $config:ident: $config_type:ty),* $(,)?
        }
        submodules {
            $($(#[doc = $part_doc:literal])* $part_vis:vis $part:ident: $part_type:ty),* $(,)?
        }
        inputs($in_self:ident) {
            $($(#[doc = $in_doc:literal])* $in:ident $(in $in_states:ident)? $(as $in_group:ident)? $(: $in_format:expr)?),* $(,)?
        }
        outputs($out_self:ident) {
            $($(#[doc = $out_doc:literal])* $out:ident $(in $out_states:ident)? $(as $out_group:ident)? $(: $out_format:expr)?),* $(,)?
        }
        registers($reg_self:ident) {
            $($(#[doc = $reg_doc:literal])* $reg:ident $(in $reg_states:ident)? $(as $reg_group:ident)? $(: $reg_format:expr)?),* $(,)?
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone)]
        $vis struct $name {
            $($(#[$config_meta])* $config_vis $config: $config_type,)*
            $($(#[doc = $part_doc])* $part_vis $part: $part_type,)*
        }

        $crate::bundle! {
            /// The input ports.
            pub struct Inputs { $($(#[doc = $in_doc])* $in $(in $in_states)? $(as $in_group)?),* }
        }
        $crate::bundle! {
            /// The output ports.
            pub struct Outputs { $($(#[doc = $out_doc])* $out $(in $out_states)? $(as $out_group)?),* }
        }
        $crate::bundle! {
            /// Registers: the state of one instance.
            pub struct Registers { $($(#[doc = $reg_doc])* $reg $(in $reg_states)? $(as $reg_group)?),* }
        }
        /// The input ports as signals.
        #[allow(dead_code)]
        pub type In<V> = Inputs<$crate::signal::Signal<V>>;
        /// The output ports as signals.
        #[allow(dead_code)]
        pub type Out<V> = Outputs<$crate::signal::Signal<V>>;
        /// The registers as signals.
        #[allow(dead_code)]
        pub type Regs<V> = Registers<$crate::signal::Signal<V>>;
        $crate::block!(@submodules $name { $($part: $part_type),* });

        impl $name {
            /// The formats of the input ports.
            #[inline(always)]
            pub fn inputs(&self) -> Inputs<$crate::format::Format> {
                #[allow(unused_variables)]
                let $in_self = self;
                $crate::block!(@formats Inputs { $($in $(in $in_states)? $(: $in_format)?),* })
            }

            /// The formats of the output ports.
            #[inline(always)]
            pub fn outputs(&self) -> Outputs<$crate::format::Format> {
                #[allow(unused_variables)]
                let $out_self = self;
                $crate::block!(@formats Outputs { $($out $(in $out_states)? $(: $out_format)?),* })
            }

            /// The formats of the registers.
            #[inline(always)]
            pub fn registers(&self) -> Registers<$crate::format::Format> {
                #[allow(unused_variables)]
                let $reg_self = self;
                $crate::block!(@formats Registers { $($reg $(in $reg_states)? $(: $reg_format)?),* })
            }
        }

        impl $crate::block::Interface for $name {
            const NAME: &'static str = $module;
            $(const RESETS: bool = $resets;)?
            type Inputs = Inputs;
            type Outputs = Outputs;
            type Registers = Registers;
            type Submodules<V: $crate::block::Interpretation> = Submodules<V>;

            #[inline(always)]
            fn inputs(&self) -> Inputs<$crate::format::Format> {
                self.inputs()
            }

            #[inline(always)]
            fn outputs(&self) -> Outputs<$crate::format::Format> {
                self.outputs()
            }

            #[inline(always)]
            fn registers(&self) -> Registers<$crate::format::Format> {
                self.registers()
            }
        }
    };
    (@formats $bundle:ident {}) => { $bundle::default() };
    (@formats $bundle:ident { $($field:ident $(in $states:ident)? $(: $format:expr)?),* }) => {
        $bundle { $($field: $crate::block!(@format $($states)? $(: $format)?)),* }
    };
    (@format $states:ident) => { <$states as $crate::states::States>::FORMAT };
    (@format $states:ident : $format:expr) => { $format };
    (@format : $format:expr) => { $format };
    (@submodules $name:ident {}) => {
        /// There is no block or memory within.
        pub type Submodules<V> = $crate::block::NoSubmodules<V>;
    };
    (@submodules $name:ident { $($part:ident: $part_type:ty),* }) => {
        /// The states of the blocks and memories within.
        #[derive(Clone)]
        pub struct Submodules<V: $crate::block::Interpretation> {
            $(#[allow(missing_docs)] pub $part: <$part_type as $crate::block::Submodule>::State<V>,)*
        }

        impl<V: $crate::block::Interpretation> $crate::block::Submodules<$name, V> for Submodules<V> {
            fn reset(block: &$name) -> Self {
                Submodules { $($part: <$part_type as $crate::block::Submodule>::reset_state::<V>(&block.$part)),* }
            }

            #[inline(always)]
            fn take(&mut self) -> Self {
                Submodules { $($part: <$part_type as $crate::block::Submodule>::take_state::<V>(&mut self.$part)),* }
            }

            fn visit(&self, block: &$name, visitor: &mut impl $crate::block::Visitor<V>) {
                $(<$part_type as $crate::block::Submodule>::visit::<V>(&block.$part, stringify!($part), &self.$part, visitor);)*
            }

            fn edit(&mut self, block: &$name, edit: &mut impl $crate::block::Edit<V>) {
                $(<$part_type as $crate::block::Submodule>::edit::<V>(&block.$part, &mut self.$part, edit);)*
            }
        }
    };
}

/// `call!(self.divider, state, inputs)`: one cycle of the block that is the submodule `divider`;
/// its outputs.
#[macro_export]
macro_rules! call {
    ($block:ident.$part:ident, $state:expr, $inputs:expr) => {
        $crate::block::Block::call(
            &$block.$part,
            stringify!($part),
            &mut $state.submodules.$part,
            $inputs,
        )
    };
}
