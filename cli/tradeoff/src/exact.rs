// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cheapest choice of one option for each of several knobs, with errors within limits: branch and
//! bound.
//!
//! ```text
//! min Σ_k c_k(b_k)   with   Σ_k e_kn(b_k) ≤ r_n
//!     ≥ Σ_k min_b (c_k(b) + Σ_n λ_n·e_kn(b)) − Σ_n λ_n·r_n     for any λ ≥ 0
//! ```
//!
//! The multipliers λ are found by subgradient steps; with them the second line is a bound of what a
//! choice for the first knobs can still lead to. Source: Lagrangian relaxation, Fisher 1981,
//! doi:10.1287/mnsc.27.1.1.

/// What an option of a knob costs, and which part of each limit it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Cost.
    pub cost: f64,
    /// Parts of the limits; negative where it gives something back.
    pub errors: [f64; 3],
}

/// How often the multipliers are improved.
const STEPS: u32 = 400;
/// The most choices that are tried: then the search returns the best so far, which may not be the
/// best.
const NODES: usize = 5_000_000;
/// Costs and errors nearer than this are the same.
const SAME: f64 = 1e-9;

/// Multipliers, and what follows from them for the knobs from each on.
struct Bounds {
    multipliers: [f64; 3],
    /// Least cost and error, weighted, of the knobs from one on.
    costs: Vec<f64>,
    /// Least error of the knobs from one on, limit by limit.
    errors: Vec<[f64; 3]>,
}

fn weighted(choice: &Choice, multipliers: &[f64; 3]) -> f64 {
    choice.cost + dot(multipliers, &choice.errors)
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|n| a[n] + b[n])
}

fn least(choices: &[Choice], of: impl Fn(&Choice) -> f64) -> &Choice {
    choices.iter().min_by(|a, b| of(a).total_cmp(&of(b))).expect("a knob has an option")
}

/// The multipliers with the largest bound, about.
fn multipliers(knobs: &[Vec<Choice>], room: [f64; 3], scale: f64) -> [f64; 3] {
    let mut now = [0.0; 3];
    let mut best = (f64::NEG_INFINITY, now);
    for step in 1..=STEPS {
        let chosen = knobs.iter().map(|knob| least(knob, |of| weighted(of, &now)));
        let (mut bound, mut beyond) = (-dot(&now, &room), room.map(|room| -room));
        for choice in chosen {
            bound += weighted(choice, &now);
            beyond = plus(beyond, choice.errors);
        }
        if bound > best.0 {
            best = (bound, now);
        }
        let length = dot(&beyond, &beyond).sqrt();
        if length < SAME {
            break;
        }
        let by = scale / f64::from(step).sqrt() / length;
        now = [0, 1, 2].map(|n| (now[n] + by * beyond[n]).max(0.0));
    }
    best.1
}

impl Bounds {
    fn new(knobs: &[Vec<Choice>], multipliers: [f64; 3]) -> Self {
        let (mut costs, mut errors) = (vec![0.0], vec![[0.0; 3]]);
        for knob in knobs.iter().rev() {
            let cost = weighted(least(knob, |of| weighted(of, &multipliers)), &multipliers);
            let error = [0, 1, 2].map(|n| least(knob, |of| of.errors[n]).errors[n]);
            costs.push(costs[costs.len() - 1] + cost);
            errors.push(plus(errors[errors.len() - 1], error));
        }
        costs.reverse();
        errors.reverse();
        Bounds { multipliers, costs, errors }
    }
}

/// A search on its way.
struct Search<'a> {
    knobs: &'a [Vec<Choice>],
    room: [f64; 3],
    bounds: Bounds,
    /// Options of each knob, the most promising first.
    orders: Vec<Vec<usize>>,
    chosen: Vec<usize>,
    best: (f64, Option<Vec<usize>>),
    nodes: usize,
}

