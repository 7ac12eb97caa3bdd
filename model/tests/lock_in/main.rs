// SPDX-License-Identifier: MIT OR Apache-2.0
//! The lock-in rejects what is not the carrier as floating point does, within the limits below, and
//! its document says so.

mod measure;

use measure::{Measured, all, document};

/// Limits of a profile: excess and the least reserve in dB, the response to a constant (none:
/// nothing may be left of it).
const LIMITS: [(&str, f64, f64, Option<f64>); 4] = [
    ("small", 4.0, 68.0, None),
    ("standard", 2.0, 75.0, Some(-140.0)),
    ("fine", 2.0, 75.0, Some(-140.0)),
    ("fast", 6.0, 22.0, Some(-120.0)),
];
/// By how much the reserve may be less than in floating point, dB.
const LESS: f64 = 4.0;
/// The bias of `standard`, relative.
const BIAS: f64 = 1e-4;

fn check(measured: &Measured, (name, excess, reserve, constant): (&str, f64, f64, Option<f64>)) {
    assert_eq!(measured.profile.name, name);
    assert!(
        measured.excess <= excess,
        "{name}: above floating point by at most {excess} dB: {measured:?}"
    );
    assert!(
        measured.reserve >= reserve,
        "{name}: a reserve of at least {reserve} dB: {measured:?}"
    );
    assert!(
        measured.reserve >= measured.float_reserve - LESS,
        "{name}: within {LESS} dB of floating point: {measured:?}"
    );
    let left = measured.constant.unwrap_or(f64::NEG_INFINITY);
    assert!(left < constant.unwrap_or(-1e3), "{name}: of a constant: {measured:?}");
}

#[test]
fn interferers_are_rejected_and_the_document_says_how_far() {
    let measured = all();
    println!("{}", document(&measured));
    measured.iter().zip(LIMITS).for_each(|(measured, limits)| check(measured, limits));
    let standard = &measured[1];
    assert!(
        standard.bias <= BIAS,
        "standard: an undithered tone is off by at most {BIAS}: {standard:?}"
    );
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/lock-in.md");
    let kept = std::fs::read_to_string(path).expect("docs/lock-in.md");
    assert_eq!(
        kept,
        document(&measured),
        "docs/lock-in.md: made anew by cargo bench -p hapticore-model --bench lock_in"
    );
}
