// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hands at a wall, closed loop on the plant: what each rule may leave of sticking force, release
//! time, flips and vanished walls. The figures of a hundred hands are in docs/physics.md §6
//! (`cargo run --release -p hapticore-tests --example walls`); these are the first twelve of them.

use hapticore_tests::walls::core::InCore;
use hapticore_tests::walls::device::{Drive, Pad};
use hapticore_tests::walls::hand::Hand;
use hapticore_tests::walls::measures::{Measures, Row};
use hapticore_tests::walls::trial::{Kind, Setup};

const HANDS: u64 = if cfg!(optimised) { 12 } else { 2 };

/// 0.5 N/mm, 1 ms frames, 1 % noise.
fn setup(kind: Kind) -> Setup {
    Setup { kind, n_per_mm: 0.5, mismatch_percent: 2.0, noise_percent: 1.0, frame_ms: 1.0 }
}

fn felt(kind: Kind) -> Row {
    let row = setup(kind).hands(0..HANDS);
    println!("{kind:?} | {}", row.text());
    row
}

#[test]
fn a_wall_with_split_drive_hardly_sticks() {
    let a = felt(Kind::A);
    assert!(a.sticking_n <= 0.03 && a.worst_n <= 0.12 && a.slow_peak_n <= 0.08, "{a:?}");
    assert!(a.release_ms <= 25.0 && a.release_p95_ms <= 90.0 && a.vanished_ms <= 1.0, "{a:?}");
    // Knowing the hand's force leaves as many: those of the hovering hand are asked for.
    assert!(a.excess_flips <= 5.0, "{a:?}");
    assert!(a.peak_n > 0.7, "and it holds: {a:?}");
}

/// What a hand feels of B while it leaves slowly, N. The rubber's creep keeps a part of the push: u stays with it until the
/// hand pulls with some tenths of a newton.
const SLOW_PEAK_B_N: f64 = 0.19;

/// The block in the words of the smallest profile costs next to nothing.
#[test]
fn the_block_is_felt_as_the_rule_is() {
    let a = felt(Kind::SmallA);
    assert!(a.sticking_n <= 0.03 && a.slow_peak_n <= 0.08 && a.release_p95_ms <= 90.0, "{a:?}");
    assert!(a.vanished_ms <= 2.0 && a.excess_flips <= 6.0, "{a:?}");
    let b = felt(Kind::SmallB);
    assert!(b.sticking_n <= 0.06 && b.worst_n <= 0.26, "{b:?}");
    assert!(b.slow_peak_n <= SLOW_PEAK_B_N, "{b:?}");
    assert!(b.release_p95_ms <= 280.0 && b.vanished_ms <= 6.0 && b.excess_flips <= 6.0, "{b:?}");
}

/// Halves that sense and brake: what the rubber's creep keeps of the push hides its end. The wall of eq. 11
/// sticks wholly, the fused rule in part, rule B less.
#[test]
fn rules_on_two_halves_stick_in_the_order_of_what_they_know() {
    let [eq11, fused, b, known] = [Kind::Eq11, Kind::Fused, Kind::B, Kind::True].map(felt);
    assert!(eq11.sticking_n > 2.0 * fused.sticking_n && fused.sticking_n > 2.0 * b.sticking_n);
    assert!(b.sticking_n > 10.0 * known.sticking_n, "{b:?} {known:?}");
    assert!(b.sticking_n <= 0.06 && b.worst_n <= 0.26, "{b:?}");
    assert!(b.slow_peak_n <= SLOW_PEAK_B_N, "{b:?}");
    assert!(b.release_ms <= 35.0 && b.release_p95_ms <= 280.0 && b.vanished_ms <= 6.0, "{b:?}");
    assert!(b.excess_flips <= 5.0 && b.peak_n > 0.7, "{b:?}");
}

/// Hands that press slowly at 1 N/mm feel half of it up to 0.7 N (A), 0.79 of it up to 1 N (B); at half
/// of it they would not.
#[test]
fn a_wall_is_as_stiff_as_it_is_to_be() {
    for (kind, to_n, least_n_per_mm) in [(Kind::A, 0.7, 0.5), (Kind::B, 1.0, 0.79)] {
        let wall = |n_per_mm| Setup { n_per_mm, ..setup(kind) }.stiffness(0..HANDS, to_n);
        let [soft, stiff] = [0.5, 1.0].map(wall);
        println!("{kind:?}: {soft:?}, {stiff:?}");
        assert!(stiff.n_per_mm >= least_n_per_mm && stiff.least_peak_n >= to_n, "{stiff:?}");
        assert!(soft.n_per_mm < least_n_per_mm || !cfg!(optimised), "{soft:?}");
    }
}

