// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest profile for a stated error. It comes from the [`Model`] or from the rows of the sweep, and is
//! judged by running it on slots that neither has used, on the scene where it is worst. Where it fails, the search
//! is repeated with a smaller target; where nothing holds, what is found is no larger than the profile that the
//! search began with.

use super::cost::Cost;
use super::errors::{Error, Errors, Quantity};
use super::knobs::Knob;
use super::model::Model;
use super::sweep::{Judged, Point, Trial};
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
    /// Predicted errors, over all scenes.
    pub predicted: Errors,
    /// Measured ones, on slots that the search has not seen: each of its worst scene.
    pub judged: Judged,
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
            .zip(&self.judged.errors)
            .all(|(most, of)| most.is_none_or(|most| of.rms <= most))
    }

    /// What was found, in words.
    pub fn text(&self) -> String {
        let mut lines = Vec::new();
        for (n, quantity) in Quantity::ALL.iter().enumerate() {
            let (Some(most), of) = (self.target.0[n], &self.judged) else { continue };
            let (measured, predicted) = (of.errors[n].rms, self.predicted[n].rms);
            let holds = if measured <= most { "holds" } else { "missed" };
            lines.push(format!(
                "{}: {measured:.3} {} on unseen slots of {}, {predicted:.3} predicted over all scenes, target {most:.3}: {holds}",
                quantity.name(),
                quantity.unit(),
                of.scenes[n],
            ));
        }
        if !self.judged.seen.is_empty() {
            let names = self.judged.seen.join(", ");
            lines.push(format!("{names}: no unseen slots, since --slots takes all of them"));
        }
        if !self.holds() {
            lines.push("nothing that was tried meets the target; this is the nearest that is no larger than the profile".into());
        }
        lines.push(format!(
            "LUT4 {:.0} instead of {:.0} (estimated, {}), flip-flops {:.0} instead of {:.0} (likewise), latency {} clocks instead of {}",
            self.cost.luts_of(self.family),
            self.before.luts_of(self.family),
            self.part,
            self.cost.flip_flops_of(self.family),
            self.before.flip_flops_of(self.family),
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

/// The cheapest profile of some models, or of a sweep's rows, whose errors are within the target. The first model
/// and the first row are of the profile that the search begins with.
///
/// # Errors
/// As [`Trial::run`].
///
/// # Panics
/// Where there is no model or no row.
pub fn search(trial: &Trial, swept: &[Point], models: &[Model], target: &Target) -> Result<Found> {
    let (least, family) = (least(models), models[0].family());
    let missed: Vec<_> = (0..3)
        .filter(|n| target.0[*n].is_some_and(|most| least[*n] > most))
        .map(|n| (Quantity::ALL[n], least[n]))
        .collect();
    let start = Verified::of(trial, models[0].family(), swept[0].clone(), target)?;
    let rows = of_rows(trial, swept, (&start, family), target)?;
    let found = verified(trial, models, target, (start, rows), missed.is_empty())?;
    let Verified { point, judged, profile, .. } = found;
    let limit = limit(&point, &judged, target);
    let listed = Knob::words().chain([Knob::BlockShift]);
    Ok(Found {
        target: *target,
        part: family.part(),
        family,
        bits: listed.map(|knob| (knob.key().into(), knob.value(&profile))).collect(),
        predicted: point.predicted,
        judged,
        cost: point.cost,
        before: models[0].cost(),
        limit,
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
    judged: Judged,
    profile: Profile,
    /// By how much errors are beyond the target, the largest ratio.
    over: f64,
    luts: f64,
}

impl Verified {
    fn run(trial: &Trial, model: &Model, bits: &[u64], target: &Target) -> Result<Self> {
        let profile = model.profile(bits);
        let point = trial.run(&[(None, profile)], &|| ())?.remove(0);
        Verified::of(trial, model.family(), point, target)
    }

    fn of(trial: &Trial, family: Family, point: Point, target: &Target) -> Result<Self> {
        let name = format!("{}-found", trial.profile().name);
        let profile = Profile { name, ..(*point.profile).clone() };
        let judged = trial.judge(&profile)?;
        let over = beyond(&judged.errors, target);
        Ok(Verified { over, luts: point.cost.luts_of(family), point, judged, profile })
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

/// By how much errors are beyond a target, the largest ratio.
fn beyond(errors: &Errors, target: &Target) -> f64 {
    let ratio = |(of, most): (&Error, &Option<f64>)| most.map_or(0.0, |most| of.rms / most);
    errors.iter().zip(&target.0).map(ratio).fold(0.0, f64::max)
}

/// The smallest row of a sweep that meets the target, if it is smaller than the start, or the start does not.
fn of_rows(
    trial: &Trial,
    swept: &[Point],
    (start, family): (&Verified, Family),
    target: &Target,
) -> Result<Option<Verified>> {
    let luts = |point: &&Point| point.cost.luts_of(family);
    let meets = |point: &&Point| beyond(&point.measured, target) <= 1.0;
    let mut rows: Vec<&Point> = swept[1..].iter().filter(meets).collect();
    rows.sort_by(|a, b| luts(a).total_cmp(&luts(b)));
    for row in rows {
        let row = Verified::of(trial, family, row.clone(), target)?;
        if row.holds() {
            return Ok(Some(row).filter(|row| row.is_better(start)));
        }
    }
    Ok(None)
}

/// How often a target is tightened where the profile that was found misses it.
const TRIES: i32 = 6;
/// By how much further from try to try: what a slot was off that no prediction has seen need not follow the words.
const FURTHER: f64 = 0.9;

/// The best profile of all models, of a row and of the start, as judged. The model of fewest predicted LUT4 comes
/// first; nothing is run that would not be smaller than what holds.
fn verified(
    trial: &Trial,
    models: &[Model],
    target: &Target,
    (start, row): (Verified, Option<Verified>),
    tightens: bool,
) -> Result<Verified> {
    let luts = |model: &Model| model.luts(&model.cheapest(&target.0));
    let mut by_luts: Vec<_> = models.iter().map(|model| (luts(model), model)).collect();
    by_luts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most_luts = start.luts;
    let mut best = row.unwrap_or(start);
    for (_, model) in by_luts {
        let mut most = target.0;
        for attempt in 0..if tightens { TRIES } else { 1 } {
            let bits = model.cheapest(&most);
            if best.holds() && model.luts(&bits) >= best.luts {
                break;
            }
            let tried = Verified::run(trial, model, &bits, target)?;
            let holds = tried.holds();
            let further = FURTHER.powi(attempt);
            most = tightened(most, &model.squares(&bits), (&tried.judged.errors, further), target);
            if tried.is_better(&best) && (holds || tried.luts <= most_luts) {
                best = tried;
            }
            if holds {
                break;
            }
        }
    }
    Ok(best)
}

/// Limits of what is predicted, so much smaller as measured errors are beyond the target, and by a factor.
fn tightened(
    most: [Option<f64>; 3],
    squares: &[f64; 3],
    (measured, further): (&[Error; 3], f64),
    target: &Target,
) -> [Option<f64>; 3] {
    let limit = |n: usize| {
        let of = target.0[n].filter(|of| measured[n].rms > *of);
        let tighter =
            of.map(|of| 0.99 * further * squares[n].max(0.0).sqrt() * of / measured[n].rms);
        tighter.or(most[n])
    };
    [0, 1, 2].map(limit)
}

/// The quantity nearest to its target, and the source that adds most to it.
fn limit(point: &Point, judged: &Judged, target: &Target) -> Option<(Quantity, String)> {
    let share = |n: &usize| target.0[*n].map_or(0.0, |most| judged.errors[*n].rms / most);
    let nearest = (0..3).max_by(|a, b| share(a).total_cmp(&share(b)))?;
    let most = point.sources[nearest].iter().max_by(|a, b| a.1.total_cmp(b.1))?;
    target.0[nearest].map(|_| (Quantity::ALL[nearest], most.0.clone()))
}
