// SPDX-License-Identifier: MIT OR Apache-2.0
//! Settings arranged by load and haptic voltage, for the figures that sweep both.

use super::paint::Paint;
use super::select::{Setting, mean, settings};
use super::series::{Point, Series};
use hapticore_run::record::{Quantities, Record, Row, Truth};

/// All settings at one load of one case, by rising voltage.
#[derive(Clone, Debug)]
pub struct Load<'a> {
    /// Load of the group, g.
    pub load_g: f64,
    /// Settings of the sweep at this load, in order.
    pub settings: Vec<Setting<'a>>,
}

/// The settings by load, the lightest first.
pub fn loads(record: &Record) -> Vec<Load<'_>> {
    let mut all: Vec<_> = settings(record);
    all.sort_by(|a, b| load(a).total_cmp(&load(b)));
    let same = |a: &Setting, b: &Setting| (load(a) - load(b)).abs() < 1e-3 && case(a) == case(b);
    let chunks = all.chunk_by(same);
    chunks.map(|chunk| Load { load_g: load(&chunk[0]), settings: by_voltage(chunk) }).collect()
}

fn by_voltage<'a>(settings: &[Setting<'a>]) -> Vec<Setting<'a>> {
    let mut settings = settings.to_vec();
    settings.sort_by(|a, b| voltage(a).total_cmp(&voltage(b)));
    settings
}

/// A setting's load, g.
pub fn load(setting: &Setting) -> f64 {
    mean(setting.rows.iter().map(|(_, t)| t.load_g))
}

/// A setting's haptic voltage, V rms.
pub fn voltage(setting: &Setting) -> f64 {
    mean(setting.rows.iter().map(|(_, t)| t.quantities.haptic_v_rms))
}

fn case(setting: &Setting) -> usize {
    setting.rows.first().map_or(0, |(row, _)| row.case)
}

/// One point for every slot.
pub fn slots(settings: &[Setting], point: impl Fn(&Row, &Truth) -> Point) -> Vec<Point> {
    settings.iter().flat_map(|s| s.rows.iter().map(|(row, truth)| point(row, truth))).collect()
}

/// What is measured in every setting: the mean over its slots as a dot, with a bar of ± one standard
/// deviation.
pub fn measured(
    name: &str,
    paint: Paint,
    settings: &[Setting],
    point: impl Fn(&Row, &Truth) -> Point,
) -> Series {
    let of = |setting: &Setting| slots(std::slice::from_ref(setting), &point);
    let samples: Vec<_> = settings.iter().map(of).collect();
    Series::sampled(name, paint, samples.iter().map(Vec::as_slice))
}

/// One point for every setting, the mean over its slots.
pub fn means(settings: &[Setting], point: impl Fn(&Row, &Truth) -> Point) -> Vec<Point> {
    let mean_of = |setting: &Setting| {
        let points = slots(std::slice::from_ref(setting), &point);
        (mean(points.iter().map(|p| p.0)), mean(points.iter().map(|p| p.1)))
    };
    settings.iter().map(mean_of).collect()
}

/// The reference's value, where there is one.
pub fn reference(row: &Row, get: impl Fn(&Quantities) -> f64) -> f64 {
    row.reference.map_or(f64::NAN, |r| get(&r.quantities))
}
