// SPDX-License-Identifier: MIT OR Apache-2.0
//! Predicted errors of random profiles beside those that slots have.
//!
//! `SEED=2 PROFILES=200 cargo test --release -p hapticore-model --test noise -- --nocapture` prints more, and
//! of other profiles.

#[allow(dead_code, reason = "tests of whole cores use the rest")]
#[path = "../equality/device.rs"]
mod device;
mod laws;
mod measured;
#[path = "../equality/random.rs"]
#[allow(dead_code, reason = "tests of whole cores use the rest")]
mod random;

use hapticore_contract::calibration::Calibration;
use hapticore_contract::profile::{Method, Profile};
use hapticore_hdl::format::Format;
use hapticore_model::fidelity::noise::Predictor;
use measured::{QUANTITIES, Scatter, measured, predicted, scenes};
use random::Random;

fn lengthen(format: &mut Format, by: i8) {
    format.frac += by;
    format.width = (format.width as i8 + by) as u8;
}

/// A bundled profile with every knob turned: words of other lengths, block-floating words, window and periods.
fn random_profile(random: &mut Random) -> Profile {
    let bundled = Profile::of_distinct_words();
    loop {
        let mut profile = bundled[random.below(bundled.len() as u64) as usize].clone();
        let f = &mut profile.formats;
        let ranges: [(&mut Format, i8, i8); 8] = [
            (&mut f.adc, -6, 0),
            (&mut f.ratio, -5, 0),
            (&mut f.position, -2, 3),
            (&mut f.admittance, -6, 0),
            (&mut f.capacitance, -6, 0),
            (&mut f.mean_square, -6, 0),
            (&mut f.square, -6, 0),
            (&mut f.force, -3, 2),
        ];
        for (format, least, most) in ranges {
            lengthen(format, least + random.below((most - least + 1) as u64) as i8);
        }
        let change = -(random.below(8) as i8);
        lengthen(&mut f.oscillator, change);
        let amplitude = profile.carrier.amplitude as f64 * 2f64.powi(change.into());
        profile.carrier.amplitude = amplitude.round() as u64;
        if random.below(2) == 0 {
            f.block_shift = random.below(13) as u8;
            f.total = Format { width: f.iq.width + 2, ..f.iq };
        } else if f.block_shift == 0 {
            let change = -(random.below(6) as i8);
            [&mut f.iq, &mut f.total].into_iter().for_each(|format| lengthen(format, change));
        }
        if random.below(2) == 0 {
            let window = profile.slot.integrate * (1 + random.below(8)) / 4;
            profile = profile.with_window(window / 20 * 20);
        }
        if profile.carrier.method == Method::Products && random.below(2) == 0 {
            let periods = profile.carrier.periods as i64 + random.below(9) as i64 - 4;
            profile.carrier.periods = periods.max(1) as u64;
        }
        if hapticore_model::check(&profile).is_ok() {
            return profile;
        }
    }
}

/// Of the slots.
const SEED: u64 = 7;

/// How many standard errors of a mean are not the prediction's: of 3,000 means, one is further off
/// once in five times.
const STANDARD_ERRORS: f64 = 4.0;

/// The calibration of a device none of whose pads is lifted: a frame of those repeats the last valid place.
fn calibration(profile: &Profile) -> Calibration {
    Calibration { contact_capacitance: 0.0, ..device::calibration(profile) }
}

/// The formats of the measured quantities.
fn words(profile: &Profile) -> [Format; 5] {
    let f = &profile.formats;
    [f.position, f.position, f.capacitance, f.force, f.mean_square]
}

/// What of a profile explains a prediction.
fn turned(profile: &Profile) -> String {
    let Profile { name, carrier, slot, formats: f, .. } = profile;
    format!(
        "{name}, adc {}, oscillator {}, iq {}, block_shift {}, {:?}, {:?}, {} periods in {} samples",
        f.adc,
        f.oscillator,
        f.iq,
        f.block_shift,
        carrier.method,
        carrier.window,
        carrier.periods,
        slot.integrate
    )
}

/// Predicted over measured rms, and predicted bound over the largest that was measured.
#[derive(Default)]
struct Agreement {
    rms: [Scatter; 5],
    bound: [Scatter; 5],
    /// Predicted less measured mean, beyond what the number of slots leaves open, in steps of the
    /// result's word.
    bias: [Scatter; 5],
    few_codes: usize,
}

