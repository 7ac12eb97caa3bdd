// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force controller, exactly rounded (docs/physics.md §6; laws in `hapticore_contract::control`).
//!
//! ```text
//! s = min([√(F_t/4^h)], 1 − lsb),   D = D_n + [(D_n+1 − D_n)·p],   n + p = cells·s
//! inverse        e = [s' − [√(F/4^h)]], s' that of the pad's last valid frame, e = 0 where s' is,  B = min([√[[F_t/G] / [k·[C²]]]], D),  d = B + [[c + [K_i·e]]·B]
//! proportional   p = [K·[F_t − F]],   d = D + [c + [α·[p − c]]]
//! integral       e = s − [√(F/4^h)],  d = D + [K·e] + [c + [K_i·e]]
//! ```
//!
//! In laws with an error, s, D and what is added to it are finer than a drive word, by 8 bits at most, so that the
//! roots of two forces differ. Their step is 2^-b with b ≥ (bits of a force) + 2·h + 1; F has no more bits than that
//! lets differ. c is 8 bits finer still. It stays as it is while estimates are invalid. While drives are off they are
//! zero, and every pad begins anew. Against a limit that holds the drive it goes as far as drive − (D + K·e), and not
//! back; the trim of the inverse law stays as it is.
//!
//! [x] is x in its format: to the nearest code, ties to even, saturated.

use super::{Exact, round, round_quotient, round_real, round_sqrt};
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::format::Format;
use hapticore_contract::profile::Profile;

/// What a controller is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Pad whose drive word is made.
    pub pad: usize,
    /// Target force, N.
    pub target: Exact,
    /// Capacitance, pF.
    pub capacitance: Exact,
    /// Measured force, N.
    pub force: Exact,
    /// Gain of the force.
    pub force_gain: Exact,
    /// The estimate is invalid.
    pub invalid: bool,
    /// The pad does not touch.
    pub lifted: bool,
    /// Drives follow their targets.
    pub enable: bool,
}

/// What is known of a pad.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pad {
    invalid: u64,
    drive: Exact,
    correction: Exact,
    /// Root of the target of its last valid frame.
    asked: Exact,
    /// It has been lifted, and its drive has not been what its law wants since.
    rises: bool,
}

/// A pad of which nothing is known.
const ANEW: Pad = Pad {
    invalid: 0,
    drive: Exact::ZERO,
    correction: Exact::ZERO,
    asked: Exact::ZERO,
    rises: false,
};

/// A drive word, and whether it should be below zero or beyond the rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// The drive word, full scales.
    pub drive: Exact,
    /// It is at zero and should be below.
    pub low: bool,
    /// It is at the rail and should be beyond.
    pub high: bool,
}

/// The force controller of all pads.
#[derive(Debug, Clone)]
pub struct Controller {
    profile: Profile,
    control: Control,
    tuning: Words,
    pads: Vec<Pad>,
    silent: u64,
    /// There has been a tick.
    ticks: bool,
    /// Silence, sensor, force: latched.
    pub faults: [bool; 3],
}

/// The tuning, rounded.
#[derive(Debug, Clone)]
struct Words {
    curve: Vec<Exact>,
    full_drive: Exact,
    proportional: Exact,
    correction: Exact,
    rail: Exact,
    slew: Exact,
    force_cap: Exact,
}

impl Controller {
    /// The controller of a profile, tuned, with all drives at zero.
    ///
    /// # Panics
    /// Where the profile has none.
    pub fn new(profile: &Profile, tuning: &Tuning) -> Self {
        let control = profile.control.clone().expect("a profile with a controller");
        let (drive, gain) = (|x| round_real(x, control.drive), |x| round_real(x, control.gain));
        let tuning = Words {
            curve: tuning.curve.iter().map(|&word| drive(word)).collect(),
            full_drive: gain(tuning.full_drive),
            proportional: gain(tuning.proportional),
            correction: gain(tuning.correction),
            rail: drive(tuning.rail),
            slew: drive(tuning.slew),
            force_cap: round_real(tuning.force_cap.min(1e9), profile.formats.force),
        };
        Controller {
            pads: vec![ANEW; profile.pads as usize],
            profile: profile.clone(),
            control,
            tuning,
            silent: 0,
            ticks: false,
            faults: [false; 3],
        }
    }

