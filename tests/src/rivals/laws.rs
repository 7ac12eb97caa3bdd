// SPDX-License-Identifier: MIT OR Apache-2.0
//! Laws that make a voltage of a target and a measured force.
//!
//! | law | words | saturation and rounding |
//! | --- | --- | --- |
//! | [`Idsp`] | `f64` | a biquad built from PID gains whose output is clamped within its feedback |
//! | [`PyRpl`] | 14 bits, gains of 24 | the integrator saturates at four times full scale, the sum at full scale; products are cut, not rounded |
//! | [`Linien`] | 14 bits, gains of 14 | the integrator saturates at full scale of either sign; the proportional part is cut to 14 bits and wraps |
//! | [`SuServo`] | 16 bits in, 25 of state, 14 out, gains of 18 | the state is clipped to zero and full scale; what is below its step is cut, towards minus infinity |
//!
//! Full scale of the words is [`FULL_SCALE_N`] in, [`FULL_SCALE_V`] out, of either sign.

use dsp_process::SplitProcess;
use hapticore_contract::control::{Control, Tuning};
use hapticore_reference::control::{Controller, Prompt};
use idsp::Build;
use idsp::iir::{Biquad, BiquadClamp, DirectForm1, pid};

/// Force of a word at full scale, N.
pub const FULL_SCALE_N: f64 = 1.0;

/// Voltage of a word at full scale, V rms.
pub const FULL_SCALE_V: f64 = 500.0;

/// One over the largest code of 14 bits.
const CODES: f64 = 8192.0;

/// What a law receives of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Force that the pad shall have, N.
    pub target_n: f64,
    /// Force that it has by eq. 8, N.
    pub force_n: f64,
    /// Capacitance, pF.
    pub capacitance_pf: f64,
}

/// A force controller of one pad.
pub trait Law {
    /// The drive of the next frame, V rms.
    fn volts(&mut self, seen: &Seen) -> f64;
}

/// A controller of this project, in floating point.
pub struct Ours {
    controller: Controller,
    force_gain: f64,
    full_scale_v: f64,
}

impl Ours {
    /// With a tuning, the gain of a core's force and the drive's full scale, V rms.
    pub fn new(control: &Control, tuning: &Tuning, force_gain: f64, full_scale_v: f64) -> Self {
        Ours { controller: Controller::new(control, tuning, 1), force_gain, full_scale_v }
    }
}

impl Law for Ours {
    fn volts(&mut self, seen: &Seen) -> f64 {
        let Seen { target_n, force_n, capacitance_pf } = *seen;
        let prompt = Prompt {
            pad: 0,
            capacitance_pf,
            force_n,
            force_gain: self.force_gain,
            invalid: false,
            lifted: false,
        };
        self.controller.hear();
        self.full_scale_v * self.controller.drive(&prompt, target_n).fraction
    }
}

/// Gains of a proportional and an integral part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// V/N.
    pub proportional: f64,
    /// V/N a frame.
    pub integral: f64,
}

/// idsp 0.23: `iir::pid::Builder` into `BiquadClamp`.
pub struct Idsp {
    filter: BiquadClamp<f64>,
    state: DirectForm1<f64>,
}

impl Idsp {
    /// With gains, its output clamped to 0 … the rail, V rms.
    pub fn new(gains: Gains, rail_v: f64) -> Self {
        let builder = pid::Builder::<f64>::default().kp(gains.proportional).ki(gains.integral);
        let biquad: Biquad<f64> = builder.build(&1.0);
        let mut filter = BiquadClamp::from(biquad);
        filter.min = 0.0;
        filter.max = rail_v;
        Idsp { filter, state: DirectForm1::default() }
    }
}

impl Law for Idsp {
    fn volts(&mut self, seen: &Seen) -> f64 {
        self.filter.process(&mut self.state, seen.target_n - seen.force_n)
    }
}

/// A force as a code of 14 bits.
fn code(newtons: f64) -> i64 {
    ((newtons / FULL_SCALE_N * CODES).floor() as i64).clamp(-8192, 8191)
}

