// SPDX-License-Identifier: MIT OR Apache-2.0
//! Recordings of a board: its rows, and what happened, as CSV or as MCAP.

mod mcap;

use std::io::{self, Write};

use hapticore_run::columns::Columns;
use hapticore_run::record::Row;

pub use mcap::Mcap;

/// What rows and notes of a board are written to.
pub trait Recorder: Send {
    /// A row.
    ///
    /// # Errors
    /// A file or a pipe that takes no more.
    fn row(&mut self, row: &Row) -> io::Result<()>;

    /// A note of the session, at the time of the last row; formats of rows alone leave it out.
    ///
    /// # Errors
    /// As [`row`](Self::row).
    fn note(&mut self, _time_s: f64, _text: &str) -> io::Result<()> {
        Ok(())
    }

    /// What has been written reaches the file.
    ///
    /// # Errors
    /// As [`row`](Self::row).
    fn flush(&mut self) -> io::Result<()>;
}

/// Rows as CSV, the columns of `frames.csv`.
pub struct Csv<W> {
    columns: Columns,
    to: W,
}

impl<W: Write> Csv<W> {
    /// Writes the head.
    ///
    /// # Errors
    /// A file or a pipe that takes nothing.
    pub fn new(columns: Columns, mut to: W) -> io::Result<Self> {
        columns.write_head(&mut to)?;
        Ok(Csv { columns, to })
    }
}

impl<W: Write + Send> Recorder for Csv<W> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        self.columns.write_row(row, &mut self.to)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

#[cfg(test)]
mod tests;
