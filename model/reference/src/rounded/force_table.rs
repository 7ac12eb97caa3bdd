// SPDX-License-Identifier: MIT OR Apache-2.0
//! Eq. 8 with a gain from the force table.
//!
//! ```text
//! V = [[√m]],   V_s' = [V_s + [α·(V − V_s)]],   V_m' = [V_m + [β·(V − V_m)]]       0 where V < release
//! f = [a + b·V_s' + d·(V_s' − V_m')]    of the row below C and of the one above
//! k = [gain · [f_below + share·(f_above − f_below)]],   F = [[[C²] · M] · k]
//! ```

use super::{Exact, Force, force, round, round_real, round_sqrt};
use hapticore_contract::calibration::ForceTable as Table;
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

/// The force table of a core, and the voltage that each of its pads has had: V_s and V_m.
#[derive(Debug, Clone)]
pub struct ForceTable {
    words: Vec<Exact>,
    past: Vec<[Exact; 2]>,
}

impl ForceTable {
    /// That of a profile with a calibration's table, of pads that never were driven.
    pub fn new(profile: &Profile, table: &Table) -> Self {
        let word = |word: &f64| round_real(*word, profile.formats.table);
        ForceTable::of_words(profile, table.words().iter().map(word).collect())
    }

    /// That of a profile with these words.
    pub fn of_words(profile: &Profile, words: Vec<Exact>) -> Self {
        ForceTable { words, past: vec![[Exact::ZERO; 2]; profile.pads as usize] }
    }

    /// Forgets the voltages of earlier windows.
    pub fn clear(&mut self) {
        self.past.fill([Exact::ZERO; 2]);
    }

    /// Other words; what pads have had stays.
    pub fn calibrate(&mut self, words: Vec<Exact>) {
        self.words = words;
    }

    /// As [`ForceTable::force`], but what the pad has had stays as it was: a frame's force is still
    /// to come.
    pub fn prompt(&mut self, profile: &Profile, pad: usize, numbers: [Exact; 3]) -> Force {
        let past = self.past[pad];
        let force = self.force(profile, pad, numbers);
        self.past[pad] = past;
        force
    }

    /// The force of a pad's next frame from capacitance, mean square and gain.
    pub fn force(
        &mut self,
        profile: &Profile,
        pad: usize,
        [capacitance, mean_square, gain]: [Exact; 3],
    ) -> Force {
        let mut saturated = self.follow(profile, pad, mean_square);
        let mut hold = |x: Exact, to: Format| {
            let rounded = round(x, to);
            saturated |= rounded.held;
            rounded.value
        };
        let word = profile.formats.table;
        let factor = Format::signed(word.width + 6, word.frac);
        let (row, share) = place(capacitance, profile.formats.capacitance);
        let [below, above] = [row, row + 1].map(|row| round(self.row(row, pad), factor).value);
        let factor = hold(below + share * (above - below), factor);
        let gain = hold(factor * gain, profile.formats.force_gain);
        let force = force(profile, [capacitance, mean_square, gain]);
        Force { saturated: saturated | force.saturated, ..force }
    }

    /// The pad's filters follow the voltage; whether one saturates.
    fn follow(&mut self, profile: &Profile, pad: usize, mean_square: Exact) -> bool {
        let to = profile.force.voltage;
        let frac = to.frac.max((profile.formats.mean_square.frac + 1) / 2);
        let voltage = round(round_sqrt(mean_square, frac), to);
        let [recent, mean, release] = [33, 34, 35].map(|word| self.words[word]);
        if voltage.value < release {
            self.past[pad] = [Exact::ZERO; 2];
            return voltage.held;
        }
        let shares = [recent.scaled(1), mean.scaled(-4)];
        let step = Format::signed(to.width + 4, to.frac);
        let next = |(past, share): (&Exact, Exact)| {
            round(*past + round(share * (voltage.value - *past), step).value, to)
        };
        let next: Vec<_> = self.past[pad].iter().zip(shares).map(next).collect();
        self.past[pad] = [next[0].value, next[1].value];
        voltage.held | next[0].held | next[1].held
    }

    /// What the words of a row make of the pad's past.
    fn row(&self, row: usize, pad: usize) -> Exact {
        let [recent, mean] = self.past[pad];
        let [a, b, d] = [0, 1, 2].map(|column| self.words[3 * row + column].scaled(4));
        a + b * recent + d * (recent - mean)
    }
}

/// The row below a capacitance and the share of the one above: of the first row what is less, of
/// the last code before the end of the table what is more.
fn place(capacitance: Exact, format: Format) -> (usize, Exact) {
    let end = Exact::new(640, 0) - Exact::of(1, format);
    let offset = capacitance - Exact::new(320, 0);
    let offset = if offset < Exact::ZERO { Exact::ZERO } else { offset };
    let rows = if offset < end { offset } else { end }.scaled(-6);
    (rows.floor() as usize, rows - Exact::new(rows.floor(), 0))
}
