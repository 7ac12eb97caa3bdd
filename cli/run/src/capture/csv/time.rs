// SPDX-License-Identifier: MIT OR Apache-2.0
//! A column of times: whether samples follow each other as the sample rate says.
//!
//! A step is odd if it is off by more than a quarter of a sample and by more than the digits of the
//! column resolve. If the next step is correct, the odd one is a jump; else the rate is another.

use anyhow::{Result, bail};

/// Steps may be off by this part of a sample.
const TOLERANCE: f64 = 0.25;

/// A hole that is longer is not filled, samples.
const LONGEST_HOLE: f64 = 1e6;

/// A column of times being read.
#[derive(Debug, Clone)]
pub struct Times {
    /// Seconds of one of the column's numbers.
    unit_s: f64,
    /// From a sample to the next, s, once it is known.
    step_s: Option<f64>,
    /// Where this stretch began, and how many samples ago.
    start: Option<(f64, u64)>,
    last_s: f64,
    /// The step before was no sample, and so long.
    odd_s: Option<f64>,
}

/// The seconds of a unit in a header or a row of units.
pub fn unit_s(word: &str) -> Option<f64> {
    let word = word.trim_matches(['(', ')', '[', ']', ' ']);
    Some(match word {
        "s" | "sec" | "second" | "Second" | "seconds" | "S" => 1.0,
        "ms" => 1e-3,
        "us" | "µs" | "μs" => 1e-6,
        "ns" => 1e-9,
        _ => return None,
    })
}

/// The unit of a column of this name where it is one of times.
pub fn named(name: &str) -> Option<f64> {
    let (word, unit) = name.split_once(['(', '[', '_']).unwrap_or((name, "s"));
    let is_time = matches!(
        word.trim().to_lowercase().as_str(),
        "time" | "t" | "second" | "seconds" | "zeit" | "timestamp"
    );
    is_time.then(|| unit_s(unit)).flatten()
}

impl Times {
    /// Times in this unit of samples that are `step_s` apart.
    pub fn new(unit_s: f64, step_s: Option<f64>) -> Self {
        Times { unit_s, step_s, start: None, last_s: 0.0, odd_s: None }
    }

    /// The same of samples that are so far apart, s, where that is known.
    pub fn with_step(self, step_s: Option<f64>) -> Self {
        Times { step_s, ..self }
    }

    /// Takes the time of a row, as it is written; how many samples are missing before it.
    ///
    /// # Errors
    /// Times that go back, or have another rate; the message begins with what was expected.
    pub fn row(&mut self, cell: &str, number: f64) -> Result<u64> {
        let now_s = number * self.unit_s;
        let Some((start_s, count)) = self.start else {
            (self.start, self.last_s) = (Some((now_s, 1)), now_s);
            return Ok(0);
        };
        let (went_s, first) = (now_s - self.last_s, self.step_s.is_none());
        self.last_s = now_s;
        let resolved_s = self.unit_s * quantum(cell);
        if went_s < -0.5 * resolved_s || (first && went_s <= 0.0) {
            bail!("expected a time after that of the row before, got \"{cell}\"");
        }
        let step_s = *self.step_s.get_or_insert(went_s);
        let tolerance_s = TOLERANCE * step_s + 2.0 * resolved_s;
        let drift_s = now_s - start_s - count as f64 * step_s;
        if (went_s - step_s).abs() <= tolerance_s && drift_s.abs() <= 0.5 * step_s + tolerance_s {
            self.start = Some((start_s, count + 1));
            self.odd_s = None;
            return Ok(0);
        }
        let mean_s = (now_s - start_s) / count as f64;
        let is_rate = (went_s - step_s).abs() <= tolerance_s
            || self.odd_s.is_some_and(|odd_s| (odd_s - went_s).abs() <= tolerance_s);
        if is_rate || went_s < step_s {
            bail!(
                "expected a sample each {step_s:e} s, got {:e} s{}",
                if count > 1 { mean_s } else { went_s },
                cure(step_s)
            );
        }
        let missing = (went_s / step_s).round() - 1.0;
        if missing > LONGEST_HOLE {
            bail!(
                "expected {step_s:e} s after the row before, got {went_s:e} s: cut the recording there"
            );
        }
        (self.start, self.odd_s) = (Some((now_s, 1)), Some(went_s));
        Ok(missing.max(0.0) as u64)
    }
}

fn cure(step_s: f64) -> String {
    format!(
        ": the sample rate is not the {} Hz of the calibration; resample the capture, or calibrate at its rate",
        (1.0 / step_s).round()
    )
}

/// What the last digit of a number as it is written stands for.
fn quantum(cell: &str) -> f64 {
    let (digits, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
    let decimals = digits.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len() as i32);
    10f64.powi(exponent.parse().unwrap_or(0) - decimals)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(times: &mut Times, cells: &[String]) -> Result<Vec<u64>> {
        cells.iter().map(|cell| times.row(cell, cell.parse().unwrap())).collect()
    }

    fn cells(numbers: impl Iterator<Item = f64>, decimals: usize) -> Vec<String> {
        numbers.map(|number| format!("{number:.decimals$}")).collect()
    }

    #[test]
    fn even_times_lose_nothing_however_they_are_rounded() {
        for decimals in [3, 6, 9] {
            let even = cells((0..5000).map(|n| -1.0 + f64::from(n) * 1e-6), decimals);
            let lost = read(&mut Times::new(1.0, Some(1e-6)), &even).unwrap();
            assert!(lost.iter().all(|lost| *lost == 0), "{decimals} decimals");
        }
    }

    #[test]
    fn a_jump_is_counted_and_another_rate_refused() {
        let jump = cells((0..100).map(|n| f64::from(n + if n < 50 { 0 } else { 37 })), 3);
        let lost = read(&mut Times::new(1e-6, Some(1e-6)), &jump).unwrap();
        assert_eq!((lost[50], lost.iter().sum::<u64>()), (37, 37));
        for step in [0.5, 2.0, 1.01] {
            let other = cells((0..200).map(|n| step * f64::from(n)), 3);
            let error = read(&mut Times::new(1e-6, Some(1e-6)), &other).unwrap_err();
            assert!(error.to_string().contains("1000000 Hz"), "{step}: {error}");
        }
        let back = cells([0.0, 1.0, 2.0, 1.0].into_iter(), 1);
        assert!(read(&mut Times::new(1e-6, Some(1e-6)), &back).is_err());
    }

    #[test]
    fn columns_of_times_are_known_by_their_names() {
        let units =
            ["Time", "TIME", "time_us", "Time (ms)", "t", "Second", "i1", "time_of_day"].map(named);
        assert_eq!(
            units,
            [Some(1.0), Some(1.0), Some(1e-6), Some(1e-3), Some(1.0), Some(1.0), None, None]
        );
    }
}
