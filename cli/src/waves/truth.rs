// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plant's truth in waveforms, beside the core's signals.

use hapticore_host::{QUANTITIES, Quantity, quantities_of};
use hapticore_scene::Truth;
use hapticore_waveforms::declarations::TruthVariable;
use hapticore_waveforms::tracer::Tracer;
use hapticore_waveforms::wave::Wave;

/// The load on the pad: known to the plant alone.
const LOAD: (&str, &str) = ("load_g", "g");

/// The truth beside the core's signals: quantities that waveforms name with these units, and the
/// load.
pub fn variables() -> Vec<TruthVariable> {
    let traced = traced()
        .map(|quantity| (quantity.name, if quantity.unit == "Ω" { "Ohm" } else { quantity.unit }));
    traced.chain([LOAD]).map(|(name, unit)| TruthVariable::new(name, unit)).collect()
}

/// The quantities that are traced: all but the direction, which no core computes.
fn traced() -> impl Iterator<Item = &'static Quantity> {
    QUANTITIES.iter().filter(|quantity| quantity.name != "direction")
}

/// The values of [`variables`], in the same order.
fn values(truth: &Truth) -> impl Iterator<Item = f64> {
    let quantities = quantities_of!(truth);
    traced().map(move |quantity| quantity.value_in(&quantities)).chain([truth.load_g])
}

/// From the next clock on, this is the truth.
pub fn set<W: Wave>(tracer: &mut Tracer<W>, truth: &Truth) {
    values(truth).enumerate().for_each(|(index, value)| tracer.set_truth(index, value));
}
