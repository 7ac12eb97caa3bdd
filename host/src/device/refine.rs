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
    let wide: Vec<Place> =
        places.chunks(columns).flat_map(|row| along(row, times(columns, LEAST[0]))).collect();
    let columns = wide.len() / rows;
    let column = |k: usize| wide.iter().skip(k).step_by(columns).copied().collect::<Vec<_>>();
    let lines: Vec<Vec<Place>> =
        (0..columns).map(|k| along(&column(k), times(rows, LEAST[1]))).collect();
    let fine =
        (0..lines[0].len()).flat_map(|row| lines.iter().map(move |line| line[row])).collect();
    (columns, fine)
}

/// A line with `times` as many steps.
fn along(line: &[Place], times: usize) -> Vec<Place> {
    let at = |k: isize| point(line, k);
    let step = |k: usize| {
        let (k, of) = (k / times, (k % times) as f64 / times as f64);
        let k = k as isize;
        cubic([at(k - 1), at(k), at(k + 1), at(k + 2)], of)
    };
    (0..=(line.len() - 1) * times).map(step).collect()
}

/// A point of a line; beyond its ends as the parabola through the last three, or the line through
/// two.
fn point(line: &[Place], k: isize) -> Place {
    let last = line.len() as isize - 1;
    let beyond = |end: isize, inwards: isize| {
        let at = |k: isize| line[(end + k * inwards) as usize];
        let (a, b) = (at(0), at(1));
        match line.get((end + 2 * inwards) as usize) {
            Some(c) => std::array::from_fn(|n| 3.0 * a[n] - 3.0 * b[n] + c[n]),
            None => std::array::from_fn(|n| 2.0 * a[n] - b[n]),
        }
    };
    match k {
        k if k < 0 => beyond(0, 1),
        k if k > last => beyond(last, -1),
        k => line[k as usize],
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
    }
}
