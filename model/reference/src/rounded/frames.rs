// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of frames. Ratios are rounded to the width of the widest other word. Invalid words repeat the pad's last
//! valid ones; a lifted pad repeats its place. The mean square, the last word, is always its own.

use super::{Exact, round};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

/// Words of a frame: r_x, r_y, x, y, R, C, F, mean square.
const WORDS: usize = 8;
/// Words of the place: r_x, r_y, x, y, R.
const PLACE: usize = 5;

/// What every pad last was.
#[derive(Debug, Clone)]
pub struct Frames {
    formats: [Format; WORDS],
    held: Vec<[i64; WORDS]>,
}

impl Frames {
    /// Frames of a profile, of pads that never were.
    pub fn new(profile: &Profile) -> Self {
        let f = &profile.formats;
        let position = f.position;
        let sheet = Format { signed: false, width: f.table.width - 1, ..f.table };
        let others = [position, position, sheet, f.capacitance, f.force, f.mean_square];
        let widest = others
            .iter()
            .map(|format| format.width + u8::from(!format.signed))
            .max()
            .expect("others");
        let width = f.ratio.width.min(widest);
        let ratio = Format::signed(width, width as i8 - 2);
        let [x, y, sheet, capacitance, force, mean_square] = others;
        let formats = [ratio, ratio, x, y, sheet, capacitance, force, mean_square];
        Frames { formats, held: vec![[0; WORDS]; profile.pads as usize] }
    }

    /// The codes of a frame with these values, which are invalid, or a lifted pad's.
    pub fn words(
        &mut self,
        pad: usize,
        values: [Exact; WORDS],
        [invalid, lifted]: [bool; 2],
    ) -> [i64; WORDS] {
        let mut words =
            std::array::from_fn(|k| round(values[k], self.formats[k]).value.code(self.formats[k]));
        let held = match (invalid, lifted) {
            (true, _) => WORDS - 1,
            (false, true) => PLACE,
            (false, false) => 0,
        };
        words[..held].copy_from_slice(&self.held[pad][..held]);
        self.held[pad] = words;
        words
    }
}
