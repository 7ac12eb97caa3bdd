use hapticore_model::{
    blocks::core::Core,
    calibration::{Calibration, Map, Point},
    fidelity::{clock::ClockSimulation, fixed::FixedSimulation},
    profile::Profile,
    signal::netlist::Netlist,
};
use std::time::Instant;
fn main() {
    for profile in Profile::all().into_iter().filter(|p| std::env::args().nth(1).is_none_or(|n| n == p.name)) {
        let core = Core::new(&profile);
        let n = Netlist::of(&core);
        println!(
            "{}: {} modules {:?} latency {}",
            profile.name,
            n.modules.len(),
            n.modules.iter().map(|m| (m.name, m.wires.len())).collect::<Vec<_>>(),
            core.latency()
        );
        let mut points = vec![];
        for j in 0..41 {
            for i in 0..61 {
                let (x, y) = ((i as f64 / 60.0 - 0.5) * 800.0, (j as f64 / 40.0 - 0.5) * 440.0);
                points.push(Point { x, y, r_x: x / 500.0, r_y: y / 300.0, sheet: 0.05 + x * 1e-5 });
            }
        }
        let calibration =
            Calibration { map: Map::fit(&profile, 61, &points), capacitance_gain: 800.0, force_gain: 2e-6 };
        calibration.check(&profile).unwrap();
        let ch = profile.channels();
        let slot = profile.slot.samples() as usize;
        let mut codes = vec![0i32; slot * ch];
        let fs = (1i64 << (profile.formats.adc.width - 1)) as f64;
        let w = std::f64::consts::TAU / profile.carrier.samples_per_period as f64;
        let amps = [0.1, 0.12, 0.2, 0.15, 0.08, 0.09];
        for n in 0..slot {
            let ph = w * n as f64;
            for k in 0..6 {
                codes[n * ch + k] = (amps[k] * fs * -(ph).sin()).round() as i32;
            }
            codes[n * ch + 6] = (0.8 * fs * ph.cos()).round() as i32;
            codes[n * ch + 7] = (0.5 * fs * (ph / 100.0).cos()).round() as i32;
        }
        let mut clock = ClockSimulation::new(&profile, &calibration);
        let mut fixed: FixedSimulation<i64> = FixedSimulation::new(&profile, &calibration);
        for s in 0..6 {
            for n in 0..slot {
                clock.sample(&codes[n * ch..(n + 1) * ch]);
            }
            let a = clock.finish_slot().expect("frame");
            let b = fixed.slot(s % 4, &codes[profile.slot.blanking() as usize * ch..]);
            assert_eq!(a, b);
            if s == 5 {
                println!("{:?}", a.reading(&profile));
                println!("{:?}", calibration.map.look_up(a.reading(&profile).r_x, a.reading(&profile).r_y));
            }
        }
        let t = Instant::now();
        let c0 = clock.clocks();
        for _ in 0..std::env::var("N").map_or(200, |n| n.parse().unwrap()) {
            for n in 0..slot {
                clock.sample(&codes[n * ch..(n + 1) * ch]);
            }
        }
        let dt = t.elapsed().as_secs_f64();
        println!("clock: {:.1} M clocks/s", (clock.clocks() - c0) as f64 / dt / 1e6);
        let t = Instant::now();
        for s in 0..std::env::var("M").map_or(2000, |n| n.parse().unwrap()) {
            fixed.slot(s % 4, &codes[profile.slot.blanking() as usize * ch..]);
        }
        let dt = t.elapsed().as_secs_f64();
        println!(
            "fixed: {:.1} M window samples/s, {:.1} us/slot, {:.1} x real time of slot",
            std::env::var("M").map_or(2000.0, |n| n.parse().unwrap()) * profile.slot.integrate as f64 / dt / 1e6,
            dt / std::env::var("M").map_or(2000.0, |n| n.parse().unwrap()) * 1e6,
            std::env::var("M").map_or(2000.0, |n| n.parse().unwrap()) * slot as f64 / dt / 1e6
        );
    }
}
