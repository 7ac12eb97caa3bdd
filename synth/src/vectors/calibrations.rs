// SPDX-License-Identifier: MIT OR Apache-2.0
//! Calibrations: that of a sheet, and words that break a careless core.

use super::Noise;
use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_rtl::codes::CalibrationWords;

/// What is written before a slot's frame is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Set {
    /// As a sheet has them, its ratios flattening towards its edges.
    Sheet,
    /// That of another sheet, seen from behind, whose resistance is negative in places.
    Behind,
    /// The table stays, the constants are any.
    Constants,
    /// The constants are any, the sheet's resistance is everywhere this code.
    Flat(i64),
    /// Powers of two: what is rounded then often lies halfway.
    Powers,
    /// At full scale, next to it or to zero, or anything.
    Corners,
}

/// Constants by name, and words of the table by address.
pub type Written = Vec<(String, i64)>;

impl Set {
    /// The words to be written, in order.
    pub fn written(self, profile: &Profile, noise: &mut Noise) -> Written {
        let sheet = CalibrationWords::new(profile, &sheet(profile, self));
        let code = |before: i64, format: Format, noise: &mut Noise| match self {
            Set::Sheet | Set::Behind => before,
            Set::Constants | Set::Flat(_) => noise.any(format),
            Set::Powers => power(format, noise),
            Set::Corners => corner(format, noise),
        };
        let mut written = Written::new();
        for word in sheet.constants {
            written.push((word.constant.name().into(), code(word.code, word.format, noise)));
        }
        if self != Set::Constants {
            let words = (0..).zip(&sheet.table);
            let is_flat = matches!(self, Set::Flat(_));
            let mut code =
                |word: i64| if is_flat { word } else { code(word, sheet.table_format, noise) };
            written.extend(words.map(|(address, &word)| (address.to_string(), code(word))));
        }
        written
    }
}

fn power(format: Format, noise: &mut Noise) -> i64 {
    let code = 1 << noise.below(u32::from(format.width));
    let code = if format.min_code() < 0 && noise.below(2) == 0 { -code } else { code };
    code.clamp(format.min_code() as i64, format.max_code() as i64)
}

fn corner(format: Format, noise: &mut Noise) -> i64 {
    let (low, high) = (format.min_code() as i64, format.max_code() as i64);
    match noise.below(8) {
        0 => low,
        1 => high,
        2 => low + 1,
        3 => 0,
        4 => 1,
        5 => (-1).max(low),
        _ => noise.any(format),
    }
}

/// A calibration such as a sheet has.
pub fn sheet(profile: &Profile, set: Set) -> Calibration {
    let (columns, rows) = (41, 25);
    let point = |k: usize| {
        let (u, v) = ((k % columns) as f64 / 20.0 - 1.0, (k / columns) as f64 / 12.0 - 1.0);
        let r_x = u * (0.95 - 0.2 * u * u) * (1.0 - 0.15 * v * v);
        let r_y = v * (0.9 - 0.2 * v * v) * (1.0 - 0.3 * u * u);
        let before =
            Point { x: 400.0 * u, y: 220.0 * v, r_x, r_y, sheet: 0.05 + 0.02 * u * u + 0.01 * v };
        match set {
            Set::Behind => {
                Point { x: 80.0 - 500.0 * u, y: 300.0 * v, r_x, r_y, sheet: 0.2 - 0.9 * u * v }
            }
            Set::Flat(code) => Point { sheet: code as f64 / 32_768.0, ..before },
            _ => before,
        }
    };
    let points: Vec<Point> = (0..columns * rows).map(point).collect();
    let position = PositionTable::fit(profile, &points).expect("a sheet").with_open_share(0.01);
    let force_table = ForceTable::default();
    let (capacitance_gain, force_gain, contact_capacitance) = (800.0, 2e-6, 100.0);
    Calibration { position, capacitance_gain, force_gain, contact_capacitance, force_table }
}
