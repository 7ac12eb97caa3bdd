// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest profile for a stated error: found by the [`Model`], verified by running it. Where it
//! fails, the search is repeated with a smaller target.

use super::cost::Cost;
use super::errors::{Error, Errors, Quantity};
use super::knobs::Knob;
use super::model::Model;
use super::sweep::{Point, Trial};
use super::target::Target;
use anyhow::Result;
use hapticore_contract::profile::Profile;
use serde::Serialize;

/// What a search found.
#[derive(Debug, Clone, Serialize)]
pub struct Found {
    /// What was asked for.
    pub target: Target,
    /// Bits of each knob.
    pub bits: Vec<(String, u64)>,
    /// Predicted and measured errors.
    pub predicted: Errors,
    /// Measured ones.
    pub measured: Errors,
    /// What it costs, and what the profile did that the search began with.
    pub cost: Cost,
    /// Of the profile that the search began with.
    pub before: Cost,
    /// The quantity that limits, and the block that adds most to its error.
    pub limit: Option<(Quantity, String)>,
    /// The quantities whose target no word length meets, and the least error there is.
    pub missed: Vec<(Quantity, f64)>,
    /// The profile.
    #[serde(skip)]
    pub profile: Profile,
}

impl Found {
    /// Whether the profile meets the target as measured.
    pub fn holds(&self) -> bool {
        self.target
            .0
            .iter()
            .zip(&self.measured)
            .all(|(most, of)| most.is_none_or(|most| of.rms <= most))
    }

    /// What was found, in words.
    pub fn text(&self) -> String {
        let mut lines = Vec::new();
        for ((quantity, most), (measured, predicted)) in
            Quantity::ALL.iter().zip(self.target.0).zip(self.measured.iter().zip(&self.predicted))
        {
            let Some(most) = most else { continue };
            let holds = if measured.rms <= most { "holds" } else { "missed" };
            lines.push(format!(
                "{}: {:.3} {} measured, {:.3} predicted, target {:.3}: {holds}",
                quantity.name(),
                measured.rms,
                quantity.unit(),
                predicted.rms,
                most
            ));
        }
        lines.push(format!(
            "LUT4 {:.0} instead of {:.0} (estimated), flip-flops {:.0} instead of {:.0}",
            self.cost.luts, self.before.luts, self.cost.flip_flops, self.before.flip_flops
        ));
        let bits: Vec<_> = self.bits.iter().map(|(knob, bits)| format!("{knob} {bits}")).collect();
        lines.push(format!("bits: {}", bits.join(", ")));
        if let Some((quantity, source)) = &self.limit {
            lines.push(format!("the {} limits, most by {source}", quantity.name()));
        }
        for (quantity, least) in &self.missed {
            lines.push(format!(
                "{}: no word length meets the target; what is left is {:.3} {}",
                quantity.name(),
                least,
                quantity.unit()
            ));
        }
        lines.join("\n")
    }
}

/// The cheapest profile about that of a trial whose errors are within the target.
///
/// # Errors
/// As [`Trial::run`].
pub fn search(trial: &Trial, model: &Model, target: &Target) -> Result<Found> {
    let longest: Vec<u64> = model.ranges().iter().map(|range| range[1]).collect();
    let least = model.squares(&longest).map(|square| square.max(0.0).sqrt());
    let missed: Vec<_> = (0..3)
        .filter(|n| target.0[*n].is_some_and(|most| least[*n] > most))
        .map(|n| (Quantity::ALL[n], least[n]))
        .collect();
    let mut most = target.0;
    let mut found = None;
    for _ in 0..TRIES {
        let bits = if missed.is_empty() { model.cheapest(&most) } else { longest.clone() };
        let profile = model.profile(trial.profile(), &bits);
        let plan = [(None, Profile { name: format!("{}-found", profile.name), ..profile })];
        let point = trial.run(&plan, &|| ())?.remove(0);
        let over = over(&point.measured, target);
        found = Some((point, plan[0].1.clone()));
        if over <= 1.0 || !missed.is_empty() {
            break;
        }
        most = most.map(|limit| limit.map(|limit| limit / (over * 1.01)));
    }
    let (point, profile) = found.expect("there is a try");
    Ok(Found {
        target: *target,
        bits: Knob::words().map(|knob| (knob.key().into(), knob.value(&profile))).collect(),
        predicted: point.predicted,
        measured: point.measured,
        cost: point.cost,
        before: model.cost(),
        limit: limit(&point, target),
        missed,
        profile,
    })
}

/// How often a target is tightened where the profile that was found misses it.
const TRIES: usize = 6;

/// By how much measured errors are beyond the target, the largest ratio.
fn over(measured: &[Error; 3], target: &Target) -> f64 {
    let ratio = |(of, most): (&Error, &Option<f64>)| most.map_or(0.0, |most| of.rms / most);
    measured.iter().zip(&target.0).map(ratio).fold(0.0, f64::max)
}

/// The quantity nearest to its target, and the source that adds most to it.
fn limit(point: &Point, target: &Target) -> Option<(Quantity, String)> {
    let share = |n: &usize| target.0[*n].map_or(0.0, |most| point.measured[*n].rms / most);
    let nearest = (0..3).max_by(|a, b| share(a).total_cmp(&share(b)))?;
    let most = point.sources[nearest].iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    target.0[nearest].map(|_| (Quantity::ALL[nearest], most.0.clone()))
}
