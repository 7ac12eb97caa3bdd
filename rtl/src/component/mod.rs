// SPDX-License-Identifier: MIT OR Apache-2.0
//! Blocks as rust-hdl components, for anybody's rust-hdl design.
//!
//! [`component!`](crate::component!) makes a component of any block: a port for each field of its
//! bundles, besides `clock` and a synchronous `reset`. In rust-hdl's simulator it steps the clocked
//! model; in rust-hdl's Verilog it is the printed modules. So no block is written twice, and what
//! rust-hdl's own expressions would get wrong is not written in them. rust-hdl has widths in types
//! and the model has them in profiles, so that a component names its ports' widths once, where they
//! are used ([`declaration`] writes that for any block):
//!
//! ```
//! use hapticore_model::blocks::multiplexer::Multiplexer;
//! use hapticore_contract::profile::Profile;
//! use rust_hdl_core::prelude::*;
//!
//! hapticore_rtl::component! {
//!     /// Serves the pads in turn.
//!     pub struct Turns of Multiplexer {
//!         inputs { strobe: Bit, clear: Bit }
//!         outputs { sample: Bit, restart: Bit, integrate: Bit, first: Bit, last: Bit, pad: Bits<2>, closed: Bit }
//!     }
//! }
//!
//! let mut turns = Turns::new(Multiplexer::new(&Profile::bundled("small")?));
//! turns.connect_all();
//! # Ok::<(), hapticore_contract::profile::ProfileError>(())
//! ```
//!
//! Words are `Bits`, those of signed formats in two's complement: rust-hdl's `Signed` overflows the
//! stack at its most negative code. Names and widths are checked when a component is made. Widths that a profile decides
//! may be parameters: `pub struct Switches<const PADS> of Pads { … outputs { select: Bits<PADS> } }`.

mod simulated;

use hapticore_hdl::verilog::{Design, Direction, Port};
use rust_hdl_core::prelude::{Bits, Block, Synth, generate_verilog};
use std::collections::BTreeMap;

#[doc(hidden)]
pub use rust_hdl_core;
pub use simulated::Simulated;

