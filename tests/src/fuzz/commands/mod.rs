// SPDX-License-Identifier: MIT OR Apache-2.0
//! Command lines, made from the command's own declaration (`hapticore::args`), and what is held of a run of one.
//!
//! | module | does |
//! | --- | --- |
//! | [`desk`] | the files that lines name: captures of other devices, profiles, calibrations, plans |
//! | [`generator`] | lines: every subcommand and option of the declaration, the rarest first |
//! | [`keys`] | keys of scenes for `--set`, from what the reader of scenes answers |
//! | [`run`](mod@run) | a run as a process with limits, and what is wrong with how it ended |
//! | `settings` | values of those keys: at limits, near the own, of other types |
//! | [`tally`] | how often each subcommand and option was accepted, and how runs ended |
//! | [`values`] | values: by an option's own list, by its name, or by the name of its value |
//!
//! A subcommand, a flag and an option with a list of values are generated once they are declared. An option with
//! another value needs a line in [`values`]; the generator stops at one that has none.

pub mod desk;
pub mod generator;
pub mod keys;
pub mod run;
mod settings;
pub mod tally;
pub mod values;

pub use desk::Desk;
pub use generator::Generator;
pub use run::{Ended, run};
pub use tally::Tally;
