// SPDX-License-Identifier: MIT OR Apache-2.0
//! Position and sheet resistance from the ratios: nineteen operations, each rounded to a word of the map.
//!
//! ```text
//! p = [(r − origin) · scale]                                        for x and y
//! v = spacing_y([(p_y − middle_y(p_x)) · stretch_y(p_x) · 2^5])
//! u = spacing_x([(p_x − middle_x(v)) · stretch_x(v) · 2^5])         (a negative stretch counts as zero)
//! curve(t) = [near + (far − near) · w],   t = −1 … 1 lying w past the entry `near`
//! table(u, v) = [above + (below − above) · w_v],   above = [left + (right − left) · w_u] in the row above, below likewise
//! x, y = table · 2^9 mm,   R = max(table, 0)
//! ```

use super::{Exact, round};
use crate::format::Format;
use crate::profile::Profile;

/// A place on the sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Millimetres along the long edges.
    pub x: Exact,
    /// Millimetres along the short edges.
    pub y: Exact,
    /// The sheet's resistance.
    pub sheet: Exact,
    /// Whether a word is held at a rail.
    pub saturated: bool,
}

/// The tables, in words of the map.
#[derive(Debug, Clone)]
pub struct Map {
    word: Format,
    /// In their order in the memory: middle_y, stretch_y, middle_x, stretch_x, spacing_y, spacing_x.
    curves: [Vec<Exact>; 6],
    /// x, y and R, row by row.
    tables: [Vec<Exact>; 3],
}

/// A stretch is stored divided by `2^STRETCH`.
const STRETCH: i8 = 5;
/// The full scale of a position is `2^POSITION` mm.
const POSITION: i8 = 9;

/// A result, and whether any word on the way was held at a rail.
struct Rounding {
    word: Format,
    saturated: bool,
}

impl Rounding {
    fn word(&mut self, x: Exact) -> Exact {
        let rounded = round(x, self.word);
        self.saturated |= rounded.held;
        rounded.value
    }

    /// Linear between neighbours: [near + (far − near) · w].
    fn between(&mut self, near: Exact, far: Exact, weight: Exact) -> Exact {
        self.word(near + (far - near) * weight)
    }

    fn curve(&mut self, entries: &[Exact], at: Exact) -> Exact {
        let (cell, weight) = cell(at, entries.len());
        self.between(entries[cell], entries[cell + 1], weight)
    }

    fn table(&mut self, nodes: &[Exact], u: Exact, v: Exact) -> Exact {
        let side = nodes.len().isqrt();
        let ((column, across), (row, down)) = (cell(u, side), cell(v, side));
        let mut along = |row: usize| {
            let left = row * side + column;
            self.between(nodes[left], nodes[left + 1], across)
        };
        let (above, below) = (along(row), along(row + 1));
        self.between(above, below, down)
    }

    fn straight(&mut self, across: Exact, middle: Exact, stretch: Exact) -> Exact {
        let stretch = if stretch < Exact::ZERO { Exact::ZERO } else { stretch };
        self.word((across - middle) * stretch.scaled(STRETCH))
    }
}

/// The cell of a table over −1 … 1 in which a coordinate lies, and how far into it.
fn cell(at: Exact, entries: usize) -> (usize, Exact) {
    let cells = Exact::new(entries as i128 - 1, 0);
    let place = ((at + Exact::new(1, 0)) * cells).scaled(-1);
    let cell = place.floor();
    (usize::try_from(cell).expect("a word is at least −1"), place - Exact::new(cell, 0))
}

impl Map {
    /// The map of a profile with these words, in their order in the memory.
    pub fn new(profile: &Profile, words: &[Exact]) -> Self {
        let mut words = words.iter().copied();
        let mut take = |count: usize| words.by_ref().take(count).collect::<Vec<_>>();
        let entries = |address: u8| (1 << address) + 1;
        let (edge, spacing) = (entries(profile.map.edge_address), entries(profile.map.spacing_address));
        let nodes = entries(profile.map.table_address) * entries(profile.map.table_address);
        Map {
            word: profile.formats.map,
            curves: [edge, edge, edge, edge, spacing, spacing].map(&mut take),
            tables: [nodes; 3].map(&mut take),
        }
    }

    /// The place for a pair of ratios, given the middle of their box and one over half its sides.
    pub fn place(&self, ratios: [Exact; 2], origin: [Exact; 2], scale: [Exact; 2]) -> Place {
        let mut to = Rounding { word: self.word, saturated: false };
        let [middle_y, stretch_y, middle_x, stretch_x, spacing_y, spacing_x] = &self.curves;
        let [p_x, p_y] = [0, 1].map(|axis| to.word((ratios[axis] - origin[axis]) * scale[axis]));
        let (middle, stretch) = (to.curve(middle_y, p_x), to.curve(stretch_y, p_x));
        let straight = to.straight(p_y, middle, stretch);
        let v = to.curve(spacing_y, straight);
        let (middle, stretch) = (to.curve(middle_x, v), to.curve(stretch_x, v));
        let straight = to.straight(p_x, middle, stretch);
        let u = to.curve(spacing_x, straight);
        let [x, y, sheet] = [0, 1, 2].map(|layer| to.table(&self.tables[layer], u, v));
        let sheet = if sheet < Exact::ZERO { Exact::ZERO } else { sheet };
        Place { x: x.scaled(POSITION), y: y.scaled(POSITION), sheet, saturated: to.saturated }
    }
}
