// SPDX-License-Identifier: MIT OR Apache-2.0
//! An axis: its range, its ticks at 1, 2 or 5 times a power of ten, their labels.

use super::number;

/// Number of ticks that an axis aims at.
const TICKS: f64 = 5.0;

/// Share of the range that is added at both ends.
const MARGIN: f64 = 0.04;

/// A range of values with a title that names the unit.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it shows: `force (N)`.
    pub title: String,
    low: f64,
    high: f64,
    log: bool,
    /// Zeros have a place at the low end of a logarithmic axis.
    zeros: bool,
    pad: bool,
    categories: Vec<String>,
}

impl Axis {
    /// From the least to the largest finite value.
    pub fn linear(title: &str, values: impl IntoIterator<Item = f64>) -> Axis {
        let (low, high) = bounds(values);
        let categories = Vec::new();
        Axis { title: title.into(), low, high, log: false, zeros: false, pad: true, categories }
    }

    /// With a range of at least this part of its values: no noise of the last digits fills the plot.
    pub fn at_least(self, part: f64) -> Axis {
        let least = part * self.low.abs().max(self.high.abs());
        let more = (0.5 * (least - (self.high - self.low))).max(0.0);
        Axis { low: self.low - more, high: self.high + more, ..self }
    }

    /// The same, starting or ending at zero where zero lies outside.
    pub fn with_zero(title: &str, values: impl IntoIterator<Item = f64>) -> Axis {
        Axis::linear(title, values.into_iter().chain([0.0]))
    }

    /// Exactly between two values.
    pub fn exact(title: &str, low: f64, high: f64) -> Axis {
        Axis { pad: false, ..Axis::linear(title, [low, high]) }
    }

    /// Logarithmic over the positive values, at least a decade. Where there are zeros, they stand at its low end, below a tick
    /// that says so.
    pub fn log(title: &str, values: impl IntoIterator<Item = f64>) -> Axis {
        let (zero, other): (Vec<f64>, Vec<f64>) = values.into_iter().partition(|v| *v == 0.0);
        let zeros = !zero.is_empty();
        let (low, high) = bounds(other.into_iter().filter(|v| *v > 0.0).map(f64::log10));
        let short = (1.0 - (high - low)).max(0.0) / 2.0;
        let below = if zeros { 0.15 * (high - low + 2.0 * short) } else { 0.0 };
        Axis { log: true, zeros, ..Axis::linear(title, [low - short - below, high + short]) }
    }

    /// Whether it is logarithmic.
    pub fn is_log(&self) -> bool {
        self.log
    }

    /// Names from top to bottom; the n-th lies at −n.
    pub fn categories(title: &str, names: Vec<String>) -> Axis {
        let low = 0.5 - names.len().max(1) as f64;
        Axis { categories: names, ..Axis::exact(title, low, 0.5) }
    }

    /// Where a value lies in the coordinates that are drawn; not finite where it has no place.
    pub fn place(&self, value: f64) -> f64 {
        if !self.log {
            value
        } else if value > 0.0 {
            value.log10()
        } else if value == 0.0 && self.zeros {
            self.low
        } else {
            f64::NAN
        }
    }

    /// Whether a place lies within what is drawn.
    pub fn shows(&self, place: f64) -> bool {
        let (low, high) = self.range();
        let rounding = 1e-9 * (high - low);
        (low - rounding..=high + rounding).contains(&place)
    }

    /// What is drawn, in the same coordinates.
    pub fn range(&self) -> (f64, f64) {
        let span = self.high - self.low;
        let margin = if self.pad { MARGIN * span } else { 0.0 };
        (self.low - margin, self.high + margin)
    }

    /// The ticks, in the same coordinates, and their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        match () {
            () if !self.categories.is_empty() => self.names(),
            () if self.log => self.log_ticks(),
            () => self.linear_ticks(),
        }
    }

    /// Characters of the longest label.
    pub fn longest_label(&self) -> usize {
        self.ticks().iter().map(|(_, text)| text.chars().count()).max().unwrap_or(1)
    }

    fn names(&self) -> Vec<(f64, String)> {
        self.categories.iter().enumerate().map(|(n, name)| (-(n as f64), name.clone())).collect()
    }

    fn linear_ticks(&self) -> Vec<(f64, String)> {
        let (low, high) = self.range();
        let step = nice_step((high - low) / TICKS);
        let decimals = usize::try_from(-step.log10().floor() as i32).unwrap_or(0);
        let first = (low / step).ceil() as i64;
        let last = (high / step).floor() as i64;
        (first..=last).map(|n| n as f64 * step).map(|v| (v, number::fixed(v, decimals))).collect()
    }

    fn log_ticks(&self) -> Vec<(f64, String)> {
        let (low, high) = self.range();
        let mantissas: &[f64] = if high - low > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let decades = low.floor() as i32..=high.ceil() as i32;
        let all = decades.flat_map(|d| mantissas.iter().map(move |m| (d, m * 10f64.powi(d))));
        let first = if self.zeros { low + 0.14 * (high - low) } else { low };
        let inside = all.filter(|(_, v)| (first..=high).contains(&v.log10()));
        let tick =
            |(d, v): (i32, f64)| (v.log10(), number::fixed(v, usize::try_from(-d).unwrap_or(0)));
        self.zeros.then(|| (self.low, "0".into())).into_iter().chain(inside.map(tick)).collect()
    }
}

/// Least and largest finite value, never equal.
fn bounds(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    let least = (1e-6 * low.abs().max(high.abs())).max(1e-12);
    if high - low >= least { (low, high) } else { (low - 10.0 * least, high + 10.0 * least) }
}

/// The step of 1, 2 or 5 times a power of ten that comes close to `raw`.
fn nice_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.log10().floor());
    let mantissa = [1.0, 2.0, 5.0].into_iter().find(|m| m * power >= raw * 0.7);
    mantissa.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(&Axis::linear("", [0.0, 400.0])), ["0", "100", "200", "300", "400"]);
        assert_eq!(
            labels(&Axis::linear("", [-0.11, 0.1])),
            ["−0.10", "−0.05", "0.00", "0.05", "0.10"]
        );
        assert_eq!(labels(&Axis::log("", [0.03, 2.0])), ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
    }

    #[test]
    fn zeros_have_a_place_on_a_logarithmic_axis() {
        let axis = Axis::log("", [0.0, 0.03, 2.0]);
        assert_eq!(labels(&axis), ["0", "0.05", "0.1", "0.2", "0.5", "1", "2"]);
        assert!(axis.shows(axis.place(0.0)) && axis.place(0.0) < axis.place(0.03));
        assert!(Axis::log("", [0.03, 2.0]).place(0.0).is_nan());
    }

    #[test]
    fn noise_of_the_last_digits_fills_no_axis() {
        let (low, high) = Axis::linear("", [149.9985, 150.0015]).at_least(2e-3).range();
        assert!(high - low > 0.3 && low < 149.9 && high > 150.1, "{low} to {high}");
        assert_eq!(
            Axis::linear("", [1.0, 2.0]).at_least(2e-3).range(),
            Axis::linear("", [1.0, 2.0]).range()
        );
    }

    #[test]
    fn no_value_and_one_value_still_make_an_axis() {
        for values in [vec![], vec![f64::NAN], vec![318.0], vec![0.0]] {
            let axis = Axis::linear("", values);
            let (low, high) = axis.range();
            assert!(low < high && (1..20).contains(&axis.ticks().len()), "{axis:?}");
        }
    }
}
