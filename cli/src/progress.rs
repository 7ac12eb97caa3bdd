// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress of long work, on standard error and only where a terminal is there to show it.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar over so many `things`; hidden where `quiet` or nobody looks.
pub fn bar_of(count: u64, things: &str, quiet: bool) -> ProgressBar {
    let template = format!("{{bar:40}} {{pos}}/{{len}} {things}, {{eta}} left");
    let bar = bar(Some(count), quiet);
    bar.set_style(ProgressStyle::with_template(&template).expect("a valid template"));
    bar
}

/// A bar over `steps`, none where unknown; hidden where `quiet` or nobody looks.
pub fn bar(steps: Option<u64>, quiet: bool) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    match steps {
        Some(steps) => {
            let template = "{bar:40} {pos}/{len} slots, {eta} left";
            ProgressBar::new(steps)
                .with_style(ProgressStyle::with_template(template).expect("a valid template"))
        }
        None => {
            let template = "{spinner} {pos} slots";
            ProgressBar::new_spinner()
                .with_style(ProgressStyle::with_template(template).expect("a valid template"))
        }
    }
}

/// Work whose length is not known; hidden where `quiet` or nobody looks.
pub fn work(what: &'static str, quiet: bool) -> ProgressBar {
    let bar = bar(None, quiet);
    let template = "{spinner} {msg}, {elapsed}";
    bar.set_style(ProgressStyle::with_template(template).expect("a valid template"));
    bar.with_message(what)
}
