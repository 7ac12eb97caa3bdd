// SPDX-License-Identifier: MIT OR Apache-2.0
//! The formats of the force controller's words.

use super::Controller;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Formats;
use hapticore_hdl::format::Format;

impl Controller {
    /// k·C², N.
    #[inline(always)]
    pub(super) fn stiffness_format(&self) -> Format {
        stiffness(self.square)
    }

    /// F_t/G, N.
    #[inline(always)]
    pub(super) fn numerator_format(&self) -> Format {
        numerator(self.target)
    }

    /// What is added to the curve, and steps along it.
    #[inline(always)]
    pub(super) fn correction_format(&self) -> Format {
        correction(self.drive)
    }

    /// What the pad keeps of its correction.
    #[inline(always)]
    pub(super) fn kept_format(&self) -> Format {
        kept(self.drive)
    }

    /// What rounding takes from a drive: half a step of its word, of either sign.
    #[inline(always)]
    pub(super) fn residue_format(&self) -> Format {
        Format::signed(FINER + 1, self.kept_format().frac)
    }

    /// The error of forces, or of their roots.
    #[inline(always)]
    pub(super) fn error_format(&self) -> Format {
        match self.law {
            Law::Proportional => Format::signed(self.target.width + 1, self.target.frac),
            Law::Integral => correction(self.drive),
            Law::Open | Law::Inverse => Format::NONE,
        }
    }

    /// What the correction's gain takes.
    #[inline(always)]
    pub(super) fn corrected_format(&self) -> Format {
        if self.law == Law::Integral { self.error_format() } else { self.correction_format() }
    }

    /// The part of a cell of the curve.
    #[inline(always)]
    pub(super) fn part_format(&self) -> Format {
        let bits = self.drive.width - self.cell_bits();
        Format::unsigned(bits, bits as i8)
    }

    /// A register of laws with an error.
    #[inline(always)]
    pub(super) fn of_feedback(&self, format: Format) -> Format {
        format.where_present(self.feeds_back())
    }

    /// A register of the integral law.
    #[inline(always)]
    pub(super) fn of_integral(&self, format: Format) -> Format {
        format.where_present(self.law == Law::Integral)
    }

    /// A register of the inverse law.
    #[inline(always)]
    pub(super) fn of_inverse(&self, format: Format) -> Format {
        format.where_present(self.law == Law::Inverse)
    }

    /// The products of the law by name, and the formats to which they are rounded.
    pub(super) fn products(&self) -> Vec<(&'static str, Format, Format)> {
        let signed = self.correction_format();
        let rise = ("the rise within a cell", signed.product(self.part_format()), signed);
        match self.law {
            Law::Open => vec![rise],
            Law::Proportional | Law::Integral => vec![
                rise,
                ("the product of error and gain", self.error_format().product(self.gain), signed),
                (
                    "the product of corrected error and gain",
                    self.corrected_format().product(self.gain),
                    self.kept_format(),
                ),
            ],
            Law::Inverse => vec![
                rise,
                (
                    "the square of the capacitance",
                    self.capacitance.product(self.capacitance),
                    self.square,
                ),
                (
                    "the product of square and gain",
                    self.square.product(self.force_gain),
                    self.stiffness_format(),
                ),
                (
                    "the product of target and gain",
                    self.target.product(self.gain),
                    self.numerator_format(),
                ),
            ],
        }
    }
}

/// The multiplier's operands: a word with a sign, and one without.
pub(super) fn operands(control: &Control, f: &Formats) -> (Format, Format) {
    let Control { law, drive, target, gain, .. } = control;
    let (left, right) = match law {
        Law::Open => (drive.width, drive.width),
        Law::Proportional | Law::Integral => {
            (drive.width.max(target.width), drive.width.max(gain.width))
        }
        Law::Inverse => (
            drive.width.max(target.width).max(f.capacitance.width).max(f.square.width),
            drive.width.max(f.capacitance.width).max(f.force_gain.width).max(gain.width),
        ),
    };
    (Format::signed(left + 1, 0), Format::unsigned(right, 0))
}

pub(super) const fn stiffness(square: Format) -> Format {
    Format::unsigned(square.width, square.width as i8 - 4)
}

pub(super) const fn numerator(target: Format) -> Format {
    Format::unsigned(target.width + 3, target.frac)
}

/// Bits by which what a pad keeps is finer than a drive word: with a gain of 2^-9 an error of one step
/// still moves it.
const FINER: u8 = 8;

pub(super) const fn kept(drive: Format) -> Format {
    Format::signed(drive.width + 1 + FINER, drive.frac + FINER as i8)
}

pub(super) const fn correction(drive: Format) -> Format {
    Format::signed(drive.width + 1, drive.frac)
}
