// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rows of slots as NumPy arrays, a column at a time.

use std::collections::HashMap;
use std::sync::Arc;

use hapticore_report::figure::Figure;
use hapticore_report::sheet::{Modes, svg};
use hapticore_report::{all_figures, columns};
use hapticore_run::columns::{Column, Columns, Value};
use hapticore_run::record::{self, Record, Row};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::failure::error;

/// Rows, one for each finished slot.
#[pyclass(frozen, module = "hapticore._core")]
pub struct Rows {
    columns: Arc<Columns>,
    /// The rows, and of a whole run what its report says besides.
    record: Record,
}

/// Titles of figures, and an SVG document of them: as a reader's mode has it, and for print.
type Drawn = (Vec<String>, String, String);

impl Rows {
    /// Rows with these columns.
    pub fn new(columns: Arc<Columns>, rows: record::Rows) -> Rows {
        Rows::of_run(columns, Record { rows, ..Record::default() })
    }

    /// The rows of a whole run.
    pub fn of_run(columns: Arc<Columns>, record: Record) -> Rows {
        Rows { columns, record }
    }

    fn named(&self, name: &str) -> PyResult<&Column> {
        let found = self.columns.iter().find(|column| column.name == name);
        found.ok_or_else(|| PyKeyError::new_err(name.to_string()))
    }

    /// Figures of columns, or without a name those of the run's report.
    fn figures(&self, names: &[String], record: &Record) -> PyResult<Vec<Figure>> {
        if names.is_empty() {
            return Ok(all_figures(record));
        }
        let figure = |name: &String| {
            let column = self.named(name)?;
            let figure = columns::over_time(record, &self.columns, column);
            figure.ok_or_else(|| error(format!("{name}: expected a column of numbers")))
        };
        names.iter().map(figure).collect()
    }

    /// The rows of these numbers alone.
    fn chosen(&self, numbers: &[i64]) -> Record {
        let all: Vec<&Row> = self.record.rows.iter().collect();
        let rows = numbers.iter().filter_map(|number| all.get(usize::try_from(*number).ok()?));
        let rows: record::Rows = rows.map(|row| (*row).clone()).collect();
        let (cases, pads) = (self.record.cases.clone(), self.record.pads.clone());
        Record { rows, cases, pads, ..Record::default() }
    }

    fn values<'a>(&'a self, column: &'a Column) -> impl Iterator<Item = Value<'a>> {
        self.record.rows.iter().map(move |row: &Row| self.columns.value(column, row))
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
        self.record.rows.len()
    }

    /// Names of the columns, in the order of frames.csv.
    fn names(&self) -> Vec<&str> {
        self.columns.iter().map(|column| column.name.as_str()).collect()
    }

    /// Figures of columns over time, or without a name those of the run's report; of these rows alone, where they are chosen.
    #[pyo3(signature = (names, chosen))]
    fn plot(
        &self,
        py: Python<'_>,
        names: Vec<String>,
        chosen: Option<PyReadonlyArray1<'_, i64>>,
    ) -> PyResult<Drawn> {
        let numbers = chosen.map(|of| of.as_array().to_vec());
        py.detach(|| {
            let chosen = numbers.map(|numbers| self.chosen(&numbers));
            let figures = self.figures(&names, chosen.as_ref().unwrap_or(&self.record))?;
            let drawn = [Modes::Both, Modes::Light].map(|modes| svg(&figures, modes));
            let [Some(both), Some(light)] = drawn else {
                return Err(error("plot: expected slots of which a figure is one plot"));
            };
            let plots = figures.iter().filter(|figure| figure.parts().is_some());
            Ok((plots.map(|figure| figure.title().to_string()).collect(), both, light))
        })
    }

    /// A column, shape (slots,): float64, int64 or bool; text as (numbers, names).
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let column = self.named(name)?;
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
