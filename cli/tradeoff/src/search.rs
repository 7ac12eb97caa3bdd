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
use hapticore_synth::target::Family;
use serde::Serialize;

/// What a search found.
#[derive(Debug, Clone, Serialize)]
pub struct Found {
    /// What was asked for.
    pub target: Target,
    /// The part whose LUT4 are counted.
    pub part: &'static str,
    /// Its family.
    #[serde(skip)]
    pub family: Family,
    /// Bits of each knob, and the shift of block-floating words.
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
            "LUT4 {:.0} instead of {:.0} (estimated, {}), flip-flops {:.0} instead of {:.0}, latency {} clocks instead of {}",
            self.cost.luts_of(self.family),
            self.before.luts_of(self.family),
            self.part,
            self.cost.flip_flops,
            self.before.flip_flops,
            self.cost.latency_clocks,
            self.before.latency_clocks
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

/// The models that a search looks into: that of a trial's sweep, the first, and those of the same
/// profile with other block-floating words.
///
/// # Errors
/// As [`Trial::run`].
pub fn models(trial: &Trial, family: Family, swept: &[Point]) -> Result<Vec<Model>> {
    let mut models = vec![Model::new(trial.profile(), family, swept)];
    for profile in Knob::other_blocks(trial.profile()) {
        models.push(models[0].with_blocks(trial, &profile)?);
    }
    Ok(models)
}

/// The cheapest profile of some models whose errors are within the target. The first model is of the
/// profile that the search begins with.
///
/// # Errors
/// As [`Trial::run`].
///
/// # Panics
/// Where there is no model.
pub fn search(trial: &Trial, models: &[Model], target: &Target) -> Result<Found> {
    let (least, family) = (least(models), models[0].family());
    let missed: Vec<_> = (0..3)
        .filter(|n| target.0[*n].is_some_and(|most| least[*n] > most))
        .map(|n| (Quantity::ALL[n], least[n]))
        .collect();
    let Verified { point, profile, .. } = verified(trial, models, target, missed.is_empty())?;
    let listed = Knob::words().chain([Knob::BlockShift]);
    Ok(Found {
        target: *target,
        part: family.part(),
        family,
        bits: listed.map(|knob| (knob.key().into(), knob.value(&profile))).collect(),
        predicted: point.predicted,
        measured: point.measured,
        cost: point.cost,
        before: models[0].cost(),
        limit: limit(&point, target),
        missed,
        profile,
    })
}

/// The least errors that any word lengths have.
fn least(models: &[Model]) -> [f64; 3] {
    let of = |model: &Model| model.squares(&model.longest()).map(|square| square.max(0.0).sqrt());
    let each: Vec<[f64; 3]> = models.iter().map(of).collect();
    [0, 1, 2].map(|n| each.iter().map(|errors| errors[n]).fold(f64::INFINITY, f64::min))
}

/// A profile that was run.
struct Verified {
    point: Point,
    profile: Profile,
    /// By how much measured errors are beyond the target, the largest ratio.
    over: f64,
    luts: f64,
}

impl Verified {
    fn run(trial: &Trial, model: &Model, bits: &[u64], target: &Target) -> Result<Self> {
        let name = format!("{}-found", trial.profile().name);
        let profile = Profile { name, ..model.profile(bits) };
        let point = trial.run(&[(None, profile.clone())], &|| ())?.remove(0);
        let ratio = |(of, most): (&Error, &Option<f64>)| most.map_or(0.0, |most| of.rms / most);
        let over = point.measured.iter().zip(&target.0).map(ratio).fold(0.0, f64::max);
        Ok(Verified { over, luts: point.cost.luts_of(model.family()), point, profile })
    }

    fn holds(&self) -> bool {
        self.over <= 1.0
    }

    /// One that meets the target is better than one that does not; then the smaller, or the less beyond.
    fn is_better(&self, than: &Verified) -> bool {
        match [self.holds(), than.holds()] {
            [true, true] => self.luts < than.luts,
            [false, false] => self.over < than.over,
            [holds, _] => holds,
        }
    }
}

/// How often a target is tightened where the profile that was found misses it.
const TRIES: usize = 6;

/// The best profile of all models, as measured. The model of fewest predicted LUT4 comes first; of the
/// others nothing is run that would not be smaller than what holds.
fn verified(trial: &Trial, models: &[Model], target: &Target, tightens: bool) -> Result<Verified> {
    let luts = |model: &Model| model.luts(&model.cheapest(&target.0));
    let mut by_luts: Vec<_> = models.iter().map(|model| (luts(model), model)).collect();
    by_luts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<Verified> = None;
    for (_, model) in by_luts {
        let mut most = target.0;
        for _ in 0..if tightens { TRIES } else { 1 } {
            let bits = model.cheapest(&most);
            let smaller = |best: &Verified| !best.holds() || model.luts(&bits) < best.luts;
            if !best.as_ref().is_none_or(smaller) {
                break;
            }
            let tried = Verified::run(trial, model, &bits, target)?;
            let holds = tried.holds();
            most = tightened(most, &model.squares(&bits), &tried.point.measured, target);
            if best.as_ref().is_none_or(|best| tried.is_better(best)) {
                best = Some(tried);
            }
            if holds {
                break;
            }
        }
    }
    Ok(best.expect("there is a model"))
}

/// Limits of what is predicted, so much smaller as measured errors are beyond the target.
fn tightened(
    most: [Option<f64>; 3],
    squares: &[f64; 3],
    measured: &[Error; 3],
    target: &Target,
) -> [Option<f64>; 3] {
    let limit = |n: usize| {
        let of = target.0[n].filter(|of| measured[n].rms > *of);
        let tighter = of.map(|of| 0.99 * squares[n].max(0.0).sqrt() * of / measured[n].rms);
        tighter.or(most[n])
    };
    [0, 1, 2].map(limit)
}

/// The quantity nearest to its target, and the source that adds most to it.
fn limit(point: &Point, target: &Target) -> Option<(Quantity, String)> {
    let share = |n: &usize| target.0[*n].map_or(0.0, |most| point.measured[*n].rms / most);
    let nearest = (0..3).max_by(|a, b| share(a).total_cmp(&share(b)))?;
    let most = point.sources[nearest].iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    target.0[nearest].map(|_| (Quantity::ALL[nearest], most.0.clone()))
}