/// A port's name and width.
pub type PortWidth = (&'static str, usize);

/// What a component's port may carry: a bit, or bits.
pub trait Word: Synth {
    /// Its bits, the others zero.
    fn to_word(self) -> u64;
    /// The word of these bits.
    fn of_word(word: u64) -> Self;
}

impl Word for bool {
    fn to_word(self) -> u64 {
        self.into()
    }

    fn of_word(word: u64) -> Self {
        word != 0
    }
}

impl<const N: usize> Word for Bits<N> {
    fn to_word(self) -> u64 {
        self.to_u64()
    }

    fn of_word(word: u64) -> Self {
        word.into()
    }
}

/// The Verilog of a rust-hdl design in which components stand, each printed module once. The top
/// module is `top`.
///
/// # Panics
/// Where rust-hdl finds an open or doubly driven signal, or two components bring different modules
/// of one name.
pub fn verilog<U: Block>(design: &U) -> String {
    let text = generate_verilog(design);
    let mut seen = BTreeMap::new();
    let mut kept = String::new();
    for module in text.split_inclusive("endmodule") {
        let name = module
            .split_once("\nmodule ")
            .map(|(_, rest)| rest.split([' ', '(', '#']).next().unwrap_or(rest));
        let body = module.split_once("\nmodule ").map_or(module, |(_, body)| body);
        match name.and_then(|name| seen.insert(name.to_owned(), body.to_owned())) {
            None => kept.push_str(module),
            Some(before) => assert_eq!(before, body, "two modules of one name"),
        }
    }
    kept
}

/// The declaration of a block's component, to be put into a design:
/// [`component!`](crate::component!) with the names and the widths that this block has. `path` is
/// where its type is, `name` what the component is to be called.
pub fn declaration<B: hapticore_hdl::block::Block>(block: &B, path: &str, name: &str) -> String {
    let design = Design::of(block, "a rust-hdl component");
    let ports = |direction: Direction| {
        let ports = design.ports.iter().filter(|port| port.direction == direction);
        let port = |port: &Port| match port.format.width {
            1 => format!("{}: Bit", port.name),
            width => format!("{}: Bits<{width}>", port.name),
        };
        ports.map(port).collect::<Vec<_>>().join(", ")
    };
    let (inputs, outputs) = (ports(Direction::Input), ports(Direction::Output));
    format!(
        "component! {{\n    pub struct {name} of {path} {{\n        inputs {{ {inputs} }}\n        outputs {{ {outputs} }}\n    }}\n}}\n"
    )
}

/// Makes a rust-hdl component of a block; see [the module](mod@crate::component).
#[macro_export]
macro_rules! component {
    ($(#[$meta:meta])* $vis:vis struct $name:ident $(<$(const $width:ident),*>)? of $block:ty {
        inputs { $($input:ident: $in_type:ty),* $(,)? }
        outputs { $($output:ident: $out_type:ty),* $(,)? }
    }) => {
        $(#[$meta])*
        $vis struct $name $(<$(const $width: usize),*>)? {
            /// The clock of all registers.
            pub clock: $crate::component::rust_hdl_core::prelude::Signal<
                $crate::component::rust_hdl_core::prelude::In, $crate::component::rust_hdl_core::prelude::Clock>,
            /// Makes all registers zero.
            pub reset: $crate::component::rust_hdl_core::prelude::Signal<
                $crate::component::rust_hdl_core::prelude::In, bool>,
            $(#[allow(missing_docs)] pub $input: $crate::component::rust_hdl_core::prelude::Signal<
                $crate::component::rust_hdl_core::prelude::In, $in_type>,)*
            $(#[allow(missing_docs)] pub $output: $crate::component::rust_hdl_core::prelude::Signal<
                $crate::component::rust_hdl_core::prelude::Out, $out_type>,)*
            simulated: $crate::component::Simulated<$block>,
        }

        impl $(<$(const $width: usize),*>)? $name $(<$($width),*>)? {
            /// The component of a block.
            ///
            /// # Panics
            /// Where the block's ports have other widths.
            pub fn new(block: $block) -> Self {
                use $crate::component::rust_hdl_core::prelude::{Signal, Synth};
                let inputs = [$((stringify!($input), <$in_type as Synth>::BITS)),*];
                let outputs = [$((stringify!($output), <$out_type as Synth>::BITS)),*];
                $name {
                    clock: Signal::default(),
                    reset: Signal::default(),
                    $($input: Signal::default(),)*
                    $($output: Signal::default(),)*
                    simulated: $crate::component::Simulated::new(block, &inputs, &outputs),
                }
            }
        }

        impl $(<$(const $width: usize),*>)? $crate::component::rust_hdl_core::prelude::Logic for $name $(<$($width),*>)? {
            fn update(&mut self) {
                use $crate::component::Word;
                let inputs = [$(self.$input.val().to_word()),*];
                let outputs = self.simulated.update(self.clock.pos_edge(), self.reset.val(), &inputs);
                let mut outputs = outputs.iter();
                $(self.$output.next = Word::of_word(*outputs.next().expect("a word a port"));)*
            }

            fn connect(&mut self) {
                $(self.$output.connect();)*
            }

            fn hdl(&self) -> $crate::component::rust_hdl_core::prelude::Verilog {
                self.simulated.hdl()
            }
        }

        impl $(<$(const $width: usize),*>)? $crate::component::rust_hdl_core::prelude::Block for $name $(<$($width),*>)? {
            fn connect_all(&mut self) {
                $crate::component::rust_hdl_core::prelude::Logic::connect(self);
                $(self.$input.connect_all();)*
                $(self.$output.connect_all();)*
            }

            fn update_all(&mut self) {
                $crate::component::rust_hdl_core::prelude::Logic::update(self);
                self.clock.update_all();
                self.reset.update_all();
                $(self.$input.update_all();)*
                $(self.$output.update_all();)*
            }

            fn has_changed(&self) -> bool {
                self.clock.has_changed() || self.reset.has_changed()
                    $(|| self.$input.has_changed())* $(|| self.$output.has_changed())*
            }

            fn accept(&self, name: &str, probe: &mut dyn $crate::component::rust_hdl_core::prelude::Probe) {
                probe.visit_start_scope(name, self);
                self.clock.accept("clock", probe);
                self.reset.accept("reset", probe);
                $(self.$input.accept(stringify!($input), probe);)*
                $(self.$output.accept(stringify!($output), probe);)*
                probe.visit_end_scope(name, self);
            }
        }
    };
}
