// SPDX-License-Identifier: MIT OR Apache-2.0
#![no_main]

hapticore_fuzz::text_target!("tuning");
