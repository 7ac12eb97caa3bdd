// SPDX-License-Identifier: MIT OR Apache-2.0
//! What tracing costs. Prints; asserts no times, which are the machine's.
//!
//! `cargo test --release -p hapticore-waveforms --test waveforms cost -- --nocapture`

use std::time::Instant;

use crate::common::{folder, settings};
use hapticore_hdl::format::Format;
use hapticore_hdl::probe::{Probe, Variable};
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::tracer::{Settings, Tracer};

const VARIABLES: usize = 100;
const CLOCKS: u64 = if cfg!(debug_assertions) { 2_000 } else { 200_000 };

/// Variables of 24 bits, of which the first few change at every clock.
struct Busy {
    codes: Vec<i64>,
    changing: usize,
}

impl Busy {
    fn step(&mut self) {
        for code in &mut self.codes[..self.changing] {
            *code = (*code * 5 + 0x1_2345) & 0x7f_ffff;
        }
    }
}

impl Probe for Busy {
    fn variables(&self) -> Vec<Variable> {
        let variable = |index| Variable {
            scope: vec!["core".into()],
            name: format!("v{index}"),
            format: Format::signed(24, 22),
            states: &[],
        };
        (0..VARIABLES).map(variable).collect()
    }

    fn sample(&self, codes: &mut Vec<i64>) {
        codes.extend_from_slice(&self.codes);
    }
}

/// Nanoseconds for each clock, and bytes of the file.
fn measure(kind: Kind, changing: usize, settings: &Settings) -> (f64, u64) {
    let folder = folder();
    let path = folder.path().join("waves");
    let mut busy = Busy { codes: (0..VARIABLES as i64).collect(), changing };
    let mut tracer = Tracer::new(kind.create(&path).unwrap(), &busy, &[], settings).unwrap();
    let start = Instant::now();
    for _ in 0..CLOCKS {
        busy.step();
        tracer.clock(&busy).unwrap();
    }
    tracer.finish().unwrap();
    (start.elapsed().as_nanos() as f64 / CLOCKS as f64, path.metadata().unwrap().len())
}

#[test]
fn cost_of_a_clock() {
    println!("{VARIABLES} variables of 24 bits, {CLOCKS} clocks; ns a clock, the file finished");
    println!("| file | changing | ns/clock | ns/clock/variable | bytes/clock |");
    println!("| --- | --- | --- | --- | --- |");
    let outside = Settings { window: Some(0..1), ..settings() };
    for kind in [Kind::Vcd, Kind::Fst] {
        for (changing, settings) in [
            (0, &outside),
            (0, &settings()),
            (5, &settings()),
            (20, &settings()),
            (100, &settings()),
        ] {
            let (ns, bytes) = measure(kind, changing, settings);
            let name = if settings == &outside {
                "outside the window".into()
            } else {
                changing.to_string()
            };
            let (each, bytes) = (ns / VARIABLES as f64, bytes as f64 / CLOCKS as f64);
            println!("| {} | {name} | {ns:.1} | {each:.3} | {bytes:.1} |", kind.extension());
        }
    }
}
