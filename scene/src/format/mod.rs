// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scene format: TOML read into a tree that remembers lines, and typed access that remembers
//! which keys are known.

mod document;
mod key;
mod kind;
mod limits;
mod lists;
mod overrides;
mod read;
mod table;
mod tree;

pub(crate) use document::parse;
pub use key::KeyInfo;
pub(crate) use key::{Key, Read, keys};
pub use kind::{Kind, Otherwise};
pub use limits::Limits;
pub(crate) use overrides::{apply, parse_value};
pub(crate) use read::Word;
pub(crate) use tree::{Node, Table, Value};
