// SPDX-License-Identifier: MIT OR Apache-2.0
//! The extension module of the Python package `hapticore`: what its Python files build upon.
//!
//! | module | does |
//! | --- | --- |
//! | `failure` | errors of Rust as exceptions of the package |
//! | `apart` | work without the interpreter's lock, which Ctrl-C ends |
//! | `rows` | rows of slots as NumPy arrays, a column at a time |
//! | `runs` | whole scenes, captures, a lab's data |
//! | `slots` | a core that receives slots |
//! | `trace` | the signals of a core, clock by clock |
//! | `display` | a display that is stepped |
//! | `page` | the live page |
//! | `board` | a board, real or virtual |
//! | `tradeoff` | what accuracy costs |
//!
//! Arguments are checked before they change anything: an error leaves every object as it was.

mod apart;
mod board;
mod display;
mod failure;
mod page;
mod rows;
mod runs;
mod slots;
mod trace;
mod tradeoff;

use hapticore_scene::gallery;
use pyo3::prelude::*;

/// Names of the bundled scenes.
#[pyfunction]
fn scenes() -> Vec<&'static str> {
    gallery::all().iter().map(|(name, _)| *name).collect()
}

/// Names of the bundled profiles.
#[pyfunction]
fn profiles() -> Vec<&'static str> {
    hapticore_contract::profile::BUNDLED.iter().map(|(name, _)| *name).collect()
}

#[pymodule(gil_used = false)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<rows::Rows>()?;
    module.add_class::<slots::Slots>()?;
    module.add_class::<display::Stepped>()?;
    module.add_class::<page::Page>()?;
    module.add_class::<board::Link>()?;
    module.add_function(wrap_pyfunction!(scenes, module)?)?;
    module.add_function(wrap_pyfunction!(profiles, module)?)?;
    module.add_function(wrap_pyfunction!(runs::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(runs::replay, module)?)?;
    module.add_function(wrap_pyfunction!(runs::calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(tradeoff::tradeoff, module)?)
}
