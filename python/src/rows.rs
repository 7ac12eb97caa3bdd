// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rows of slots as NumPy arrays, a column at a time.

use std::collections::HashMap;
use std::sync::Arc;

use hapticore_run::columns::{Column, Columns, Value};
use hapticore_run::record::{self, Row};
use numpy::IntoPyArray;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

/// Rows, one for each finished slot.
#[pyclass(frozen, module = "hapticore._core")]
pub struct Rows {
    columns: Arc<Columns>,
    rows: record::Rows,
}

impl Rows {
    /// Rows with these columns.
    pub fn new(columns: Arc<Columns>, rows: record::Rows) -> Rows {
        Rows { columns, rows }
    }

    fn values<'a>(&'a self, column: &'a Column) -> impl Iterator<Item = Value<'a>> {
        self.rows.iter().map(move |row: &Row| self.columns.value(column, row))
    }

    /// Numbers of names, and the names: an array of text is made from both.
    fn texts<'a>(&'a self, column: &'a Column) -> (Vec<i64>, Vec<&'a str>) {
        let (mut names, mut numbers) = (Vec::new(), HashMap::new());
        let number = |value| {
            let Value::Text(text) = value else { return 0 };
            *numbers.entry(text).or_insert_with(|| {
                names.push(text);
                names.len() as i64 - 1
            })
        };
        let of_rows = self.values(column).map(number).collect();
        (of_rows, names)
    }
}

#[pymethods]
impl Rows {
    fn __len__(&self) -> usize {
        self.rows.len()
    }

    /// Names of the columns, in the order of frames.csv.
    fn names(&self) -> Vec<&str> {
        self.columns.iter().map(|column| column.name.as_str()).collect()
    }

    /// A column, shape (slots,): float64, int64 or bool; text as (numbers, names).
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(column) = self.columns.iter().find(|column| column.name == name) else {
            return Err(PyKeyError::new_err(name.to_string()));
        };
        let index = |value| if let Value::Index(index) = value { index as i64 } else { 0 };
        let number = |value| if let Value::Number(number) = value { number } else { f64::NAN };
        let flag = |value| matches!(value, Value::Flag(true));
        Ok(match self.columns.kind(column) {
            Value::Number(_) => array(py, self.values(column).map(number)),
            Value::Index(_) => array(py, self.values(column).map(index)),
            Value::Flag(_) => array(py, self.values(column).map(flag)),
            Value::Text(_) => {
                let (numbers, names) = self.texts(column);
                (numbers.into_pyarray(py), names).into_pyobject(py)?.into_any()
            }
        })
    }
}

fn array<'py, T: numpy::Element>(
    py: Python<'py>,
    values: impl Iterator<Item = T>,
) -> Bound<'py, PyAny> {
    values.collect::<Vec<_>>().into_pyarray(py).into_any()
}
