// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words that make a calibrated sensor of a core: constants at its ports, and the words of its
//! position table.
//!
//! The one list of the constants: a board's registers, its start-up, `hapticore codes` and the
//! vectors for users of the Verilog all follow it. A test of `hapticore-rtl` holds it equal to the
//! core's ports.

use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;

/// A constant of the calibration: a port of the core and a register of a board.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Constant {
    /// Picofarads at an admittance of one.
    CapacitanceGain,
    /// Newtons per square picofarad at the full haptic mean square.
    ForceGain,
    /// Picofarads at or below which a pad is lifted.
    ContactCapacitance,
}

impl Constant {
    /// All constants, in the order of the core's ports.
    pub const ALL: [Constant; 3] =
        [Constant::CapacitanceGain, Constant::ForceGain, Constant::ContactCapacitance];

    /// The name of its port, and of its register.
    pub const fn name(self) -> &'static str {
        match self {
            Constant::CapacitanceGain => "capacitance_gain",
            Constant::ForceGain => "force_gain",
            Constant::ContactCapacitance => "contact_capacitance",
        }
    }

    /// What it is, for readers of a table.
    pub const fn about(self) -> &'static str {
        match self {
            Constant::CapacitanceGain => "Calibration: picofarads at an admittance of one.",
            Constant::ForceGain => {
                "Calibration: newtons per square picofarad at full haptic mean square."
            }
            Constant::ContactCapacitance => {
                "Calibration: picofarads at or below which a pad is lifted."
            }
        }
    }

    /// Its format in a core of the profile.
    pub const fn format(self, profile: &Profile) -> Format {
        match self {
            Constant::CapacitanceGain => profile.formats.capacitance_gain,
            Constant::ForceGain => profile.formats.force_gain,
            Constant::ContactCapacitance => profile.formats.capacitance,
        }
    }

    /// Its value in a calibration.
    pub const fn value(self, calibration: &Calibration) -> f64 {
        match self {
            Constant::CapacitanceGain => calibration.capacitance_gain,
            Constant::ForceGain => calibration.force_gain,
            Constant::ContactCapacitance => calibration.contact_capacitance,
        }
    }
}

/// The formats of all words that commands write: those of a calibration, and how wide others are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WordFormats {
    /// Of the constants, in the order of [`Constant::ALL`].
    pub constants: [Format; Constant::ALL.len()],
    /// Of the words of the position table.
    pub table: Format,
    /// Bits of the widest word of the drive, where the board has one; else none.
    pub drive_bits: u8,
}

impl WordFormats {
    /// Those of a core of the profile.
    pub fn new(profile: &Profile) -> Self {
        WordFormats {
            constants: Constant::ALL.map(|constant| constant.format(profile)),
            table: profile.formats.table,
            drive_bits: crate::drive::widest(profile),
        }
    }
}

/// A constant and its code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ConstantWord {
    /// Which constant it is.
    pub constant: Constant,
    /// Raw code of the word.
    pub code: i64,
    /// Number format of the word.
    pub format: Format,
}

/// A calibration as codes for a core: the values of its ports and of its position table.
///
/// ```
/// # use hapticore_contract::calibration::{Calibration, ForceTable, Point, PositionTable};
/// # use hapticore_contract::profile::Profile;
/// use hapticore_protocol::{CalibrationWords, Constant};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let profile = Profile::bundled("standard")?;
/// # let places = (0..9 * 7).map(|k| (f64::from(k % 9) / 4.0 - 1.0, f64::from(k / 9) / 3.0 - 1.0));
/// # let point = |(x, y)| Point { x: 400.0 * x, y: 220.0 * y, r_x: 0.8 * x, r_y: 0.8 * y, sheet: 0.05 };
/// # let position = PositionTable::fit(&profile, &places.map(point).collect::<Vec<_>>())?;
/// let force_table = ForceTable::default();
/// let (capacitance_gain, force_gain, contact_capacitance) = (800.0, 2e-6, 100.0);
/// let calibration =
///     Calibration { position, capacitance_gain, force_gain, contact_capacitance, force_table };
/// let words = CalibrationWords::new(&profile, &calibration);
/// let gain = words.constant(Constant::CapacitanceGain);
/// assert_eq!(gain.format.real(gain.code), 800.0);
/// assert_eq!(words.table.len(), calibration.position.words.len());
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CalibrationWords {
    /// The constants, in the order of [`Constant::ALL`].
    pub constants: [ConstantWord; Constant::ALL.len()],
    /// The words of the position table and, where the law is one, of the force table behind it, by
    /// address.
    pub table: Vec<i64>,
    /// The format of the table's words.
    pub table_format: Format,
}

impl CalibrationWords {
    /// The words of a calibration for a core of a profile. Numbers beyond their formats saturate;
    /// [`Calibration::check`] tells.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let constants = Constant::ALL.map(|constant| {
            let format = constant.format(profile);
            ConstantWord {
                constant,
                code: format.code_saturating(constant.value(calibration)),
                format,
            }
        });
        let table_format = profile.formats.table;
        let words = calibration.words(profile).into_iter();
        let table = words.map(|real| table_format.code_saturating(real)).collect();
        CalibrationWords { constants, table, table_format }
    }

    /// The word of a constant.
    pub fn constant(&self, constant: Constant) -> ConstantWord {
        self.constants[constant as usize]
    }
}
