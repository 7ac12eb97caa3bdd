// SPDX-License-Identifier: MIT OR Apache-2.0
//! Other ways to the cheapest word lengths, on the same model.

use good_lp::{Expression, ProblemVariables, Solution, SolverModel, constraint, variable};
use hapticore_tradeoff::model::Model;
use rand::SeedableRng;
use rand::rngs::StdRng;

/// RMS errors of force, capacitance and position that must not be exceeded.
pub type Limits = [Option<f64>; 3];
type Bits = Vec<u64>;

/// The better of two candidates: one that holds the limits, then the cheaper one.
fn keep(model: &Model, limits: &Limits, best: &mut Option<Bits>, bits: &Bits) {
    let is_cheaper = best.as_ref().is_none_or(|best| model.luts(bits) < model.luts(best));
    if is_cheaper && model.holds(bits, limits) {
        *best = Some(bits.clone());
    }
}

/// Every combination.
pub fn exhaustive(model: &Model, limits: &Limits) -> Option<Bits> {
    let ranges = model.ranges();
    let (mut best, mut bits): (_, Bits) = (None, ranges.iter().map(|range| range[0]).collect());
    loop {
        keep(model, limits, &mut best, &bits);
        let Some(at) = (0..bits.len()).find(|&at| bits[at] < ranges[at][1]) else { return best };
        bits[at] += 1;
        bits[..at].iter_mut().zip(&ranges).for_each(|(bits, range)| *bits = range[0]);
    }
}

/// The least LUT4 that there are: a choice of one length for each word, as an integer program.
pub fn integer_program(model: &Model, limits: &Limits) -> Option<f64> {
    let ranges = model.ranges();
    let base: Bits = ranges.iter().map(|range| range[1]).collect();
    let (luts, squares) = (model.luts(&base), model.squares(&base));
    let mut variables = ProblemVariables::new();
    let mut cost = Expression::from(luts);
    let mut errors: [Expression; 3] = squares.map(Expression::from);
    let mut choices = Vec::new();
    for (at, range) in ranges.iter().enumerate() {
        let mut one = Expression::from(0.0);
        // None chosen is the longest word: without it among the choices the solver's basis stays regular.
        for bits in range[0]..range[1] {
            let mut changed = base.clone();
            changed[at] = bits;
            // Left out: what no length of the others makes good, up to 4^16 times the limit.
            if !model.holds(&changed, limits) {
                continue;
            }
            let chosen = variables.add(variable().binary());
            one += chosen;
            cost += (model.luts(&changed) - luts) * chosen;
            let more = model.squares(&changed);
            for (error, (more, square)) in errors.iter_mut().zip(more.into_iter().zip(squares)) {
                *error += (more - square) * chosen;
            }
        }
        choices.push(constraint!(one <= 1));
    }
    let mut problem = variables.minimise(cost.clone()).using(good_lp::microlp);
    for choice in choices {
        problem = problem.with(choice);
    }
    for (error, most) in errors.into_iter().zip(limits) {
        if let Some(most) = most {
            problem = problem.with(constraint!(error * (1.0 / (most * most)) <= 1.0));
        }
    }
    let solved = problem.solve();
    eprintln!("{:?} {limits:?} {squares:?} {}", solved.as_ref().err(), ranges.len());
    Some(solved.ok()?.eval(cost))
}

/// From the shortest words on, the bit is added that brings the errors down most for its area.
pub fn min_plus_one(model: &Model, limits: &Limits) -> Option<Bits> {
    let ranges = model.ranges();
    let mut bits: Bits = ranges.iter().map(|range| range[0]).collect();
    while !model.holds(&bits, limits) {
        let (used, luts) = (model.used(&bits, limits), model.luts(&bits));
        let longer = (0..bits.len()).filter(|&at| bits[at] < ranges[at][1]).map(|at| {
            let mut longer = bits.clone();
            longer[at] += 1;
            let gain = used - model.used(&longer, limits);
            (gain / (model.luts(&longer) - luts).max(1e-3), longer)
        });
        bits = longer.max_by(|a, b| a.0.total_cmp(&b.0))?.1;
    }
    Some(bits)
}

/// Simulated annealing from the longest words; what exceeds a limit costs LUT4 by its share.
pub fn annealed(model: &Model, limits: &Limits, evaluations: usize) -> Option<Bits> {
    let mut random = fastrand::Rng::with_seed(1);
    let ranges = model.ranges();
    let price = |bits: &Bits| {
        let over = (model.used(bits, limits) - 1.0).max(0.0);
        model.luts(bits) + 100.0 * over.min(1e3)
    };
    let mut bits: Bits = ranges.iter().map(|range| range[1]).collect();
    let (mut now, mut best) = (price(&bits), None);
    for step in 0..evaluations {
        let temperature = 30.0 * (1.0 - step as f64 / evaluations as f64) + 1e-3;
        let mut next = bits.clone();
        let at = random.usize(..bits.len());
        let by = if random.bool() { 1 } else { -1 };
        next[at] = next[at].saturating_add_signed(by).clamp(ranges[at][0], ranges[at][1]);
        let then = price(&next);
        if then <= now || random.f64() < ((now - then) / temperature).exp() {
            (bits, now) = (next, then);
            keep(model, limits, &mut best, &bits);
        }
    }
    best
}

/// Tree-structured Parzen estimators, one for each word (crate `tpe`).
pub fn by_tpe(model: &Model, limits: &Limits, evaluations: usize) -> Option<Bits> {
    let mut random = StdRng::seed_from_u64(1);
    let ranges = model.ranges();
    let optimizer = |range: &[u64; 2]| {
        let within = tpe::range(range[0] as f64, range[1] as f64 + 1.0).expect("a range");
        tpe::TpeOptimizer::new(tpe::parzen_estimator(), within)
    };
    let mut optimizers: Vec<_> = ranges.iter().map(optimizer).collect();
    let mut best = None;
    for _ in 0..evaluations {
        let asked: Vec<f64> =
            optimizers.iter_mut().map(|of| of.ask(&mut random).expect("a value")).collect();
        let bits: Bits =
            asked.iter().zip(&ranges).map(|(asked, range)| (*asked as u64).min(range[1])).collect();
        keep(model, limits, &mut best, &bits);
        let over = (model.used(&bits, limits) - 1.0).max(0.0);
        let price = model.luts(&bits) + 100.0 * over.min(1e3);
        for (of, asked) in optimizers.iter_mut().zip(asked) {
            of.tell(asked, price).expect("a number");
        }
    }
    best
}