impl Search<'_> {
    /// Goes on from a choice for the first knobs, of this cost and these errors.
    fn descend(&mut self, cost: f64, errors: [f64; 3]) {
        let at = self.chosen.len();
        let left = [0, 1, 2].map(|n| self.room[n] - errors[n]);
        let bound = cost + self.bounds.costs[at] - dot(&self.bounds.multipliers, &left);
        let is_beyond = (0..3).any(|n| self.bounds.errors[at][n] > left[n] + SAME);
        if bound >= self.best.0 - SAME || is_beyond || self.nodes == NODES {
            return;
        }
        self.nodes += 1;
        if at == self.knobs.len() {
            // The bound lies below the cost where limits are not used up.
            if cost < self.best.0 - SAME {
                self.best = (cost, Some(self.chosen.clone()));
            }
            return;
        }
        for n in 0..self.orders[at].len() {
            let option = self.orders[at][n];
            let choice = self.knobs[at][option];
            self.chosen.push(option);
            self.descend(cost + choice.cost, plus(errors, choice.errors));
            self.chosen.pop();
        }
    }
}

/// The options, one of each knob, that cost least with errors within `room`; none where none is
/// cheaper than `most`.
pub fn cheapest(knobs: &[Vec<Choice>], room: [f64; 3], most: f64) -> Option<Vec<usize>> {
    let spread = |knob: &Vec<Choice>| {
        let costs = || knob.iter().map(|of| of.cost);
        costs().fold(f64::MIN, f64::max) - costs().fold(f64::MAX, f64::min)
    };
    let scale = knobs.iter().map(spread).fold(0.0, f64::max);
    let multipliers = multipliers(knobs, room, scale);
    let order = |knob: &Vec<Choice>| {
        let mut order: Vec<usize> = (0..knob.len()).collect();
        let weight = |option: &usize| weighted(&knob[*option], &multipliers);
        order.sort_by(|a, b| weight(a).total_cmp(&weight(b)));
        order
    };
    let mut search = Search {
        orders: knobs.iter().map(order).collect(),
        bounds: Bounds::new(knobs, multipliers),
        knobs,
        room,
        chosen: Vec::new(),
        best: (most, None),
        nodes: 0,
    };
    search.descend(0.0, [0.0; 3]);
    search.best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every combination of five knobs with six options each.
    fn by_all(knobs: &[Vec<Choice>], room: [f64; 3]) -> Option<f64> {
        let mut sums = vec![(0.0, [0.0; 3])];
        for knob in knobs {
            let longer = |(cost, errors): &(f64, [f64; 3])| {
                let (cost, errors) = (*cost, *errors);
                knob.iter().map(move |of| (cost + of.cost, plus(errors, of.errors)))
            };
            sums = sums.iter().flat_map(longer).collect();
        }
        let holds = |errors: &[f64; 3]| (0..3).all(|n| errors[n] <= room[n] + SAME);
        let costs = sums.into_iter().filter(|(_, errors)| holds(errors)).map(|(cost, _)| cost);
        costs.min_by(f64::total_cmp)
    }

    #[test]
    fn nothing_is_cheaper_than_what_is_found() {
        let mut random = fastrand::Rng::with_seed(1);
        for round in 0..200 {
            let mut choice = |bits: i32| Choice {
                cost: 10.0 * f64::from(bits) * (0.5 + random.f64()),
                errors: [0; 3].map(|_| 4f64.powi(-bits) * random.f64()),
            };
            let knobs: Vec<Vec<Choice>> =
                (0..5).map(|_| (0..6).map(&mut choice).collect()).collect();
            let room = [0; 3].map(|_| 10f64.powf(-2.0 * random.f64()));
            let found = cheapest(&knobs, room, f64::INFINITY).map(|options| {
                options.iter().zip(&knobs).map(|(option, knob)| knob[*option].cost).sum::<f64>()
            });
            match (found, by_all(&knobs, room)) {
                (Some(found), Some(best)) => {
                    assert!((found - best).abs() < 1e-6, "{round}: {found}, {best}")
                }
                (found, best) => assert_eq!(found, best, "{round}"),
            }
        }
    }

    #[test]
    fn what_no_choice_meets_is_not_found() {
        let choice = Choice { cost: 1.0, errors: [0.6, 0.0, 0.0] };
        assert_eq!(cheapest(&[vec![choice], vec![choice]], [1.0; 3], f64::INFINITY), None);
        assert_eq!(cheapest(&[vec![choice]], [1.0; 3], f64::INFINITY), Some(vec![0]));
        assert_eq!(cheapest(&[vec![choice]], [1.0; 3], 1.0), None, "nothing cheaper");
    }
}
