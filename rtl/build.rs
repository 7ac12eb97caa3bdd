// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tells tests which external tools there are.

#[path = "../tests/found.rs"]
mod found;

fn main() {
    found::set("..");
    println!("cargo::rerun-if-changed=../tests/found.rs");
}
