// SPDX-License-Identifier: MIT OR Apache-2.0
//! A finer raster from a coarser one: cubic through four neighbours along either axis. A map is
//! fitted to it, so that each of its cells has points, however coarse the raster that was measured.

/// Columns and rows at least.
const LEAST: [usize; 2] = [241, 141];

/// A place and what is read there.
pub type Place = [f64; 5];

/// The raster of `columns` to a row, refined to at least [`LEAST`]; its columns and places.
pub fn refine(columns: usize, places: &[Place]) -> (usize, Vec<Place>) {
    let rows = places.len() / columns;
    let times = |points: usize, least: usize| (least - 1).div_ceil(points - 1).max(1);
    let across = steps(columns, times(columns, LEAST[0]));
    let mut wide = Vec::with_capacity(across.len() * rows);
    for row in places.chunks(columns) {
        wide.extend(across.iter().map(|step| step.between(|k| row[k])));
    }
    let columns = across.len();
    let down = steps(rows, times(rows, LEAST[1]));
    let mut fine = Vec::with_capacity(down.len() * columns);
    for step in down {
        fine.extend((0..columns).map(|column| step.between(|row| wide[row * columns + column])));
    }
    (columns, fine)
}

/// What the raster has at a place, cubic along either axis; none beyond it.
pub fn at(columns: usize, places: &[Place], [x, y]: [f64; 2]) -> Option<Place> {
    let lines = || places.chunks(columns);
    let across = Step::to(columns, |k| places[k][0], x)?;
    let down = Step::to(places.len() / columns, |k| places[k * columns][1], y)?;
    let between: Vec<Place> = lines().map(|row| across.between(|k| row[k])).collect();
    Some(down.between(|k| between[k]))
}

/// A place between two points of a line, or on the first of them.
struct Step {
    /// Points of the line.
    points: usize,
    /// The point before it, and how far it is from there to the next.
    after: usize,
    share: f64,
}

/// The places of a line of `points` points with `times` as many steps.
fn steps(points: usize, times: usize) -> Vec<Step> {
    let step =
        |k: usize| Step { points, after: k / times, share: (k % times) as f64 / times as f64 };
    (0..=(points - 1) * times).map(step).collect()
}

impl Step {
    /// To a value between those of the points, which rise or fall along the line.
    fn to(points: usize, value: impl Fn(usize) -> f64, to: f64) -> Option<Step> {
        let share = |k: usize| (to - value(k)) / (value(k + 1) - value(k));
        let after = (0..points - 1).find(|k| (0.0..=1.0).contains(&share(*k)))?;
        Some(Step { points, after, share: share(after) })
    }

    /// The line at this place.
    fn between(&self, line: impl Fn(usize) -> Place) -> Place {
        let k = self.after as isize;
        let near = [k - 1, k, k + 1, k + 2].map(|k| point(&line, self.points, k));
        cubic(near, self.share)
    }
}

/// A point of a line; beyond its ends as the parabola through the last three, or the line through
/// two.
fn point(line: impl Fn(usize) -> Place, points: usize, k: isize) -> Place {
    let last = points as isize - 1;
    let beyond = |end: isize, inwards: isize| {
        let [a, b] = [end, end + inwards].map(|k| line(k as usize));
        match end + 2 * inwards {
            c if (0..=last).contains(&c) => {
                let c = line(c as usize);
                std::array::from_fn(|n| 3.0 * a[n] - 3.0 * b[n] + c[n])
            }
            _ => std::array::from_fn(|n| 2.0 * a[n] - b[n]),
        }
    };
    match k {
        k if k < 0 => beyond(0, 1),
        k if k > last => beyond(last, -1),
        k => line(k as usize),
    }
}

/// The cubic through the middle two of four points, with slopes from their neighbours.
fn cubic([a, b, c, d]: [Place; 4], t: f64) -> Place {
    std::array::from_fn(|n| {
        let slope = [(c[n] - a[n]) / 2.0, (d[n] - b[n]) / 2.0];
        let (bend, twist) = (
            3.0 * (c[n] - b[n]) - 2.0 * slope[0] - slope[1],
            2.0 * (b[n] - c[n]) + slope[0] + slope[1],
        );
        b[n] + t * (slope[0] + t * (bend + t * twist))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_comes_back_exactly_and_measured_places_stay() {
        let place = |x: f64, y: f64| [x, y, x * x - x * y, y * y + 2.0, 3.0 * x];
        let coarse: Vec<_> = (0..12).map(|k| place((k % 4) as f64, (k / 4) as f64)).collect();
        let (columns, fine) = refine(4, &coarse);
        assert!(columns >= LEAST[0] && fine.len() / columns >= LEAST[1]);
        for &[x, y, r_x, r_y, ohm] in &fine {
            let expected = place(x, y);
            assert!(
                [r_x, r_y, ohm].iter().zip(&expected[2..]).all(|(a, b)| (a - b).abs() < 1e-12),
                "{x} {y}"
            );
        }
        assert!(coarse.iter().all(|place| fine.contains(place)));
        let [.., r_x, r_y, _] = at(4, &coarse, [1.3, 0.6]).unwrap();
        assert!((r_x - place(1.3, 0.6)[2]).abs() + (r_y - place(1.3, 0.6)[3]).abs() < 1e-12);
        assert_eq!(at(4, &coarse, [3.0, 2.0]), Some(place(3.0, 2.0)));
        assert_eq!(at(4, &coarse, [3.1, 0.0]), None);
    }
}
