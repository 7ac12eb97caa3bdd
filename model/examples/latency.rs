use hapticore_model::{
    block::Block,
    blocks::*,
    calibration::{Calibration, Map, Point},
    fidelity::clock::ClockSimulation,
    probe::Probe,
    profile::Profile,
};
fn main() {
    for profile in Profile::all() {
        let mut points = vec![];
        for j in 0..11 {
            for i in 0..11 {
                let (x, y) = (i as f64 * 80.0 - 400.0, j as f64 * 40.0 - 200.0);
                points.push(Point { x, y, r_x: x / 500.0, r_y: y / 300.0, sheet: 0.05 });
            }
        }
        let cal = Calibration { map: Map::fit(&profile, 11, &points), capacitance_gain: 800.0, force_gain: 2e-6 };
        let mut sim = ClockSimulation::new(&profile, &cal);
        let names: Vec<String> = sim.variables().iter().map(|v| format!("{}.{}", v.scope.join("."), v.name)).collect();
        let mut last = vec![];
        Probe::sample(&sim, &mut last);
        let slot = profile.slot.samples();
        for n in 0..slot {
            ClockSimulation::sample(
                &mut sim,
                &[1000, 1200, 900, 1100, 500, 400, 9000, 5000].map(|c| if n % 2 == 0 { c } else { -c }),
            );
            if n == slot - 2 {
                break;
            }
        }
        let c0 = std::cell::Cell::new(0);
        let seen = std::cell::RefCell::new(vec![0; names.len()]);
        for _ in 0..60 {
            sim.sample_with(&[1000, 1200, 900, 1100, 500, 400, 9000, 5000], |s| {
                c0.set(c0.get() + 1);
                let mut now = vec![];
                Probe::sample(s, &mut now);
                for (k, name) in names.iter().enumerate() {
                    if (name.ends_with("done")
                        || name.ends_with("valid")
                        || name.ends_with("ready")
                        || name.ends_with(".sample")
                        || name.ends_with("start")
                        || name.ends_with("divide"))
                        && now[k] == 1
                        && seen.borrow()[k] < 3
                    {
                        seen.borrow_mut()[k] += 1;
                        println!("{} {}", c0.get(), name);
                    }
                }
            });
        }
        let e = estimator::Estimator::new(&profile);
        println!(
            "currents {} estimator {} core {}",
            e.currents().latency(),
            e.latency(),
            core::Core::new(&profile).latency()
        );
    }
}
