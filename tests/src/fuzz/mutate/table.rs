// SPDX-License-Identifier: MIT OR Apache-2.0
//! A table of comma-separated values with other cells, rows and columns.

use super::Mutator;

impl Mutator {
    /// The table with a few changes; none where it is empty.
    pub(super) fn table(&mut self, text: &str) -> Option<String> {
        let mut rows: Vec<Vec<String>> =
            text.lines().map(|line| line.split(',').map(String::from).collect()).collect();
        for _ in 0..self.changes() {
            let last = rows.len().checked_sub(1)?;
            let [a, b] = [0; 2].map(|_| self.rng.usize(..=last));
            match self.rng.u8(..16) {
                0 => rows.insert(a, rows[b].clone()),
                1 => drop(rows.remove(a)),
                2 => rows.swap(a, b),
                3 => self.columns(&mut rows),
                4 => drop(rows[a].pop()),
                5..=8 => self.copy_cell(&mut rows, a, b),
                _ => self.cell(&mut rows, a),
            }
        }
        let lines: Vec<String> = rows.iter().map(|row| row.join(",")).collect();
        Some(lines.join("\n") + "\n")
    }

    /// A number or word in a cell of a row.
    fn cell(&mut self, rows: &mut [Vec<String>], row: usize) {
        let column = self.rng.usize(..rows[row].len().max(1));
        let Some(cell) = rows[row].get_mut(column) else { return };
        let as_text = self.rng.u8(..16) == 0;
        *cell = match (cell.trim().parse(), cell.trim().parse()) {
            (Ok(integer), _) if !as_text => self.integer(integer, &[]).to_string(),
            (_, Ok(float)) if !as_text => self.float(float, &[]).to_string(),
            _ => self.string(cell, &[]),
        };
    }

    /// The cell of one row in another row and column.
    fn copy_cell(&mut self, rows: &mut [Vec<String>], from: usize, to: usize) {
        let columns = [from, to].map(|row| self.rng.usize(..rows[row].len().max(1)));
        let copied = rows[from].get(columns[0]).cloned();
        if let (Some(copied), Some(cell)) = (copied, rows[to].get_mut(columns[1])) {
            *cell = copied;
        }
    }

    /// Of all rows a column removed, twice or exchanged with another.
    fn columns(&mut self, rows: &mut [Vec<String>]) {
        let widest = rows.iter().map(Vec::len).max().unwrap_or(0).max(1);
        let ([a, b], kind) = ([0; 2].map(|_| self.rng.usize(..widest)), self.rng.u8(..3));
        for row in rows.iter_mut().filter(|row| row.len() > a.max(b)) {
            match kind {
                0 => drop(row.remove(a)),
                1 => row.insert(a, row[b].clone()),
                _ => row.swap(a, b),
            }
        }
    }
}
