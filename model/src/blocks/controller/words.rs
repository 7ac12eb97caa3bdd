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
        correction(self.fine)
    }

    /// What the pad keeps of its correction.
    #[inline(always)]
    pub(super) fn kept_format(&self) -> Format {
        kept(self.law, self.fine)
    }

    /// A measured force, below the scale of targets.
    #[inline(always)]
    pub(super) fn measured_format(&self) -> Format {
        let frac = match self.law {
            // Its square root is as fine as a drive word, and takes twice as many bits.
            Law::Inverse => self.force.frac.clamp(0, 2 * self.fine.frac - self.shift),
            _ => measured_frac(self.fine, self.force, self.shift),
        };
        Format::unsigned((frac + self.shift) as u8, frac)
    }

    /// The error of forces, or of their roots.
    #[inline(always)]
    pub(super) fn error_format(&self) -> Format {
        match self.law {
            Law::Proportional => error(self.target, self.measured_format().frac),
            Law::Integral => correction(self.fine),
            Law::Inverse => less(correction(self.fine), Control::TRIM_ERROR_BITS),
            Law::Open => Format::NONE,
        }
    }

    /// What the correction's gain takes.
    #[inline(always)]
    pub(super) fn corrected_format(&self) -> Format {
        if self.law == Law::Proportional { self.correction_format() } else { self.error_format() }
    }

    /// The part of a cell of the curve.
    #[inline(always)]
    pub(super) fn part_format(&self) -> Format {
        let bits = self.fine.width - self.cell_bits();
        Format::unsigned(bits, bits as i8)
    }

    /// The trim as the drive is multiplied by it.
    #[inline(always)]
    pub(super) fn trim_format(&self) -> Format {
        less(self.correction_format(), Control::TRIM_BITS)
    }

    /// A register of laws with an error.
    #[inline(always)]
    pub(super) fn of_feedback(&self, format: Format) -> Format {
        format.where_present(self.feeds_back())
    }

    /// A register of laws with an error of roots.
    #[inline(always)]
    pub(super) fn of_roots(&self, format: Format) -> Format {
        format.where_present(self.roots_force())
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
        let step = (
            "the product of corrected error and gain",
            self.corrected_format().product(self.gain),
            self.kept_format(),
        );
        match self.law {
            Law::Open => vec![rise],
            Law::Proportional | Law::Integral => vec![
                rise,
                ("the product of error and gain", self.error_format().product(self.gain), signed),
                step,
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
                step,
                ("the product of trim and drive", self.trim_format().product(self.drive), signed),
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
            let fine = fine(control, f);
            let part = fine.width - control.cells.ilog2() as u8;
            let measured = measured_frac(fine, f.force, control.target_shift());
            (fine.width.max(error(*target, measured).width - 1), part.max(gain.width))
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

/// Bits by which roots are finer than drive words at most: those of forces in words beyond that are alike.
const FINEST: i8 = 8;

/// Roots of forces, the curve and what is added to it. In laws with an error they are so fine that the
/// roots of two forces are never the same: below 2^shift, √(F + step) − √F is over step/2^(shift/2 + 1).
pub(super) fn fine(control: &Control, f: &Formats) -> Format {
    let Control { law, drive, .. } = control;
    let bits = match law {
        Law::Open | Law::Inverse => 0,
        Law::Proportional | Law::Integral => {
            (f.force.frac + control.target_shift() + 1 - drive.frac).clamp(0, FINEST)
        }
    };
    Format::unsigned(drive.width + bits as u8, drive.frac + bits)
}

/// Fractional bits of a measured force: as many as its root tells apart.
const fn measured_frac(fine: Format, force: Format, shift: i8) -> i8 {
    let most = fine.frac - shift - 1;
    if force.frac < 0 {
        0
    } else if force.frac > most {
        most
    } else {
        force.frac
    }
}

/// What a square root is taken of: a target or force below one, or the inverse law's quotient.
pub(super) fn radicand(control: &Control, fine: Format) -> Format {
    let Control { drive, target, .. } = control;
    let bits = (2 * drive.frac).max(target.frac + control.target_shift()).max(fine.frac);
    Format::unsigned(bits as u8, bits)
}

const fn error(target: Format, measured_frac: i8) -> Format {
    let finer = if measured_frac > target.frac { measured_frac - target.frac } else { 0 };
    Format::signed(target.width + finer as u8 + 1, target.frac + finer)
}

/// Bits by which what a pad keeps is finer than what it corrects: with a gain of 2^-9 an error of one
/// step still moves it.
const FINER: u8 = 8;

pub(super) fn kept(law: Law, fine: Format) -> Format {
    let kept = Format::signed(fine.width + 1 + FINER, fine.frac + FINER as i8);
    if law == Law::Inverse { less(kept, Control::TRIM_BITS) } else { kept }
}

/// The same words below 2^-`bits` of full scale.
fn less(format: Format, bits: u8) -> Format {
    Format::signed(format.width - bits, format.frac)
}

pub(super) const fn correction(fine: Format) -> Format {
    Format::signed(fine.width + 1, fine.frac)
}