    /// The host is alive.
    pub fn hear(&mut self) {
        self.silent = 0;
    }

    /// A millisecond has passed.
    pub fn tick(&mut self) {
        self.ticks = true;
        self.silent = (self.silent + 1).min(self.control.silent_ms);
        self.watch();
    }

    /// Clears all faults.
    pub fn clear_faults(&mut self) {
        self.faults = [false; 3];
        self.watch();
    }

    /// Every pad begins anew.
    pub fn clear(&mut self) {
        self.pads.fill(ANEW);
    }

    fn watch(&mut self) {
        self.faults[0] |= self.silent == self.control.silent_ms;
        if self.faults.contains(&true) {
            self.clear();
        }
    }

    /// The drive word of a pad.
    pub fn drive(&mut self, request: &Request) -> Drive {
        if !request.enable || !self.ticks || self.faults.contains(&true) {
            self.clear();
        }
        let pad = self.pads[request.pad];
        let most = self.control.invalid_frames;
        let invalid = if request.invalid { (pad.invalid + 1).min(most) } else { 0 };
        self.faults[1] |= invalid == most;
        self.faults[2] |= !request.invalid && request.force > self.tuning.force_cap;
        let (correction, wanted) = self.wanted(request, pad);
        let rounded = round(wanted, self.control.drive).value;
        let rail = self.tuning.rail;
        let (low, high) = (wanted < Exact::ZERO, wanted > rail);
        let within = if low {
            Exact::ZERO
        } else if high {
            rail
        } else {
            rounded
        };
        let off = !request.enable || !self.ticks || self.faults.contains(&true);
        let last = if pad.drive > rail { rail } else { pad.drive };
        let slewed = self.slewed(last, pad.rises, if request.invalid { last } else { within });
        let drive = if off || request.lifted { Exact::ZERO } else { slewed };
        let rises = request.lifted || pad.rises && (request.invalid || drive < within);
        let limit = match self.control.law {
            Law::Inverse => pad.correction,
            _ => round(drive - (wanted - correction), self.kept()).value,
        };
        let falls = correction < pad.correction;
        let correction = if request.invalid {
            pad.correction
        } else if falls && (low || drive > within) {
            if limit < pad.correction { limit } else { pad.correction }
        } else if !falls && (high || drive < within) {
            if limit > pad.correction { limit } else { pad.correction }
        } else {
            correction
        };
        let correction = if request.lifted { Exact::ZERO } else { correction };
        let asked = match request {
            Request { lifted: true, .. } => Exact::ZERO,
            Request { invalid: true, .. } => pad.asked,
            _ => self.root(request.target),
        };
        self.pads[request.pad] = Pad { invalid, drive, correction, asked, rises };
        if off {
            self.clear();
        }
        let measured = !request.invalid && !request.lifted;
        let low = low && drive == Exact::ZERO && measured;
        Drive { drive, low, high: high && drive >= rail && measured }
    }

    fn slewed(&self, last: Exact, rises: bool, to: Exact) -> Exact {
        let slew = self.tuning.slew;
        let contact = round_real(self.control.contact_slew(), self.control.drive);
        let up = if rises && contact < slew { contact } else { slew };
        let change = to - last;
        if change > up {
            return round(last + up, self.control.drive).value;
        }
        if change < Exact::ZERO && change.magnitude() > slew { last - slew } else { to }
    }

    /// Bits of a root, and of what is added to the curve.
    fn bits(&self) -> i8 {
        let drive = self.control.drive.frac;
        match self.control.law {
            Law::Open | Law::Inverse => drive,
            _ => self
                .profile
                .formats
                .force
                .frac
                .saturating_add(self.control.target_shift() + 1)
                .clamp(drive, drive + 8),
        }
    }

    /// A measured force below 4^h, in words whose roots differ.
    fn measured(&self) -> Format {
        let shift = self.control.target_shift();
        let most = match self.control.law {
            Law::Inverse => 2 * self.bits() - shift,
            _ => self.bits() - shift - 1,
        };
        let frac = self.profile.formats.force.frac.clamp(0, most);
        Format::unsigned((frac + shift) as u8, frac)
    }

