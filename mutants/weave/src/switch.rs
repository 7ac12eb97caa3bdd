// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which of the woven mutants is enabled: `HAPTICORE_MUTANT`, a number; none where it is not set. Where
//! `HAPTICORE_REACHED` names a file, none is, and the numbers of those that are met are written there.

use std::fs::File;
use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

const UNREAD: u32 = u32::MAX;
const RECORDS: u32 = u32::MAX - 1;

static ENABLED: AtomicU32 = AtomicU32::new(UNREAD);
static REACHED: [AtomicBool; 1 << 16] = [const { AtomicBool::new(false) }; 1 << 16];
static RECORD: OnceLock<File> = OnceLock::new();

/// The number of the enabled mutant where it is one of `first ..= last`, else 0.
#[inline(always)]
pub fn woven(first: u32, last: u32) -> u32 {
    let enabled = ENABLED.load(Ordering::Relaxed);
    if enabled < RECORDS {
        if first <= enabled && enabled <= last { enabled } else { 0 }
    } else {
        unusual(first, last)
    }
}

#[cold]
#[inline(never)]
fn unusual(first: u32, last: u32) -> u32 {
    if REACHED[first as usize].load(Ordering::Relaxed) {
        return 0;
    }
    let record = RECORD.get().or_else(|| {
        let name = std::env::var_os("HAPTICORE_REACHED")?;
        Some(RECORD.get_or_init(|| File::create(name).expect("a file of what is reached")))
    });
    if let Some(mut file) = record {
        ENABLED.store(RECORDS, Ordering::Relaxed);
        if !REACHED[first as usize].swap(true, Ordering::Relaxed) {
            file.write_all(format!("{first} {last}\n").as_bytes()).expect("written");
        }
        return 0;
    }
    let enabled = std::env::var("HAPTICORE_MUTANT").map_or(0, |text| text.parse().expect("a number"));
    ENABLED.store(enabled, Ordering::Relaxed);
    woven(first, last)
}
