// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force table beside eq. 8: calibrated on one set of readings, judged on others, on the model
//! device and on random ones.
//!
//! What the table leaves is largest where its rows end or a spot of the pad pulls in between two of them: rows are
//! 64 pF apart from 320 pF on, by the core's words, and the device's capacitance rises from 270 pF by steps of 20 to
//! 60 pF.

use std::sync::Arc;

use hapticore_contract::profile::ForceLaw;
use hapticore_host::device::Force;
use hapticore_run::calibrate::bench::Bench;
use hapticore_run::calibrate::random::{Normal, scene};
use hapticore_run::case::{Case, Settings};
use hapticore_run::engine::Fidelity;
use hapticore_run::inputs;
use hapticore_run::lab::force_table::{Reading, eq8, fit, gain, residuals};
use hapticore_run::lab::loads::{Load, Loads};
use hapticore_run::record::Row;

/// Seed of the noise of readings, and of the devices that are judged: others than the prior's.
const NOISE: u64 = 1;
const DEVICES: u64 = 99;

/// Noise of a laboratory's readings, N (standard deviation).
const NOISE_N: f64 = 0.005;

/// A calibrated device.
struct Calibrated {
    bench: Bench,
    force_k: f64,
    force: Force,
}

/// The largest and the rms error of a set, mN: of the table, and of eq. 8.
type Errors = [[f64; 2]; 2];

impl Calibrated {
    fn new(text: &str, normal: &mut Normal) -> Self {
        let bench = Bench::of(text).unwrap().expect("a gap and friction");
        let mut readings = bench.readings().unwrap();
        readings.iter_mut().for_each(|reading| reading.force_n += NOISE_N * normal.deviate());
        let force_k = eq8(&readings);
        let force = fit(&readings, force_k);
        Calibrated { bench, force_k, force }
    }

    fn factor(&self, reading: &Reading) -> f64 {
        self.force.factor(reading.capacitance_pf, reading.recent_v, reading.mean_v)
    }

    fn errors(&self, readings: &[Reading]) -> Errors {
        residuals(readings, self.force_k, &self.force).map(|of| of.map(|newton| 1e3 * newton))
    }

    /// Settled at 10 to 150 g and 10 to 400 V, up and down.
    fn settled(&self) -> Vec<Reading> {
        let up = (1..=40).map(|n| 10.0 * f64::from(n));
        let volts: Vec<f64> = up.clone().chain(up.rev()).collect();
        let loads = [10.0, 20.0, 35.0, 50.0, 75.0, 100.0, 125.0, 150.0];
        loads.iter().flat_map(|load| self.bench.settled(*load, &volts).unwrap()).collect()
    }

    /// Steps of the voltage: the first 20 ms of each, and what follows to 4 s.
    fn steps(&self, loads_g: &[f64], volts: &[f64]) -> [Vec<Reading>; 2] {
        let mut sets = [vec![], vec![]];
        for load_g in loads_g {
            for volt in volts {
                let step = self.bench.step(*load_g, *volt, 4000).unwrap();
                sets[0].extend(&step[..20]);
                sets[1].extend(&step[20..]);
            }
        }
        sets
    }
}

fn show(name: &str, [table, eq8]: Errors) {
    let [[most, rms], [most_8, rms_8]] = [table, eq8];
    println!("{name}: table {most:.1} max {rms:.1} rms, eq. 8 {most_8:.1} max {rms_8:.1} rms, mN");
}

#[test]
fn the_model_device() {
    let device = Calibrated::new(&scene(None), &mut Normal::new(NOISE));
    let settled = device.errors(&device.settled());
    show("settled, 10-150 g to 400 V, up and down", settled);
    assert!(settled[0][0] <= 14.0 && settled[1][0] > 25.0, "{settled:?}");
    for (name, loads, volts, limits) in [
        ("30-80 g, 250-350 V", &[30.0, 50.0, 80.0][..], &[250.0, 320.0, 350.0][..], [6.5, 10.5]),
        // Beyond the loads and voltages of the readings.
        (
            "10-150 g, 200-400 V",
            &[10.0, 50.0, 120.0, 150.0][..],
            &[200.0, 300.0, 400.0][..],
            [17.5, 17.5],
        ),
    ] {
        let [first, rest] = device.steps(loads, volts).map(|set| device.errors(&set));
        show(&format!("first 20 ms, {name}"), first);
        show(&format!("20 ms to 4 s, {name}"), rest);
        assert!(first[0][0] <= limits[0] && first[1][0] > 15.0, "{name}: {first:?}");
        assert!(rest[0][0] <= limits[1] && rest[1][0] > 20.0, "{name}: {rest:?}");
    }
}

