// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tells whether code is optimised: the formats of every register are checked at every clock where
//! it is not, which debug assertions do not say.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(optimised)");
    if std::env::var("OPT_LEVEL").is_ok_and(|level| level != "0") {
        println!("cargo::rustc-cfg=optimised");
    }
}
