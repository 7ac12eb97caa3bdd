// SPDX-License-Identifier: MIT OR Apache-2.0
#![no_main]

hapticore_fuzz::mutate_values!("calibration");

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    hapticore_tests::fuzz::run("calibration", data);
});
