// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames: what the core says of a pad after its slot.

mod field;

pub use field::Field;

use crate::profile::Profile;

/// What to think of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Flags {
    /// A code was at a rail of the ADC.
    pub clipped: bool,
    /// A word was held at a rail.
    pub saturated: bool,
    /// There is no such position or capacitance: the pad's last valid results stand.
    pub invalid: bool,
    /// A terminal's current is that of an open one.
    pub lost: bool,
}

/// A frame: codes of all fields, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// The pad.
    pub pad: usize,
    /// The codes, in the formats of [`Field::format`].
    pub codes: [i64; Field::ALL.len()],
    /// What to think of it.
    pub flags: Flags,
}

/// The numbers of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// The pad.
    pub pad: usize,
    /// Eq. 2.
    pub r_x: f64,
    /// Eq. 3.
    pub r_y: f64,
    /// Millimetres from the middle, along the long edges.
    pub x_mm: f64,
    /// Millimetres from the middle, along the short edges.
    pub y_mm: f64,
    /// The sheet's resistance, in full scales of voltage per current.
    pub sheet: f64,
    /// Picofarads.
    pub capacitance_pf: f64,
    /// Newtons.
    pub force_n: f64,
    /// The mean square of the haptic voltage, in full scales squared (a constant at full scale gives
    /// [`Profile::square_gain`]).
    pub mean_square: f64,
    /// What to think of it.
    pub flags: Flags,
}

impl Frame {
    /// The numbers that the codes stand for.
    pub fn reading(&self, profile: &Profile) -> Reading {
        let of = |field: Field| field.format(profile).real(self.codes[field as usize]);
        Reading {
            pad: self.pad,
            r_x: of(Field::RatioX),
            r_y: of(Field::RatioY),
            x_mm: of(Field::X),
            y_mm: of(Field::Y),
            sheet: of(Field::Sheet),
            capacitance_pf: of(Field::Capacitance),
            force_n: of(Field::Force),
            mean_square: of(Field::MeanSquare),
            flags: self.flags,
        }
    }
}
