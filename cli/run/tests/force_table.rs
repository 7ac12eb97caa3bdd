// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force table beside eq. 8: calibrated on one set of readings, judged on others, on the model
//! device and on random ones.

use hapticore_host::device::Force;
use hapticore_run::calibrate::bench::Bench;
use hapticore_run::calibrate::random::{Normal, scene};
use hapticore_run::lab::force_table::{Reading, eq8, fit, gain};

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
        readings.iter_mut().for_each(|reading| reading.force_n += NOISE_N * normal.next());
        let force_k = eq8(&readings);
        let force = fit(&readings, force_k);
        Calibrated { bench, force_k, force }
    }

    fn factor(&self, reading: &Reading) -> f64 {
        self.force.factor(reading.capacitance_pf, reading.recent_v, reading.mean_v)
    }

    fn errors(&self, readings: &[Reading]) -> Errors {
        let of = |factor: &dyn Fn(&Reading) -> f64| {
            let off = |r: &Reading| 1e3 * (self.force_k * r.square() * factor(r) - r.force_n);
            let squares: f64 = readings.iter().map(|r| off(r).powi(2)).sum();
            let largest = readings.iter().map(|r| off(r).abs()).fold(0.0, f64::max);
            [largest, (squares / readings.len() as f64).sqrt()]
        };
        [of(&|reading| self.factor(reading)), of(&|_| 1.0)]
    }

    /// Settled at 10 to 150 g and 10 to 400 V, up and down.
    fn settled(&self) -> Vec<Reading> {
        let up = (1..=40).map(|n| 10.0 * f64::from(n));
        let volts: Vec<f64> = up.clone().chain(up.rev()).collect();
        let loads = [10.0, 20.0, 35.0, 50.0, 75.0, 100.0, 125.0, 150.0];
        loads.iter().flat_map(|load| self.bench.settled(*load, &volts).unwrap()).collect()
    }

    /// Steps of the voltage: the first 20 ms of each, and the rest to 4 s.
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
    for (name, loads, volts) in [
        ("20-100 g, 250-350 V", &[30.0, 50.0, 80.0][..], &[250.0, 320.0, 350.0][..]),
        ("10-150 g, 200-400 V", &[10.0, 50.0, 120.0, 150.0][..], &[200.0, 300.0, 400.0][..]),
    ] {
        let [first, rest] = device.steps(loads, volts);
        show(&format!("first 20 ms, {name}"), device.errors(&first));
        show(&format!("20 ms to 4 s, {name}"), device.errors(&rest));
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
    ten.iter_mut().for_each(|reading| reading.force_n += NOISE_N * noise.next());
    device.force_k *= gain(&ten, |r| device.force_k * r.square() * device.factor(r));
    let after = device.errors(&device.settled());
    show("friction + 20 %, gain as before", before);
    show("friction + 20 %, gain refitted", after);
}