/// At frames of 1 ms no hand at a stiff wall makes it come and go.
#[test]
fn a_stiff_wall_has_no_bursts() {
    for kind in [Kind::A, Kind::B] {
        let row = Setup { n_per_mm: 8.0, ..setup(kind) }.hands(0..HANDS);
        assert_eq!(row.bursts, 0.0, "{kind:?}: {row:?}");
    }
}

/// In by 4 mm beyond the surface, a pause, out again, with 300 N/m: the sticking force is at most
/// 0.008 N, and the wall is never lost.
#[test]
fn the_trajectory_of_the_paper_neither_sticks_nor_loses_the_wall() {
    let drive = Drive::calibrated(Kind::A.pad());
    for mismatch_percent in [-2.0, 2.0] {
        let setup = Setup { mismatch_percent, noise_percent: 0.4, ..setup(Kind::A) };
        let frames = setup.run(&Hand::of_the_paper(), &drive, 1);
        let felt = Measures::of(&frames, 1.0);
        println!("{felt:?}");
        assert!(felt.sticking_n <= 0.008 && felt.vanished_ms == 0.0, "{felt:?}");
        assert!(felt.peak_n > 0.3, "the wall holds: {felt:?}");
    }
}

/// With sheet, noise, ADC and the core between pad and drive, slots of 250 µs.
#[test]
fn a_wall_in_the_core_is_felt_as_the_rule_is() {
    let hands = if cfg!(optimised) { 3 } else { 1 };
    let core =
        InCore { pad: Pad::Strips, profile: "fast", n_per_mm: 0.5, play_mm: 0.2, noise_ppm: 18.0 };
    let a = core.hands(0..hands, 2.0);
    println!("{core:?} | {}", a.text());
    assert!(a.sticking_n <= 0.03 && a.worst_n <= 0.12 && a.slow_peak_n <= 0.08, "{a:?}");
    assert!(a.release_ms <= 25.0 && a.release_p95_ms <= 90.0 && a.vanished_ms <= 1.0, "{a:?}");
    assert!(a.peak_n > 0.7, "and it holds: {a:?}");
}

/// A hand that slides along the surface while it presses in feels a fifth of the wall's force as drag, or less; where it
/// stands still before, the wall holds it. What a brake cannot do is in docs/physics.md §6: it sinks in to where it aims.
#[test]
fn a_hand_that_slides_along_the_surface_is_not_dragged() {
    let hands = match std::env::var("HANDS") {
        Ok(hands) => hands.parse().expect("HANDS: a number"),
        Err(_) if cfg!(optimised) => 3,
        Err(_) => 1,
    };
    for (pad, noise_ppm, play_mm) in
        [(Pad::Strips, 18.0, 0.2), (Pad::Halves, 18.0, 0.2), (Pad::Strips, 60.0, 0.4)]
    {
        let core = InCore { pad, profile: "fast", n_per_mm: 0.5, play_mm, noise_ppm };
        for mm_per_s in [10.0, 50.0, 150.0] {
            for (seed, slid) in core.sliding(0..hands, mm_per_s).into_iter().enumerate() {
                let name =
                    format!("{pad:?}, {noise_ppm} ppm, {mm_per_s} mm/s, hand {seed}: {slid:?}");
                println!("{name}");
                assert!((slid.held - 1.0).abs() <= 0.1, "{name}");
                assert!(slid.wall_n > 0.2 && slid.drag_n <= 0.2 * slid.wall_n, "{name}");
            }
        }
    }
}

/// Of hands whose seeds no rule was tuned on. A frame of the pad is three slots of 250 µs with strips, two with halves.
#[test]
fn a_stiff_wall_is_felt_and_releases_within_milliseconds() {
    let hands = if cfg!(optimised) { 2000..2003 } else { 2000..2001 };
    for (pad, noise_ppm, play_mm, release_ms) in [
        (Pad::Strips, 18.0, 0.2, 15.0),
        (Pad::Halves, 18.0, 0.2, 30.0),
        (Pad::Strips, 60.0, 0.4, 15.0),
        (Pad::Halves, 60.0, 0.4, 30.0),
    ] {
        let core = InCore { pad, profile: "fast", n_per_mm: 8.0, play_mm, noise_ppm };
        let latency = core.latency(hands.clone(), 50.0);
        println!("{pad:?}, {noise_ppm} ppm: {latency:?}");
        assert!(latency.engage_ms > 0.0 && latency.engage_ms <= 5.0, "{pad:?}: {latency:?}");
        assert!(
            latency.release_ms > 0.0 && latency.release_ms <= release_ms,
            "{pad:?}: {latency:?}"
        );
        assert!(latency.contrast >= 7.0, "{pad:?}: {latency:?}");
    }
}
