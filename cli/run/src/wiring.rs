// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whether the channels of a recording are those of the device: sign, order and gain, from its slots.
//!
//! ```text
//!   Y_k = I_k/V                    of a slot's window: Im Y_k < 0 where a channel is reversed, for the current through a
//!                                  pad leads the sensing voltage
//!   s_k = |Y_k| / Σ|Y_k|           at the place that the ratios name these are the calibration's shares, s_k(place)
//!   off = Σ|s_k − s_k(place)|/2    as a mean over SLOTS slots; where it is more than the calibration's own error, each pair
//!                                  of channels is exchanged, and each channel divided by a factor: what brings the
//!                                  mean below BETTER of itself is the fault
//! ```
//!
//! The slots are spread over the recording. Two exchanges may explain a recording equally well, for a
//! sheet is its own mirror image: both are named.

use std::f64::consts::TAU;

use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::{Profile, Window};
use hapticore_host::DeviceCalibration;
use hapticore_host::device::Shares;

use crate::lab::shares;

/// Slots that are judged together, at most; half of them before the first frame is written.
const SLOTS: usize = 64;

/// Slots after which frames are written, whether they could be judged or not.
const PATIENCE: usize = 4096;

/// Shares are off where their mean distance exceeds this many errors of the calibration plus
/// `LEAST_OFF`.
const ERRORS: f64 = 2.0;

/// See [`ERRORS`].
const LEAST_OFF: f64 = 6e-4;

/// A distance counts as this at most: that of a slot that names no place, too.
const FARTHEST: f64 = 0.3;

/// What explains it must bring the mean distance down to this part.
const BETTER: f64 = 0.4;

/// What explains it up to this factor as well is named, too.
const ALIKE: f64 = 1.5;

/// Without an explanation this much of the current must be where it should not be.
const MISFIT: f64 = 0.03;

/// A channel's part of the current below which its sign is not judged.
const WEAK: f64 = 0.02;

/// The sum of the currents below which no slot is judged, of full scale.
const LEAST: f64 = 1e-3;

/// A reversed channel is named where this part of the slots shows it.
const COMMON: f64 = 0.2;

/// Factors that are tried are powers of this, up to [`MOST`] and not within [`NONE`].
const FACTOR: f64 = 1.06;

/// See [`FACTOR`].
const MOST: i32 = 14;

/// See [`FACTOR`].
const NONE: i32 = 3;

/// What may be wrong with the order or the gains of channels.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    Swapped(usize, usize),
    Gain(usize, f64),
}

/// The channels of a recording, slot by slot.
pub struct Wiring {
    oscillator: Vec<[f64; 2]>,
    signs: [Vec<i8>; 2],
    calibration: Calibration,
    shares: Option<Shares>,
    full_scale: f64,
    /// Slots that show each channel reversed; the sensing voltage is the last.
    reversed: Vec<usize>,
    judged: usize,
    seen: usize,
    /// Shares of one slot in `every`.
    slots: Vec<Vec<f64>>,
    every: usize,
}

impl Wiring {
    /// Of a device with this calibration, by a core of the profile.
    pub fn new(profile: &Profile, device: &DeviceCalibration, calibration: &Calibration) -> Self {
        let samples = profile.slot.integrate;
        let window = |turn: f64| match profile.carrier.window {
            Window::Hann => 1.0 - (TAU * turn).cos(),
            Window::Rectangular => 1.0,
        };
        let wave = |n: u64| {
            let turn = n as f64 / samples as f64;
            let phase = TAU * (turn * profile.carrier.periods as f64).fract();
            [phase.cos(), -phase.sin()].map(|part| 2.0 * window(turn) * part / samples as f64)
        };
        Wiring {
            oscillator: (0..samples).map(wave).collect(),
            signs: [device.terminals.x.clone(), device.terminals.y.clone()],
            calibration: calibration.clone(),
            shares: device.shares.clone(),
            full_scale: 1.0 / profile.formats.adc.lsb(),
            reversed: vec![0; device.terminals.x.len() + 1],
            judged: 0,
            seen: 0,
            slots: Vec::new(),
            every: 1,
        }
    }

    /// Takes the codes of a slot's window; flags of its frame.
    pub fn window(&mut self, codes: &[i32]) -> Vec<String> {
        self.seen += 1;
        let reversed = self.judge(codes);
        reversed.iter().for_each(|k| self.reversed[*k] += 1);
        reversed.into_iter().map(|k| format!("{}_reversed", self.channel(k))).collect()
    }

