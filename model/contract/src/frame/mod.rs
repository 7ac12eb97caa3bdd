// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames: what the core says of a pad after its slot.

mod field;

pub use field::Field;

use crate::profile::Profile;

/// What to think of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Flags {
    /// An ADC code of the window was at full scale.
    pub clipped: bool,
    /// A word of the estimate is saturated.
    pub saturated: bool,
    /// No such position or capacitance: the words repeat the pad's last valid ones.
    pub invalid: bool,
    /// Open terminal: a current is below the calibrated threshold.
    pub lost: bool,
    /// The pad does not touch: its capacitance is at most the calibrated least of a contact. Capacitance and force are
    /// this slot's; ratios, position and sheet resistance repeat the pad's last valid ones.
    pub lifted: bool,
}

/// A frame: codes of all fields, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// Pad number, from 0.
    pub pad: usize,
    /// The codes, in the formats of [`Field::format`].
    pub codes: [i64; Field::ALL.len()],
    /// What to think of it.
    pub flags: Flags,
}

/// The numbers of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement<T = f64> {
    /// Pad number, from 0.
    pub pad: usize,
    /// Ratio r_x of eq. 2.
    pub r_x: T,
    /// Ratio r_y of eq. 3.
    pub r_y: T,
    /// Millimetres from the middle, along the long edges.
    pub x_mm: T,
    /// Millimetres from the middle, along the short edges.
    pub y_mm: T,
    /// The sheet's resistance, in full scales of voltage per current.
    pub sheet: T,
    /// Capacitance between pad and sheet, pF.
    pub capacitance_pf: T,
    /// Haptic force of eq. 8, N.
    pub force_n: T,
    /// The mean square of the haptic voltage, in full scales squared (a constant at full scale
    /// gives [`Profile::square_gain`]).
    pub mean_square: T,
    /// What to think of it.
    pub flags: Flags,
}

impl<T> Measurement<T> {
    /// The measurement with each of its numbers converted.
    ///
    /// ```
    /// use hapticore_contract::{frame::{Flags, Frame, Measurement}, profile::Profile};
    ///
    /// let profile = Profile::bundled("standard")?;
    /// let frame = Frame { pad: 0, codes: [0, 0, 96, 0, 0, 0, 0, 0], flags: Flags::default() };
    /// let single: Measurement<f32> = frame.measurement(&profile).map(|number| number as f32);
    /// assert_eq!(f64::from(single.x_mm), frame.measurement(&profile).x_mm);
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    pub fn map<U>(self, mut of: impl FnMut(T) -> U) -> Measurement<U> {
        Measurement {
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
    ///
    /// ```
    /// use hapticore_contract::{frame::{Field, Flags, Frame}, profile::Profile};
    ///
    /// let profile = Profile::bundled("standard")?;
    /// let mut codes = [0; Field::ALL.len()];
    /// codes[Field::Force as usize] = Field::Force.format(&profile).code(0.25).expect("a quarter of a newton");
    /// let flags = Flags { saturated: true, ..Flags::default() };
    /// let measurement = Frame { pad: 3, codes, flags }.measurement(&profile);
    /// assert_eq!((measurement.pad, measurement.force_n, measurement.flags.saturated), (3, 0.25, true));
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    pub fn measurement(&self, profile: &Profile) -> Measurement {
        let of = |field: Field| field.format(profile).real(self.codes[field as usize]);
        Measurement {
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
