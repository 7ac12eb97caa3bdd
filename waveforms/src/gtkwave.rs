// SPDX-License-Identifier: MIT OR Apache-2.0
//! GTKWave save files: a view of one trace, ready to open.
//!
//! Codes are shown as the numbers they stand for, states by name, chosen signals as curves. The
//! same save file opens the VCD and the FST of a run, from any working directory and wherever the
//! folder is moved. It also opens the dump of the printed Verilog in a bench of the same instances.
//! Marks of the trace are markers A, B, …. Checked with GTKWave 3.3.118.
//!
//! GTKWave leaves a fraction below 0.0001 out of a fixed-point number (0.00001 shows as 0, 2.00001
//! as 2; curves too). A format whose largest number is about that small is therefore shown as its
//! raw code, with what one step is worth: `gain (2^-38)`; so are codes worth more than one.

use std::ops::Range;
use std::path::Path;

use crate::Error;
use crate::declarations::{Encoding, Signal};
use crate::display::{alias, fixed_point, flag, flags, viewer_path};
use crate::layout::{Row, Section, lay_out};
use crate::tracer::Trace;
use crate::view::{Style, View, ViewError};

/// The width of the waves on a screen for the first zoom, in units of 200 pixels as GTKWave counts
/// it.
const SCREEN_FRAMES: f64 = 3.2;

/// Letters of markers.
const MARKERS: usize = 26;

/// A folder that does not exist. GTKWave carries names over from the folder where the save file
/// says it was saved to the one where it is found; a plain file name would be looked for in the
/// working directory.
const FOLDER: &str = "/hapticore";

/// A save file and the files it refers to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SaveFile {
    /// The text of the save file.
    pub text: String,
    /// The translation files, by name: code to state. They belong into the same folder.
    pub translations: Vec<(String, String)>,
}

impl SaveFile {
    /// The save file that shows `ticks` of `trace` as `view` says; opened alone, it opens the file
    /// `dump` beside it. Translation files get names that start as that of `dump`.
    ///
    /// # Errors
    /// The view names a signal that the trace does not have.
    pub fn new(
        view: &View,
        trace: &Trace,
        dump: &str,
        ticks: &Range<u64>,
    ) -> Result<Self, ViewError> {
        let stem = dump.rsplit_once('.').map_or(dump, |(stem, _)| stem);
        let text = head(dump, ticks) + &markers(trace);
        let mut printer = Printer { trace, stem, text, translations: Vec::new() };
        lay_out(view, &trace.declarations)?.iter().for_each(|section| printer.section(section));
        let translations = printer
            .translations
            .into_iter()
            .map(|(name, states)| (name, translation(states)))
            .collect();
        Ok(SaveFile { text: printer.text, translations })
    }
}

/// Writes the save file `path` and its translation files, for `ticks` of the waveform file `dump` in
/// the same folder.
///
/// # Errors
/// The view does not fit the trace, or a file cannot be written.
pub fn save(
    view: &View,
    trace: &Trace,
    dump: &str,
    ticks: &Range<u64>,
    path: &Path,
) -> Result<(), Error> {
    let file = SaveFile::new(view, trace, dump, ticks)?;
    for (name, text) in &file.translations {
        write(&path.with_file_name(name), text)?;
    }
    write(path, &file.text)
}

struct Printer<'a> {
    trace: &'a Trace,
    stem: &'a str,
    text: String,
    translations: Vec<(String, States)>,
}

type States = &'static [&'static str];

impl Printer<'_> {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn flags(&mut self, flags: u64) {
        self.line(&format!("@{flags:x}"));
    }

    fn section(&mut self, section: &Section) {
        let closed = if section.closed { flag::CLOSED } else { 0 };
        self.flags(flag::GROUP_BEGIN | flag::BLANK | closed);
        self.line(&format!("-{}", section.heading));
        section.rows.iter().for_each(|row| self.row(row));
        self.flags(flag::GROUP_END | flag::BLANK | closed);
        self.line(&format!("-{}", section.heading));
    }

    fn row(&mut self, row: &Row) {
        let trace = self.trace;
        let signal = &trace.declarations.signals()[row.signal];
        self.flags(flags(&signal.encoding, row.style));
        self.attributes(signal, row);
        let path = viewer_path(signal);
        let alias = row.alias.clone().unwrap_or_else(|| alias(signal));
        self.line(&format!("+{{{alias}}} {path}"));
        self.height(row);
    }

    fn attributes(&mut self, signal: &Signal, row: &Row) {
        if let (Encoding::State(_, states), Style::Number) = (&signal.encoding, row.style) {
            let (number, name) = self.translation(signal, states);
            self.line(&format!("^{number} {FOLDER}/{name}"));
        }
        if let Some(color) = row.color {
            self.line(&format!("[color] {}", color as u8));
        }
        if let Some(shift) = fixed_point(&signal.encoding, row.style) {
            self.line(&format!("[fpshift_count] {shift}"));
        }
    }

    /// The empty lines over which an analog trace stretches.
    fn height(&mut self, row: &Row) {
        if matches!(row.style, Style::Step | Style::Line) {
            for _ in 1..row.height {
                self.flags(flag::STRETCH);
                self.line("-");
            }
        }
    }

    /// The number, from 1, and name of the translation file of `states`; signals with the same
    /// states share one.
    fn translation(&mut self, signal: &Signal, states: States) -> (usize, String) {
        let known = self.translations.iter().position(|(_, known)| *known == states);
        let index = known.unwrap_or_else(|| {
            self.translations.push((format!("{}.{}.txt", self.stem, signal.path()), states));
            self.translations.len() - 1
        });
        (index + 1, self.translations[index].0.clone())
    }
}

fn head(dump: &str, ticks: &Range<u64>) -> String {
    let start = ticks.start;
    let span = ticks.end.saturating_sub(start).max(1) as f64;
    let zoom = -(span / SCREEN_FRAMES).log2();
    format!(
        "[*] GTKWave save file, written by hapticore
[dumpfile] \"{FOLDER}/{dump}\"
[savefile] \"{FOLDER}/{dump}.gtkw\"
[timestart] {start}
[size] 1600 900
[pos] -1 -1
[sst_width] 220
[signals_width] 300
[sst_expanded] 1
*{zoom:.6} -1"
    )
}

/// The ends of the line that begins with the zoom: ticks of markers, then their names.
fn markers(trace: &Trace) -> String {
    let marks = trace.marks.iter().take(MARKERS);
    let mut text: String = marks.clone().map(|(_, tick)| format!(" {tick}")).collect();
    text += "\n";
    for ((name, _), letter) in marks.zip('A'..) {
        text += &format!("[markername] {letter}{name}\n");
    }
    text
}

/// The lines `code NAME` of a translation file; codes in decimal, as the flags ask for.
fn translation(states: States) -> String {
    states.iter().enumerate().map(|(code, name)| format!("{code} {name}\n")).collect()
}

/// Writes a whole small file atomically.
fn write(path: &Path, text: &str) -> Result<(), Error> {
    hapticore_files::write(path, text).map_err(Error::io(path))
}
