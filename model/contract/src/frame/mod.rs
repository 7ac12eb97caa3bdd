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
pub struct Reading<T = f64> {
    /// The pad.
    pub pad: usize,
    /// Eq. 2.
    pub r_x: T,
    /// Eq. 3.
    pub r_y: T,
    /// Millimetres from the middle, along the long edges.
    pub x_mm: T,
    /// Millimetres from the middle, along the short edges.
    pub y_mm: T,
    /// The sheet's resistance, in full scales of voltage per current.
    pub sheet: T,
    /// Picofarads.
    pub capacitance_pf: T,
    /// Newtons.
    pub force_n: T,
    /// The mean square of the haptic voltage, in full scales squared (a constant at full scale gives
    /// [`Profile::square_gain`]).
    pub mean_square: T,
    /// What to think of it.
    pub flags: Flags,
}

impl<T> Reading<T> {
    /// The reading with each of its numbers converted.
    pub fn map<U>(self, mut of: impl FnMut(T) -> U) -> Reading<U> {
        Reading {
            pad: self.pad,
            r_x: of(self.r_x),
            r_y: of(self.r_y),
            x_mm: of(self.x_mm),
            y_mm: of(self.y_mm),
            sheet: of(self.sheet),
            capacitance_pf: of(self.capacitance_pf),
            force_n: of(self.force_n),
            mean_square: of(self.mean_square),
            flags: self.flags,
        }
    }
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
