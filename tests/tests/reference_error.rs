// SPDX-License-Identifier: MIT OR Apache-2.0
//! The floating-point reference against the same equations in double-double, on every bundled
//! scene: what `f64` rounds stays within a bound that is derived for each slot, and `f32` does not.

use hapticore_scene::gallery;
use hapticore_tests::reference_error::{HEAD, Measured, QUANTITIES, measure, table};
use num_traits::Float;
use rayon::prelude::*;
use std::sync::LazyLock;
use xprec::Df64;

/// Slots of each scene, evenly spread over its cases; the example of this name takes more.
const SLOTS: usize = if cfg!(optimised) { 12 } else { 2 };
/// Smaller values than these are zeros that were rounded, whose error says nothing.
const ZERO: f64 = 1e-9;

static SCENES: LazyLock<Vec<(&str, Measured)>> = LazyLock::new(|| {
    gallery::all().par_iter().map(|&(name, _)| (name, measure(name, SLOTS))).collect()
});

#[test]
fn f64_is_within_its_bound_on_every_quantity_of_every_scene() {
    print!("{HEAD}");
    for (scene, measured) in &*SCENES {
        print!("{}", table(scene, measured));
        assert!(measured.slots > 0, "{scene}: no slot with a valid place");
        assert_eq!(
            measured.contradictions, 0,
            "{scene}: slots whose flags f64 and double-double do not agree on"
        );
        for ((quantity, unit), errors) in QUANTITIES.iter().zip(&measured.errors) {
            assert!(errors.share <= 1.0, "{scene}, {quantity} in {unit}: {errors:?}");
        }
        let [.., capacitance, _, _, _, _] = measured.errors;
        assert!(capacitance.error > 0.0, "{scene}: double-double has no more bits than f64");
    }
}

/// The check can fail: 24 bits are beyond the bound of 53 wherever there is anything to measure.
#[test]
fn f32_is_beyond_the_bound_of_f64() {
    for (scene, measured) in &*SCENES {
        for ((quantity, _), errors) in
            QUANTITIES.iter().zip(&measured.errors).filter(|(_, e)| e.value > ZERO)
        {
            assert!(errors.single_share > 100.0, "{scene}, {quantity}: {errors:?}");
        }
    }
}

/// What the reference asks of double-double has 100 bits: quotients, square roots, sines and
/// cosines.
#[test]
fn double_double_has_a_hundred_bits() {
    let unit = Df64::from(2f64.powi(-100));
    let (one, three, four) = (Df64::from(1.0), Df64::from(3.0), Df64::from(4.0));
    let near = |got: Df64, expected: Df64, what: &str| {
        let error = (got - expected).abs();
        assert!(error <= unit * expected.abs(), "{what}: {got} instead of {expected}");
    };
    for k in 1..500 {
        // Neither is an f64.
        let (a, b) = (
            Df64::from(f64::from(k)) / Df64::from(709.0),
            Df64::from(f64::from(k + 37)) / Df64::from(311.0),
        );
        assert!(f64::from(a - Df64::from(f64::from(a))) != 0.0);
        near(a / b * b, a, "(a / b) b");
        near(a.sqrt() * a.sqrt(), a, "√a √a");
        let ((sine, cosine), (sine3, cosine3)) = (Float::sin_cos(a), Float::sin_cos(three * a));
        near(sine * sine + cosine * cosine, one, "sin² + cos²");
        assert!((sine3 - (three * sine - four * sine * sine * sine)).abs() < unit * four, "sin 3a");
        assert!(
            (cosine3 - (four * cosine * cosine * cosine - three * cosine)).abs() < unit * four,
            "cos 3a"
        );
    }
}
