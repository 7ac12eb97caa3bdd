// SPDX-License-Identifier: MIT OR Apache-2.0
//! The program of `examples/board_to_csv.rs` on bytes of a simulated board: its rows are those of
//! `hapticore simulate`.

#[path = "../examples/board_to_csv.rs"]
mod board_to_csv;

use board_to_csv::convert;
use hapticore_host::END;
use std::io::{self, Read, Write};

const CALIBRATION: &str = "recordings/hockey.calibration.toml";

fn recorded() -> Vec<u8> {
    std::fs::read("recordings/hockey.bin").expect("a recording")
}

fn expected() -> String {
    std::fs::read_to_string("recordings/hockey.frames.csv").expect("frames")
}

fn converted(bytes: impl Read) -> String {
    let mut csv = Vec::new();
    convert(["small", CALIBRATION], bytes, &mut csv).expect("a conversion");
    String::from_utf8(csv).expect("text")
}

#[test]
fn a_recording_becomes_the_rows_of_simulate() {
    assert_eq!(converted(recorded().as_slice()), expected());
}

#[test]
fn a_damaged_frame_is_left_out_and_the_others_keep_their_times() {
    let mut bytes = recorded();
    let ends: Vec<_> = (0..bytes.len()).filter(|&at| bytes[at] == END).collect();
    // A byte within the third frame from the end.
    bytes[ends[ends.len() - 4] + 5] ^= 0x10;
    let mut rows: Vec<_> = expected().lines().map(str::to_owned).collect();
    rows.remove(rows.len() - 3);
    assert_eq!(converted(bytes.as_slice()).lines().collect::<Vec<_>>(), rows);
}

#[test]
fn bytes_that_come_one_by_one_are_the_same() {
    struct Slow(std::vec::IntoIter<u8>);
    impl Read for Slow {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            Ok(self.0.next().map_or(0, |byte| {
                into[0] = byte;
                1
            }))
        }
    }
    assert_eq!(converted(Slow(recorded().into_iter())), expected());
}

#[test]
fn a_pipe_that_closes_ends_the_conversion() {
    struct Closed(usize);
    impl Write for Closed {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 = self.0.checked_sub(1).ok_or(io::ErrorKind::BrokenPipe)?;
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    // The board sends for ever; the reader goes after two rows.
    let endless = recorded().into_iter().cycle();
    struct Endless<I>(I);
    impl<I: Iterator<Item = u8>> Read for Endless<I> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            into.iter_mut().for_each(|byte| *byte = self.0.next().expect("endless"));
            Ok(into.len())
        }
    }
    let error =
        convert(["small", CALIBRATION], Endless(endless), Closed(2)).expect_err("a closed pipe");
    assert!(error.to_string().contains("pipe"), "{error}");
}
