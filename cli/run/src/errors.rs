// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rounding error of every signal of the estimator: a core beside the core that keeps each
//! value unrounded, too.

use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_hdl::interpretations::shadow::Shadow;
use hapticore_hdl::probe::Variable;
use hapticore_hdl::probe::{sample, variables};
use hapticore_model::fidelity::fixed::FixedSimulation;

use crate::engine::Slot;
use crate::record::SignalError;

/// The largest rounding errors so far.
pub struct Errors {
    core: FixedSimulation<Shadow>,
    variables: Vec<Variable>,
    largest: Vec<f64>,
    values: Vec<Shadow>,
}

impl Errors {
    /// A core of the profile, calibrated, just before its first slot.
    pub fn new(profile: &Profile, calibration: &Calibration) -> Self {
        let core = FixedSimulation::new(profile, calibration);
        let variables = variables(core.state().0, "core");
        Errors {
            core,
            largest: vec![0.0; variables.len()],
            values: Vec::with_capacity(variables.len()),
            variables,
        }
    }

    /// Runs a slot and keeps the largest error of each signal.
    pub fn slot(&mut self, slot: &Slot) {
        slot.frame(&mut self.core);
        let (core, cell) = self.core.state();
        self.values.clear();
        sample(core, cell, &mut self.values);
        for ((largest, value), variable) in
            self.largest.iter_mut().zip(&self.values).zip(&self.variables)
        {
            *largest = largest.max((variable.format.real(value.code) - value.real).abs());
        }
    }

    /// The largest error of each signal that is a fraction and was ever off.
    pub fn largest(&self) -> Vec<SignalError> {
        let pairs = self.variables.iter().zip(&self.largest);
        let off = pairs.filter(|(variable, largest)| variable.format.frac > 0 && **largest > 0.0);
        off.map(|(variable, &largest)| SignalError {
            signal: [&variable.scope[1..], std::slice::from_ref(&variable.name)].concat().join("."),
            format: variable.format.to_string(),
            max_error: largest,
            max_codes: largest / variable.format.lsb(),
        })
        .collect()
    }
}

/// The larger of the errors of two runs, signal by signal.
pub fn merge(into: &mut Vec<SignalError>, other: Vec<SignalError>) {
    for error in other {
        match into.iter_mut().find(|known| known.signal == error.signal) {
            Some(known) if known.max_error >= error.max_error => (),
            Some(known) => *known = error,
            None => into.push(error),
        }
    }
}
