// SPDX-License-Identifier: MIT OR Apache-2.0
//! Progress of long work, on standard error: a bar on a terminal, else a line every ten seconds.

use std::io::IsTerminal;
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::console::complain;

/// How often a line is printed where there is no terminal.
const LINE: Duration = Duration::from_secs(10);

/// A bar over `count` `things`, `None` where unknown; hidden where `quiet`.
pub fn bar(count: Option<u64>, things: &str, quiet: bool) -> ProgressBar {
    let template = match count {
        Some(_) => "{bar:40} {pos}/{len} {msg}, {eta} left",
        None => "{spinner} {pos} {msg}",
    };
    shown(count, template, things, quiet)
}

/// Work whose steps are not counted; hidden where `quiet`.
pub fn work(what: &str, quiet: bool) -> ProgressBar {
    shown(None, "{spinner} {msg}, {elapsed}", what, quiet)
}

fn shown(count: Option<u64>, template: &str, message: &str, quiet: bool) -> ProgressBar {
    let bar = if quiet || !std::io::stderr().is_terminal() {
        ProgressBar::hidden()
    } else {
        count.map_or_else(ProgressBar::new_spinner, ProgressBar::new)
    };
    bar.set_style(ProgressStyle::with_template(template).expect("a valid template"));
    bar.set_message(message.to_owned());
    if let Some(count) = count {
        bar.set_length(count);
    }
    if !quiet && bar.is_hidden() {
        print_lines(&bar);
    }
    bar
}

/// Prints where a hidden bar is, as long as it is neither finished nor dropped.
fn print_lines(bar: &ProgressBar) {
    let bar = bar.downgrade();
    thread::spawn(move || {
        loop {
            thread::sleep(LINE);
            match bar.upgrade() {
                Some(bar) if !bar.is_finished() => {
                    complain(format_args!("progress: {}", line(&bar)))
                }
                _ => return,
            }
        }
    });
}

fn line(bar: &ProgressBar) -> String {
    let (at, message, after) = (bar.position(), bar.message(), bar.elapsed().as_secs());
    match bar.length() {
        Some(count) => {
            format!("{at} of {count} {message} after {after} s{}", left(at, count, bar.elapsed()))
        }
        None if at > 0 => format!("{at} {message} after {after} s"),
        None => format!("{message}: {after} s"),
    }
}

/// How long the rest takes, at the speed so far.
fn left(at: u64, count: u64, elapsed: Duration) -> String {
    let rest = count.saturating_sub(at) as f64 / at as f64;
    let seconds = rest * elapsed.as_secs_f64();
    if seconds.is_finite() { format!(", about {seconds:.0} s left") } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_names_what_is_done_of_what() {
        let bar = bar(Some(7), "points", true);
        bar.inc(3);
        assert_eq!(line(&bar), "3 of 7 points after 0 s, about 0 s left");
        assert_eq!(left(3, 7, Duration::from_secs(30)), ", about 40 s left");
        assert_eq!(left(0, 7, Duration::from_secs(30)), "");
        let work = work("calibrating", true);
        assert_eq!(line(&work), "calibrating: 0 s");
    }
}
