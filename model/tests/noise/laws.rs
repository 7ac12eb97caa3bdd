// SPDX-License-Identifier: MIT OR Apache-2.0
//! The known laws of errors appear, as measured and as predicted.

use super::calibration;
use super::measured::{
    QUANTITIES, Scene, amplitude_of_tone, measured, measured_against, predicted, reference_errors,
    scenes,
};
use hapticore_contract::profile::{Profile, Window};
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::noise::Moments;

const CAPACITANCE: usize = 2;

fn standard() -> Profile {
    Profile::bundled("standard").expect("bundled")
}

/// Measured and predicted errors of a result.
fn errors(profile: &Profile, scene: &Scene, quantity: usize) -> [f64; 2] {
    let calibration = calibration(profile);
    let (predicted, _) = predicted(profile, &calibration, scene, 7);
    let measured = measured(profile, &calibration, scene, 7);
    [measured, predicted].map(|of: [Moments; 5]| of[quantity].rms())
}

fn shorter(format: Format, bits: u8) -> Format {
    Format { width: format.width - bits, frac: format.frac - bits as i8, ..format }
}

/// A word's bit halves the error, until what other words leave dominates.
#[test]
fn a_bit_halves_the_error_until_another_word_dominates() {
    let scene = &scenes()[0];
    let of = |bits: u8| {
        let mut profile = standard();
        let f = &mut profile.formats;
        f.capacitance = shorter(f.capacitance, bits);
        errors(&profile, scene, CAPACITANCE)
    };
    let by_bits: Vec<[f64; 2]> = (0..=8).rev().map(of).collect();
    let gains: Vec<[f64; 2]> =
        by_bits.windows(2).map(|pair| [0, 1].map(|kind| pair[0][kind] / pair[1][kind])).collect();
    for [measured, predicted] in &gains {
        println!("one more bit: {measured:.3} measured, {predicted:.3} predicted");
    }
    assert!(gains[0].iter().all(|gain| (gain - 2.0).abs() < 0.2), "{gains:?}");
    assert!(gains[7].iter().all(|gain| *gain < 1.1), "{gains:?}");
}

/// What eq. 6 leaves of the capacitance, because it does not know the sheet's resistance, no word makes
/// smaller: it is the same with words of any length, whatever these add.
#[test]
fn the_bias_of_eq_6_does_not_depend_on_bits() {
    let (scene, with_sheet) = (&scenes()[0], standard());
    let of = |bits: u8| {
        let mut profile = standard();
        profile.capacitance.sheet_correction = false;
        let f = &mut profile.formats;
        for format in [&mut f.capacitance, &mut f.admittance, &mut f.iq, &mut f.total] {
            *format = shorter(*format, bits);
        }
        let calibration = calibration(&profile);
        let bias =
            measured_against(&with_sheet, &profile, &calibration, scene, 7)[CAPACITANCE].mean;
        [bias, errors(&profile, scene, CAPACITANCE)[0]]
    };
    let [long, shorter, shortest] = [0, 4, 8].map(of);
    for [bias, words] in [long, shorter, shortest] {
        println!("eq. 6: mean {bias:.4} pF off the truth, its words {words:.4} pF RMS");
    }
    assert!(shortest[1] > 50.0 * long[1], "{long:?} and {shortest:?}: words were shortened");
    for [bias, words] in [shorter, shortest] {
        let chance = 4.0 * words / (scene.slots() as f64).sqrt();
        assert!((bias - long[0]).abs() < 0.02 * long[0].abs() + chance, "{bias} for {}", long[0]);
    }
    assert!(long[0].abs() > 10.0 * long[1], "{long:?}: the equation's part is the larger one");
}