impl Agreement {
    fn of(profiles: &[Profile]) -> Self {
        let mut agreement = Agreement::default();
        for profile in profiles {
            let calibration = calibration(profile);
            for scene in scenes() {
                let (predicted, least_codes) = predicted(profile, &calibration, &scene, SEED);
                agreement.few_codes += usize::from(least_codes < Predictor::FEW_CODES);
                let measured = measured(profile, &calibration, &scene, SEED);
                for (n, (predicted, measured)) in predicted.into_iter().zip(measured).enumerate() {
                    let ratio = predicted.rms() / measured.rms();
                    if !(0.8..1.25).contains(&ratio) {
                        println!(
                            "{}: predicted / measured rms {ratio:.3}: {}",
                            QUANTITIES[n],
                            turned(profile)
                        );
                    }
                    agreement.rms[n].add(ratio);
                    agreement.bound[n].add(predicted.bound / measured.bound);
                    let open = STANDARD_ERRORS * (measured.variance / scene.slots() as f64).sqrt();
                    let off = (predicted.mean - measured.mean).abs() - open;
                    agreement.bias[n].add(off.max(0.0) / words(profile)[n].lsb());
                }
            }
        }
        agreement
    }
}

#[test]
fn predicted_errors_are_those_that_slots_have() {
    let given = |name: &str, otherwise: u64| {
        std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
    };
    let (count, mut random) = (given("PROFILES", 5), Random::new(given("SEED", 1)));
    let mut profiles = Profile::of_distinct_words();
    profiles.extend((0..count).map(|_| random_profile(&mut random)));
    let agreement = Agreement::of(&profiles);
    let of_quantities = || agreement.rms.iter().zip(&agreement.bound).zip(QUANTITIES);
    for ((rms, bound), name) in of_quantities() {
        println!("{name}: predicted / measured rms: {}", rms.text());
        println!("   bound / largest measured: {}", bound.text());
    }
    for (bias, name) in agreement.bias.iter().zip(QUANTITIES) {
        println!("{name}: mean off by more than chance, steps: {}", bias.text());
    }
    println!("{} scenes with few codes", agreement.few_codes);
    for ((rms, bound), name) in of_quantities() {
        assert!((rms.at(0.5) - 1.0).abs() < 0.05, "{name}: {}", rms.text());
        assert!(rms.at(0.05) > 0.8 && rms.at(0.95) < 1.2, "{name}: {}", rms.text());
        assert!(rms.at(0.0) > 0.67 && rms.at(1.0) < 1.5, "{name}: {}", rms.text());
        assert!(bound.at(0.0) >= 1.0, "{name}: {}", bound.text());
        assert!(bound.at(0.5) < 8.0 && bound.at(1.0) < 32.0, "{name}: {}", bound.text());
    }
    for (bias, name) in agreement.bias.iter().zip(QUANTITIES) {
        assert!(bias.at(1.0) < 0.25, "{name}: {}", bias.text());
    }
}

/// Ratios of small currents in short words are many steps of a long table word away from those without
/// rounding: the position's gain from them is that of any other slot.
#[test]
fn positions_of_short_currents_beside_long_table_words_are_predicted() {
    let mut profile = Profile::bundled("fine").expect("bundled");
    for format in [&mut profile.formats.iq, &mut profile.formats.total] {
        (format.width, format.frac) = (format.width - 4, format.frac - 4);
    }
    let (calibration, scene) = (calibration(&profile), &scenes()[1]);
    let (predicted, _) = predicted(&profile, &calibration, scene, SEED);
    let measured = measured(&profile, &calibration, scene, SEED);
    for n in 0..2 {
        let ratio = predicted[n].rms() / measured[n].rms();
        println!("{}: predicted over measured {ratio:.3}", QUANTITIES[n]);
        assert!((0.8..1.2).contains(&ratio), "{}: {ratio}", QUANTITIES[n]);
    }
}

/// The comparison would notice a prediction that is of other words.
#[test]
fn a_prediction_of_other_words_disagrees() {
    let profile = Profile::bundled("standard").expect("bundled");
    let calibration = calibration(&profile);
    let mut shorter = profile.clone();
    for format in [&mut shorter.formats.iq, &mut shorter.formats.total] {
        (format.width, format.frac) = (format.width - 4, format.frac - 4);
    }
    let scene = &scenes()[0];
    let (of_other, _) = predicted(&profile, &calibration, scene, SEED);
    let measured = measured(&shorter, &calibration, scene, SEED);
    assert!(of_other[2].rms() < 0.5 * measured[2].rms(), "{:?}", [of_other[2], measured[2]]);
}
