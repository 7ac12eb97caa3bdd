// SPDX-License-Identifier: MIT OR Apache-2.0
//! A hardware language: fixed-point blocks that are written once and interpreted in several ways.
//!
//! A block is a pure function from (registers, inputs) to (next registers, outputs), generic over
//! what the value of a signal is. Operators are exact and infer their format; every narrowing names
//! its rounding and its overflow. The same text is simulated cycle by cycle, compared with real
//! numbers, proved free of overflow, and printed as Verilog.
//!
//! | module | holds |
//! | --- | --- |
//! | [`format`](mod@format) | formats of fixed-point numbers |
//! | [`signal`] | signals: a value and its format; operators, `quantize`, `resize` |
//! | [`bundle`](mod@bundle) | named groups of registers or ports: [`bundle!`]; multiplexers: [`when!`] |
//! | [`states`](mod@states) | states of state machines: [`states!`] |
//! | [`memory`] | block RAMs and tables |
//! | [`block`](mod@block) | blocks, their instances and their state: [`block!`], [`call!`], [`next!`] |
//! | [`interpretations`] | codes, reals, both, intervals, and the netlist |
//! | [`probe`] | what a simulation shows of itself, for waveforms |
//! | [`verilog`] | Verilog-2005 from the netlist |
//! | [`smt`] | claims of the netlist as bit-vector problems (SMT-LIB 2) |
//!
//! # A first block
//!
//! An accumulator of samples with a limit, written:
//!
//! ```
//! use hapticore_hdl::block::{Block, Interpretation, State};
//! use hapticore_hdl::format::{BIT, Format};
//! use hapticore_hdl::interpretations::netlist::Netlist;
//! use hapticore_hdl::interpretations::range::{Range, take_violations, whole};
//! use hapticore_hdl::probe::{sample, variables};
//! use hapticore_hdl::signal::{HalfEven, Signal, bit, code};
//! use hapticore_hdl::verilog::Design;
//!
//! hapticore_hdl::block! {
//!     /// Adds half of each sample to a sum that saturates.
//!     pub struct Accumulator("accumulator") {
//!         sum: Format,
//!     }
//!     submodules {}
//!     inputs(accumulator) {
//!         /// Adds `sample`.
//!         enable: BIT,
//!         sample: Format::signed(8, 7),
//!     }
//!     outputs(accumulator) {
//!         sum: accumulator.sum,
//!         /// The last addition was beyond full scale.
//!         saturated: BIT,
//!     }
//!     registers(accumulator) {
//!         sum: accumulator.sum,
//!         saturated: BIT,
//!     }
//! }
//!
//! impl Block for Accumulator {
//!     fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
//!         let r = state.load(self);
//!         let (sum, saturated) = (r.sum + i.sample.scaled(-1)).saturate(self.sum, HalfEven);
//!         let added = Registers { sum, saturated };
//!         hapticore_hdl::next!(self, state, i.enable => added, else r);
//!         Outputs { sum: r.sum, saturated: r.saturated }
//!     }
//! }
//!
//! let block = Accumulator { sum: Format::signed(9, 7) };
//!
//! // Clocked: values are codes.
//! let mut state = block.reset::<i64>();
//! let sample_of = |value| code(value, Format::signed(8, 7));
//! block.clock(&mut state, Inputs { enable: bit(true), sample: sample_of(101) });
//! assert_eq!(state.registers.sum, 50, "50.5 is a tie, which goes to the even code");
//!
//! // Traced: every register by name, for a waveform file.
//! let mut codes = Vec::new();
//! sample(&block, &state, &mut codes);
//! let names: Vec<_> = variables(&block, "top").into_iter().map(|variable| variable.name).collect();
//! assert_eq!((names, codes), (vec!["sum".to_string(), "saturated".to_string()], vec![50, 0]));
//!
//! // Proved: values are intervals, and no narrowing that claims it can overflow.
//! let mut state = block.reset::<Range>();
//! let any = |format| Signal { value: whole(format), format };
//! for _ in 0..100 {
//!     block.clock(&mut state, Inputs { enable: any(BIT), sample: any(Format::signed(8, 7)) });
//! }
//! assert_eq!(take_violations(), []);
//! assert_eq!(state.registers.sum, whole(Format::signed(9, 7)), "every code can be reached");
//!
//! // Printed.
//! let verilog = Design::of(&block, "an example").text();
//! assert!(verilog.contains("output reg signed [8:0] sum"), "{verilog}");
//! assert_eq!(Netlist::of(&block).top().registers.len(), 2);
//! ```

pub mod area;
pub mod block;
pub mod bundle;
pub mod claims;
mod declaration;
pub mod format;
pub mod interpretations;
pub mod memory;
pub mod probe;
pub mod signal;
pub mod smt;
pub mod states;
pub mod verilog;
