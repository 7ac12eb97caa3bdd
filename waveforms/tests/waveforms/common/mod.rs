// SPDX-License-Identifier: MIT OR Apache-2.0
//! A small simulation with every kind of variable, shaped like the core.

use std::path::{Path, PathBuf};

use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::probe::{Probe, Variable};
use hapticore_waveforms::declarations::TruthVariable;
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::tracer::{Settings, Trace, Tracer};

pub const STATES: &[&str] = &["IDLE", "SETTLE", "INTEGRATE", "READ"];

/// The variables: path, format, states.
pub const VARIABLES: &[(&str, Format, &[&str])] = &[
    ("core.multiplexer.state", Format::unsigned(2, 0), STATES),
    ("core.multiplexer.pad", Format::unsigned(4, 0), &[]),
    ("core.oscillator.sin", Format::signed(18, 17), &[]),
    ("core.oscillator.cos", Format::signed(18, 17), &[]),
    ("core.oscillator.phase", Format::unsigned(32, 32), &[]),
    ("core.demodulator.i", Format::signed(24, 22), &[]),
    ("core.demodulator.q", Format::signed(24, 22), &[]),
    ("core.demodulator.acc", Format::signed(63, 40), &[]),
    ("core.demodulator.valid", BIT, &[]),
    ("core.position.x", Format::signed(16, 8), &[]),
    ("core.position.y", Format::signed(16, 8), &[]),
    ("core.capacitance.c", Format::unsigned(20, 12), &[]),
    ("core.capacitance.gain", Format::unsigned(18, 38), &[]),
    ("core.force.f", Format::unsigned(16, 12), &[]),
    ("core.force.coarse", Format::signed(8, -3), &[]),
];

/// The simulation: each variable is a plain function of the clock.
pub struct Fake {
    pub clock: u64,
}

impl Fake {
    pub fn codes(&self) -> Vec<i64> {
        let n = self.clock as i64;
        let turn = n as f64 / 100.0 * std::f64::consts::TAU;
        let full = |format: Format, real: f64| format.code_saturating(real);
        let slot = n / 250;
        let formats: Vec<_> = VARIABLES.iter().map(|variable| variable.1).collect();
        vec![
            [0, 1, 2, 2, 3][(n / 50 % 5) as usize],
            slot % 16,
            full(formats[2], turn.sin()),
            full(formats[3], turn.cos()),
            (n * 42_949_673) & 0xffff_ffff,
            full(formats[5], 0.8 * (n % 250) as f64 / 250.0),
            full(formats[6], -0.3 * (n % 250) as f64 / 250.0),
            n.wrapping_mul(-0x61c8_8646_80b5_83eb) >> 1,
            (n % 250 == 249) as i64,
            full(formats[9], 20.0 * (slot as f64).sin()),
            full(formats[10], -15.0 * (slot as f64).cos()),
            full(formats[11], 180.0 + slot as f64),
            100_000 + slot,
            full(formats[13], 0.5 + 0.1 * (slot % 7) as f64),
            slot % 256 - 128,
        ]
    }
}

impl Probe for Fake {
    fn variables(&self) -> Vec<Variable> {
        let variable = |&(path, format, states): &(&str, Format, &'static [&'static str])| {
            let mut scope: Vec<String> = path.split('.').map(Into::into).collect();
            let name = scope.pop().expect("a path");
            Variable { scope, name, format, states }
        };
        VARIABLES.iter().map(variable).collect()
    }

    fn sample(&self, codes: &mut Vec<i64>) {
        codes.extend(self.codes());
    }
}

/// Traces `clocks` clocks of the simulation into `folder/waves.*`; truth 0 is set from the start,
/// truth 1 from clock 5.
pub fn trace(folder: &Path, kind: Kind, settings: &Settings, clocks: u64) -> (PathBuf, Trace) {
    let path = folder.join("waves").with_extension(kind.extension());
    let mut tracer =
        Tracer::new(kind.create(&path).unwrap(), &Fake { clock: 0 }, &truth(), settings).unwrap();
    for clock in 0..clocks {
        tracer.set_truth(0, true_x(clock));
        if clock >= 5 {
            tracer.set_truth(1, -1.5e-12);
        }
        tracer.clock(&Fake { clock }).unwrap();
    }
    (path, tracer.finish().unwrap())
}

pub fn truth() -> [TruthVariable; 2] {
    [TruthVariable::new("x", "mm"), TruthVariable::new("error", "")]
}

pub fn true_x(clock: u64) -> f64 {
    20.0 * (clock as f64 / 250.0).sin()
}

/// A new folder, deleted with the value.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

pub fn settings() -> Settings {
    Settings::of_clock(25_000_000).unwrap()
}
