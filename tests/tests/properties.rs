// SPDX-License-Identifier: MIT OR Apache-2.0
//! Properties that every core has, whatever its words: symmetries, order, independence. A case that
//! breaks one is shrunk, and the waveforms of what is left are written as a VCD file.

use std::fs;
use std::ops::Range;
use std::path::PathBuf;

use hapticore_contract::frame::Measurement;
use hapticore_model::blocks::core::Core;
use hapticore_model::fidelity::clock::ClockSimulation;
use hapticore_rtl::netlist;
use hapticore_tests::stability::bench::{Bench, Pad};
use hapticore_waveforms::tracer::{Settings, Tracer};
use hapticore_waveforms::vcd_file::VcdFile;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestCaseResult, TestError, TestRunner};

/// Cases for each profile.
const CASES: u32 = 60;

/// Thousandths: integers shrink to the edge of what fails, and cases are read at a glance.
fn thousandths(of: Range<u32>) -> impl Strategy<Value = f64> {
    of.prop_map(|thousandths| f64::from(thousandths) / 1000.0)
}

/// A pad anywhere that a sheet of six terminals may have it: a common part of the currents, and what
/// each terminal has beyond it.
fn pads() -> impl Strategy<Value = Pad> {
    let own = prop::array::uniform6(thousandths(0..600));
    (thousandths(20..300), own, thousandths(0..1000), thousandths(0..900)).prop_map(
        |(common, own, phase, haptic)| Pad {
            currents: own.map(|own| common * (0.4 + own)).into(),
            sense: 0.9,
            phase,
            haptic,
            haptic_turns: 0.01,
        },
    )
}

/// Runs a property on all profiles.
///
/// # Panics
/// Where it does not hold; the message names the smallest case and the file of its waveforms.
fn check<S: Strategy>(
    name: &str,
    strategy: S,
    pad: impl Fn(&S::Value) -> &Pad,
    property: impl Fn(&Bench, &S::Value) -> TestCaseResult,
) {
    check_on(&Bench::all(), name, strategy, pad, property);
}

/// [`check`] on profiles of the property's own.
fn check_on<S: Strategy>(
    benches: &[Bench],
    name: &str,
    strategy: S,
    pad: impl Fn(&S::Value) -> &Pad,
    property: impl Fn(&Bench, &S::Value) -> TestCaseResult,
) {
    for bench in benches {
        let profile = &bench.profile.name;
        let config = Config {
            cases: CASES,
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(15),
            ..Config::default()
        };
        let outcome = TestRunner::new(config).run(&strategy, |value| property(bench, &value));
        match outcome {
            Ok(()) => {}
            Err(TestError::Fail(reason, value)) => {
                let file = waveforms(bench, name, pad(&value));
                panic!(
                    "`{profile}`: {reason}; smallest case {value:?}, waveforms in {}",
                    file.display()
                );
            }
            Err(error) => panic!("`{profile}`: {error}"),
        }
    }
}

/// Waveforms of a slot's estimate, from the window's end to the frame.
fn waveforms(bench: &Bench, name: &str, pad: &Pad) -> PathBuf {
    let profile = &bench.profile;
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("properties");
    fs::create_dir_all(&folder).expect("a folder for waveforms");
    let path = folder.join(format!("{name}-{}.vcd", profile.name));
    let end = profile.slot_clocks();
    let settings = Settings {
        window: Some(end..end + Core::new(profile).latency()),
        ..Settings::of_clock(25_000_000).expect("a clock")
    };
    let mut core = ClockSimulation::new(profile, &bench.calibration);
    let wave = VcdFile::create(&path).expect("a file");
    let signals = netlist::signals_of_core(&Core::new(profile));
    let mut tracer = Tracer::of_signals(wave, signals, &[], &settings).expect("named signals");
    let slot = bench.slot(|n, channel| bench.signal(pad, n, channel));
    for codes in
        slot.chunks_exact(profile.channels()).cycle().take(2 * profile.slot.samples() as usize)
    {
        core.sample_with(codes, |core| tracer.clock(core).expect("waveforms are written"));
    }
    tracer.finish().expect("waveforms are written");
    path
}

fn scaled(pad: &Pad, by: f64) -> Pad {
    Pad { currents: pad.currents.iter().map(|current| by * current).collect(), ..pad.clone() }
}

