// SPDX-License-Identifier: MIT OR Apache-2.0
//! The wiring of a board and its device, checked step by step: which line is open, swapped, reversed, noisy or clipped,
//! which pad is missing. The drive stays off.
//!
//! ```text
//! 1  data lines      fixed codes of the ADC, one line after the other                      (BringUp)
//! 2  ranges          where a code is at full scale, one channel after the other is at ±10 V, all others at ±12.5 V
//! 3  places          each pad at each terminal's place: ratios and capacitance, expected and measured
//! 4  judgement       no fault, one or two: what explains step 3 best; scatter of step 3: which channel is noisy
//! ```
//!
//! Frames carry no currents, only ratios and the sum of currents per sensing voltage. So the board gets a calibration for
//! this check that finds a place for any ratios: r is read at all places. Expected values follow from the shares of the
//! terminals' currents in the device's calibration.
//!
//! Not found: a sensing voltage with reversed sign, which changes no result; the haptic channel beyond its data line,
//! which carries nothing while the drive is off.

mod expected;
mod judge;
mod noise;
mod report;

use anyhow::{Result, ensure};
use hapticore_contract::calibration::Calibration;
use hapticore_host::DeviceCalibration;
use hapticore_host::startup::{AdcSetup, LineFault, Range};

pub use report::{Finding, Report};

use crate::bench::{Bench, MOVING, for_any_ratios};
use expected::Expected;

/// Frames of each pad at each place.
const FRAMES: usize = 16;

/// What was measured of a pad at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Datum {
    /// The pad, or part of one, as the board numbers it.
    pub pad: usize,
    /// Where it was put, as a number of [`Expected::places`].
    pub place: usize,
    /// Means of both ratios and of the capacitance, pF.
    pub mean: [f64; 3],
    /// Variances of the ratios, their covariance, relative variance of the capacitance.
    pub scatter: [f64; 4],
    /// Frames in which the results were valid, of [`FRAMES`].
    pub valid: usize,
    /// A code was at full scale.
    pub clipped: bool,
}

impl Datum {
    /// Whether there is a measurement.
    pub fn is_valid(&self) -> bool {
        2 * self.valid >= FRAMES
    }
}

/// Checks a board's wiring.
///
/// # Errors
/// A board that does not start up for another reason than its wiring, a calibration without shares of the currents.
pub fn check(bench: &mut dyn Bench, device: &DeviceCalibration) -> Result<Report> {
    let profile = bench.profile().clone();
    let expected = Expected::new(&profile, device, bench.parts_mm())?;
    let calibration = for_any_ratios(&profile, device)?;
    bench.tell("step 1 of 3: data lines of the ADC");
    let lines = bench.bring_up(&calibration, &AdcSetup::default(), true)?;
    if !lines.is_empty() {
        return Ok(Report::of_lines(&lines));
    }
    let (data, clipped) = measure(bench, (&calibration, &expected))?;
    bench.tell("step 3 of 3: what explains the measurements");
    Ok(judge::judge(&expected, data, clipped))
}

/// Data of all places, and the channels that clip at ±10 V.
fn measure(
    bench: &mut dyn Bench,
    (calibration, expected): (&Calibration, &Expected),
) -> Result<(Vec<Datum>, Vec<usize>)> {
    let (mut data, mut clipped) = (Vec::new(), Vec::new());
    let rounds = expected.places.len();
    for round in 0..rounds {
        bench.tell(&format!("step 2 of 3: places, {} of {rounds}", round + 1));
        let places = expected.round(round);
        bench.put(&places.iter().map(|place| expected.places[*place]).collect::<Vec<_>>())?;
        let mut of_round = frames(bench, (expected, &places))?;
        if clipped.is_empty() && of_round.iter().any(|datum| datum.clipped) {
            clipped = find_clipped(bench, calibration, (expected, &places))?;
            of_round = frames(bench, (expected, &places))?;
        }
        data.extend(of_round);
    }
    Ok((data, clipped))
}

/// The channels of which a code is at full scale at ±10 V; afterwards all are at ±12.5 V.
fn find_clipped(
    bench: &mut dyn Bench,
    calibration: &Calibration,
    (expected, places): (&Expected, &[usize]),
) -> Result<Vec<usize>> {
    let channels = bench.profile().channels();
    let mut clipped = Vec::new();
    // The last one has no channel at ±10 V.
    for channel in 0..=channels {
        let mut adc = AdcSetup { ranges: [Range::V12_5; 8] };
        if let Some(range) = adc.ranges.get_mut(channel).filter(|_| channel < channels) {
            *range = Range::V10;
        }
        bench.bring_up(calibration, &adc, false)?;
        let clips = frames(bench, (expected, places))?.iter().any(|datum| datum.clipped);
        match clips && channel == channels {
            true => return Ok((0..channels).collect()),
            false => clipped.extend(clips.then_some(channel)),
        }
    }
    Ok(clipped)
}

/// What each pad reads where it is.
fn frames(bench: &mut dyn Bench, (expected, places): (&Expected, &[usize])) -> Result<Vec<Datum>> {
    let profile = bench.profile().clone();
    let packets = bench.frames(MOVING + FRAMES)?;
    let pads = profile.pads as usize;
    (0..pads)
        .map(|pad| {
            let of_pad = packets.iter().filter(|packet| packet.frame.pad == pad).skip(MOVING);
            let of_pad: Vec<_> = of_pad.take(FRAMES).collect();
            ensure!(of_pad.len() == FRAMES, "expected {FRAMES} frames of pad {pad}");
            let clipped = of_pad.iter().any(|packet| packet.frame.flags.clipped);
            let readings: Vec<[f64; 3]> = of_pad
                .iter()
                .filter(|packet| !packet.frame.flags.invalid)
                .map(|packet| {
                    let of = packet.frame.measurement(&profile);
                    [of.r_x, of.r_y, of.capacitance_pf]
                })
                .collect();
            let place = places[pad / expected.parts()];
            Ok(Datum { pad, place, clipped, ..datum(&readings) })
        })
        .collect()
}

/// Means and variances.
fn datum(readings: &[[f64; 3]]) -> Datum {
    let count = readings.len().max(1) as f64;
    let mean = [0, 1, 2].map(|k| readings.iter().map(|of| of[k]).sum::<f64>() / count);
    let product = |a: usize, b: usize| {
        readings.iter().map(|of| (of[a] - mean[a]) * (of[b] - mean[b])).sum::<f64>() / count
    };
    let relative = product(2, 2) / mean[2].powi(2).max(f64::MIN_POSITIVE);
    let scatter = [product(0, 0), product(1, 1), product(0, 1), relative];
    Datum { pad: 0, place: 0, mean, scatter, valid: readings.len(), clipped: false }
}

/// A line's fault as a finding.
impl From<&(u8, LineFault)> for Finding {
    fn from((line, fault): &(u8, LineFault)) -> Self {
        Finding::DataLine { line: usize::from(*line), fault: *fault }
    }
}