#[test]
fn other_devices() {
    let (mut devices, mut noise) = (Normal::new(DEVICES), Normal::new(NOISE + 1));
    let mut worst = [[[0.0f64; 2]; 2]; 3];
    for number in 0..24 {
        let device = Calibrated::new(&scene(Some(&mut devices)), &mut noise);
        let [first, rest] = device.steps(&[50.0], &[300.0, 350.0]);
        for (set, readings) in [device.settled(), first, rest].iter().enumerate() {
            let errors = device.errors(readings);
            show(&format!("device {number}, set {set}"), errors);
            for (worst, of) in worst[set].iter_mut().flatten().zip(errors.as_flattened()) {
                *worst = worst.max(*of);
            }
        }
    }
    for (set, worst) in ["settled", "first 20 ms", "20 ms to 4 s"].iter().zip(worst) {
        show(&format!("worst of 24, {set}"), worst);
        assert!(worst[0][0] <= 21.0 && worst[1][0] > 30.0, "{set}: {worst:?}");
    }
}

/// A friction coefficient that has risen by a fifth is seen in the force alone: one gain, refitted
/// from ten readings, takes it out.
#[test]
fn friction_that_has_changed_is_one_gain() {
    let mut noise = Normal::new(NOISE + 2);
    let mut device = Calibrated::new(&scene(None), &mut noise);
    let worn = scene(None).replace("mu = 0.12\n", "mu = 0.144\n");
    device.bench = Bench::of(&worn).unwrap().expect("a gap and friction");
    let before = device.errors(&device.settled());
    let volts = [150.0, 220.0, 280.0, 340.0, 400.0];
    let loads = [20.0, 100.0];
    let ten = loads.iter().flat_map(|load| device.bench.settled(*load, &volts).unwrap());
    let mut ten: Vec<_> = ten.collect();
    ten.iter_mut().for_each(|reading| reading.force_n += NOISE_N * noise.deviate());
    device.force_k *= gain(&ten, |r| device.force_k * r.square() * device.factor(r));
    let after = device.errors(&device.settled());
    show("friction + 20 %, gain as before", before);
    show("friction + 20 %, gain refitted", after);
    assert!(before[0][0] > 100.0 && after[0][0] <= 16.0, "{before:?} {after:?}");
}

/// A scene's first case with the core's words: the largest error of its force, and what the words
/// add to floating point, mN.
fn run(name: &str, law: ForceLaw) -> [f64; 2] {
    let scene = Arc::new(inputs::scene(name, &[]).unwrap());
    let mut profile = inputs::profile("standard").unwrap();
    profile.force.law = law;
    let profile = inputs::windowed(profile, &scene).unwrap();
    let case = Case::new(&scene, 0, &profile, &[]).unwrap();
    let settings = Settings { fidelity: Fidelity::Fixed, errors: false };
    let outcome = case.run(&settings, None, &|| ()).unwrap();
    let off = |of: &dyn Fn(&Row) -> f64| {
        outcome.rows.iter().map(|row| 1e3 * of(row).abs()).fold(0.0, f64::max)
    };
    [
        off(&|row| row.measured.force_n - row.truth.unwrap().quantities.force_n),
        off(&|row| row.measured.force_n - row.reference.unwrap().quantities.force_n),
    ]
}

/// The paper's figures, with a table from the bench: other loads, voltages and times.
#[test]
fn the_scenes() {
    for (name, limit) in [("fig6", 6.5), ("fig7", 7.5)] {
        let ([table, words], [eq8, _]) = (run(name, ForceLaw::Table), run(name, ForceLaw::Eq8));
        println!("{name}: table {table:.2} mN, eq. 8 {eq8:.1} mN; words add {words:.3} mN");
        assert!(table <= limit && eq8 > 16.0, "{name}: {table} {eq8}");
        assert!(words <= 0.075, "{name}: {words}");
    }
}

