// SPDX-License-Identifier: MIT OR Apache-2.0
//! Random profiles: the proof covers every narrowing and every address of an accepted profile. A refusal names the
//! profile's field or signal, and the bits that a word lacks.

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{ForceLaw, Method, Profile, ProfileError, Window};
use hapticore_hdl::format::{Format, MAX_WIDTH};
use hapticore_proof::prove;
use std::collections::BTreeSet;

/// A profile with other counts and times, and with as many other formats as said; short slots,
/// so that a proof is.
fn random(rng: &mut fastrand::Rng, formats: usize) -> Profile {
    let mut profile = Profile::all()[rng.usize(..4)].clone();
    profile.pads = rng.u64(1..=5);
    let terminals = rng.usize(3..=7);
    let sign = |n: usize, rng: &mut fastrand::Rng| [-1, 1, rng.i8(-1..=1)][n.min(2)];
    profile.terminals.x = (0..terminals).map(|n| sign(n, rng)).collect();
    profile.terminals.y = (0..terminals).map(|n| sign((n + 1) % terminals, rng)).collect();
    profile.clocks_per_sample += rng.u64(0..10);
    let times = rng.u64(2..=12);
    profile.slot.open = 5 * rng.u64(1..=3);
    profile.slot.settle = 5 * rng.u64(20..=60);
    (profile.slot.integrate, profile.carrier.periods) = match profile.carrier.method {
        Method::Polyphase => (5 * times, times),
        Method::Products => (8 * times, times),
    };
    if rng.u8(..4) == 0 {
        profile.carrier.window = Window::Rectangular;
    }
    profile.haptic.windows = 1 << rng.u8(0..=2);
    (profile.position.columns, profile.position.rows) =
        (2 * rng.u64(2..=20) + 1, 2 * rng.u64(2..=20) + 1);
    // The program's loop is the same, however often it is run through.
    profile.position.steps = 1;
    profile.force.law = if rng.bool() { ForceLaw::Table } else { ForceLaw::Eq8 };
    if rng.bool() {
        let laws = [Law::Open, Law::Proportional, Law::Integral, Law::Inverse];
        profile.control = Some(Control::of(&profile, laws[rng.usize(..4)]));
    }
    (0..formats).for_each(|_| another_format(&mut profile, rng));
    profile
}

/// One format with some bits more or less on either side of its point.
fn another_format(profile: &mut Profile, rng: &mut fastrand::Rng) {
    let f = &mut profile.formats;
    let all = [
        &mut f.iq,
        &mut f.total,
        &mut f.ratio,
        &mut f.admittance,
        &mut f.capacitance,
        &mut f.mean_square,
        &mut f.square,
        &mut f.force,
        &mut f.capacitance_gain,
        &mut f.force_gain,
    ];
    let which = rng.usize(..all.len());
    let format = all.into_iter().nth(which).expect("one of them");
    let (above, below) = (rng.i8(-3..=6), rng.i8(-3..=6));
    format.width = (format.width as i8 + above + below).clamp(4, 30) as u8;
    format.frac += below;
}

#[test]
fn random_profiles_that_are_accepted_are_proved() {
    let mut rng = fastrand::Rng::with_seed(15);
    let (mut accepted, mut refused) = (0, BTreeSet::new());
    while accepted < 24 {
        let profile = random(&mut rng, 2);
        match hapticore_model::check(&profile) {
            Ok(()) => {
                let proof = prove(&profile);
                let first = proof.violations.first().map(ToString::to_string);
                assert!(proof.holds(), "{first:?}\n{profile:?}");
                accepted += 1;
            }
            Err(ProfileError::Value { field, .. }) => drop(refused.insert(field)),
            Err(error) => panic!("{error}"),
        }
    }
    println!("{accepted} accepted and proved; refused for {refused:?}");
    assert!(refused.len() > 5, "{refused:?}");
}

/// Some formats as wide as they may be, their points anywhere.
fn wide(profile: &mut Profile, rng: &mut fastrand::Rng) {
    let f = &mut profile.formats;
    if rng.bool() {
        f.iq = Format::signed(rng.u8(20..=30), rng.i8(18..=29));
        f.total = Format::signed(30, f.iq.frac);
    }
    for format in [
        &mut f.admittance,
        &mut f.capacitance,
        &mut f.mean_square,
        &mut f.square,
        &mut f.force,
        &mut f.capacitance_gain,
        &mut f.force_gain,
    ] {
        if rng.u8(..3) == 0 {
            *format = Format::unsigned(28, rng.i8(-16..=48));
        }
    }
}

/// What a profile could overflow in is named, with the bits that a word lacks.
#[test]
fn a_word_that_lacks_bits_is_refused_by_name() {
    let mut rng = fastrand::Rng::with_seed(16);
    let mut found = BTreeSet::new();
    for _ in 0..6000 {
        let mut profile = random(&mut rng, 0);
        wide(&mut profile, &mut rng);
        let Err(ProfileError::Value { field, expected, got }) = hapticore_model::check(&profile)
        else {
            continue;
        };
        let Some((signal, _)) = expected.split_once(&format!(" of at most {MAX_WIDTH} bits"))
        else {
            continue;
        };
        let (width, lacks) = got.split_once(": a word lacks ").expect("the bits it lacks");
        let lacking: u8 = lacks.split(' ').next().and_then(|bits| bits.parse().ok()).expect("bits");
        assert_eq!(width.parse(), Ok(MAX_WIDTH + lacking), "{field}: {expected}, {got}");
        if found.insert((field.clone(), signal.to_owned())) {
            println!("{field}: expected {expected}, got {got}");
        }
    }
    assert!(found.len() >= 6, "{found:?}");
}
