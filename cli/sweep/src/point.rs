// SPDX-License-Identifier: MIT OR Apache-2.0
//! Points of a plan: which there are, what each sets, and what each is called.

use serde::Serialize;
use serde_json::{Value, json};

use crate::axis::{Axis, Points, Settings, Side};
use crate::canonical;
use crate::plan::Plan;

/// One run of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Where in the plan, from 0.
    pub index: usize,
    /// Of the scene's noise and mismatch.
    pub seed: u64,
    /// What of the profile is set.
    pub profile: Settings,
    /// What of the scene is set.
    pub scene: Settings,
}

/// Names the points of a plan.
pub struct Names {
    /// The hash of what all points have in common.
    base: String,
}

impl Plan {
    /// The number of points.
    pub fn len(&self) -> usize {
        self.combinations() as usize
    }

    /// A plan has one point at least, but for one that draws none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of points, however many.
    pub(crate) fn combinations(&self) -> u128 {
        let of = |axis: &Axis| axis.values.list().map_or(1, |list| list.len() as u128);
        let settings = match &self.points {
            Points::Grid(axes) => axes.iter().map(of).fold(1, u128::saturating_mul),
            Points::Random { count, .. } => u128::from(*count),
        };
        settings.saturating_mul(self.seeds.len() as u128)
    }

    /// A point: seeds vary slowest, then the scene's keys, then the profile's.
    ///
    /// # Panics
    /// If `index` is beyond the last point.
    pub fn point(&self, index: usize) -> Point {
        assert!(index < self.len(), "there are {} points", self.len());
        let settings = self.len() / self.seeds.len();
        let seed = self.seeds[index / settings];
        let mut point = Point { index, seed, profile: Settings::new(), scene: Settings::new() };
        let mut left = index % settings;
        for axis in self.axes().iter().rev() {
            let value = match (&self.points, axis.values.list()) {
                (Points::Grid(_), Some(list)) => {
                    let value = &list[left % list.len()];
                    left /= list.len();
                    value.clone()
                }
                (Points::Random { seed, .. }, _) => axis.values.drawn(random(*seed, left, axis)),
                (Points::Grid(_), None) => unreachable!("a grid's axes are lists"),
            };
            let side = match axis.side {
                Side::Profile => &mut point.profile,
                Side::Scene => &mut point.scene,
            };
            side.insert(axis.key.clone(), value);
        }
        point
    }

    /// Orders points so that those which share plant and calibration are neighbours.
    pub fn group_by_bench(&self, points: &mut [usize]) {
        let keys = self.bench_keys();
        points.sort_by_cached_key(|index| {
            let Point { seed, profile, scene, .. } = self.point(*index);
            let moving: Vec<_> = keys.iter().map(|key| profile.get(key)).collect();
            canonical::text(&(seed, scene, moving))
        });
    }

    /// What the points are called.
    ///
    /// # Panics
    /// Where scene and case are not those of a plan that was read.
    pub fn names(&self) -> Names {
        let scene = self.scene_with(&Settings::new()).expect("a plan's scene has been read");
        let case = scene.cases.into_iter().find(|case| case.name == self.case);
        // Without comments and whatever else makes no difference.
        let document = case.expect("a plan's case is one of its scene's").document;
        let document: Value = toml::from_str(&document).expect("a document is TOML");
        Names {
            base: canonical::name(&json!({
                "schema": self.schema,
                "core": self.core,
                "scene": document,
                "case": self.case,
                "profile": self.profile,
                "fidelity": self.fidelity,
                "slots": self.slots,
                "predicted": self.predicted,
            })),
        }
    }
}

impl Names {
    /// The name of a point: the hash of what it has in common with others, and of what it sets.
    pub fn of(&self, point: &Point) -> String {
        #[derive(Serialize)]
        struct Named<'a> {
            base: &'a str,
            profile: &'a Settings,
            scene: &'a Settings,
            seed: u64,
        }
        let Point { profile, scene, seed, .. } = point;
        canonical::name(&Named { base: &self.base, profile, scene, seed: *seed })
    }
}

/// A draw: of the plan's seed, the point and the axis alone, so that neither more points nor further
/// axes change those that there are.
fn random(seed: u64, point: usize, axis: &Axis) -> u64 {
    let name = canonical::text(&(seed, point, axis.side, &axis.key));
    let hash = blake3::hash(name.as_bytes());
    u64::from_le_bytes(hash.as_bytes()[..8].try_into().expect("eight bytes"))
}
