// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lines that the report and the terminal share.

use hapticore_run::number::number;
use hapticore_run::record::Record;

/// The margins of each case's loop, and what a step of it does.
pub fn stability(record: &Record) -> impl Iterator<Item = String> {
    let or_none = |value: Option<f64>, unit: &str| {
        value.map_or("none".to_string(), |value| format!("{}{unit}", number(value)))
    };
    let gains = record.gains.iter().map(|(case, of)| {
        format!(
            "gains: case \"{case}\": feed_forward_v {}, proportional_v {}, integral_v {}",
            number(of.feed_forward_v),
            number(of.proportional_v),
            number(of.integral_v)
        )
    });
    let margins = record.stability.iter().map(move |(case, of)| {
        let step = of.step.map_or(String::new(), |step| {
            format!(
                "; a step overshoots by {} % and swings over {} %",
                number(step.overshoot_percent),
                number(step.swing_percent)
            )
        });
        format!(
            "loop: case \"{case}\" at {} N: phase margin {}, gain margin {}{step}",
            number(of.force_n),
            or_none(of.phase_margin_deg, "°"),
            or_none(of.gain_margin, "")
        )
    });
    gains.chain(margins)
}

/// The difference of a level from a finer one, percent.
pub fn off(percent: f64, finer: &str) -> String {
    format!("{} % from {finer}", number(percent))
}

/// How fast the device was simulated: `41 × real time`.
pub fn speed(record: &Record) -> String {
    let speed = record.simulated_seconds / record.wall_seconds;
    let decimals =
        if speed < 10.0 { (1.0 - speed.log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
    if speed.is_finite() { format!("{speed:.decimals$} × real time") } else { "–".into() }
}