/// Errors are the core's against a reference in `f64`, whose own error is a thousandth of them at most; in `f32`
/// it would not be.
#[test]
fn a_reference_in_double_precision_suffices_and_one_in_single_precision_does_not() {
    let scene = &scenes()[0];
    for name in ["small", "standard", "fine"] {
        let profile = Profile::bundled(name).expect("bundled");
        let calibration = calibration(&profile);
        let [single, double] = reference_errors(&profile, &calibration, scene, 7);
        let core = measured(&profile, &calibration, scene, 7).map(Moments::rms);
        for (n, quantity) in QUANTITIES.into_iter().enumerate() {
            let [single, double] = [single, double].map(|of| of[n] / core[n]);
            println!(
                "{name}, {quantity}: core {:.1e}; reference in f32 {single:.1e}, in f64 {double:.1e} of it",
                core[n]
            );
            assert!(double < 1e-3, "{name}, {quantity}: {double}");
        }
        let worst = single.into_iter().zip(core).map(|(single, core)| single / core);
        let worst = worst.fold(0.0, f64::max);
        assert!(name != "fine" || worst > 0.1, "{name}: f32 is off {worst} of the core's error");
    }
}

/// Rounding of the samples averages out: over four times as many, half of it is left.
#[test]
fn the_adcs_error_falls_with_the_square_root_of_the_window() {
    let scene = &scenes()[0];
    let of = |samples: u64, periods: u64| {
        let mut profile = standard();
        profile.formats.adc = shorter(profile.formats.adc, 6);
        (profile.slot.integrate, profile.carrier.periods) = (samples, periods);
        errors(&profile, scene, CAPACITANCE)
    };
    let (short, long) = (of(500, 51), of(2000, 203));
    for (short, long) in short.into_iter().zip(long) {
        println!("four times the samples: {:.3} of the error", long / short);
        assert!((long / short - 0.5).abs() < 0.06, "{}", long / short);
    }
}

/// With ten samples per period an undithered tone meets ten codes only; with periods that have no
/// divisor in common with the samples it meets all.
#[test]
fn a_window_of_coprime_periods_cures_the_bias_of_an_undithered_tone() {
    let of = |periods: u64| {
        let mut profile = standard();
        profile.formats.adc = Format::signed(16, 15);
        profile.carrier.periods = periods;
        let amplitude = |n: u64| (64.0 + 0.37 * n as f64) * profile.formats.adc.lsb();
        let errors = (0..64).map(|n| {
            let turn = n as f64 / 64.0 + 0.003;
            amplitude_of_tone(&profile, amplitude(n), turn, profile.carrier.periods as f64)
                / amplitude(n)
                - 1.0
        });
        (errors.map(|error| error * error).sum::<f64>() / 64.0).sqrt()
    };
    let (ten, coprime) = (of(100), of(101));
    println!(
        "of 64 codes: {:.4} % with ten samples per period, {:.4} % with 101 periods",
        100.0 * ten,
        100.0 * coprime
    );
    assert!(ten > 0.001 && coprime < 0.0005, "{ten} and {coprime}");
}

/// A rectangular window has less noise, and lets through what lies beside the carrier.
#[test]
fn a_rectangular_window_leaks_and_a_hann_window_is_noisier() {
    let of = |window: Window| {
        let mut profile = standard();
        profile.carrier.window = window;
        let periods = profile.carrier.periods as f64;
        let leak = amplitude_of_tone(&profile, 0.5, 0.1, periods + 20.5) / 0.5;
        // 16 bits, of which the analog noise moves the last: rounding is random.
        profile.formats.adc = shorter(profile.formats.adc, 2);
        [leak, errors(&profile, &scenes()[0], CAPACITANCE)[0]]
    };
    let [hann, rectangular] = [Window::Hann, Window::Rectangular].map(of);
    println!("leak {:.1} dB and {:.1} dB", 20.0 * hann[0].log10(), 20.0 * rectangular[0].log10());
    println!(
        "error, Hann over rectangular: {:.3} (1.5, 1.76 dB, in power)",
        hann[1] / rectangular[1]
    );
    assert!(rectangular[0] > 100.0 * hann[0], "{rectangular:?} and {hann:?}");
    assert!((hann[1] / rectangular[1] - 1.5f64.sqrt()).abs() < 0.1, "{rectangular:?} and {hann:?}");
}