    /// Whether enough slots have been judged or passed for frames to be written.
    pub fn is_decided(&self) -> bool {
        self.every > 1 || self.slots.len() >= SLOTS / 2 || self.seen >= PATIENCE
    }

    fn channel(&self, k: usize) -> String {
        if k + 1 < self.reversed.len() { format!("i{}", k + 1) } else { "v_sense".into() }
    }

    /// The channels that are reversed in a slot.
    fn judge(&mut self, codes: &[i32]) -> Vec<usize> {
        let terminals = self.signs[0].len();
        let amplitudes = self.amplitudes(codes, terminals + 1);
        let [v_re, v_im] = amplitudes[terminals];
        let square = v_re * v_re + v_im * v_im;
        let norms: Vec<f64> =
            amplitudes[..terminals].iter().map(|[re, im]| re.hypot(*im)).collect();
        let total: f64 = norms.iter().sum();
        if total < LEAST * self.full_scale || square.sqrt() < LEAST * self.full_scale {
            return Vec::new();
        }
        self.judged += 1;
        let leads = |k: &usize| amplitudes[*k][1] * v_re - amplitudes[*k][0] * v_im;
        let strong: Vec<usize> = (0..terminals).filter(|k| norms[*k] > WEAK * total).collect();
        let reversed: Vec<usize> = strong.iter().copied().filter(|k| leads(k) < 0.0).collect();
        if reversed.len() == strong.len() {
            return vec![terminals];
        }
        if reversed.is_empty() {
            self.keep(norms.iter().map(|norm| norm / total).collect());
        }
        reversed
    }

    /// Keeps the shares of some slots, spread over the recording.
    fn keep(&mut self, shares: Vec<f64>) {
        let is_open = |share: &f64| *share < self.calibration.position.open_share();
        if !self.judged.is_multiple_of(self.every) || shares.iter().any(is_open) {
            return;
        }
        self.slots.push(shares);
        if self.slots.len() == SLOTS {
            let mut index = 0;
            self.slots.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every *= 2;
        }
    }

    /// In-phase and quadrature parts of the first channels, in codes.
    fn amplitudes(&self, codes: &[i32], count: usize) -> Vec<[f64; 2]> {
        let channels = codes.len() / self.oscillator.len();
        let mut sums = vec![[0.0; 2]; count];
        for (row, [cosine, sine]) in codes.chunks_exact(channels).zip(&self.oscillator) {
            for (sum, code) in sums.iter_mut().zip(row) {
                sum[0] += f64::from(*code) * cosine;
                sum[1] += f64::from(*code) * sine;
            }
        }
        sums
    }

    /// How far shares are from those at the place that they name; none where they name none.
    fn off(&self, known: &Shares, shares: &[f64]) -> Option<f64> {
        let signed = |axis: usize| -> f64 {
            shares.iter().zip(&self.signs[axis]).map(|(share, sign)| share * f64::from(*sign)).sum()
        };
        let has_sign = |k: &usize| (self.signs[0][*k], self.signs[1][*k]) != (0, 0);
        let sum: f64 = (0..shares.len()).filter(has_sign).map(|k| shares[k]).sum();
        let found = self.calibration.position.look_up(signed(0) / sum, signed(1) / sum);
        let told = found.is_valid().then(|| shares::predicted(known, [found.x, found.y], None))?;
        told.map(|told| shares::off(&told, shares))
    }

    /// The mean distance of slots' shares, with a fault undone.
    fn mean_off(&self, known: &Shares, slots: &[&Vec<f64>], fault: Option<Fault>) -> f64 {
        let of = |shares: &&Vec<f64>| {
            let mut shares = shares.to_vec();
            match fault {
                Some(Fault::Swapped(a, b)) => shares.swap(a, b),
                Some(Fault::Gain(k, factor)) => {
                    shares[k] /= factor;
                    let sum: f64 = shares.iter().sum();
                    shares.iter_mut().for_each(|share| *share /= sum);
                }
                None => (),
            }
            self.off(known, &shares).unwrap_or(1.0).min(FARTHEST)
        };
        slots.iter().map(of).sum::<f64>() / slots.len() as f64
    }

