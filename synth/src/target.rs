// SPDX-License-Identifier: MIT OR Apache-2.0
//! FPGA families, and boards with what must hold on each.

use crate::cells::Cells;
use hapticore_rtl::board::target::Target;

/// An FPGA family, as the part of it that our boards have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// iCE40UP5K in an SG48.
    Ice40,
    /// ECP5 85F, speed 6, in a CABGA381.
    Ecp5,
}

/// A supported board with its FPGA and limits.
#[derive(Debug, Clone, Copy)]
pub struct Board {
    /// Its pins and its top.
    pub target: Target,
    /// FPGA family on the board.
    pub family: Family,
    /// The clock that the median seed must reach.
    pub least_mhz: f64,
    /// The most of logic cells, multipliers and block RAMs, where the part is small enough for it
    /// to matter.
    pub most: Option<[u64; 3]>,
}

/// All supported boards.
pub const BOARDS: [Board; 2] = [
    Board { target: Target::Ulx3s, family: Family::Ecp5, least_mhz: 100.0, most: None },
    Board {
        target: Target::Icebreaker,
        family: Family::Ice40,
        least_mhz: 14.4, // 1.2 × 12
        most: Some([5280 * 3 / 4, 8, 30]),
    },
];

/// The name of every board's top module.
pub const TOP: &str = "top";

/// The board of a name.
pub fn board(name: &str) -> Option<&'static Board> {
    BOARDS.iter().find(|board| board.target.name() == name)
}

impl Family {
    /// All supported families.
    pub const ALL: [Family; 2] = [Family::Ice40, Family::Ecp5];

    /// Its name, as options have it.
    pub fn name(self) -> &'static str {
        match self {
            Family::Ice40 => "ice40",
            Family::Ecp5 => "ecp5",
        }
    }

    /// The part, for people.
    pub fn part(self) -> &'static str {
        match self {
            Family::Ice40 => "iCE40UP5K",
            Family::Ecp5 => "ECP5 85F, speed 6",
        }
    }

    /// The Yosys commands that make cells of what has been read.
    pub fn synthesis(self, top: &str) -> String {
        match self {
            Family::Ice40 => {
                format!(
                    "hierarchy -top {top}; proc; flatten; opt; share -aggressive; opt; synth_ice40 -dsp -top {top}"
                )
            }
            Family::Ecp5 => format!("synth_ecp5 -top {top}"),
        }
    }

    /// The same without sharing of operators. In force loops, whose adders are seldom wider than the
    /// choices before them would be, it takes fewer cells (iCE40: `small` with walls 5792 instead of
    /// 6129 LUT4).
    pub fn synthesis_unshared(self, top: &str) -> String {
        match self {
            Family::Ice40 => format!("synth_ice40 -dsp -top {top}"),
            Family::Ecp5 => self.synthesis(top),
        }
    }

    /// The same with modules kept apart, to see who costs what.
    pub fn synthesis_by_module(self, top: &str) -> String {
        match self {
            Family::Ice40 => format!("synth_ice40 -dsp -noflatten -top {top}"),
            Family::Ecp5 => format!("synth_ecp5 -noflatten -top {top}"),
        }
    }

    /// The program that places and routes, and how it is called for the part.
    pub fn place(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Family::Ice40 => ("nextpnr-ice40", &["--up5k", "--package", "sg48", "--freq", "14.4"]),
            Family::Ecp5 => (
                "nextpnr-ecp5",
                &["--85k", "--package", "CABGA381", "--speed", "6", "--freq", "100"],
            ),
        }
    }

    /// The options that name constraints and the routed design.
    pub fn options(self) -> [&'static str; 2] {
        match self {
            Family::Ice40 => ["--pcf", "--asc"],
            Family::Ecp5 => ["--lpf", "--textcfg"],
        }
    }

    /// The option without which pins need constraints.
    pub fn unconstrained(self) -> &'static str {
        match self {
            Family::Ice40 => "--pcf-allow-unconstrained",
            Family::Ecp5 => "--lpf-allow-unconstrained",
        }
    }

    /// The ending of a constraints file.
    pub fn constraints(self) -> &'static str {
        match self {
            Family::Ice40 => "pcf",
            Family::Ecp5 => "lpf",
        }
    }

    /// The program that packs a routed design, with its options, and the ending of a bitstream.
    pub fn pack(self) -> (&'static str, &'static [&'static str], &'static str) {
        match self {
            Family::Ice40 => ("icepack", &[], "bin"),
            Family::Ecp5 => ("ecppack", &["--compress"], "bit"),
        }
    }

    /// The cells that nextpnr reports, of which a part has a number: logic, multipliers, block RAM.
    pub fn resources(self) -> [&'static str; 3] {
        match self {
            Family::Ice40 => ["ICESTORM_LC", "ICESTORM_DSP", "ICESTORM_RAM"],
            Family::Ecp5 => ["TRELLIS_COMB", "MULT18X18D", "DP16KD"],
        }
    }

    /// Counts a cell of Yosys's.
    pub fn count(self, cells: &mut Cells, kind: &str, number: u64) {
        let place = match kind {
            "SB_LUT4" | "LUT4" => &mut cells.luts,
            "SB_CARRY" | "CCU2C" => &mut cells.carries,
            "SB_MAC16" | "MULT18X18D" => &mut cells.multipliers,
            "TRELLIS_FF" => &mut cells.registers,
            "TRELLIS_DPR16X4" => &mut cells.lut_rams,
            "DP16KD" => &mut cells.block_rams,
            _ if kind.starts_with("SB_DFF") => &mut cells.registers,
            _ if kind.starts_with("SB_RAM40") => &mut cells.block_rams,
            _ => return,
        };
        *place += number;
    }
}
