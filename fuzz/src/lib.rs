// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the fuzz targets share.

/// Has libFuzzer change values of a target's text rather than bytes, and exchange those of two texts
/// (`hapticore_tests::fuzz::{mutate, cross}`).
#[macro_export]
macro_rules! mutate_values {
    ($target:literal) => {
        libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
            let bytes = libfuzzer_sys::fuzzer_mutate;
            hapticore_tests::fuzz::mutate($target, data, size, most, seed, bytes)
        });
        libfuzzer_sys::fuzz_crossover!(|data1: &[u8], data2: &[u8], out: &mut [u8], seed: u32| {
            hapticore_tests::fuzz::cross($target, data1, data2, out, seed)
        });
    };
}
