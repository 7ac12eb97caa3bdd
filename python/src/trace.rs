// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every signal of a core through one slot, clock by clock.

use anyhow::{Result, bail};
use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::Profile;
use hapticore_hdl::probe::{Probe, Variable};
use hapticore_model::fidelity::clock::ClockSimulation;

/// A signal's name and its value after each clock.
pub type Signal = (String, Vec<f64>);

/// The names of all signals of a core, with their instances: `estimator.position.sum`.
pub fn names(profile: &Profile, calibration: &Calibration) -> Vec<String> {
    ClockSimulation::new(profile, calibration).variables().iter().map(name).collect()
}

fn name(variable: &Variable) -> String {
    let scope = variable.scope.iter().skip(1);
    scope.chain([&variable.name]).map(String::as_str).collect::<Vec<_>>().join(".")
}

/// The signals of these names, of a core after a reset that receives a slot of pad 0, until its frame is there. The
/// window's codes come behind a blanking without current.
///
/// # Errors
/// No such signal.
pub fn trace(
    (profile, calibration): (&Profile, &Calibration),
    window: &[i32],
    wanted: &[String],
) -> Result<Vec<Signal>> {
    let mut core = ClockSimulation::new(profile, calibration);
    let variables = core.variables();
    let mut chosen = Vec::new();
    for wanted in wanted {
        let Some(index) = variables.iter().position(|variable| name(variable) == *wanted) else {
            bail!("signals: expected a name among those of Core.signals, got {wanted:?}");
        };
        chosen.push((index, variables[index].format.lsb(), Vec::new()));
    }
    let channels = profile.channels();
    let blanking = vec![0; profile.slot.blanking() as usize * channels];
    // The frame comes while the next slot is blanked.
    let next = vec![0; profile.slot.samples() as usize * channels];
    let mut codes = Vec::new();
    for sample in [&blanking[..], window, &next].iter().flat_map(|of| of.chunks_exact(channels)) {
        core.sample_with(sample, |core| {
            codes.clear();
            core.sample(&mut codes);
            for (index, lsb, values) in &mut chosen {
                values.push(codes[*index] as f64 * *lsb);
            }
        });
        if core.take_frame().is_some() {
            break;
        }
    }
    let values = chosen.into_iter().map(|(_, _, values)| values);
    Ok(wanted.iter().cloned().zip(values).collect())
}
