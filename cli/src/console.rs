// SPDX-License-Identifier: MIT OR Apache-2.0
//! Standard output and standard error, which may be closed or full: a run is never lost to them.
//!
//! A reader that has gone (`hapticore simulate fig3 | head -1`) wants no more: what is left to say
//! is dropped in silence. Any other failure, a full disk, is an error, told when everything else is
//! done.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::Mutex;

use anyhow::{Context, Result};

/// A colour of terminals.
#[derive(Clone, Copy)]
pub enum Colour {
    /// What fails.
    Red,
    /// What passes.
    Green,
}

/// Text on standard output, in a colour where that is a terminal and `NO_COLOR` is not set.
pub fn coloured(text: &str, colour: Colour) -> String {
    in_colour(text, colour, io::stdout().is_terminal())
}

/// The same in red on standard error.
pub fn red_of_stderr(text: &str) -> String {
    in_colour(text, Colour::Red, io::stderr().is_terminal())
}

/// The variable that keeps colours off: <https://no-color.org>.
const NO_COLOUR: &str = "NO_COLOR";

fn in_colour(text: &str, colour: Colour, terminal: bool) -> String {
    let no_colour = std::env::var_os(NO_COLOUR).is_some_and(|value| !value.is_empty());
    if !terminal || no_colour {
        return text.into();
    }
    let code = match colour {
        Colour::Red => 31,
        Colour::Green => 32,
    };
    format!("\x1b[{code}m{text}\x1b[0m")
}

/// Why standard output takes no more.
static FAILED: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints a line to standard output, as `println!` does.
#[macro_export]
macro_rules! say {
    ($($text:tt)*) => { $crate::console::print(format_args!("{}\n", format_args!($($text)*))) };
}

/// Prints text to standard output, until that fails.
pub fn print(text: Arguments) {
    let mut failed = FAILED.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if failed.is_none() {
        *failed = io::stdout().write_fmt(text).err();
    }
}

/// Prints a line to standard error, or nothing where that fails: there is no other stream to report
/// it on.
pub fn complain(text: Arguments) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Prints a warning to standard error.
pub fn warn(text: &str) {
    complain(format_args!("{} {text}", red_of_stderr("warning:")));
}

/// Sends on what has been printed: a program that waits for it may be reading.
pub fn flush() {
    let mut failed = FAILED.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if failed.is_none() {
        *failed = io::stdout().flush().err();
    }
}

/// Ends standard output.
///
/// # Errors
/// It did not take everything, though somebody reads it.
pub fn finish() -> Result<()> {
    let mut failed = FAILED.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    match failed.take().map_or_else(|| io::stdout().flush(), Err) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(error).context("standard output")
        }
        _ => Ok(()),
    }
}
