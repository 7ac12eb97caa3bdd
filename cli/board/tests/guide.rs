// SPDX-License-Identifier: MIT OR Apache-2.0
//! A guided calibration on virtual boards whose devices differ from the calibration that it begins with, judged at other
//! places.

use fastrand::Rng;
use hapticore_board::bench::{Bench as _, DeviceTime};
use hapticore_board::guide::guide;
use hapticore_board::target::{Asked, virtual_device};
use hapticore_host::{DeviceCalibration, Quantities, Readout, Residual};

/// Keys of a scene and their values.
type Keys = &'static [(&'static str, &'static str)];

fn bench(set: Keys) -> DeviceTime {
    let set = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let asked = Asked { port: "virtual:hockey".into(), set, ..Asked::default() };
    DeviceTime::new(virtual_device(&asked).expect("a bundled scene"))
}

/// Position errors of a board with a calibration, at places drawn at random.
fn errors(bench: &mut DeviceTime, device: &DeviceCalibration) -> Residual {
    let profile = bench.profile().clone();
    let calibration = device.for_profile(&profile).expect("a calibration");
    bench.bring_up(&calibration, &Default::default(), false).expect("it starts up");
    let mut readout = Readout::new(&profile, device);
    let mut random = Rng::with_seed(5);
    let mut draw = |reach: f64| (2.0 * random.f64() - 1.0) * reach;
    let found = (0..30).map(|_| {
        let place = [draw(380.0), draw(200.0)].map(f64::round);
        bench.put(&[place]).expect("on the sheet");
        let packets = bench.frames(12).expect("frames");
        let of_first = packets.iter().filter(|packet| packet.frame.pad == 0).skip(4);
        let found: Vec<_> =
            of_first.map(|packet| readout.convert(&packet.frame.measurement(&profile)).0).collect();
        let mean =
            |of: fn(&Quantities) -> f64| found.iter().map(of).sum::<f64>() / found.len() as f64;
        (place, [mean(|of| of.x_mm), mean(|of| of.y_mm)])
    });
    Residual::of(found.collect::<Vec<_>>().into_iter())
}

#[test]
fn a_guided_calibration_finds_pads_of_another_device() {
    // Keys of the device, and the error that is left, mm rms.
    let devices: [(Keys, f64); 3] = [
        (&[("sheet.terminal_ohm", "100")], 2.0),
        (&[("sensor.gain_mismatch_percent", "2")], 2.0),
        (&[("sheet.slope_percent", "[20, 0]"), ("sheet.rung", "grid-5-mm")], 2.0),
    ];
    let own = (**bench(&[]).board.case().device).clone();
    for (set, limit_mm) in devices {
        let mut board = bench(set);
        let before = errors(&mut board, &own);
        let corrected = guide(&mut bench(set), &own).expect("a calibration");
        let after = errors(&mut board, &corrected.device);
        eprintln!(
            "{set:?}: {}; held out {}; then {}",
            before.errors(),
            corrected.held_out.errors(),
            after.errors()
        );
        assert!(
            after.rms_mm < limit_mm && after.rms_mm < before.rms_mm / 4.0,
            "{set:?}: {before:?} {after:?}"
        );
    }
}