/// What a laboratory takes: settled readings, and from each step every twentieth millisecond; from
/// rises and falls, where it makes some, every seventh.
fn laboratory(bench: &Bench, volts: &[f64], sines: &[[f64; 2]]) -> Loads {
    let mut normal = Normal::new(NOISE + 3);
    let mut load = |load_g: f64, reading: &Reading, time_s: Option<f64>| Load {
        haptic_v_rms: reading.haptic_v_rms,
        newtons: reading.force_n + NOISE_N * normal.deviate(),
        load_g: Some(load_g),
        reference_pf: Some(reading.capacitance_pf),
        sensed_pf: None,
        time_s,
    };
    let mut loads = Vec::new();
    for load_g in [20.0, 100.0] {
        let settled = bench.settled(load_g, volts).unwrap();
        loads.extend(settled.iter().map(|reading| load(load_g, reading, None)));
    }
    let steps = [[20.0, 350.0], [100.0, 350.0]]
        .map(|[load_g, volt]| (load_g, bench.step(load_g, volt, 1000), 20));
    let sines = sines.iter().map(|&[load_g, volt]| (load_g, bench.sine(load_g, volt, 500), 7));
    for (load_g, record, every) in steps.into_iter().chain(sines) {
        // Times of slots: their middles.
        let at_s = |slot: usize| (slot as f64 + 0.5) * 1e-3;
        let record = record.unwrap();
        let rows = record.iter().enumerate().step_by(every);
        loads.extend(rows.map(|(slot, reading)| load(load_g, reading, Some(at_s(slot)))));
    }
    Loads { file: "loads.csv".into(), loads, friction: false, timed: true }
}

/// The gain of eq. 8 and the table that `hapticore calibrate` makes of loads.
fn fitted(lab: &Loads) -> anyhow::Result<(f64, Force)> {
    let setup = "pads = 1\nsample_rate_hz = 1e6\ncarrier_hz = 101000.0\ncurrent_full_scale_a = 0.004\n\
                 sense_full_scale_v = 8.0\nhaptic_full_scale_v = 600.0\n";
    let force = lab.fit(&toml::from_str(setup).unwrap())?;
    Ok((force.force_k.value, force.table.expect("a table")))
}

/// 18 voltages to 400 V, V.
fn eighteen() -> Vec<f64> {
    (3..=20).map(|n| 20.0 * f64::from(n)).collect()
}

/// What `hapticore calibrate` makes of loads with times: a table that leaves little of other readings.
#[test]
fn a_laboratory() {
    let bench = Bench::of(&scene(None)).unwrap().expect("a gap and friction");
    let lab = laboratory(&bench, &eighteen(), &[]);
    let (force_k, table) = fitted(&lab).unwrap();
    let others = bench.settled(60.0, &eighteen()).unwrap();
    let [[of_table, _], [of_eq8, _]] = residuals(&others, force_k, &table);
    println!("60 g, settled: table {:.1} mN, eq. 8 {:.1} mN", 1e3 * of_table, 1e3 * of_eq8);
    assert!(of_table <= 0.008 && of_eq8 > 0.02, "{of_table} {of_eq8}");
    let few = Loads { loads: lab.loads[..40].to_vec(), ..lab };
    let refused = fitted(&few).unwrap_err().to_string();
    assert!(refused.starts_with("loads.csv: time_s: expected 60 readings"), "{refused}");
}

/// Rises and falls in a laboratory's loads, with rows some milliseconds apart, improve the prediction of
/// others, faster and not as high.
#[test]
fn a_laboratory_records_rises_and_falls() {
    let bench = Bench::of(&scene(None)).unwrap().expect("a gap and friction");
    let others = bench.sine(50.0, 380.0, 350).unwrap();
    let [without, with] = [&[][..], &[[20.0, 400.0], [100.0, 400.0]]].map(|sines| {
        let (force_k, table) = fitted(&laboratory(&bench, &eighteen(), sines)).unwrap();
        residuals(&others, force_k, &table)[0]
    });
    let [without, with] = [without, with].map(|[_, rms_n]| 1e3 * rms_n);
    println!("50 g, rise and fall: {with:.2} mN RMS, {without:.2} without any in the loads");
    assert!(with <= 4.7 && with < 0.85 * without, "{with} {without}");
}
