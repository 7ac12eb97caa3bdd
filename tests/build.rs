// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tells tests whether code is optimised: they are thorough where it is, which debug assertions do
//! not say; and which external tools there are.

mod found;

fn main() {
    found::set("..");
    println!("cargo::rerun-if-changed=found.rs");
    println!("cargo::rustc-check-cfg=cfg(optimised)");
    if std::env::var("OPT_LEVEL").is_ok_and(|level| level != "0") {
        println!("cargo::rustc-cfg=optimised");
    }
}