    /// The slots to judge: those that name a place; all where most do not.
    fn judgeable(&self, known: &Shares) -> Vec<&Vec<f64>> {
        let named: Vec<_> =
            self.slots.iter().filter(|slot| self.off(known, slot).is_some()).collect();
        if 2 * named.len() >= self.slots.len() { named } else { self.slots.iter().collect() }
    }

    /// How far the slots' shares are off, and what explains it; nothing where they are as they should be.
    fn explained(&self) -> Option<(f64, Vec<Fault>)> {
        let known = self.shares.as_ref().filter(|_| !self.slots.is_empty())?;
        let slots = self.judgeable(known);
        let off = self.mean_off(known, &slots, None);
        if off < ERRORS * known.error + LEAST_OFF {
            return None;
        }
        let terminals = self.signs[0].len();
        let swaps =
            (0..terminals).flat_map(|a| (a + 1..terminals).map(move |b| Fault::Swapped(a, b)));
        let factors =
            (-MOST..=MOST).filter(|power| power.abs() >= NONE).map(|power| FACTOR.powi(power));
        let gains = factors.flat_map(|factor| (0..terminals).map(move |k| Fault::Gain(k, factor)));
        let mut tried: Vec<(f64, Fault)> = swaps
            .chain(gains)
            .map(|fault| (self.mean_off(known, &slots, Some(fault)), fault))
            .collect();
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (least, best) = tried[0];
        if least > BETTER * off {
            let is_named = slots.len() < self.slots.len() || off < FARTHEST / 2.0;
            return (off > MISFIT && is_named).then(|| (off, Vec::new()));
        }
        let mut faults = vec![best];
        if matches!(best, Fault::Swapped(..)) {
            let alike = |(off, fault): &&(f64, Fault)| {
                *off <= ALIKE * least + known.error && matches!(fault, Fault::Swapped(..))
            };
            faults.extend(tried[1..].iter().filter(alike).map(|(_, fault)| *fault));
        }
        Some((off, faults))
    }

    /// The flag of all frames, where order or gains of the channels are wrong.
    pub fn flag(&self) -> Option<&'static str> {
        let (_, faults) = self.explained()?;
        Some(match faults.first() {
            Some(Fault::Swapped(..)) => "swapped",
            Some(Fault::Gain(..)) => "misread",
            None => "misfit",
        })
    }

    /// What is wrong with the channels of the recording.
    pub fn notes(&self) -> Vec<String> {
        let is_common = |(_, count): &(usize, &usize)| {
            **count > 0 && **count as f64 >= COMMON * self.judged as f64
        };
        let reversed = self.reversed.iter().enumerate().filter(is_common);
        let mut notes: Vec<String> = reversed
            .map(|(k, count)| {
                let others = if k + 1 < self.reversed.len() { "" } else { ", or all currents are" };
                format!(
                    "{} IS REVERSED{others}, in {count} of {} frames: the current through a pad leads v_sense; turn the sensor's \
                     leads or the sign",
                    self.channel(k),
                    self.judged
                )
            })
            .collect();
        notes.extend(self.explained().map(|(off, faults)| text(off, &faults)));
        if self.shares.is_none() {
            notes.push(
                "order and gains of the channels were not checked: the calibration has no [shares]; calibrate anew to have them \
                 checked"
                    .into(),
            );
        }
        notes
    }
}

/// What a fault is, in words.
fn text(off: f64, faults: &[Fault]) -> String {
    let percent = 100.0 * off;
    let swaps: Vec<String> = faults
        .iter()
        .filter_map(|fault| match fault {
            Fault::Swapped(a, b) => Some(format!("i{} AND i{}", a + 1, b + 1)),
            Fault::Gain(..) => None,
        })
        .collect();
    match faults.first() {
        Some(Fault::Swapped(..)) => format!(
            "{} ARE SWAPPED: so exchanged, the currents at the place that is found are the calibration's; as they are, {percent:.1} % \
             of the current is elsewhere",
            swaps.join(", OR ")
        ),
        Some(Fault::Gain(k, factor)) => format!(
            "i{} READS {factor:.2} TIMES what it should: the other currents are the calibration's at the place that is found; gain, range \
             or contact of that channel",
            k + 1
        ),
        None => format!(
            "THE CURRENTS ARE NOT THE CALIBRATION'S at the place that is found, {percent:.1} % of them: another device, wiring or \
             calibration"
        ),
    }
}
