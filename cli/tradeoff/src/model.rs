// SPDX-License-Identifier: MIT OR Apache-2.0
//! The additive model of a profile's errors and area: what each word adds, and what a bit of it costs.
//!
//! ```text
//! E² = E₀² + Σ v_k·(4^(b₀−b_k) − 1),      LUT = LUT₀ + Σ s_k·(b_k − b₀)
//! ```
//!
//! v_k, the variance that the word of knob k adds, and s_k, what a bit of it costs, come from one
//! prediction and one netlist per knob; any combination then is a sum. From the longest words on, the
//! search removes the bit that saves most area for the error that it adds, as long as the limits
//! hold. Branch and bound ([`super::exact`]) then finds what is cheaper.

use super::cost::{Cost, cost};
use super::errors::Errors;
use super::exact::{self, Choice};
use super::forecast::Forecast;
use super::knobs::Knob;
use super::sweep::{Point, Trial};
use anyhow::Result;
use hapticore_contract::profile::Profile;
use hapticore_synth::target::Family;
use serde::Serialize;

/// What one more bit of a knob would buy.
#[derive(Debug, Clone, Serialize)]
pub struct NextBit {
    /// The knob's key in a profile.
    pub knob: String,
    /// Where it stands.
    pub bits: u64,
    /// By how much the predicted errors of force, capacitance and position would fall, each in its unit.
    pub less: [f64; 3],
    /// LUT4 that it would take.
    pub luts: f64,
}

/// What a bit of a knob adds and costs.
#[derive(Debug, Clone)]
struct Slope {
    knob: Knob,
    /// Where the knob stands in the profile, and how far it may be turned.
    base: u64,
    range: [u64; 2],
    /// Variance that the word adds at `base`, of each quantity.
    variance: [f64; 3],
    luts: f64,
}

impl Slope {
    /// What a knob's word does between a profile and the same with [`STEP`] bits less.
    fn between(knob: Knob, about: (&Profile, Family), itself: Told, shorter: Told) -> Self {
        let (profile, family) = about;
        let grown = 4f64.powi(STEP as i32) - 1.0;
        let variance = |n| ((shorter.square(n) - itself.square(n)) / grown).max(0.0);
        Slope {
            knob,
            base: knob.value(profile),
            range: range(knob, profile),
            variance: [0, 1, 2].map(variance),
            luts: (itself.cost.luts_of(family) - shorter.cost.luts_of(family)) / STEP as f64,
        }
    }

    /// The same in another profile with the same word, whose LUT4 are known: the area is its own.
    fn about(&self, (profile, family): (&Profile, Family), luts: f64) -> Result<Self> {
        let shorter = self.knob.set(profile, self.base - STEP);
        let cost = shorter.map(|shorter| cost(&shorter)).transpose()?;
        let per_bit = |shorter: Cost| (luts - shorter.luts_of(family)) / STEP as f64;
        let luts = cost.map_or(self.luts, per_bit);
        Ok(Slope { range: range(self.knob, profile), luts, ..*self })
    }

    /// The variance that the word adds with `bits` bits beyond that at `base`, over the latter.
    fn grown(&self, bits: u64) -> f64 {
        4f64.powi(self.base as i32 - bits as i32) - 1.0
    }

    /// LUT4 that `bits` bits cost beyond those at `base`.
    fn more_luts(&self, bits: u64) -> f64 {
        self.luts * (bits as f64 - self.base as f64)
    }

    /// What each length within range costs beyond that of the profile, and which part of the limits it
    /// takes.
    fn choices(&self, most: &[Option<f64>; 3]) -> Vec<Choice> {
        let choice = |bits: u64| {
            let part = |n: usize| {
                most[n].map_or(0.0, |most| self.grown(bits) * self.variance[n] / (most * most))
            };
            Choice { cost: self.more_luts(bits), errors: [0, 1, 2].map(part) }
        };
        (self.range[0]..=self.range[1]).map(choice).collect()
    }
}

/// Cost and predicted errors of a profile.
#[derive(Clone, Copy)]
struct Told {
    cost: Cost,
    predicted: Errors,
}

impl From<Forecast> for Told {
    fn from(of: Forecast) -> Self {
        Told { cost: of.cost, predicted: of.predicted }
    }
}

impl Told {
    /// Mean square of a predicted error.
    fn square(self, quantity: usize) -> f64 {
        self.predicted[quantity].rms.powi(2)
    }
}