    fn signed(&self) -> Format {
        Format::signed(self.bits() as u8 + 1, self.bits())
    }

    fn kept(&self) -> Format {
        let frac = self.bits() + 8;
        match self.control.law {
            Law::Inverse => Format::signed(frac as u8 + 1 - Control::TRIM_BITS, frac),
            _ => Format::signed(frac as u8 + 1, frac),
        }
    }

    /// √(F/4^h), below one.
    fn root(&self, force: Exact) -> Exact {
        let fraction = Format::unsigned(self.bits() as u8, self.bits());
        round(round_sqrt(force.scaled(-self.control.target_shift()), self.bits()), fraction).value
    }

    /// The curve at a root.
    fn curve(&self, root: Exact) -> Exact {
        let bits = self.control.cells.ilog2() as i8;
        let scaled = root.scaled(bits);
        let cell = scaled.floor();
        let part = scaled - Exact::new(cell, 0);
        let [low, high] = [cell, cell + 1].map(|n| self.tuning.curve[n as usize]);
        low + round((high - low) * part, self.signed()).value
    }

    /// The correction after this frame, and the drive without limits.
    fn wanted(&self, request: &Request, pad: Pad) -> (Exact, Exact) {
        let (t, signed) = (&self.tuning, self.signed());
        let root = self.root(request.target);
        let curve = self.curve(root);
        match self.control.law {
            Law::Open => (Exact::ZERO, curve),
            Law::Inverse => {
                let inverse = self.inverse(request);
                let base = if inverse > curve { curve } else { inverse };
                let trim = self.trim(request, pad);
                let frac = self.bits();
                let operand = Format::signed(frac as u8 + 1 - Control::TRIM_BITS, frac);
                (trim, base + round(round(trim, operand).value * base, signed).value)
            }
            Law::Proportional => {
                let target = self.control.target;
                let frac = target.frac.max(self.measured().frac);
                let format = Format::signed(target.integer_bits() as u8 + frac as u8 + 1, frac);
                let error = round(request.target - request.force, format).value;
                let scaled = round(error * t.proportional, signed).value;
                let away = round(scaled - pad.correction, signed).value;
                let step = round(away * t.correction, self.kept()).value;
                let correction = round(pad.correction + step, self.kept()).value;
                (correction, curve + correction)
            }
            Law::Integral => {
                let force = round(request.force, self.measured()).value;
                let error = root - self.root(force);
                let proportional = round(error * t.proportional, signed).value;
                let step = round(error * t.correction, self.kept()).value;
                let correction = round(pad.correction + step, self.kept()).value;
                (correction, curve + proportional + correction)
            }
        }
    }

    /// The trim after this frame.
    fn trim(&self, request: &Request, pad: Pad) -> Exact {
        if pad.asked == Exact::ZERO {
            return pad.correction;
        }
        let frac = self.bits();
        let limited = Format::signed(frac as u8 + 1 - Control::TRIM_ERROR_BITS, frac);
        let force = round(request.force, self.measured()).value;
        let error = round(pad.asked - self.root(force), limited).value;
        let step = round(error * self.tuning.correction, self.kept()).value;
        round(pad.correction + step, self.kept()).value
    }

    /// √(F_t/G / (k·C²)), below one.
    fn inverse(&self, request: &Request) -> Exact {
        let (square, target, drive) =
            (self.profile.formats.square, self.control.target, self.control.drive);
        let stiffness = Format::unsigned(square.width, square.width as i8 - 4);
        let numerator = Format::unsigned(target.width + 3, target.frac);
        let quotient = Format::unsigned(2 * drive.width, 2 * drive.frac);
        let squared = round(request.capacitance * request.capacitance, square).value;
        let per_square = round(squared * request.force_gain, stiffness).value;
        let wanted = round(request.target * self.tuning.full_drive, numerator).value;
        let quotient = round_quotient(wanted, per_square, quotient).value;
        round(round_sqrt(quotient, drive.frac), drive).value
    }
}
