// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force loops whose area and clock are reported: the core of a profile with a controller, and with
//! walls.

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{Profile, Wall};
use hapticore_hdl::verilog::Design;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

use crate::cells::Cells;
use crate::harness;
use crate::report::{COLUMNS, ModuleCells, Timing, Used, columns, median, mhz};
use crate::sources::{self, File};
use crate::target::Family;

/// What a row of the report is of.
#[derive(Debug, Clone)]
pub struct Loop {
    /// The profile with everything that is added to it.
    pub profile: Profile,
    /// What is added to the core: `inverse, walls`.
    pub adds: String,
    /// The part that it is for.
    pub family: Family,
    /// Whether it is placed, which takes minutes, with the clock as a result.
    pub placed: bool,
}

/// What is added to a core: the controller's law, walls; whether it is placed.
type Added = (Option<Law>, Option<Wall>, bool);

const NOTHING: Added = (None, None, false);
/// Pads in two parts: those of every bundled profile are four.
const WALLS: Option<Wall> = Some(Wall::B);

/// The loops of a profile on the part of its board.
const LOOPS: [(&str, Family, &[Added]); 2] = [
    (
        "small",
        Family::Ice40,
        &[
            NOTHING,
            (Some(Law::Inverse), None, false),
            (Some(Law::Integral), None, false),
            (Some(Law::Inverse), WALLS, true),
        ],
    ),
    (
        "standard",
        Family::Ecp5,
        &[NOTHING, (Some(Law::Inverse), None, false), (Some(Law::Inverse), WALLS, true)],
    ),
];

impl Loop {
    /// All loops, each profile's core without one first.
    ///
    /// # Panics
    /// Where a bundled profile is none.
    pub fn all() -> Vec<Loop> {
        let of = |(name, family, added): (&str, Family, &[Added])| {
            let profile = Profile::bundled(name).expect("bundled");
            added.iter().map(|added| Loop::of(&profile, family, *added)).collect::<Vec<_>>()
        };
        LOOPS.into_iter().flat_map(of).collect()
    }

    fn of(profile: &Profile, family: Family, (law, wall, placed): Added) -> Loop {
        let mut profile = profile.clone();
        profile.control = law.map(|law| Control::of(&profile, law));
        profile.wall = wall;
        let law = law.map_or("core alone", Law::name);
        let adds = format!("{law}{}", if wall.is_some() { ", walls" } else { "" });
        Loop { profile, adds, family, placed }
    }

    /// Its name: `small, inverse, walls`.
    pub fn name(&self) -> String {
        format!("{}, {}", self.profile.name, self.adds)
    }

    /// Whether a row is of this loop.
    pub fn is_of(&self, row: &LoopRow) -> bool {
        (&row.profile, &row.adds) == (&self.profile.name, &self.adds)
    }

    /// What is printed of it.
    pub fn design(&self) -> Design {
        hapticore_rtl::header::design(&self.profile)
    }

    /// Its Verilog.
    pub fn files(&self) -> Vec<File> {
        sources::files(&self.design())
    }

    /// The row of what has been measured.
    pub fn row(&self, measured: Measured) -> LoopRow {
        let design = self.design();
        let (before, after) = harness::bits(&design);
        LoopRow {
            profile: self.profile.name.clone(),
            adds: self.adds.clone(),
            part: self.family.part().into(),
            sources: sources::hash_of(&sources::files(&design)),
            harness: before + after,
            measured,
        }
    }
}

/// What the tools make of a loop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Cells of the loop alone, flattened.
    pub cells: Cells,
    /// What of the part the loop in its harness takes, packed: it may be more than there is.
    pub used: Used,
    /// The clock in the harness, by seed; none where it is not placed.
    pub timings: Vec<Timing>,
    /// Cells module by module, each kept apart: their sum is more than `cells`.
    pub modules: Vec<ModuleCells>,
}

/// One loop in a table of all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoopRow {
    /// Name of the profile.
    pub profile: String,
    /// What is added to its core.
    pub adds: String,
    /// FPGA that the loop is placed on.
    pub part: String,
    /// The hash of its Verilog.
    pub sources: String,
    /// Flip-flops of the harness around it, each a logic cell of `used`.
    pub harness: u64,
    /// What the tools make of it.
    #[serde(flatten)]
    pub measured: Measured,
}

/// Force loops on the parts of their boards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoopsReport {
    /// The command that makes it.
    pub made_by: String,
    /// One row per loop; a profile's core alone comes first.
    pub rows: Vec<LoopRow>,
}

/// Modules of the loop, the core's apart.
const OF_LOOP: [&str; 4] = ["controller", "drives", "split_pad", "wall"];

impl LoopsReport {
    /// The report as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!(
            "# Force loops: the core with a controller and walls\n\nMade by `{}`. Cells after synthesis of the bare loop, and LUT4 \
             beyond the core of the same profile; logic cells and clock with it between shift registers, whose flip-flops, one \
             logic cell each, are the next column. Walls are those of pads in two parts.\n\n\
             | profile, part | core with | {COLUMNS} | LUT4 beyond the core | logic cells | of the harness | clock of seeds, MHz | median |\n\
             |{}\n",
            self.made_by,
            " --- |".repeat(13)
        );
        let mut core = 0;
        for row in &self.rows {
            if row.modules_of_loop().is_empty() {
                core = row.measured.cells.luts;
            }
            writeln!(text, "{}", row.markdown(core)).expect("a string grows");
        }
        text + &self.modules()
    }

    /// The cells of controllers and walls, module by module.
    fn modules(&self) -> String {
        let mut text = format!(
            "\nCells of the loop's own modules, each apart, without the divider, square root and multiplier within it:\n\n\
             | profile, part | core with | module | {COLUMNS} |\n|{}\n",
            " --- |".repeat(9)
        );
        for row in &self.rows {
            for ModuleCells { module, cells } in row.modules_of_loop() {
                let LoopRow { profile, part, adds, .. } = row;
                let module = module.trim_start_matches("hapticore_");
                writeln!(text, "| {profile}, {part} | {adds} | {module} | {} |", columns(cells))
                    .expect("a string grows");
            }
        }
        text
    }
}

impl LoopRow {
    /// The modules that only a loop has.
    pub fn modules_of_loop(&self) -> Vec<&ModuleCells> {
        let own = |of: &&ModuleCells| {
            of.module.strip_prefix("hapticore_").is_some_and(|name| OF_LOOP.contains(&name))
        };
        self.measured.modules.iter().filter(own).collect()
    }

    fn markdown(&self, core: u64) -> String {
        let LoopRow { profile, part, adds, harness, measured, .. } = self;
        let Measured { cells, used, timings, .. } = measured;
        let Used { logic: [used, all], multipliers: [_, multipliers], block_rams: [_, rams] } =
            used;
        let percent = 100.0 * *used as f64 / *all as f64;
        let fits = used <= all && cells.multipliers <= *multipliers && cells.block_rams <= *rams;
        let clock = match (fits, timings.is_empty()) {
            (false, _) => "does not fit | –".into(),
            (_, true) => "not placed | –".into(),
            _ => format!("{} | {:.1}", mhz(timings), median(timings)),
        };
        format!(
            "| {profile}, {part} | {adds} | {} | {} | {used} of {all} ({percent:.0} %) | {harness} | {clock} |",
            columns(cells),
            cells.luts as i64 - core as i64
        )
    }
}