fn volts(code: i64) -> f64 {
    code as f64 / CODES * FULL_SCALE_V
}

/// A gain in full scales of either side, as a code of `frac` fractional bits.
fn gain(volts_per_newton: f64, frac: i32) -> i64 {
    (volts_per_newton * FULL_SCALE_N / FULL_SCALE_V * 2f64.powi(frac)).round() as i64
}

/// PyRPL's `red_pitaya_pid_block`.
pub struct PyRpl {
    proportional: i64,
    integral: i64,
    integrated: i64,
}

impl PyRpl {
    /// Fractional bits of the proportional gain, and of the integrator.
    const BITS: [i32; 2] = [12, 18];

    /// With gains.
    pub fn new(gains: Gains) -> Self {
        PyRpl {
            proportional: gain(gains.proportional, Self::BITS[0]),
            integral: gain(gains.integral, Self::BITS[1]),
            integrated: 0,
        }
    }
}

impl Law for PyRpl {
    fn volts(&mut self, seen: &Seen) -> f64 {
        let error = code(seen.target_n) - code(seen.force_n);
        let most = ((4 * 8192) << Self::BITS[1]) - 1;
        self.integrated = (self.integrated + error * self.integral).clamp(-most - 1, most);
        let sum =
            ((error * self.proportional) >> Self::BITS[0]) + (self.integrated >> Self::BITS[1]);
        volts(sum.clamp(-8192, 8191))
    }
}

/// Linien's `gateware/logic/pid.py`.
pub struct Linien {
    proportional: i64,
    integral: i64,
    integrated: i64,
}

impl Linien {
    /// Fractional bits of the proportional gain, which is below 2, and of the integrator: fewer than
    /// there, since a frame is a hundred thousand of its clocks.
    const BITS: [i32; 2] = [12, 8];

    /// With gains.
    pub fn new(gains: Gains) -> Self {
        Linien {
            proportional: gain(gains.proportional, Self::BITS[0]).clamp(-8192, 8191),
            // The product is four bits finer than the integrator's input.
            integral: gain(gains.integral, Self::BITS[1] + 4).clamp(-8192, 8191),
            integrated: 0,
        }
    }
}

impl Law for Linien {
    fn volts(&mut self, seen: &Seen) -> f64 {
        let error = code(seen.target_n) - code(seen.force_n);
        let most = 8191 << Self::BITS[1];
        self.integrated = (self.integrated + ((error * self.integral) >> 4)).clamp(-most - 1, most);
        let proportional = (error * self.proportional) >> Self::BITS[0];
        let wrapped = (proportional + 8192).rem_euclid(16384) - 8192;
        volts((wrapped + (self.integrated >> Self::BITS[1])).clamp(-8192, 8191))
    }
}

/// SUServo's `gateware/suservo/iir.py` (ARTIQ) as an integrator: 2^11·y ← 2^11·y + b₀·2^8·x.
pub struct SuServo {
    integral: i64,
    state: i64,
}

impl SuServo {
    /// Largest state.
    const MOST: i64 = (1 << 24) - 1;

    /// An integral gain, V/N a frame, from a state at a fraction of full scale.
    pub fn new(volts_per_newton: f64, start: f64) -> Self {
        // x at full scale is 2^23, y 2^24.
        SuServo { integral: gain(volts_per_newton, 12), state: (start * Self::MOST as f64) as i64 }
    }
}

impl Law for SuServo {
    fn volts(&mut self, seen: &Seen) -> f64 {
        let code = |newtons: f64| ((newtons / FULL_SCALE_N * 32768.0).floor() as i64).min(32767);
        let error = code(seen.target_n) - code(seen.force_n);
        let sum = (self.state << 11) + self.integral * (error << 8);
        self.state = (sum >> 11).clamp(0, Self::MOST);
        (self.state >> 10) as f64 / 16384.0 * FULL_SCALE_V
    }
}
