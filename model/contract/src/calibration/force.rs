// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force table: what eq. 8's gain is multiplied by, from the capacitance and from the voltage
//! that the pad has had.
//!
//! ```text
//! V_s += α·(V − V_s),   V_m += β·(V − V_m)            once a frame of the pad; both 0 while V < release
//! factor = a(C) + b(C)·V_s + d(C)·(V_s − V_m)         a, b, d linear between 11 rows, 320 to 960 pF
//! F = gain · factor · (C·V)²
//! ```
//!
//! V is the square root of the mean-square word. In steady state the force is a function of
//! capacitance and voltage. While the gaps move, the force depends on the voltages of the recent
//! past: V_s forgets in 10 ms, V_m, as the rubber creeps, in 1.5 s. Source: docs/physics.md §3.

use super::position::Real;

/// From capacitance and past voltage to the factor of the force gain, and the words of a core's
/// force table.
///
/// ```
/// use hapticore_contract::calibration::{ForceTable, PastVoltage};
///
/// let mut table = ForceTable { recent: 0.5, mean: 0.01, release: 0.01, ..ForceTable::default() };
/// table.rows[1] = [1.5, 0.2, 0.0]; // at 384 pF
/// let mut past = PastVoltage::default();
/// past.follow(&table, 0.4);
/// assert_eq!((past.recent, past.mean), (0.2, 0.004));
/// assert_eq!(table.factor(352.0, past), (1.0 + 1.5 + 0.2 * 0.2) / 2.0);
/// past.follow(&table, 0.0);
/// assert_eq!(past, PastVoltage::default(), "released");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceTable {
    /// a, b and d of each row: the factor without voltage, its rise with V_s, and with V_s − V_m.
    pub rows: [[f64; 3]; ForceTable::ROWS],
    /// α: the share of the voltage's difference by which V_s follows it in a frame, 0 to 1.
    pub recent: f64,
    /// β: the same of V_m, below [`ForceTable::MOST_MEAN`].
    pub mean: f64,
    /// The voltage below which the pad counts as released, and is forgotten.
    pub release: f64,
}

/// Eq. 8: a factor of one.
impl Default for ForceTable {
    fn default() -> Self {
        ForceTable {
            rows: [[1.0, 0.0, 0.0]; ForceTable::ROWS],
            recent: 1.0,
            mean: 0.0,
            release: 0.0,
        }
    }
}

/// The voltage that a pad has had, as its filters have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PastVoltage<T = f64> {
    /// V_s.
    pub recent: T,
    /// V_m.
    pub mean: T,
}

/// A pad that has not been driven.
impl<T: Real> Default for PastVoltage<T> {
    fn default() -> Self {
        PastVoltage { recent: T::zero(), mean: T::zero() }
    }
}

impl<T: Real> PastVoltage<T> {
    /// A frame with this voltage goes by.
    pub fn follow(&mut self, table: &ForceTable, voltage: T) {
        if voltage < real(table.release) {
            *self = PastVoltage::default();
            return;
        }
        self.recent = self.recent + real::<T>(table.recent) * (voltage - self.recent);
        self.mean = self.mean + real::<T>(table.mean) * (voltage - self.mean);
    }
}

impl ForceTable {
    /// Rows.
    pub const ROWS: usize = 11;
    /// The capacitance of the first row, pF.
    pub const FIRST_PF: f64 = 320.0;
    /// From row to row, pF: a power of two, so that a core takes row and share from the bits.
    pub const STEP_PF: f64 = 64.0;
    /// A word of a row is this share of its number.
    pub const ROW_SHARE: f64 = 1.0 / 16.0;
    /// The word of α is this share of it.
    pub const RECENT_SHARE: f64 = 0.5;
    /// β is below this, and its word this often as large.
    pub const MOST_MEAN: f64 = 1.0 / 16.0;
    /// Words: those of the rows, α, β, the voltage of release.
    pub const WORDS: usize = 3 * ForceTable::ROWS + 3;

    /// The words in the order of a core's memory, as fractions.
    pub fn words(&self) -> [f64; ForceTable::WORDS] {
        let mut words = [0.0; ForceTable::WORDS];
        let (rows, others) = words.split_at_mut(3 * ForceTable::ROWS);
        let numbers = self.rows.as_flattened();
        rows.iter_mut().zip(numbers).for_each(|(word, row)| *word = row * ForceTable::ROW_SHARE);
        others.copy_from_slice(&[
            self.recent * ForceTable::RECENT_SHARE,
            self.mean / ForceTable::MOST_MEAN,
            self.release,
        ]);
        words
    }

    /// The row below a capacitance and the share of the next; beyond the ends those of the ends.
    pub fn place<T: Real>(capacitance_pf: T) -> (usize, T) {
        let last = real::<T>(ForceTable::ROWS as f64 - 1.0);
        let rows = (capacitance_pf - real(ForceTable::FIRST_PF)) / real(ForceTable::STEP_PF);
        let rows = rows.max(T::zero()).min(last);
        let below = rows.floor().min(last - T::one());
        (below.to_usize().unwrap_or(0), rows - below)
    }

    /// What the force gain is multiplied by.
    pub fn factor<T: Real>(&self, capacitance_pf: T, past: PastVoltage<T>) -> T {
        let (row, share) = ForceTable::place(capacitance_pf);
        let at = |row: usize| {
            let [a, b, d] = self.rows[row].map(real::<T>);
            a + b * past.recent + d * (past.recent - past.mean)
        };
        let below = at(row);
        below + share * (at(row + 1) - below)
    }
}

/// A number of the calibration, as it is.
fn real<T: Real>(x: f64) -> T {
    T::from_f64(x).expect("a floating-point type takes every f64")
}