/// What the core makes of a pad's tones, which no ADC rounds.
fn tones(bench: &Bench, pad: &Pad) -> Measurement {
    let square = 0.5 * pad.haptic * pad.haptic;
    bench.fixed().phasors(0, &bench.phasors(pad), square).measurement(&bench.profile)
}

/// The largest error that rounding of the currents' words leaves in a ratio. It is half a step of I
/// and of Q of every terminal, and one of the amplitude's square root and of the ratio's own word.
fn ratio_step(bench: &Bench, pad: &Pad) -> f64 {
    let formats = &bench.profile.formats;
    let total: f64 = pad.currents.iter().sum();
    let currents = 2.0 * bench.terminals() as f64 * formats.iq.lsb() / bench.profile.tone_gain();
    2.0 * currents / total + 2.0 * formats.ratio.lsb()
}

#[test]
fn ratios_do_not_depend_on_the_size_of_the_currents() {
    check(
        "scale",
        (pads(), thousandths(300..1000)),
        |(pad, _)| pad,
        |bench, (pad, by)| {
            let (whole, part) = (tones(bench, pad), tones(bench, &scaled(pad, *by)));
            let step = ratio_step(bench, &scaled(pad, *by));
            prop_assert!(
                (whole.r_x - part.r_x).abs() <= step,
                "r_x {} and {}",
                whole.r_x,
                part.r_x
            );
            prop_assert!(
                (whole.r_y - part.r_y).abs() <= step,
                "r_y {} and {}",
                whole.r_y,
                part.r_y
            );
            Ok(())
        },
    );
}

#[test]
fn mirrored_currents_give_the_opposite_ratio() {
    check(
        "mirror",
        pads(),
        |pad| pad,
        |bench, pad| {
            let c = &pad.currents;
            let mirrored =
                Pad { currents: vec![c[3], c[2], c[1], c[0], c[4], c[5]], ..pad.clone() };
            let (left, right) = (tones(bench, pad), tones(bench, &mirrored));
            prop_assert_eq!(left.r_x, -right.r_x);
            prop_assert_eq!(left.r_y, right.r_y);
            // The table is as symmetric as least squares on rounded words leave it.
            let step = 4.0 * bench.profile.formats.position.lsb() + 0.05;
            prop_assert!(
                left.flags.invalid || (left.x_mm + right.x_mm).abs() < step,
                "{} {}",
                left.x_mm,
                right.x_mm
            );
            Ok(())
        },
    );
}

#[test]
fn codes_of_the_opposite_sign_give_the_same_frame_within_its_rounding() {
    check(
        "sign",
        pads(),
        |pad| pad,
        |bench, pad| {
            let codes = bench.codes(pad);
            let opposite: Vec<i32> = codes.iter().map(|code| -code).collect();
            let (plus, minus) = (bench.measure(&codes), bench.measure(&opposite));
            let step = ratio_step(bench, pad);
            prop_assert!(
                (plus.r_x - minus.r_x).abs() <= step,
                "r_x {} and {}",
                plus.r_x,
                minus.r_x
            );
            prop_assert!(
                (plus.r_y - minus.r_y).abs() <= step,
                "r_y {} and {}",
                plus.r_y,
                minus.r_y
            );
            let relative = (plus.capacitance_pf / minus.capacitance_pf - 1.0).abs();
            prop_assert!(
                relative
                    <= step + 2.0 * bench.profile.formats.capacitance.lsb() / plus.capacitance_pf,
                "{relative}"
            );
            Ok(())
        },
    );
}

/// Behind the sheet's resistance the capacitance bends with the current: here nothing is taken out.
#[test]
fn capacitance_is_proportional_to_the_currents() {
    let linear = |bench: Bench| {
        let mut profile = bench.profile;
        profile.capacitance.sheet_correction = false;
        Bench::with(profile)
    };
    let benches: Vec<_> = Bench::all().into_iter().map(linear).collect();
    check_on(
        &benches,
        "linearity",
        (pads(), thousandths(100..1000)),
        |(pad, _)| pad,
        |bench, (pad, by)| {
            let (whole, part) = (tones(bench, pad), tones(bench, &scaled(pad, *by)));
            let formats = &bench.profile.formats;
            // Half a step of either word, and what rounding of the currents' words leaves of either.
            let word = 0.5 * (1.0 + by) * formats.capacitance.lsb();
            let currents = (ratio_step(bench, &scaled(pad, *by)) + ratio_step(bench, pad))
                * by
                * whole.capacitance_pf;
            let off = (part.capacitance_pf - by * whole.capacitance_pf).abs();
            prop_assert!(off <= word + currents, "{} of {}", off, word + currents);
            Ok(())
        },
    );
}

