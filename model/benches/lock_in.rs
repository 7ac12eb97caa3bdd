// SPDX-License-Identifier: MIT OR Apache-2.0
//! How far the lock-in rejects what is not the carrier: prints `docs/lock-in.md`.
//!
//! `cargo bench -p hapticore-model --bench lock_in > docs/lock-in.md`

#[path = "../tests/lock_in/measure.rs"]
mod measure;

fn main() {
    print!("{}", measure::document(&measure::all()));
}
