// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reports: what is committed in `synth/reports/`, as JSON for programs and as a table for people.

use crate::cells::Cells;
use crate::target::Board;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// The cells of a module, without those of modules within.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ModuleCells {
    /// Name of the module.
    pub module: String,
    /// Cells of the module alone.
    pub cells: Cells,
}

/// What a placed design takes of its part: used and available.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Used {
    /// Logic cells (iCE40: a table with its flip-flop; ECP5: a table).
    pub logic: [u64; 2],
    /// Hardware multipliers, used and available.
    pub multipliers: [u64; 2],
    /// Number of block RAMs; used and available where there are two numbers.
    pub block_rams: [u64; 2],
}

/// The highest clock with a seed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// The seed of the placer.
    pub seed: u64,
    /// The clock, after routing.
    pub mhz: f64,
}

/// A limit that the design must meet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Quantity that the limit applies to.
    pub name: String,
    /// Measured value.
    pub measured: f64,
    /// Largest or smallest value allowed.
    pub limit: f64,
    /// Whether the measured value is within the limit.
    pub holds: bool,
}

/// A board's report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BoardReport {
    /// The command that makes it.
    pub made_by: String,
    /// Name of the board.
    pub board: String,
    /// FPGA of the board.
    pub part: String,
    /// The hash of its Verilog and constraints.
    pub sources: String,
    /// Cells after synthesis.
    pub cells: Cells,
    /// What of the part is used.
    pub used: Used,
    /// The clock with each seed.
    pub timings: Vec<Timing>,
    /// Median clock of all seeds, MHz.
    pub median_mhz: f64,
    /// The hash of the first seed's bitstream.
    pub bitstream: String,
    /// Limits that the design must meet.
    pub limits: Vec<Limit>,
    /// Cells module by module, each kept apart: their sum is more than `cells`.
    pub modules: Vec<ModuleCells>,
}

/// One core in a table of all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoreRow {
    /// Name of the profile.
    pub profile: String,
    /// FPGA that the core is placed on.
    pub part: String,
    /// The hash of its Verilog.
    pub sources: String,
    /// Cells of the core alone.
    pub cells: Cells,
    /// The clock in the harness, by seed; none where the part is too small.
    pub timings: Vec<Timing>,
    /// Why it was not placed.
    pub unplaced: Option<String>,
}

/// Every bundled profile on every family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoresReport {
    /// The command that makes it.
    pub made_by: String,
    /// One row per profile and family.
    pub rows: Vec<CoreRow>,
}

/// The middle of an odd number of timings, or of an even one the lower of both middles.
pub fn median(timings: &[Timing]) -> f64 {
    let mut all: Vec<_> = timings.iter().map(|timing| timing.mhz).collect();
    all.sort_by(f64::total_cmp);
    all[(all.len() - 1) / 2]
}

/// What must hold on a board.
pub fn limits(board: &Board, used: &Used, median_mhz: f64) -> Vec<Limit> {
    let at_least = |name: &str, measured: f64, limit: f64| Limit {
        name: name.into(),
        measured,
        limit,
        holds: measured >= limit,
    };
    let mut all = vec![at_least("median clock, MHz, at least", median_mhz, board.least_mhz)];
    let names = ["logic cells, at most", "multipliers, at most", "block RAMs, at most"];
    let measured = [used.logic[0], used.multipliers[0], used.block_rams[0]];
    for ((name, measured), most) in
        names.into_iter().zip(measured).zip(board.most.into_iter().flatten())
    {
        let (measured, limit) = (measured as f64, most as f64);
        all.push(Limit { name: name.into(), measured, limit, holds: measured <= limit });
    }
    all
}

pub(crate) const COLUMNS: &str = "LUT4 | carry | flip-flops | multipliers | block RAM | LUT RAM";

pub(crate) fn columns(cells: &Cells) -> String {
    let Cells { luts, carries, registers, multipliers, block_rams, lut_rams } = cells;
    format!("{luts} | {carries} | {registers} | {multipliers} | {block_rams} | {lut_rams}")
}

pub(crate) fn mhz(timings: &[Timing]) -> String {
    timings.iter().map(|timing| format!("{:.1}", timing.mhz)).collect::<Vec<_>>().join(" ")
}

impl BoardReport {
    /// The report as Markdown.
    pub fn markdown(&self) -> String {
        let Used { logic, multipliers, block_rams } = self.used;
        let share = |[used, available]: [u64; 2]| {
            format!("{used} of {available} ({:.0} %)", 100.0 * used as f64 / available as f64)
        };
        let mut text = format!(
            "# {}: {}\n\nMade by `{}`.\n\n| of the part | used |\n| --- | --- |\n| logic cells | {} |\n| multipliers | {} |\n\
             | block RAM | {} |\n| clock of seeds 1 to {}, MHz | {} |\n| median, MHz | {:.1} |\n\n",
            self.board,
            self.part,
            self.made_by,
            share(logic),
            share(multipliers),
            share(block_rams),
            self.timings.len(),
            mhz(&self.timings),
            self.median_mhz,
        );
        text += "| limit | measured | limit | holds |\n| --- | --- | --- | --- |\n";
        for Limit { name, measured, limit, holds } in &self.limits {
            let holds = if *holds { "yes" } else { "**no**" };
            writeln!(text, "| {name} | {measured:.1} | {limit:.1} | {holds} |")
                .expect("a string grows");
        }
        write!(
            text,
            "\nCells after synthesis, module by module (each apart, without those within it), and of the whole flattened:\n\n\
             | module | {COLUMNS} |\n| --- | --- | --- | --- | --- | --- | --- |\n"
        )
        .expect("a string grows");
        for ModuleCells { module, cells } in &self.modules {
            writeln!(text, "| {module} | {} |", columns(cells)).expect("a string grows");
        }
        text + &format!("| **whole** | {} |\n", columns(&self.cells))
    }
}

impl CoresReport {
    /// The report as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!(
            "# Every bundled profile on every family: the core alone\n\nMade by `{}`. Cells after synthesis of the bare core; the \
             clock with it between shift registers, seed by seed.\n\n| profile | part | {COLUMNS} | clock, MHz |\n\
             | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
            self.made_by
        );
        for row in &self.rows {
            let clock = row.unplaced.clone().unwrap_or_else(|| mhz(&row.timings));
            writeln!(
                text,
                "| {} | {} | {} | {clock} |",
                row.profile,
                row.part,
                columns(&row.cells)
            )
            .expect("a string grows");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::board;

    #[test]
    fn the_median_is_a_timing() {
        let timings =
            |all: &[f64]| all.iter().map(|&mhz| Timing { seed: 1, mhz }).collect::<Vec<_>>();
        assert_eq!(median(&timings(&[3.0, 1.0, 2.0])), 2.0);
        assert_eq!(median(&timings(&[3.0, 1.0])), 1.0);
    }

    #[test]
    fn limits_hold_up_to_themselves() {
        let used = |cells| Used { logic: [cells, 5280], multipliers: [8, 8], block_rams: [30, 30] };
        let board = board("icebreaker").unwrap();
        assert!(limits(board, &used(3960), 14.4).iter().all(|limit| limit.holds));
        let broken =
            |used: &Used, mhz| limits(board, used, mhz).iter().filter(|limit| !limit.holds).count();
        assert_eq!(broken(&used(3961), 14.4), 1);
        assert_eq!(broken(&used(3960), 14.3), 1);
    }
}
