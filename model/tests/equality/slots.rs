// SPDX-License-Identifier: MIT OR Apache-2.0
//! Whole slots: frames of fidelities `fixed` and `clock`, and of the estimator by itself, are those
//! of the reference.

use crate::device::{self, Sight, calibration, short_profiles, short_table_profiles};
use crate::harness::{Bench, operations, show};
use crate::random::Random;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::frame::{Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::estimator::{self, Estimator};
use hapticore_model::blocks::position::TablePort;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_model::fidelity::fixed::FixedSimulation;
use hapticore_reference::rounded::{Exact, Prompt, Slots, Sums};

fn check_slots(profile: &Profile, slots: usize, seed: u64) {
    let calibration = calibration(profile);
    let mut reference = Slots::new(profile, &calibration);
    let mut fixed: FixedSimulation = FixedSimulation::new(profile, &calibration);
    let mut clock = ClockSimulation::new(profile, &calibration);
    let (mut random, channels) = (Random::new(seed), profile.channels());
    for slot in 0..slots {
        let sight = Sight::ALL[(slot + slot / Sight::ALL.len()) % Sight::ALL.len()];
        let codes = device::codes(profile, sight, &mut random);
        let pad = slot % profile.pads as usize;
        let window = &codes[profile.slot.blanking() as usize * channels..];
        let expected = reference.slot(pad, window);
        let case = format!("{} slot {slot} of {sight:?}, pad {pad}", profile.name);
        assert_eq!(fixed.slot(pad, window), expected, "{case}: fixed, reference");
        clock.samples(&codes);
        let frame = clock.finish_slot().expect("a frame for every slot");
        assert_eq!(frame, expected, "{case}, clock {}: clock, reference", clock.clocks());
    }
}

#[test]
fn frames_of_whole_slots_are_the_reference() {
    for profile in Profile::all() {
        check_slots(&profile, if cfg!(optimised) { 63 } else { 7 }, 1);
    }
}

#[test]
fn frames_of_short_slots_are_the_reference() {
    for profile in short_profiles() {
        check_slots(&profile, operations(900) as usize, 2);
    }
}

#[test]
fn frames_by_eq_6_alone_are_the_reference() {
    for mut profile in short_profiles() {
        profile.capacitance.sheet_correction = false;
        check_slots(&profile, operations(900) as usize, 3);
    }
}

#[test]
fn frames_with_a_force_table_are_the_reference() {
    for profile in short_table_profiles() {
        check_slots(&profile, operations(900) as usize, 4);
    }
}

#[test]
fn frames_of_any_sums_are_the_reference() {
    let both = || short_profiles().into_iter().chain(short_table_profiles());
    let controlled = both()
        .map(|profile| Profile { control: Some(Control::of(&profile, Law::Inverse)), ..profile });
    let profiles = both().chain(controlled);
    for (seed, profile) in (0..).zip(profiles) {
        let calibration = calibration(&profile);
        let mut reference = Slots::new(&profile, &calibration);
        let mut bench = Bench::new(Estimator::try_new(&profile).unwrap());
        let constants = calibrate(&mut bench, &profile, &calibration);
        let mut random = Random::new(seed);
        // A controller asks for two estimates of a slot.
        let slots = if profile.control.is_some() { 800 } else { 2_500 };
        for _ in 0..operations(slots) {
            check_sums(&mut bench, &mut reference, constants, &profile, &mut random);
        }
    }
}

fn calibrate(
    bench: &mut Bench<Estimator>,
    profile: &Profile,
    calibration: &Calibration,
) -> estimator::Inputs<i64> {
    let f = &profile.formats;
    let zero = estimator::Inputs::map(bench.block.inputs(), |_| 0);
    for (address, word) in (0..).zip(calibration.words(profile)) {
        let table = TablePort { write: 1, address, word: f.table.code_saturating(word) };
        bench.clock(estimator::Inputs {
            calibration: estimator::Calibration { table, ..zero.calibration },
            ..zero
        });
    }
    estimator::Inputs {
        calibration: Core::new(profile).idle_inputs(calibration).calibration,
        ..zero
    }
}

fn check_sums(
    bench: &mut Bench<Estimator>,
    reference: &mut Slots,
    constants: estimator::Inputs<i64>,
    profile: &Profile,
    random: &mut Random,
) {
    let format = bench.block.inputs().sum;
    let smaller = random.below(u64::from(format.width) / 3);
    let sums: Vec<i64> =
        (0..=2 * profile.demodulated()).map(|_| random.word(format) >> smaller).collect();
    let (pad, clipped) = (random.below(profile.pads) as i64, random.below(2) as i64);
    for (index, &sum) in (0..).zip(&sums) {
        bench.clock(estimator::Inputs { valid: 1, index, sum, pad, clipped, ..constants });
    }
    let (mut codes, mut prompt) = ([0; 8], None);
    let done = (0..10_000).find_map(|_| {
        let estimator::Outputs { frames: out, prompt: given } = bench.clock(constants);
        if given.prompt == 1 {
            prompt = Some(given);
        }
        if out.valid == 1 {
            codes[out.index as usize] = out.frame;
        }
        (out.done == 1).then_some(out)
    });
    let out = done.expect("a frame finishes");
    let [clipped, saturated, invalid, lost, lifted] =
        [out.clipped, out.saturated, out.invalid, out.lost, out.lifted].map(|flag| flag != 0);
    let flags = Flags { clipped, saturated, invalid, lost, lifted };
    let frame = Frame { pad: out.pad as usize, codes, flags };
    let of = |code: i64| Exact::of(code, format);
    let (square, phases) = sums.split_last().expect("there are sums");
    let phases = phases.chunks(2).map(|iq| [of(iq[0]), of(iq[1])]).collect();
    let sums_of = Sums { phases, square: of(*square), clipped };
    let (expected, expected_prompt) = reference.frame_and_prompt(pad as usize, &sums_of);
    let shown = show::<estimator::Inputs>(constants);
    if profile.control.is_some() {
        let expected = prompt_codes(profile, pad, &expected_prompt);
        assert_eq!(prompt, Some(expected), "clock {}: of sums {sums:?}; {shown}", bench.clock);
    }
    assert_eq!(frame, expected, "clock {}: got, reference of sums {sums:?}; {shown}", bench.clock);
}

/// The ports of a prompt estimate, in the clock in which it comes.
fn prompt_codes(profile: &Profile, pad: i64, prompt: &Prompt) -> estimator::PromptPort<i64> {
    let f = &profile.formats;
    estimator::PromptPort {
        prompt: 1,
        prompt_pad: pad,
        prompt_capacitance: prompt.capacitance.code(f.capacitance),
        prompt_force: prompt.force.code(f.force),
        prompt_gain: prompt.force_gain.code(f.force_gain),
        prompt_invalid: prompt.invalid.into(),
        prompt_lifted: prompt.lifted.into(),
    }
}
