// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is written is what an independent reader reads, at every clock, in both formats.

use std::path::Path;

use crate::common::{Fake, VARIABLES, folder, settings, trace, true_x};
use hapticore_waveforms::fst_file::FstFile;
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::tracer::{Settings, Tracer};
use wellen::SignalValueRef;
use wellen::simple::Waveform;

const CLOCKS: u64 = 700;

/// A waveform file as `wellen` reads it.
struct Read(Waveform);

impl Read {
    fn new(path: &Path) -> Self {
        let mut waveform = wellen::simple::read(path).unwrap();
        let signals: Vec<_> = waveform
            .hierarchy()
            .all_vars()
            .map(|var| waveform.hierarchy()[var].signal_ref())
            .collect();
        waveform.load_signals(&signals);
        Read(waveform)
    }

    fn last_tick(&self) -> u64 {
        *self.0.time_table().last().unwrap()
    }

    /// The value of a signal at a tick: digits, or a number; nothing before its first value.
    fn at(&self, path: &str, tick: u64) -> Option<String> {
        let names: Vec<_> = path.split('.').collect();
        let (name, scopes) = names.split_last().unwrap();
        let var = self
            .0
            .hierarchy()
            .lookup_var(scopes, name)
            .unwrap_or_else(|| panic!("{path} is not in the file"));
        let signal = self.0.get_signal(self.0.hierarchy()[var].signal_ref()).unwrap();
        let index = self.0.time_table().partition_point(|&time| time <= tick).checked_sub(1)?;
        let offset = signal.get_offset(index as u32)?;
        Some(match signal.get_value_at(&offset, 0) {
            SignalValueRef::Real(value) => value.to_string(),
            SignalValueRef::BitVec(value) => value.bit_string(),
            other => panic!("{path}: {other:?}"),
        })
    }

    fn code(&self, path: &str, width: u8, tick: u64) -> String {
        let digits = self.at(path, tick).unwrap_or_default();
        assert_eq!(digits.len(), usize::from(width), "{path} at {tick}");
        digits
    }

    /// Checks every variable of the made-up core at every clock, just at it and just before the
    /// next.
    fn check_codes(&self, clocks: std::ops::Range<u64>, period: u64) {
        for clock in clocks {
            for (&(path, format, _), code) in VARIABLES.iter().zip((Fake { clock }).codes()) {
                let width = usize::from(format.width);
                let expected = &format!("{code:064b}")[64 - width..];
                for tick in [clock * period, (clock + 1) * period - 1] {
                    assert_eq!(
                        self.code(path, format.width, tick),
                        expected,
                        "{path} at {tick}: {code} as {format}"
                    );
                }
            }
        }
    }
}

fn both(test: impl Fn(Kind)) {
    [Kind::Vcd, Kind::Fst].into_iter().for_each(test);
}

#[test]
fn every_code_comes_back_at_every_clock() {
    both(|kind| {
        let folder = folder();
        let (path, trace) = trace(folder.path(), kind, &settings(), CLOCKS);
        assert_eq!(trace.ticks, 0..CLOCKS * 40);
        let read = Read::new(&path);
        assert_eq!(read.last_tick(), CLOCKS * 40);
        read.check_codes(0..CLOCKS, 40);
    });
}

#[test]
fn truth_comes_back_to_the_bit() {
    both(|kind| {
        let folder = folder();
        let read = Read::new(&trace(folder.path(), kind, &settings(), CLOCKS).0);
        for clock in 0..CLOCKS {
            assert_eq!(read.at("truth.x", clock * 40), Some(true_x(clock).to_string()));
        }
        let unset = read.at("truth.error", 4 * 40).filter(|value| value != "NaN");
        assert_eq!((unset, read.at("truth.error", 5 * 40)), (None, Some((-1.5e-12).to_string())));
    });
}

#[test]
fn a_window_holds_its_clocks_and_no_others() {
    both(|kind| {
        let folder = folder();
        let settings = Settings { window: Some(100..140), ..settings() };
        let (path, trace) = trace(folder.path(), kind, &settings, CLOCKS);
        assert_eq!(trace.ticks, 4000..5600);
        let read = Read::new(&path);
        read.check_codes(100..140, 40);
        assert_eq!(read.last_tick(), 5600);
        let before = read.at("core.oscillator.sin", 3999).filter(|digits| !digits.starts_with('x'));
        assert_eq!(before, None, "nothing is known before the window");
        assert_eq!(
            read.at("truth.error", 4000),
            Some((-1.5e-12).to_string()),
            "set long before the window"
        );
    });
}

#[test]
fn the_clock_wire_rises_with_the_registers() {
    both(|kind| {
        let folder = folder();
        let settings = Settings { clock_wire: true, ..settings() };
        let read = Read::new(&trace(folder.path(), kind, &settings, 4).0);
        let wire: String = (0..8).map(|half| read.code("core.clock", 1, half * 20)).collect();
        assert_eq!(wire, "10101010");
        read.check_codes(0..4, 40);
    });
}

#[test]
fn clocks_passed_over_hold_their_values() {
    let folder = folder();
    let path = folder.path().join("waves.vcd");
    let wave = Kind::Vcd.create(&path).unwrap();
    let mut tracer = Tracer::new(wave, &Fake { clock: 0 }, &[], &settings()).unwrap();
    tracer.clock(&Fake { clock: 0 }).unwrap();
    tracer.skip(9);
    tracer.clock(&Fake { clock: 10 }).unwrap();
    tracer.finish().unwrap();
    let read = Read::new(&path);
    read.check_codes(10..11, 40);
    assert_eq!(read.at("core.oscillator.sin", 399), read.at("core.oscillator.sin", 0));
}

#[test]
fn sections_of_an_fst_join_without_a_seam() {
    let folder = folder();
    let path = folder.path().join("waves.fst");
    let wave = FstFile::create(&path).unwrap().with_section_bytes(2000);
    let mut tracer = Tracer::new(wave, &Fake { clock: 0 }, &[], &settings()).unwrap();
    for clock in 0..CLOCKS {
        tracer.clock(&Fake { clock }).unwrap();
    }
    tracer.finish().unwrap();
    Read::new(&path).check_codes(0..CLOCKS, 40);
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    both(|kind| {
        let folders = [folder(), folder()];
        let [a, b] = folders.each_ref().map(|folder| trace(folder.path(), kind, &settings(), 50).0);
        assert_eq!(std::fs::read(a).unwrap(), std::fs::read(b).unwrap());
    });
}