#[test]
fn force_is_proportional_to_the_square_of_the_haptic_voltage() {
    check(
        "square",
        (pads(), thousandths(100..1000)),
        |(pad, _)| pad,
        |bench, (pad, by)| {
            let part = Pad { haptic: by * pad.haptic, ..pad.clone() };
            let (whole, part) = (tones(bench, pad), tones(bench, &part));
            let (formats, by) = (&bench.profile.formats, by * by);
            // Of either, half a step of the force, of C²·m, and of the mean square m.
            let energy = formats.square.lsb() * bench.calibration.force_gain;
            let square = formats.mean_square.lsb() / (0.5 * pad.haptic * pad.haptic);
            let limit = 0.5 * (1.0 + by) * (formats.force.lsb() + energy + square * whole.force_n);
            let off = (part.force_n - by * whole.force_n).abs();
            prop_assert!(pad.haptic == 0.0 || off <= limit, "{off} of {limit}");
            Ok(())
        },
    );
}

#[test]
fn more_haptic_voltage_never_gives_less_force() {
    check(
        "force",
        (pads(), thousandths(0..1000)),
        |(pad, _)| pad,
        |bench, (pad, part)| {
            let less = Pad { haptic: part * pad.haptic, ..pad.clone() };
            prop_assert!(tones(bench, &less).force_n <= tones(bench, pad).force_n);
            Ok(())
        },
    );
}

#[test]
fn more_current_never_gives_less_capacitance() {
    check(
        "capacitance",
        (pads(), thousandths(0..1000)),
        |(pad, _)| pad,
        |bench, (pad, part)| {
            let (less, more) = (tones(bench, &scaled(pad, *part)), tones(bench, pad));
            let within = bench.profile.formats.capacitance.lsb();
            let valid = !less.flags.invalid && !more.flags.invalid;
            prop_assert!(!valid || less.capacitance_pf <= more.capacitance_pf + within);
            Ok(())
        },
    );
}

#[test]
fn a_pad_s_frames_do_not_depend_on_its_number_or_on_the_others() {
    check(
        "order",
        (pads(), pads(), 0usize..4),
        |(pad, ..)| pad,
        |bench, (pad, other, number)| {
            let (mut alone, mut among) = (bench.fixed(), bench.fixed());
            let (codes, others) = (bench.codes(pad), bench.codes(other));
            for slot in 0..2 {
                let first = alone.slot(0, &codes);
                (0..4).filter(|of| of != number).for_each(|of| {
                    among.slot(of, &others);
                });
                let frame = among.slot(*number, &codes);
                prop_assert_eq!(
                    (frame.codes, frame.flags),
                    (first.codes, first.flags),
                    "slot {}",
                    slot
                );
            }
            Ok(())
        },
    );
}

/// The machinery itself: a property that does not hold is shrunk to where it begins not to, with
/// waveforms.
#[test]
fn a_broken_property_ends_in_a_small_case_and_its_waveforms() {
    let strategy =
        thousandths(100..900).prop_map(|haptic| Pad { haptic, ..Bench::of("small").pad(0.3) });
    let broken = std::panic::catch_unwind(|| {
        check(
            "broken",
            strategy,
            |pad| pad,
            |_, pad| {
                prop_assert!(pad.haptic < 0.5);
                Ok(())
            },
        );
    });
    let message = *broken.expect_err("it does not hold").downcast::<String>().expect("a message");
    let haptic = message.split("haptic: ").nth(1).and_then(|text| text.split(',').next());
    let haptic: f64 = haptic.expect("the case").parse().expect("a number");
    assert!((haptic - 0.5).abs() < 1e-9, "shrunk to the edge: {haptic}");
    let file = message.rsplit("waveforms in ").next().expect("a file");
    let text = fs::read_to_string(file).expect("waveforms");
    assert!(text.contains("$enddefinitions"), "a VCD file");
    assert!(text.len() < 3_000_000, "a small one: {} bytes", text.len());
}
