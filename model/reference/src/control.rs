// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force controller in floating point.
//!
//! ```text
//! s = √F_t,   D = curve(s), linear between its points
//! open           d = D
//! proportional   d = D + c,         c += α·(K·(F_t − F) − c)          (paper, Fig. 8b: α = 1)
//! integral       d = D + K·e + c,   c += K_i·e,   e = √F_t − √F       (roots over that of the largest target)
//! inverse        d = B + c·B,  c += K_i·e,  B = min(√(F_t/G / (k·C²)), D)     (docs/physics.md §6)
//! ```
//!
//! The drive is held within 0 … rail, then within slew of the pad's last, at most the rail. c stays as it is while
//! estimates are invalid; against a limit that holds the drive it goes as far as drive − (D + K·e), and not back. The
//! inverse law's c, a trim of ½ at most, stays as it is against a limit and for a target of zero; its e,
//! of the target of the frame before, is 2^-6 at most. A
//! fault takes every drive to zero immediately, and each pad then begins at zero, with c at zero. A lifted pad begins
//! in the same way, and rises no faster than a contact may until its drive is what the law wants.

use hapticore_contract::control::{Control, Drive, Faults, Law, Tuning};

/// An estimate that comes before its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prompt {
    /// Pad number, from 0.
    pub pad: usize,
    /// Capacitance with the sheet's resistance at the pad's last place, pF.
    pub capacitance_pf: f64,
    /// Its haptic force, N.
    pub force_n: f64,
    /// Gain of that force, N/pF² at a haptic mean-square word of one.
    pub force_gain: f64,
    /// There is no such capacitance, or a code was at full scale.
    pub invalid: bool,
    /// The pad does not touch.
    pub lifted: bool,
}

#[derive(Debug, Clone, Copy, Default)]
struct Pad {
    invalid: u64,
    drive: f64,
    correction: f64,
    /// Root of the target of its last valid frame.
    asked: f64,
    /// It has been lifted, and its drive has not been what its law wants since.
    rises: bool,
}

/// The force controller of all pads.
#[derive(Debug, Clone)]
pub struct Controller {
    control: Control,
    tuning: Tuning,
    pads: Vec<Pad>,
    silent: u64,
    faults: Faults,
}

impl Controller {
    /// A controller of `pads` pads, tuned, with all drives at zero.
    pub fn new(control: &Control, tuning: &Tuning, pads: usize) -> Self {
        Controller {
            control: control.clone(),
            tuning: tuning.clone(),
            pads: vec![Pad::default(); pads],
            silent: 0,
            faults: Faults::default(),
        }
    }

    /// The host is alive.
    pub fn hear(&mut self) {
        self.silent = 0;
    }

    /// A millisecond has passed.
    pub fn tick(&mut self) {
        self.silent += 1;
        self.watch();
    }

    /// Clears all faults; a host that is still silent is one again.
    pub fn clear_faults(&mut self) {
        self.faults = Faults::default();
        self.watch();
    }

    /// Every pad begins anew, at zero.
    pub fn clear(&mut self) {
        self.pads.fill(Pad::default());
    }

    fn watch(&mut self) {
        self.faults.silence |= self.silent >= self.control.silent_ms;
        if self.faults.any() {
            self.clear();
        }
    }

    /// The drive of a pad whose force shall be `target_n`.
    pub fn drive(&mut self, prompt: &Prompt, target_n: f64) -> Drive {
        let pad = self.pads[prompt.pad];
        let invalid = if prompt.invalid { pad.invalid + 1 } else { 0 };
        self.faults.sensor |= invalid >= self.control.invalid_frames;
        self.faults.force |= !prompt.invalid && prompt.force_n > self.tuning.force_cap;
        let (correction, wanted) = self.wanted(prompt, target_n, pad);
        let within = wanted.min(self.tuning.rail).max(0.0);
        let (low, high) = (wanted < 0.0, wanted > self.tuning.rail);
        let Tuning { rail, slew, .. } = self.tuning;
        let last = pad.drive.min(rail);
        let to = if prompt.invalid { last } else { within };
        let up = if pad.rises { slew.min(self.control.contact_slew()) } else { slew };
        let off = self.faults.any();
        let drive = if off || prompt.lifted { 0.0 } else { to.min(last + up).max(last - slew) };
        let rises = prompt.lifted || pad.rises && (prompt.invalid || drive < within);
        let limit = match self.control.law {
            Law::Inverse => pad.correction,
            _ => drive - (wanted - correction),
        };
        let correction = if prompt.invalid {
            pad.correction
        } else if wanted > drive && correction >= pad.correction {
            pad.correction.max(limit)
        } else if wanted < drive && correction <= pad.correction {
            pad.correction.min(limit)
        } else {
            correction
        };
        let correction = if prompt.lifted { 0.0 } else { correction };
        let asked = match prompt {
            Prompt { lifted: true, .. } => 0.0,
            Prompt { invalid: true, .. } => pad.asked,
            _ => self.root(target_n),
        };
        self.pads[prompt.pad] = Pad { invalid, drive, correction, asked, rises };
        if off {
            self.clear();
        }
        let measured = !prompt.invalid && !prompt.lifted;
        let low = low && drive == 0.0 && measured;
        let high = high && drive >= self.tuning.rail && measured;
        Drive { pad: prompt.pad, fraction: drive, low, high, faults: self.faults, walled: None }
    }

    /// √F over that of the largest target.
    fn root(&self, newtons: f64) -> f64 {
        (newtons.max(0.0).sqrt() / self.control.root_full_scale()).min(1.0)
    }

    fn curve(&self, root: f64) -> f64 {
        let (curve, cells) = (&self.tuning.curve, self.tuning.curve.len() - 1);
        let at = root * cells as f64;
        let cell = (at as usize).min(cells - 1);
        curve[cell] + (curve[cell + 1] - curve[cell]) * (at - cell as f64)
    }

    /// The inverse law's trim after this frame.
    fn trim(&self, pad: Pad, force_n: f64) -> f64 {
        let power = |bits: u8| 0.5f64.powi(i32::from(bits));
        let [most, most_error] = [Control::TRIM_BITS, Control::TRIM_ERROR_BITS].map(power);
        let error = if pad.asked > 0.0 { pad.asked - self.root(force_n) } else { 0.0 };
        let step = self.tuning.correction * error.clamp(-most_error, most_error);
        (pad.correction + step).clamp(-most, most)
    }

    /// The correction after this frame, and the drive without limits.
    fn wanted(&self, prompt: &Prompt, target_n: f64, pad: Pad) -> (f64, f64) {
        let correction = pad.correction;
        let Tuning { proportional, correction: gain, full_drive, .. } = self.tuning;
        let root = self.root(target_n);
        let curve = self.curve(root);
        match self.control.law {
            Law::Open => (0.0, curve),
            Law::Proportional => {
                let scaled = proportional * (target_n - prompt.force_n);
                let correction = correction + gain * (scaled - correction);
                (correction, curve + correction)
            }
            Law::Integral => {
                let error = root - self.root(prompt.force_n);
                let correction = correction + gain * error;
                (correction, curve + proportional * error + correction)
            }
            Law::Inverse => {
                let stiffness = prompt.force_gain * prompt.capacitance_pf.powi(2);
                let inverse = (target_n * full_drive / stiffness).sqrt();
                let base = if inverse < curve { inverse } else { curve };
                let correction = self.trim(pad, prompt.force_n);
                (correction, base + correction * base)
            }
        }
    }
}
