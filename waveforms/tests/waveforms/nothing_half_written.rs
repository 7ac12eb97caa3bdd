// SPDX-License-Identifier: MIT OR Apache-2.0
//! A file appears whole or not at all.

use std::fs;
use std::path::Path;

use crate::common::{Fake, folder, settings, truth};
use hapticore_waveforms::Error;
use hapticore_waveforms::declarations::Declarations;
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::tracer::{Settings, Tracer};
use hapticore_waveforms::wave::Wave;

fn names(folder: &Path) -> Vec<String> {
    fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn a_dropped_trace_leaves_nothing_and_an_older_file_alone() {
    for kind in [Kind::Vcd, Kind::Fst] {
        let folder = folder();
        let path = folder.path().join("waves");
        fs::write(&path, "older").unwrap();
        let mut tracer =
            Tracer::new(kind.create(&path).unwrap(), &Fake { clock: 0 }, &truth(), &settings())
                .unwrap();
        (0..1000).for_each(|clock| tracer.clock(&Fake { clock }).unwrap());
        assert_eq!(names(folder.path()).len(), 2, "a partial file");
        drop(tracer);
        assert_eq!(
            (names(folder.path()), fs::read_to_string(&path).unwrap()),
            (vec!["waves".into()], "older".into())
        );
    }
}

#[test]
fn a_finished_trace_leaves_one_file() {
    for kind in [Kind::Vcd, Kind::Fst] {
        let folder = folder();
        let (path, _) = crate::common::trace(folder.path(), kind, &settings(), 10);
        assert_eq!(names(folder.path()), [path.file_name().unwrap().to_str().unwrap()]);
    }
}

#[test]
fn a_folder_that_is_not_there_is_an_error_that_names_the_file() {
    let path = Path::new("no/such/folder/waves.vcd");
    for kind in [Kind::Vcd, Kind::Fst] {
        let tracer = kind
            .create(path)
            .and_then(|wave| Tracer::new(wave, &Fake { clock: 0 }, &[], &settings()));
        assert!(tracer.err().unwrap().to_string().contains("no/such/folder/waves.vcd"));
    }
}

#[test]
fn a_run_that_never_enters_the_window_leaves_no_file() {
    let settings = Settings { window: Some(50..60), ..settings() };
    for kind in [Kind::Vcd, Kind::Fst] {
        let folder = folder();
        let wave = kind.create(&folder.path().join("waves")).unwrap();
        let mut tracer = Tracer::new(wave, &Fake { clock: 0 }, &[], &settings).unwrap();
        (0..10).for_each(|clock| tracer.clock(&Fake { clock }).unwrap());
        let error = tracer.finish().unwrap_err().to_string();
        assert_eq!(error, "waves not kept: expected clocks in the window 50 to 60, got 10 clocks");
        assert!(names(folder.path()).is_empty());
    }
}

/// A file on a disk that is full for one change.
struct Full {
    changes: u32,
}

impl Wave for Full {
    fn begin(&mut self, _: &Declarations) -> Result<(), Error> {
        Ok(())
    }

    fn time(&mut self, _: u64) -> Result<(), Error> {
        Ok(())
    }

    fn bits(&mut self, _: usize, _: u64) -> Result<(), Error> {
        self.changes += 1;
        if self.changes == 30 { Err(Error::Incomplete) } else { Ok(()) }
    }

    fn real(&mut self, _: usize, _: f64) -> Result<(), Error> {
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        panic!("a trace with a hole is not kept");
    }
}

#[test]
fn a_trace_with_a_hole_is_not_kept() {
    let mut tracer =
        Tracer::new(Full { changes: 0 }, &Fake { clock: 0 }, &[], &settings()).unwrap();
    let failures = (0..100).filter(|&clock| tracer.clock(&Fake { clock }).is_err()).count();
    assert_eq!(failures, 1);
    assert!(matches!(tracer.finish(), Err(Error::Incomplete)));
}
