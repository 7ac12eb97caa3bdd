// SPDX-License-Identifier: MIT OR Apache-2.0
//! The Pareto front: points that no other beats.

/// Whether each point is on the front: none other is as good in all numbers and better in one; less
/// is better.
///
/// ```
/// // Error and area: the third costs more than the second and is no better.
/// assert_eq!(hapticore_tradeoff::front::front(&[[1.0, 9.0], [2.0, 5.0], [2.0, 6.0]]), [true, true, false]);
/// ```
pub fn front<const N: usize>(points: &[[f64; N]]) -> Vec<bool> {
    let beats = |a: &[f64; N], b: &[f64; N]| a != b && a.iter().zip(b).all(|(a, b)| a <= b);
    let mut order: Vec<usize> = (0..points.len()).collect();
    let by_all = |a: &usize, b: &usize| {
        let numbers = points[*a].iter().zip(&points[*b]);
        numbers.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(a.cmp(b))
    };
    order.sort_by(by_all);
    // What beats a point comes before it, and is itself on the front or beaten by one that is.
    let mut front: Vec<usize> = Vec::new();
    for point in order {
        if !front.iter().any(|on| beats(&points[*on], &points[point])) {
            front.push(point);
        }
    }
    let mut is_on = vec![false; points.len()];
    front.into_iter().for_each(|point| is_on[point] = true);
    is_on
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_what_comparing_all_with_all_gives() {
        // A small generator suffices: what matters is ties and all orders.
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) % 8) as f64
        };
        let points: Vec<[f64; 3]> = (0..300).map(|_| [next(), next(), next()]).collect();
        let beaten = |own: &[f64; 3]| {
            points.iter().any(|other| {
                other.iter().zip(own).all(|(a, b)| a <= b)
                    && other.iter().zip(own).any(|(a, b)| a < b)
            })
        };
        let all: Vec<bool> = points.iter().map(|point| !beaten(point)).collect();
        assert_eq!(front(&points), all);
        assert!(all.iter().any(|on| *on) && all.iter().any(|on| !on));
    }
}
