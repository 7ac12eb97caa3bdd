// SPDX-License-Identifier: MIT OR Apache-2.0
//! The range reading proves that nothing overflows, and would notice if something did.

use hapticore_model::blocks::demodulator::Demodulator;
use hapticore_model::format::Format;
use hapticore_model::profile::Profile;
use hapticore_model::proof::prove;
use hapticore_model::signal::range::{Range, take_violations, whole};
use hapticore_model::signal::{Exact, Never, Signal, bit, int, zero};

/// What relates several signals, and where it is held: `tests/equality` runs the divider and the root over all codes of
/// small widths, and every test build checks each of these narrowings at each clock.
const LEMMAS: [&str; 4] = [
    "a number less its floor is below one",
    "the cells of a curve or table lie within the memory",
    "the remainder of a division stays below its denominator",
    "the remainder of a root is at most twice the root so far",
];

#[test]
fn no_signal_of_a_bundled_profile_can_overflow() {
    for profile in Profile::all() {
        let proof = prove(&profile);
        let mut lemmas = proof.lemmas.clone();
        lemmas.sort_unstable();
        println!(
            "{}: {} clocks in {} rounds, {} registers",
            profile.name,
            proof.clocks,
            proof.rounds,
            proof.registers.len()
        );
        assert!(proof.holds(), "{}: {:?}", profile.name, proof.violations.first());
        assert_eq!(lemmas, LEMMAS, "{}: the lemmas that the proof relies on", profile.name);
    }
}

#[test]
fn every_register_stays_within_its_format() {
    for (name, format, range) in prove(&Profile::bundled("small").unwrap()).registers {
        assert!(whole(format).holds(range), "{name} {format}: {range:?}");
    }
}

#[test]
fn one_sample_too_many_is_noticed() {
    let profile = Profile::bundled("standard").unwrap();
    let demodulator = Demodulator::new(&profile);
    let (adc, wave) = (whole(profile.formats.adc), whole(profile.formats.oscillator));
    let product =
        Signal { value: adc, format: profile.formats.adc } * Signal { value: wave, format: profile.formats.oscillator };
    let sum_of = |samples: u64| {
        take_violations();
        let mut sum: Signal<Range> = zero(demodulator.sum());
        (0..samples).for_each(|_| sum = demodulator.accumulate(bit(false), sum, product));
        take_violations().len()
    };
    assert_eq!(sum_of(profile.slot.integrate), 0, "the sum holds a whole window of the worst samples");
    let headroom = 1u64 << (64 - (profile.slot.integrate - 1).leading_zeros());
    assert!(sum_of(headroom + 1) > 0, "more than its guard bits are for overflows, and is seen to");
}

#[test]
fn a_register_one_bit_short_is_noticed() {
    take_violations();
    let byte: Signal<Range> = Signal { value: whole(Format::unsigned(8, 0)), format: Format::unsigned(8, 0) };
    (byte + int(1)).fit(Format::unsigned(8, 0), Exact, Never);
    assert_eq!(take_violations().len(), 1);
}
