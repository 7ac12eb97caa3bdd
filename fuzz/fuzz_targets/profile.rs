// SPDX-License-Identifier: MIT OR Apache-2.0
#![no_main]

hapticore_fuzz::mutate_values!("profile");

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    hapticore_tests::fuzz::run("profile", data);
});
