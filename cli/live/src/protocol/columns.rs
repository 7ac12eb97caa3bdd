// SPDX-License-Identifier: MIT OR Apache-2.0
//! Columns of `frames.pads`: the one list of them.

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

use super::state::State;

/// A column of numbers.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Its key in `frames.pads`.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is called.
    pub label: &'static str,
    /// Decimal digits that are sent.
    digits: i32,
    get: fn(&PadRow) -> Option<f64>,
}

impl PartialEq for Column {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Serialize for Column {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(3))?;
        map.serialize_entry("name", self.name)?;
        map.serialize_entry("unit", self.unit)?;
        map.serialize_entry("label", self.label)?;
        map.end()
    }
}

impl Column {
    /// The value of a row, rounded; none where the row has none or it is not finite.
    pub fn value(&self, row: &PadRow) -> Option<f64> {
        (self.get)(row).and_then(|value| rounded(value, self.digits))
    }
}

/// A number with this many decimal digits; none where it is not finite.
pub(crate) fn rounded(value: f64, digits: i32) -> Option<f64> {
    let scale = 10f64.powi(digits);
    // Adding zero makes −0 a 0.
    let rounded = (value * scale).round() / scale + 0.0;
    rounded.is_finite().then_some(rounded)
}

macro_rules! columns {
    ($($name:ident, $unit:literal, $label:literal, $digits:literal;)*) => {
        /// The latest frame of a pad.
        #[derive(Debug, Clone, Default, PartialEq)]
        pub struct PadRow {
            /// Pad number, from 0.
            pub pad: usize,
            $(#[doc = concat!($label, ", ", $unit, ".")] pub $name: Option<f64>,)*
            /// The pad's state.
            pub state: State,
            /// Names of the frame's flags, joined by `+`.
            pub flags: String,
        }

        /// The columns of numbers, in their order.
        pub const COLUMNS: [Column; [$($digits),*].len()] = [$(Column {
            name: stringify!($name), unit: $unit, label: $label, digits: $digits, get: |row| row.$name,
        }),*];
    };
}

columns! {
    age_ms, "ms", "Age of the frame", 2;
    x_mm, "mm", "Measured position along x", 4;
    y_mm, "mm", "Measured position along y", 4;
    force_n, "N", "Measured haptic force", 5;
    capacitance_pf, "pF", "Measured capacitance", 3;
    haptic_v_rms, "V", "Measured haptic voltage, RMS", 2;
    true_x_mm, "mm", "True position along x", 4;
    true_y_mm, "mm", "True position along y", 4;
    true_force_n, "N", "True haptic force", 5;
    true_capacitance_pf, "pF", "True capacitance", 3;
    true_haptic_v_rms, "V", "True haptic voltage, RMS", 2;
    finger_x_mm, "mm", "Position of the finger along x", 4;
    finger_y_mm, "mm", "Position of the finger along y", 4;
    hand_x_n, "N", "Force of the hand along x", 5;
    hand_y_n, "N", "Force of the hand along y", 5;
    load_g, "g", "Load", 3;
    target_n, "N", "Target force", 5;
    drive_v_rms, "V", "Drive, RMS", 2;
    depth_mm, "mm", "Measured depth in the wall", 4;
}

/// Rows as a map of columns.
pub(super) fn as_columns<S: Serializer>(rows: &[PadRow], serializer: S) -> Result<S::Ok, S::Error> {
    fn column<T>(rows: &[PadRow], of: impl Fn(&PadRow) -> T) -> Vec<T> {
        rows.iter().map(of).collect()
    }
    let mut map = serializer.serialize_map(Some(COLUMNS.len() + 3))?;
    map.serialize_entry("pad", &column(rows, |row| row.pad))?;
    for of in &COLUMNS {
        map.serialize_entry(of.name, &column(rows, |row| of.value(row)))?;
    }
    map.serialize_entry("state", &column(rows, |row| row.state))?;
    map.serialize_entry("flags", &column(rows, |row| row.flags.clone()))?;
    map.end()
}
