// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the fuzz targets share.

use libfuzzer_sys::Corpus;

/// A target of texts: libFuzzer changes values rather than bytes, and exchanges those of two texts
/// (`hapticore_tests::fuzz::{mutate, cross}`).
#[macro_export]
macro_rules! text_target {
    ($target:literal) => {
        libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
            let bytes = libfuzzer_sys::fuzzer_mutate;
            hapticore_tests::fuzz::mutate($target, data, size, most, seed, bytes)
        });
        libfuzzer_sys::fuzz_crossover!(|data1: &[u8], data2: &[u8], out: &mut [u8], seed: u32| {
            hapticore_tests::fuzz::cross($target, data1, data2, out, seed)
        });
        libfuzzer_sys::fuzz_target!(|data: &[u8]| -> libfuzzer_sys::Corpus {
            $crate::run($target, data)
        });
    };
}

/// Runs a target and says whether libFuzzer may go on from the input: from each that is accepted, and of those that
/// are refused from one in 1024. They would be nearly all of the corpus, and what is made of them is seldom accepted.
pub fn run(target: &str, data: &[u8]) -> Corpus {
    let accepted = hapticore_tests::fuzz::run(target, data);
    let sum =
        data.iter().fold(0_u32, |sum, byte| sum.wrapping_mul(31).wrapping_add((*byte).into()));
    if accepted || sum.is_multiple_of(1024) { Corpus::Keep } else { Corpus::Reject }
}