/// The additive model of a profile's errors and area.
#[derive(Debug, Clone)]
pub struct Model {
    profile: Profile,
    family: Family,
    /// Of the profile itself.
    cost: Cost,
    squares: [f64; 3],
    slopes: Vec<Slope>,
}

/// By how many bits a word is shortened to see what it adds; [`Trial::plan`](super::sweep::Trial::plan) has this step.
const STEP: u64 = 2;
/// How far words may grow or shrink.
const REACH: u64 = 8;

impl Model {
    /// What predictions and netlists about a profile say: those of its sweep, the profile itself
    /// first, as [`Trial::plan`] has them. LUT4 are a family's.
    ///
    /// # Panics
    /// Where there is no point.
    pub fn new(profile: &Profile, family: Family, swept: &[Point]) -> Self {
        let told = |point: &Point| Told { cost: point.cost, predicted: point.predicted };
        let itself = told(&swept[0]);
        let slope = |knob: Knob| {
            let shorter = knob.value(profile).checked_sub(STEP)?;
            let is_it = |point: &&Point| point.knob == knob.key() && point.value == shorter;
            let shorter = told(swept.iter().find(is_it)?);
            Some(Slope::between(knob, (profile, family), itself, shorter))
        };
        Model {
            profile: profile.clone(),
            family,
            cost: itself.cost,
            squares: [0, 1, 2].map(|n| itself.square(n)),
            slopes: Knob::searched().filter_map(slope).collect(),
        }
    }

    /// The model of the same profile with other block-floating words. What words after these add to
    /// errors does not depend on them: it is not predicted again.
    ///
    /// # Errors
    /// As [`Trial::forecast`].
    pub fn with_blocks(&self, trial: &Trial, profile: &Profile) -> Result<Self> {
        let words = Knob::Words.value(profile).checked_sub(STEP);
        let shorter = words.and_then(|words| Knob::Words.set(profile, words));
        let profiles: Vec<Profile> = [profile.clone()].into_iter().chain(shorter).collect();
        let told = trial.forecast(&profiles)?.into_iter().map(Told::from).collect::<Vec<_>>();
        let about = (profile, self.family);
        let slope = |slope: &Slope| match (slope.knob, told.get(1)) {
            (Knob::Words, Some(shorter)) => {
                Ok(Slope::between(slope.knob, about, told[0], *shorter))
            }
            _ => slope.about(about, told[0].cost.luts_of(self.family)),
        };
        Ok(Model {
            profile: profile.clone(),
            family: self.family,
            cost: told[0].cost,
            squares: [0, 1, 2].map(|n| told[0].square(n)),
            slopes: self.slopes.iter().map(slope).collect::<Result<_>>()?,
        })
    }

    /// The model of these knobs alone: the others keep their lengths.
    pub fn only(&self, knobs: &[Knob]) -> Model {
        let of_them = self.slopes.iter().filter(|slope| knobs.contains(&slope.knob));
        Model { slopes: of_them.cloned().collect(), ..self.clone() }
    }

    /// Whether a profile differs from the model's own in word lengths alone.
    pub fn is_about(&self, profile: &Profile) -> bool {
        Knob::BlockShift.value(&self.profile) == Knob::BlockShift.value(profile)
    }

    /// The family whose LUT4 are counted.
    pub fn family(&self) -> Family {
        self.family
    }

    /// What the profile itself costs.
    pub fn cost(&self) -> Cost {
        self.cost
    }

    /// How far each word may be shortened and lengthened, bits.
    pub fn ranges(&self) -> Vec<[u64; 2]> {
        self.slopes.iter().map(|slope| slope.range).collect()
    }

    /// The longest words.
    pub fn longest(&self) -> Vec<u64> {
        self.slopes.iter().map(|slope| slope.range[1]).collect()
    }

    /// Mean squares of the errors with these bits.
    pub fn squares(&self, bits: &[u64]) -> [f64; 3] {
        let mut squares = self.squares;
        for (slope, bits) in self.slopes.iter().zip(bits) {
            for (square, variance) in squares.iter_mut().zip(slope.variance) {
                *square += variance * slope.grown(*bits);
            }
        }
        squares
    }

    /// Estimated LUT4 with these bits.
    pub fn luts(&self, bits: &[u64]) -> f64 {
        let more = |(slope, bits): (&Slope, &u64)| slope.more_luts(*bits);
        self.cost.luts_of(self.family) + self.slopes.iter().zip(bits).map(more).sum::<f64>()
    }

