// SPDX-License-Identifier: MIT OR Apache-2.0
//! The paper's Fig. 7: friction and what eq. 8 makes of it over time, the pad's capacitance, and
//! its voltage, which falls.

use super::figure::Figure;
use super::general::{self, Quantity};
use super::hockey::force_error;
use hapticore_run::record::Record;

/// Below this the haptic voltage is off, V rms.
const OFF_V: f64 = 1.0;

/// Voltage on an axis of its own range, since it falls by some percent.
const VOLTAGE: Quantity = ("Haptic voltage while switched on", "V RMS (V)", |q| {
    if q.haptic_v_rms > OFF_V { q.haptic_v_rms } else { f64::NAN }
});

/// Force, its error, capacitance, voltage.
pub fn figures(record: &Record) -> Vec<Figure> {
    let [force, capacitance, voltage] = [
        general::quantity_of_column("force_n"),
        general::quantity_of_column("capacitance_pf"),
        VOLTAGE,
    ]
    .map(|q| general::over_time(record, q));
    vec![force, force_error(record, "estimate"), capacitance, voltage]
}
