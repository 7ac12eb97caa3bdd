// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors of results that have a golden model: its slopes, and what the result is off.

use super::*;

#[test]
fn a_golden_model_brings_the_error_of_a_result() {
    let recording = Recording::begin();
    let x = input(&recording, 4.0);
    let own = moments(0.5, 1.0, 2.0);
    let exact = |real| constant::<Noise>(real, FORMAT);
    let quotient = exact(1.3125).golden(&[x, exact(3.0)], |of| of[0] / of[1]);
    check(
        &recording,
        quotient,
        own.times(1.0 / 3.0).plus(Moments::of_result(FORMAT.lsb())),
        "4/3, rounded",
    );
    let whole = exact(2.0).golden(&[x, exact(2.0)], |of| of[0] / of[1]);
    check(&recording, whole, own.times(0.5), "4/2 needs no rounding");
    let near = exact(2.0).golden(&[x, exact(2.0)], |of| of[0] / of[1] + 1e-6);
    check(
        &recording,
        near,
        own.times(0.5).plus(Moments::of_result(FORMAT.lsb())),
        "more than a millionth of an LSB off",
    );
    let of_exact = exact(1.3125).golden(&[exact(4.0), exact(3.0)], |of| of[0] / of[1]);
    assert_eq!((of_exact.value.entry, of_exact.value.shadow.real), (EXACT, 4.0 / 3.0));
}

#[test]
fn slopes_are_taken_by_every_operand() {
    let recording = Recording::begin();
    let [a, b, c, d] = [1.0, 2.0, 3.0, 4.0].map(|real| input(&recording, real));
    let own = moments(0.5, 1.0, 2.0);
    let ideal = |of: &[f64]| of[0] + 10.0 * of[1] + 100.0 * of[2] + 1000.0 * of[3];
    let all = Signal { format: Format::signed(30, 4), ..code(4321 << 4, FORMAT) };
    let gains = [1.0, 10.0, 100.0, 1000.0].map(|gain| own.times(gain));
    let expected = gains.into_iter().fold(Moments::default(), Moments::plus);
    check(&recording, all.golden(&[a, b, c, d], ideal), expected, "four");
    let third = all.golden(&[a, b, c], |of| if of.len() == 3 { 4321.0 * of[2] / 3.0 } else { 0.0 });
    check(&recording, third, own.times(4321.0 / 3.0), "three");
}

/// A cube tells the step of the difference: f' = 3x² + step².
#[test]
fn slopes_are_those_at_a_small_step() {
    let recording = Recording::begin();
    let own = moments(0.5, 1.0, 2.0);
    let cube = |of: &[f64]| of[0].powi(3);
    for (real, frac, slope) in
        [(1.0, 10, 3.0), (-8.0, 4, 192.0), (0.0, 10, 0.0), (1024.0, -10, 3.0 * 1024.0 * 1024.0)]
    {
        let x = input_of(&recording, real, Format::signed(16, frac));
        let wide = Signal { format: Format::signed(60, 0), ..code(real.powi(3) as i64, FORMAT) };
        check(&recording, wide.golden(&[x], cube), own.times(slope), "of a cube");
    }
    let x = input_of(&recording, 0.0, Format::signed(16, -10));
    let zero = Signal { format: Format::signed(60, 0), ..code(0, FORMAT) };
    let gain = recording.errors(zero.golden(&[x], cube).value).total.mean / own.mean;
    assert!((gain / 1.024f64.powi(2) - 1.0).abs() < 1e-9, "a thousandth of an LSB of 1024: {gain}");
}

/// A floor that a golden model calls an approximation has the error of a floor; beyond its limit
/// the bits below matter no more.
#[test]
fn a_floor_has_an_error_where_a_golden_model_says_so() {
    let recording = Recording::begin();
    let (x, to) = (input(&recording, 3.3125), Format::signed(8, 1));
    let own = moments(0.5, 1.0, 2.0);
    let floor = Moments::of_rounding(Floor, 3, 0.5);
    let check_off = |ideal: fn(&[f64]) -> f64, of: Moments, case: &str| {
        let floored = x.quantize(to, Floor, Proved);
        check(&recording, floored.golden(&[x], ideal), own.plus(of), case);
    };
    check_off(|of| of[0], floor, "itself");
    check_off(
        |of| of[0] - 0.75,
        Moments { mean: floor.mean + 0.75, ..floor },
        "a step and a half off",
    );
    check_off(|of| of[0] + 1.25, Moments::default(), "saturated");
    check_off(|of| of[0] - 1.25, Moments::default(), "saturated below");
    check_off(
        |of| of[0] + 1.0,
        Moments { mean: floor.mean - 1.0, ..floor },
        "two steps are not yet saturated",
    );
    let other = code(6, to).golden(&[x], |of| of[0]);
    check(&recording, other, own.plus(Moments::of_result(0.5)), "no floor");
}