    /// What one more bit of each knob would buy in a profile.
    pub fn next_bits(&self, profile: &Profile) -> Vec<NextBit> {
        let bits: Vec<u64> = self.slopes.iter().map(|slope| slope.knob.value(profile)).collect();
        let rms = |bits: &[u64]| self.squares(bits).map(|square| square.max(0.0).sqrt());
        let now = rms(&bits);
        let next = |(at, slope): (usize, &Slope)| {
            let mut longer = bits.clone();
            longer[at] += 1;
            let then = rms(&longer);
            let less = [0, 1, 2].map(|n| now[n] - then[n]);
            NextBit { knob: slope.knob.key().into(), bits: bits[at], less, luts: slope.luts }
        };
        self.slopes.iter().enumerate().map(next).collect()
    }

    /// The bits that cost least with errors within limits; the longest words where no length meets
    /// them.
    pub fn cheapest(&self, most: &[Option<f64>; 3]) -> Vec<u64> {
        let mut bits = self.longest();
        while let Some(next) = self.shorter(&bits, most) {
            bits = next;
        }
        let knobs: Vec<Vec<Choice>> = self.slopes.iter().map(|slope| slope.choices(most)).collect();
        let part = |n: usize| most[n].map_or(0.0, |most| self.squares[n] / (most * most));
        let room = [0, 1, 2].map(|n| 1.0 - part(n));
        let cheaper =
            exact::cheapest(&knobs, room, self.luts(&bits) - self.cost.luts_of(self.family));
        let value = |(slope, option): (&Slope, usize)| slope.range[0] + option as u64;
        cheaper.map_or(bits, |options| self.slopes.iter().zip(options).map(value).collect())
    }

    /// Whether errors with these bits are within limits.
    pub fn holds(&self, bits: &[u64], most: &[Option<f64>; 3]) -> bool {
        let squares = self.squares(bits);
        squares
            .iter()
            .zip(most)
            .all(|(square, most)| most.is_none_or(|most| *square <= most * most))
    }

    /// How much of the targets is used up: the largest share.
    pub fn used(&self, bits: &[u64], most: &[Option<f64>; 3]) -> f64 {
        let squares = self.squares(bits);
        let share =
            |(square, most): (&f64, &Option<f64>)| most.map_or(0.0, |most| square / (most * most));
        squares.iter().zip(most).map(share).fold(0.0, f64::max)
    }

    fn with(&self, bits: &[u64], at: usize, by: i64) -> Option<Vec<u64>> {
        let value = bits[at].checked_add_signed(by)?;
        let [least, most] = self.slopes[at].range;
        (least..=most).contains(&value).then(|| {
            let mut bits = bits.to_vec();
            bits[at] = value;
            bits
        })
    }

    /// A bit less, where most area is saved for the error that is added.
    fn shorter(&self, bits: &[u64], most: &[Option<f64>; 3]) -> Option<Vec<u64>> {
        let used = self.used(bits, most);
        let tried = (0..bits.len()).filter_map(|at| {
            let next = self.with(bits, at, -1).filter(|next| self.holds(next, most))?;
            let added = (self.used(&next, most) - used).max(1e-12);
            Some((self.slopes[at].luts.max(1e-3) / added, next))
        });
        tried.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, next)| next)
    }

    /// The profile with these bits; a word that no core can have keeps its length.
    pub fn profile(&self, bits: &[u64]) -> Profile {
        let mut found = self.profile.clone();
        // A word that must not be longer than another's waits for it.
        for _ in 0..2 {
            for (slope, bits) in self.slopes.iter().zip(bits) {
                found = slope.knob.set(&found, *bits).unwrap_or(found);
            }
        }
        found
    }
}

/// How far a knob may be turned by itself.
fn range(knob: Knob, profile: &Profile) -> [u64; 2] {
    let base = knob.value(profile);
    let within = |by: &i64| {
        base.checked_add_signed(*by).is_some_and(|value| knob.set(profile, value).is_some())
    };
    let reach = REACH as i64;
    let down = (1..=reach).take_while(|by| within(&-by)).last().unwrap_or(0);
    // A finer ADC is another part, which a profile asks for, not a search.
    let most = if knob == Knob::Adc { 0 } else { reach };
    let up = (1..=most).take_while(within).last().unwrap_or(0);
    [base - down as u64, base + up as u64]
}
